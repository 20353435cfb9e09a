// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// A file in a zip archive.
struct ZipMember {
  std::string name;
  std::size_t at = 0;      ///< byte of its local header
  std::size_t packed = 0;  ///< bytes
  std::size_t size = 0;    ///< bytes once unpacked, as the archive says
  unsigned method = 0;     ///< 0 stored, 8 deflated
  unsigned crc = 0;
};

/// The members of a zip archive in the order of its directory; nothing where the bytes are none. Zip64,
/// several volumes and encryption are not understood.
std::vector<ZipMember> zip_members(std::string_view bytes);

/// Unpacks a member. Throws Error (with `name` of the archive) where it is damaged, packed in a way that is
/// not known, or larger than `most_bytes`.
std::string unpacked(std::string_view bytes, const ZipMember& member, const std::string& name,
                     std::size_t most_bytes);

/// A file that is to lie in a zip archive.
struct ZipFile {
  std::string name;  ///< with folders, parted by '/'
  std::string bytes;
};

/// The bytes of a zip archive, every file deflated; the same files give the same bytes (no dates). Throws
/// Error where it would need more than what plain zip holds: 65 535 files, 4 GB.
std::string zipped(const std::vector<ZipFile>& files);

}  // namespace limen
