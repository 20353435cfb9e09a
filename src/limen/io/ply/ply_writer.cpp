// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/io/ply/ply.h"

namespace limen {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are in memory");

constexpr std::size_t kRowsPerWrite = 16384;
constexpr std::size_t kWrittenStrip = 512;

const char* ply_name(Scalar type) {
  static constexpr const char* kNames[] = {"char", "uchar", "short",  "ushort", "int",
                                           "uint", "int64", "uint64", "float",  "double"};
  return kNames[static_cast<std::size_t>(type)];
}

/// A number as another type: whole numbers are rounded and kept within their range, not-a-number becomes 0.
template <typename Value>
Value converted(double number) {
  if constexpr (std::is_floating_point_v<Value>) {
    return static_cast<Value>(number);
  } else {
    if (!(number == number)) return 0;
    const double rounded = std::round(number);
    if (rounded <= static_cast<double>(std::numeric_limits<Value>::lowest()))
      return std::numeric_limits<Value>::lowest();
    if (rounded >= static_cast<double>(std::numeric_limits<Value>::max()))
      return std::numeric_limits<Value>::max();
    return static_cast<Value>(rounded);
  }
}

/// Where one column of some rows goes.
struct Target {
  char* first;
  std::size_t stride;
};

template <typename Value>
void put_numbers(const RecordTable& table, const Field& field, RowRange rows, const Target& to) {
  double strip[kWrittenStrip];
  char* at = to.first;
  for (std::size_t begin = rows.begin; begin < rows.end; begin += kWrittenStrip) {
    const std::size_t end = std::min(rows.end, begin + kWrittenStrip);
    load_numbers(table, field, {begin, end}, strip);
    for (std::size_t i = begin; i < end; ++i, at += to.stride) {
      const auto value = converted<Value>(strip[i - begin]);
      std::memcpy(at, &value, sizeof value);
    }
  }
}

void copy_numbers(const Field& field, RowRange rows, std::size_t bytes, const Target& to) {
  const char* from = field.data + rows.begin * field.stride;
  char* at = to.first;
  for (std::size_t i = rows.begin; i < rows.end; ++i, at += to.stride, from += field.stride)
    std::memcpy(at, from, bytes);
}

void put_column(const RecordTable& table, const Field& field, Scalar type, RowRange rows, const Target& to) {
  if (field.plain() && field.type == type && !table.swapped)
    return copy_numbers(field, rows, size_of(type), to);
  with_type(type, [&](auto kind) { put_numbers<decltype(kind)>(table, field, rows, to); });
}

std::string property_word(std::string name) {
  for (char& c : name) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') c = '_';
  }
  return name.empty() ? "_" : name;
}

bool has_origins(const CloudPlan& plan) {
  return std::any_of(plan.columns.begin(), plan.columns.end(),
                     [](const ColumnPlan& column) { return lower_case(column.name) == "x_origin"; });
}

/// The header; of the same length for every number of points, so that the number can be put in later.
std::string header_of(const CloudPlan& plan, std::uint64_t points) {
  const std::string count = std::to_string(points);
  const std::string room(20 - std::min<std::size_t>(20, count.size()), '-');
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment limen\n";
  if (!has_origins(plan)) {
    text += plan.centre ? fmt::format("comment scanner_position {} {} {}\n", plan.centre->x(),
                                      plan.centre->y(), plan.centre->z())
                        : "comment scanner_position unknown\n";
  }
  for (const std::string& crs : plan.georeference) text += "comment crs " + one_line(crs) + "\n";
  text += fmt::format("comment {}\nelement vertex {}\n", room, count);
  for (const ColumnPlan& column : plan.columns)
    text += fmt::format("property {} {}\n", ply_name(column.type), property_word(column.name));
  return text + "end_header\n";
}

class PlyWriter : public CloudWriter {
 public:
  PlyWriter(const std::filesystem::path& path, CloudPlan plan) : plan_(std::move(plan)), file_(path) {
    file_.write(header_of(plan_, plan_.most_points));
    for (const ColumnPlan& column : plan_.columns) record_bytes_ += size_of(column.type);
  }

  void write(const RecordTable& rows) override {
    constexpr std::size_t kRowsAtOnce = 16 * kRowsPerWrite;
    for (std::size_t begin = 0; begin < rows.rows; begin += kRowsAtOnce)
      write_rows(rows, {begin, std::min(rows.rows, begin + kRowsAtOnce)});
    points_ += rows.rows;
  }

  void finish() override {
    if (points_ == 0) throw Error("no points are left to write", plan_.name, "check the input");
    if (points_ != plan_.most_points) file_.overwrite(0, header_of(plan_, points_));
    file_.commit();
  }

 private:
  void write_rows(const RecordTable& table, RowRange rows) {
    const std::size_t count = rows.end - rows.begin;
    bytes_.resize(count * record_bytes_);
    parallel_for(count, kRowsPerWrite, [&](std::size_t begin, std::size_t end) {
      std::size_t at = begin * record_bytes_;
      for (std::size_t k = 0; k < plan_.columns.size(); ++k) {
        const Scalar type = plan_.columns[k].type;
        put_column(table, table.fields[k], type, {rows.begin + begin, rows.begin + end},
                   {bytes_.data() + at, record_bytes_});
        at += size_of(type);
      }
    });
    file_.write(bytes_);
  }

  CloudPlan plan_;
  AtomicFile file_;
  std::size_t record_bytes_ = 0;
  std::uint64_t points_ = 0;
  std::string bytes_;
};

}  // namespace

std::unique_ptr<CloudWriter> make_ply_writer(const std::filesystem::path& path, const CloudPlan& plan) {
  return std::make_unique<PlyWriter>(path, plan);
}

}  // namespace limen
