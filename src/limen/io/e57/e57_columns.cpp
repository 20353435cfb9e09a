// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/io/e57/e57_crc.h"

namespace limen {
namespace {

/// Rows per task.
constexpr std::size_t kPart = 65536;
constexpr std::array<const char*, 3> kCartesian{"cartesianX", "cartesianY", "cartesianZ"};
constexpr std::array<const char*, 3> kSpherical{"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
constexpr std::array<std::array<const char*, 2>, 14> kNames{{{"cartesianX", "x"},
                                                             {"cartesianY", "y"},
                                                             {"cartesianZ", "z"},
                                                             {"colorRed", "red"},
                                                             {"colorGreen", "green"},
                                                             {"colorBlue", "blue"},
                                                             {"rowIndex", "row_index"},
                                                             {"columnIndex", "column_index"},
                                                             {"timeStamp", "gps_time"},
                                                             {"returnIndex", "return_index"},
                                                             {"returnCount", "return_count"},
                                                             {"nor:normalX", "nx"},
                                                             {"nor:normalY", "ny"},
                                                             {"nor:normalZ", "nz"}}};

/// The smallest type that holds all integers from minimum to maximum.
Scalar narrowest(std::int64_t minimum, std::int64_t maximum) {
  const auto within = [&](auto type) {
    using Limits = std::numeric_limits<decltype(type)>;
    return minimum >= std::int64_t{Limits::min()} && maximum <= std::int64_t{Limits::max()};
  };
  if (within(std::uint8_t{})) return Scalar::uint8;
  if (within(std::int8_t{})) return Scalar::int8;
  if (within(std::uint16_t{})) return Scalar::uint16;
  if (within(std::int16_t{})) return Scalar::int16;
  if (within(std::uint32_t{})) return Scalar::uint32;
  if (within(std::int32_t{})) return Scalar::int32;
  return Scalar::int64;
}

/// Where a column's bits are, and what is to be made of them.
struct Packed {
  const E57Bits* bits;
  unsigned width;
  std::uint64_t minimum;
  std::size_t count;
};

template <typename Value>
void unpack(const Packed& packed, char* to) {
  auto* out = reinterpret_cast<Value*>(to);
  const char* const bytes = packed.bits->bytes.data();
  const std::uint64_t mask = packed.width >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << packed.width) - 1;
  std::size_t bit = packed.bits->shift;
  if (packed.width <= 57) {
    for (std::size_t i = 0; i < packed.count; ++i, bit += packed.width) {
      const std::uint64_t raw = (load_eight(bytes + (bit >> 3U)) >> (bit & 7U)) & mask;
      out[i] = static_cast<Value>(static_cast<std::int64_t>(packed.minimum + raw));
    }
    return;
  }
  for (std::size_t i = 0; i < packed.count; ++i, bit += packed.width) {
    std::uint64_t raw = load_eight(bytes + (bit >> 3U)) >> (bit & 7U);
    if ((bit & 7U) != 0)
      raw |= std::uint64_t{static_cast<unsigned char>(bytes[(bit >> 3U) + 8])} << (64U - (bit & 7U));
    out[i] = static_cast<Value>(static_cast<std::int64_t>(packed.minimum + (raw & mask)));
  }
}

void unpack_as(Scalar type, const Packed& packed, char* to) {
  switch (type) {
    case Scalar::int8:
    case Scalar::uint8:
      return unpack<std::uint8_t>(packed, to);
    case Scalar::int16:
    case Scalar::uint16:
      return unpack<std::uint16_t>(packed, to);
    case Scalar::int32:
    case Scalar::uint32:
      return unpack<std::uint32_t>(packed, to);
    case Scalar::float64:
      return unpack<double>(packed, to);
    default:
      return unpack<std::int64_t>(packed, to);
  }
}

void scale_in_place(double* numbers, std::size_t count, double scale, double offset) {
  if (scale == 1.0 && offset == 0.0) return;
  for (std::size_t i = 0; i < count; ++i) numbers[i] = offset + scale * numbers[i];
}

bool all_ones(double number) {
  return number == std::floor(number) && number < 65535.0 &&
         (static_cast<unsigned>(number) & (static_cast<unsigned>(number) + 1U)) == 0;
}

}  // namespace

/// The decoded numbers of a table.
struct E57Fields::Piece {
  std::vector<std::unique_ptr<char[]>> columns;
};

std::string e57_field_name(const std::string& column_name) {
  for (const auto& [theirs, ours] : kNames) {
    if (column_name == theirs) return ours;
  }
  constexpr std::string_view kOurs = "limen:";
  if (column_name.rfind(kOurs, 0) == 0)
    return e57_plain_name(std::string_view(column_name).substr(kOurs.size()));
  return column_name;
}

E57Fields::E57Fields(const E57Scan& scan) : scan_(&scan) {
  plan_coordinates();
  for (int k = 0; k < static_cast<int>(scan.columns.size()); ++k) {
    const bool planned =
        std::any_of(plans_.begin(), plans_.end(), [&](const Plan& plan) { return plan.column == k; });
    const bool used = std::find(ball_.begin(), ball_.end(), k) != ball_.end();
    const bool text = scan.columns[static_cast<std::size_t>(k)].storage == E57Storage::text;
    if (!planned && !used && !text && k != state_) plan_column(k, false);
  }
}

int E57Fields::find(const char* name) const {
  for (std::size_t k = 0; k < scan_->columns.size(); ++k) {
    const E57Column& column = scan_->columns[k];
    if (column.name == name && column.storage != E57Storage::text) return static_cast<int>(k);
  }
  return -1;
}

void E57Fields::plan_coordinates() {
  const auto all = [&](const std::array<const char*, 3>& names) {
    std::vector<int> columns;
    for (const char* name : names) columns.push_back(find(name));
    if (std::find(columns.begin(), columns.end(), -1) != columns.end()) columns.clear();
    return columns;
  };
  const std::vector<int> cartesian = all(kCartesian);
  if (!cartesian.empty()) {
    state_ = find("cartesianInvalidState");
    for (const int column : cartesian) plan_column(column, true);
    return;
  }
  ball_ = all(kSpherical);
  if (ball_.empty()) return;
  state_ = find("sphericalInvalidState");
  for (const char* name : {"x", "y", "z"}) {
    Plan plan;
    plan.name = name;
    plans_.push_back(std::move(plan));
    names_.emplace_back(name);
  }
}

void E57Fields::plan_column(int column, bool coordinate) {
  const E57Column& source = scan_->columns[static_cast<std::size_t>(column)];
  Plan plan;
  names_.push_back(e57_field_name(source.name));
  plan.name = lower_case(names_.back());
  plan.column = column;
  if (source.storage == E57Storage::integer) {
    plan.type = narrowest(source.minimum, source.maximum);
    plan.constant = source.bits == 0;
    plan.scale = source.scale;
    plan.offset = source.offset;
    if (coordinate && state_ >= 0) {  // an invalid point is not a number
      plan.type = Scalar::float64;
      plan.constant = false;
      plan.as_value = true;
      plan.scale = 1.0;
      plan.offset = 0.0;
    }
  } else {
    plan.type = source.storage == E57Storage::float32 ? Scalar::float32 : Scalar::float64;
  }
  if (source.name == "timeStamp") plan.offset += scan_->acquisition_start_s;
  scale_colour(plan);
  plans_.push_back(std::move(plan));
}

/// Colours of unusual ranges (10 bits, fractions of one) are brought to 0..255 or 0..65535; limits that look
/// like those of the values found are left alone.
void E57Fields::scale_colour(Plan& plan) const {
  static constexpr std::array<std::string_view, 3> kColours{"red", "green", "blue"};
  const auto* const found = std::find(kColours.begin(), kColours.end(), plan.name);
  if (found == kColours.end()) return;
  const E57Column& source = scan_->columns[static_cast<std::size_t>(plan.column)];
  const bool integer = source.storage == E57Storage::integer;
  std::optional<E57Limits> limits = scan_->colour_limits[static_cast<std::size_t>(found - kColours.begin())];
  if (!limits && integer)
    limits = {source.offset + source.scale * static_cast<double>(source.minimum),
              source.offset + source.scale * static_cast<double>(source.maximum)};
  const bool bytes = integer && source.maximum == 255 && source.scale == 1.0;
  if (!limits || bytes || limits->low != 0.0 || !(limits->high > 0.0)) return;
  const double high = limits->high;
  if (high == 255.0 || high == 65535.0 || !(high > 255.0 || all_ones(high))) return;
  const double factor = (high > 255.0 ? 65535.0 : 255.0) / high;
  plan.scale *= factor;
  plan.offset *= factor;
}

std::vector<double> E57Fields::values(const E57Streams& streams, int column, RowRange rows) const {
  std::vector<double> numbers(rows.end - rows.begin);
  const E57Column& source = scan_->columns[static_cast<std::size_t>(column)];
  Plan plan;
  plan.column = column;
  plan.as_value = source.storage == E57Storage::integer;
  if (source.storage != E57Storage::float32) {
    decode_part(streams, plan, rows, reinterpret_cast<char*>(numbers.data()));
    return numbers;
  }
  std::vector<float> floats(numbers.size());
  decode_part(streams, plan, rows, reinterpret_cast<char*>(floats.data()));
  std::copy(floats.begin(), floats.end(), numbers.begin());
  return numbers;
}

void E57Fields::decode_part(const E57Streams& streams, const Plan& plan, RowRange rows, char* out) const {
  const E57Column& source = scan_->columns[static_cast<std::size_t>(plan.column)];
  const std::size_t count = rows.end - rows.begin;
  E57Bits bits;
  if (source.bits == 0) {
    bits.bytes.resize(sizeof(std::uint64_t) * 2);
  } else {
    bits = streams.bits_of(static_cast<std::size_t>(plan.column), rows);
  }
  if (source.storage != E57Storage::integer) {
    std::memcpy(out, bits.bytes.data(), count * source.bits / 8);
    return;
  }
  unpack_as(plan.type, {&bits, source.bits, static_cast<std::uint64_t>(source.minimum), count}, out);
  if (plan.as_value) scale_in_place(reinterpret_cast<double*>(out), count, source.scale, source.offset);
}

/// Spherical coordinates become Cartesian; invalid ones become not a number.
void E57Fields::mend_coordinates(const E57Streams& streams, RowRange rows, Piece& piece) const {
  if (spherical()) {
    const std::vector<double> range = values(streams, ball_[0], rows);
    const std::vector<double> azimuth = values(streams, ball_[1], rows);
    const std::vector<double> elevation = values(streams, ball_[2], rows);
    std::array<double*, 3> x{};
    for (std::size_t k = 0; k < 3; ++k) x[k] = reinterpret_cast<double*>(piece.columns[k].get());
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      const std::size_t j = i - rows.begin;
      const double level = range[j] * std::cos(elevation[j]);
      x[0][i] = level * std::cos(azimuth[j]);
      x[1][i] = level * std::sin(azimuth[j]);
      x[2][i] = range[j] * std::sin(elevation[j]);
    }
  }
  if (state_ < 0) return;
  const std::vector<double> state = values(streams, state_, rows);
  for (std::size_t k = 0; k < 3; ++k) {
    char* const column = piece.columns[k].get();
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      if (state[i - rows.begin] == 0.0) continue;
      if (plans_[k].type == Scalar::float32) {
        reinterpret_cast<float*>(column)[i] = std::numeric_limits<float>::quiet_NaN();
      } else {
        reinterpret_cast<double*>(column)[i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }
}

RecordTable E57Fields::decode(const E57Streams& streams, std::size_t rows) const {
  auto piece = std::make_shared<Piece>();
  RecordTable table;
  table.rows = rows;
  for (const Plan& plan : plans_) {
    const std::size_t size = size_of(plan.type);
    piece->columns.emplace_back(new char[(plan.constant ? 1 : rows) * size]);
    table.fields.push_back({plan.name,
                            plan.type,
                            piece->columns.back().get(),
                            plan.constant ? 0 : size,
                            plan.scale,
                            plan.offset,
                            {}});
    if (plan.constant && rows > 0) decode_part(streams, plan, {0, 1}, piece->columns.back().get());
  }
  const std::size_t parts = (rows + kPart - 1) / kPart;
  const auto part = [&](std::size_t i) { return RowRange{i * kPart, std::min(rows, (i + 1) * kPart)}; };
  parallel_for(parts * plans_.size(), 1, [&](std::size_t task, std::size_t) {
    const Plan& plan = plans_[task % plans_.size()];
    if (plan.column < 0 || plan.constant) return;
    const RowRange own = part(task / plans_.size());
    char* const out = piece->columns[task % plans_.size()].get() + own.begin * size_of(plan.type);
    decode_part(streams, plan, own, out);
  });
  if (state_ >= 0 || spherical())
    parallel_for(parts, 1, [&](std::size_t i, std::size_t) { mend_coordinates(streams, part(i), *piece); });
  table.keeper = std::move(piece);
  return table;
}

}  // namespace limen
