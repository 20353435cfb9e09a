// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace limen {

/// A scan as a user names it: a file, or by " #N" behind it one of the scans in it, counted from 0.
struct ScanInFile {
  std::string file;
  std::optional<std::size_t> index;  ///< empty: the file as a whole
};

/// The two parts of a name, whatever is on the disk.
ScanInFile split_scan_name(const std::string& name);

/// The same, but a name that is that of a file as it is written, or whose first part is none, is whole.
ScanInFile scan_in_file(const std::string& name);

/// The file of scan_in_file().
std::string file_of_scan(const std::string& name);

}  // namespace limen
