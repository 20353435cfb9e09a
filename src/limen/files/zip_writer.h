// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// A file that is to lie in a zip archive.
struct ZipFile {
  std::string name;  ///< with folders, parted by '/'
  std::string bytes;
};

/// The bytes of a zip archive, every file deflated; the same files give the same bytes (no dates). Throws
/// Error where it would need more than what plain zip holds: 65 535 files, 4 GB.
std::string zipped(const std::vector<ZipFile>& files);

}  // namespace limen
