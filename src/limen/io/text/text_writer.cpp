// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/table_cells.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

constexpr std::size_t kLinesAtOnce = 8192;

/// A name as one word of a line.
std::string column_word(std::string name) {
  for (char& c : name) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == ';') c = '_';
  }
  return name.empty() ? "_" : name;
}

bool is_coordinate(const std::string& name) {
  const std::string lower = lower_case(name);
  return lower == "x" || lower == "y" || lower == "z" || lower == "x_origin" || lower == "y_origin" ||
         lower == "z_origin";
}

class TextWriter : public CloudWriter {
 public:
  TextWriter(const std::filesystem::path& path, CloudPlan plan)
      : plan_(std::move(plan)), commas_(lower_case(path.extension().string()) == ".csv"), file_(path) {
    file_.write(head());
  }

  void write(const RecordTable& rows) override {
    for (std::size_t begin = 0; begin < rows.rows; begin += kLinesAtOnce)
      write_rows(rows, {begin, std::min(rows.rows, begin + kLinesAtOnce)});
    points_ += rows.rows;
  }

  void finish() override {
    if (points_ == 0) throw Error("no points are left to write", plan_.name, "check the input");
    file_.commit();
  }

 private:
  [[nodiscard]] std::string head() const {
    std::string text;
    if (!commas_) {
      if (plan_.centre) text += scanner_position_line(*plan_.centre) + "\n";
      for (const std::string& crs : plan_.georeference) text += "// crs " + one_line(crs) + "\n";
    }
    std::string names;
    for (const ColumnPlan& column : plan_.columns) {
      if (!names.empty()) names += separator();
      names += commas_ ? csv_field(column_word(column.name)) : column_word(column.name);
    }
    return text + (commas_ ? "" : "// ") + names + "\n";
  }

  [[nodiscard]] char separator() const { return commas_ ? ',' : ' '; }

  void append(double number, const ColumnPlan& column) {
    auto out = std::back_inserter(text_);
    if (is_coordinate(column.name)) {
      fmt::format_to(out, "{:.6f}", number);
    } else if (is_integer(column.type)) {
      fmt::format_to(out, "{:.0f}", number);
    } else if (column.type == Scalar::float32) {
      fmt::format_to(out, "{}", static_cast<float>(number));
    } else {
      fmt::format_to(out, "{}", number);
    }
  }

  void write_rows(const RecordTable& table, RowRange rows) {
    const std::size_t columns = plan_.columns.size();
    numbers_.resize((rows.end - rows.begin) * columns);
    for (std::size_t k = 0; k < columns; ++k)
      load_numbers(table, table.fields[k], rows, numbers_.data() + k, columns);
    text_.clear();
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      const std::size_t k = i % columns;
      append(numbers_[i], plan_.columns[k]);
      text_.push_back(k + 1 == columns ? '\n' : separator());
    }
    file_.write({text_.data(), text_.size()});
  }

  CloudPlan plan_;
  bool commas_;
  AtomicFile file_;
  std::uint64_t points_ = 0;
  std::vector<double> numbers_;
  std::string text_;
};

}  // namespace

std::string scanner_position_line(const Vector3d& centre) {
  return fmt::format("// scanner_position {:.6f} {:.6f} {:.6f}", centre.x(), centre.y(), centre.z());
}

std::unique_ptr<CloudWriter> make_text_writer(const std::filesystem::path& path, const CloudPlan& plan) {
  return std::make_unique<TextWriter>(path, plan);
}

}  // namespace limen
