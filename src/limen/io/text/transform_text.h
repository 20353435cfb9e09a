// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/table/transformed_cloud.h"

namespace limen {

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
  struct Triple {
    std::size_t column[3];
    bool direction;
  };
  std::vector<Triple> triples_;
  Rigid3 motion_;
};

/// The part of transform_cloud for PTS, XYZ and other text.
TransformedCloud transform_text(const NamedBytes& input, const Rigid3& target_from_source,
                                const std::filesystem::path& output);

}  // namespace limen
