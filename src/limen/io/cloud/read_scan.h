// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/io/table/scan_file.h"
#include "limen/model/scan.h"

namespace limen {

/// One scan of several in the same world frame, about the local origin of the first, each point with its own
/// scanner position. Centres, times, intensities, colours and topology are kept where every scan has them.
/// `scans` is not empty.
Scan join_scans(const std::vector<Scan>& scans);

/// Reads a file, or "FILE #N" for one scan of it, with all that is known about it; the format is recognised
/// by content, then by extension. Throws Error that names file, place and remedy for anything that cannot be
/// read.
ScanFile read_scan_file(const std::filesystem::path& path, const ReadOptions& options = {},
                        Monitor& monitor = silent_monitor());

/// How many points of a file that was read are no points: its user may have exported it wrong. Empty where
/// all are. It is among the notes of read_scan_file().
std::string unusable_note(const ScanFile& file);
std::string unusable_note(std::size_t unusable, std::size_t kept);

/// Reads scan `index` of a file, in the order of read_scan_file(), without the others where the format
/// allows. Throws Error where there is none.
Scan read_one_scan(const std::filesystem::path& path, std::size_t index, const ReadOptions& options = {},
                   Monitor& monitor = silent_monitor());

/// Reads every scan of a file. Most formats hold one, PTX holds several.
std::vector<Scan> read_scans(const std::filesystem::path& path, const ReadOptions& options = {},
                             Monitor& monitor = silent_monitor());

/// Reads a file of one scan; several static stations of a PTX are joined into one scan with per-point
/// centres.
Scan read_scan(const std::filesystem::path& path, const ReadOptions& options = {},
               Monitor& monitor = silent_monitor());

/// A sentence where a file says that its numbers are no metres; empty where they are.
std::string unit_remark(double metres_per_unit);

/// A sentence where an offset that a file names was added to its numbers; empty where none was.
std::string offset_remark(const Vector3d& offset_applied);

}  // namespace limen
