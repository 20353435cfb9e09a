// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/table/point_file.h"
#include "limen/io/table/scan_file.h"

namespace limen {

/// The part of transform_cloud for PTX.
TransformedCloud transform_ptx(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output);

/// True where the bytes begin like a PTX file: ten lines of 1, 1, 3, 3, 3, 3, 4, 4, 4 and 4 numbers.
bool looks_like_ptx(std::string_view bytes);

/// Reads a PTX file from memory: any number of static scans, each moved to world coordinates by its 4 x 4
/// matrix. Each scan has its scanner's position as scanner position (where the matrix is the identity, 0,0,0
/// only where that can be the scanner), and columns and rows as topology. Missing returns (0 0 0) are left
/// out. `name` is for messages. Throws Error that names the file, the scan and the line.
ScanFile read_ptx(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

/// The same file, each scan of it a cloud that is read in pieces; `bytes` must outlive it.
std::unique_ptr<PointFile> open_ptx(std::string_view bytes, const std::string& name);

/// Where a scan of a PTX file lies in its text.
struct PtxPlace {
  std::size_t header = 0;  ///< byte at which its ten header lines begin
  std::size_t body = 0;    ///< byte behind them
  std::size_t points = 0;  ///< lines of points that follow
};
/// The places of all scans, in their order. Throws Error where a header is damaged or points are missing.
std::vector<PtxPlace> ptx_places(std::string_view bytes, const std::string& name);

}  // namespace limen
