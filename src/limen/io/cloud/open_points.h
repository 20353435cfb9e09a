// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "limen/files/mapped_file.h"
#include "limen/io/table/point_file.h"

namespace limen {

/// The formats of points that are read.
enum class PointFormat { ply, pcd, ptx, text, e57, las };

/// By what the bytes say, then by the ending of `path`, so that a damaged file is named for what it wants to
/// be. Throws Error where it is none of them.
PointFormat point_format_of(std::string_view bytes, const std::filesystem::path& path);

/// A point file with the bytes it is read from.
class OpenPoints {
 public:
  /// Throws Error where the file cannot be opened or its head not be read.
  explicit OpenPoints(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string name() const { return path_.string(); }
  [[nodiscard]] std::string_view bytes() const { return bytes_->bytes(); }
  [[nodiscard]] PointFormat format() const { return format_; }
  [[nodiscard]] const PointFile& file() const { return *file_; }
  /// Texts of the coordinate system, where the file has some.
  [[nodiscard]] const std::vector<std::string>& georeference() const { return georeference_; }
  /// Points of all clouds, as the file says.
  [[nodiscard]] std::uint64_t points() const;
  /// Gives the memory of bytes that were read back; they may be read again.
  void forget() const { bytes_->forget(); }

 private:
  std::filesystem::path path_;
  std::unique_ptr<MappedFile> bytes_;
  PointFormat format_;
  std::unique_ptr<PointFile> file_;
  std::vector<std::string> georeference_;
};

}  // namespace limen
