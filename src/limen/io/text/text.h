// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/table/cloud_writer.h"
#include "limen/io/table/moved_columns.h"
#include "limen/io/table/point_file.h"
#include "limen/io/table/scan_file.h"

namespace limen {

/// Writes text, one point a line: a first line with the names of the columns (after "//", or plain in .csv),
/// numbers with blanks between them (commas in .csv). Coordinates have six decimals, a micrometre; all other
/// numbers the digits that give their type back. Optical centre and coordinate system stand in comment lines,
/// not in .csv. Throws Error where the file cannot be written.
std::unique_ptr<CloudWriter> make_text_writer(const std::filesystem::path& path, const CloudPlan& plan);

/// Moves the numbers of lines of text: three columns that are a point, or a direction that only turns. Every
/// other byte of a line stays. Numbers keep their digits behind the point, four at least for metres.
class LineMover {
 public:
  /// `names` of the columns, lower case.
  LineMover(const std::vector<std::string>& names, const Rigid3& motion);

  /// Appends the moved line, its end included as it was. Throws Error that names `where` for a line that
  /// lacks a number.
  void append(std::string& out, std::string_view line, const std::string& where) const;
  /// The lines of a text that are rows, moved on all threads; the others as they are.
  [[nodiscard]] std::string moved(std::string_view text, bool counts_allowed, const std::string& where) const;

 private:
  std::vector<MovedColumns> triples_;
  Rigid3 motion_;
};

/// The part of transform_cloud for PTS, XYZ and other text.
TransformedCloud transform_text(const NamedBytes& input, const Rigid3& target_from_source,
                                const std::filesystem::path& output);

/// The position in a comment line "// scanner_position X Y Z"; nothing in any other line.
std::optional<Vector3d> scanner_position_in(std::string_view line);
/// Such a comment line, without its end.
std::string scanner_position_line(const Vector3d& centre);

/// True where the bytes are text whose first lines are rows of numbers (PTS, XYZ, CSV).
bool looks_like_xyz(std::string_view bytes);

/// Reads points from text: PTS with its count line, XYZ, CSV and the like from memory. Separators are blanks,
/// tabs, commas and semicolons; numbers have decimal points. Lines that begin with #, % or // are comments,
/// of which one may state the scanner's position; a line with names x, y and z, a comment or not, names the
/// columns. Without names: 3 columns are x y z, 4 end with intensity, 7 with intensity red green blue, 6 with
/// red green blue where these are whole numbers up to 255; further columns are passed over. `name` is for
/// messages. Throws Error that names file and line.
ScanFile read_xyz(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

/// How the rows of a text are to be understood.
struct TextLayout {
  std::size_t body = 0;            ///< bytes before the first row
  bool counted = false;            ///< lines with a count stand before rows (PTS)
  std::vector<std::string> names;  ///< of the columns, lower case
};
TextLayout text_layout(std::string_view bytes, const std::string& name);

/// The same file as a cloud that is read in pieces; `bytes` must outlive it.
std::unique_ptr<PointFile> open_xyz(std::string_view bytes, const std::string& name);

}  // namespace limen
