// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/files/mapped_file.h"
#include "limen/files/scan_in_file.h"
#include "limen/io/table/point_file.h"

namespace limen {

/// The formats of points that are read.
enum class PointFormat { ply, pcd, ptx, text, e57, las };

/// By what the bytes say, then by the ending of `path`, so that a damaged file is named for what it wants to
/// be. Throws Error where it is none of them.
PointFormat point_format_of(std::string_view bytes, const std::filesystem::path& path);

/// The clouds with points of a file, of which empty ones are no scans; a file of one cloud has one scan.
std::vector<std::size_t> scans_with_points(const PointFile& file);

/// Rows that are read at once where a file is read piece by piece.
constexpr std::size_t kPointsAtOnce = std::size_t{1} << 18U;

/// A point file with the bytes it is read from, or one scan of such a file: then the other clouds of the file
/// are not seen.
class OpenPoints {
 public:
  /// `path`: a file, or "FILE #N" for one of its scans (files/scan_in_file.h). Throws Error where the file
  /// cannot be opened or its head not be read, and where it has no such scan.
  explicit OpenPoints(const std::filesystem::path& path);
  /// Scan number `scan` of the file, counted among those with points.
  OpenPoints(const std::filesystem::path& path, std::size_t scan);

  /// As it was given.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string name() const { return path_.string(); }
  [[nodiscard]] std::string_view bytes() const { return bytes_->bytes(); }
  [[nodiscard]] PointFormat format() const { return format_; }
  [[nodiscard]] const PointFile& file() const { return *file_; }
  /// Texts of the coordinate system, where the file has some.
  [[nodiscard]] const std::vector<std::string>& georeference() const { return georeference_; }
  /// The one scan of several that was named; empty: all that the file holds.
  [[nodiscard]] const std::optional<std::size_t>& chosen() const { return chosen_; }
  /// Number in the whole file of a cloud of file().
  [[nodiscard]] std::size_t number_in_file(std::size_t cloud) const { return first_ + cloud; }
  /// Points of all clouds, as the file says.
  [[nodiscard]] std::uint64_t points() const;
  /// Reads all points of a cloud of file(), as a proof that it can be read. Throws Error where it cannot.
  void prove(std::size_t cloud) const;
  /// Gives the memory of bytes that were read back; they may be read again.
  void forget() const { bytes_->forget(); }

 private:
  OpenPoints(const std::filesystem::path& path, const ScanInFile& named);

  std::filesystem::path path_;
  std::optional<std::size_t> chosen_;
  std::size_t first_ = 0;  ///< number in the file of the first cloud of file_
  std::unique_ptr<MappedFile> bytes_;
  PointFormat format_;
  std::unique_ptr<PointFile> file_;
  std::vector<std::string> georeference_;
};

}  // namespace limen
