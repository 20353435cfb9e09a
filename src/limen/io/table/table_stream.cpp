// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/table_stream.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"

namespace limen {
namespace {

class TableStream : public PointStream {
 public:
  explicit TableStream(RecordTable table) : table_(std::move(table)) {}

  std::optional<RecordTable> next(std::size_t most_rows) override {
    if (at_ >= table_.rows) return {};
    RecordTable piece = table_;
    piece.rows = std::min(std::max<std::size_t>(1, most_rows), table_.rows - at_);
    for (Field& field : piece.fields) field.data += at_ * field.stride;
    at_ += piece.rows;
    return piece;
  }

 private:
  RecordTable table_;
  std::size_t at_ = 0;
};

/// Bytes of the first `rows` lines of `text`, all of it where it has fewer.
std::size_t bytes_of_lines(std::string_view text, std::size_t rows) {
  std::size_t at = 0;
  for (std::size_t row = 0; row < rows && at < text.size(); ++row) {
    const void* newline = std::memchr(text.data() + at, '\n', text.size() - at);
    if (newline == nullptr) return text.size();
    at = static_cast<std::size_t>(static_cast<const char*>(newline) - text.data()) + 1;
  }
  return at;
}

class TextStream : public PointStream {
 public:
  explicit TextStream(TextCloud cloud) : cloud_(std::move(cloud)), skip_(cloud_.wanted.skip) {}

  std::optional<RecordTable> next(std::size_t most_rows) override {
    while (!cloud_.text.empty() && left() > 0) {
      // No more lines than rows that are wanted: what follows them may be of another kind.
      std::vector<double> numbers = take(std::min(std::max<std::size_t>(1, most_rows), left()));
      if (numbers.empty()) continue;
      std::vector<std::string> names = cloud_.names;
      if (cloud_.change) names = cloud_.change(numbers);
      return table_of_numbers(std::make_shared<const std::vector<double>>(std::move(numbers)), names);
    }
    require_all();
    return {};
  }

 private:
  [[nodiscard]] std::size_t left() const {
    return cloud_.wanted.rows ? *cloud_.wanted.rows - read_ : static_cast<std::size_t>(-1);
  }

  /// The numbers of the next lines.
  std::vector<double> take(std::size_t lines) {
    const std::string_view text = cloud_.text.substr(0, bytes_of_lines(cloud_.text, lines));
    TextRows wanted = cloud_.wanted;
    wanted.skip = 0;
    wanted.rows.reset();
    wanted.first_line_number += lines_;
    const std::size_t columns = wanted.columns;
    if (skip_ > 0) wanted.columns = 0;  // rows of another kind may stand here
    ParsedRows parsed = parse_rows(text, wanted, cloud_.file);
    if (skip_ >= parsed.rows) {
      skip_ -= parsed.rows;
      parsed.numbers.clear();
    } else if (skip_ > 0) {
      wanted.skip = std::exchange(skip_, 0);
      wanted.columns = columns;
      parsed = parse_rows(text, wanted, cloud_.file);
    }
    cloud_.text.remove_prefix(text.size());
    lines_ += parsed.lines;
    promised_ += parsed.promised;
    read_ += parsed.numbers.size() / columns;
    return std::move(parsed.numbers);
  }

  void require_all() const {
    const std::size_t wanted = std::max(promised_, cloud_.wanted.rows.value_or(0));
    if (read_ >= wanted) return;
    throw Error(fmt::format("the file ends after {} of {} points", read_, wanted), cloud_.file,
                "get the whole file, or correct the count");
  }

  TextCloud cloud_;
  std::size_t skip_;
  std::size_t lines_ = 0;
  std::size_t read_ = 0;
  std::size_t promised_ = 0;
};

class SourcesFile : public PointFile {
 public:
  SourcesFile(std::string format, std::vector<CloudSource> sources)
      : format_(std::move(format)), sources_(std::move(sources)) {
    for (const CloudSource& source : sources_) clouds_.push_back(source.facts);
  }
  [[nodiscard]] std::string format() const override { return format_; }
  [[nodiscard]] const std::vector<CloudFacts>& clouds() const override { return clouds_; }
  [[nodiscard]] std::unique_ptr<PointStream> read(std::size_t index) const override {
    return sources_.at(index).open();
  }

 private:
  std::string format_;
  std::vector<CloudSource> sources_;
  std::vector<CloudFacts> clouds_;
};

}  // namespace

std::unique_ptr<PointStream> stream_of_table(RecordTable table) {
  return std::make_unique<TableStream>(std::move(table));
}

std::unique_ptr<PointStream> stream_of_text(TextCloud cloud) {
  if (cloud.names.empty()) return stream_of_table({});
  return std::make_unique<TextStream>(std::move(cloud));
}

std::unique_ptr<PointFile> make_point_file(std::string format, std::vector<CloudSource> clouds) {
  return std::make_unique<SourcesFile>(std::move(format), std::move(clouds));
}

}  // namespace limen
