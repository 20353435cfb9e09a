// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "limen/files/text_numbers.h"
#include "limen/io/table/point_file.h"

namespace limen {

/// A table that is there as a whole, piece after piece.
std::unique_ptr<PointStream> stream_of_table(RecordTable table);

/// Rows of numbers in a text that are to become a cloud.
struct TextCloud {
  std::string_view text;
  TextRows wanted;
  std::vector<std::string> names;  ///< of the columns, as many as wanted.columns
  std::string file;                ///< for messages
  /// What is done to the numbers of each piece, and the names of the columns they have then; may be empty.
  std::function<std::vector<std::string>(std::vector<double>& numbers)> change = {};
};

/// The rows of a text piece after piece, none where there are no columns. Where `wanted.rows` or counts in
/// the text promise more rows than there are, an Error comes at the end.
std::unique_ptr<PointStream> stream_of_text(TextCloud cloud);

/// One cloud and how it is read.
struct CloudSource {
  CloudFacts facts;
  std::function<std::unique_ptr<PointStream>()> open;
};

/// A point file made of what its parts say.
std::unique_ptr<PointFile> make_point_file(std::string format, std::vector<CloudSource> clouds);

}  // namespace limen
