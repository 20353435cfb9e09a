// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/record_table.h"

#include <cstring>
#include <utility>

namespace limen {
namespace {

template <std::size_t bytes>
struct Unsigned;
template <>
struct Unsigned<1> {
  using Type = std::uint8_t;
  static Type swap(Type value) { return value; }
};
template <>
struct Unsigned<2> {
  using Type = std::uint16_t;
  static Type swap(Type value) { return __builtin_bswap16(value); }
};
template <>
struct Unsigned<4> {
  using Type = std::uint32_t;
  static Type swap(Type value) { return __builtin_bswap32(value); }
};
template <>
struct Unsigned<8> {
  using Type = std::uint64_t;
  static Type swap(Type value) { return __builtin_bswap64(value); }
};

template <typename Value, bool swapped>
double load_one(const char* bytes) {
  using Bits = Unsigned<sizeof(Value)>;
  typename Bits::Type bits;
  std::memcpy(&bits, bytes, sizeof bits);
  if constexpr (swapped) bits = Bits::swap(bits);
  Value value;
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

/// Source and destination of one loop over a column.
struct NumberStrip {
  const char* from;
  std::size_t from_stride;
  std::size_t count;
  double* to;
  std::size_t to_stride;
};

template <typename Value>
void load_strip(const NumberStrip& strip, bool swapped) {
  const char* from = strip.from;
  double* to = strip.to;
  if (swapped) {
    for (std::size_t i = 0; i < strip.count; ++i, from += strip.from_stride, to += strip.to_stride)
      *to = load_one<Value, true>(from);
  } else {
    for (std::size_t i = 0; i < strip.count; ++i, from += strip.from_stride, to += strip.to_stride)
      *to = load_one<Value, false>(from);
  }
}

void keep_bits(const NumberStrip& strip, BitRange bits) {
  const std::uint64_t mask = bits.count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits.count) - 1;
  for (std::size_t i = 0; i < strip.count; ++i) {
    double& number = strip.to[i * strip.to_stride];
    number = static_cast<double>((static_cast<std::uint64_t>(number) >> bits.shift) & mask);
  }
}

}  // namespace

std::size_t size_of(Scalar scalar) {
  return with_type(scalar, [](auto value) { return sizeof value; });
}

bool is_integer(Scalar scalar) {
  return scalar != Scalar::float32 && scalar != Scalar::float64;
}

const Field* RecordTable::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    for (const Field& field : fields) {
      if (field.name == name) return &field;
    }
  }
  return nullptr;
}

RecordTable table_of_numbers(std::shared_ptr<const std::vector<double>> numbers,
                             const std::vector<std::string>& names) {
  RecordTable table;
  table.rows = names.empty() ? 0 : numbers->size() / names.size();
  const auto* first = reinterpret_cast<const char*>(numbers->data());
  for (std::size_t k = 0; k < names.size(); ++k) {
    table.fields.push_back(
        {names[k], Scalar::float64, first + k * sizeof(double), names.size() * sizeof(double)});
  }
  table.keeper = std::move(numbers);
  return table;
}

void load_numbers(const RecordTable& table, const Field& field, RowRange rows, double* out,
                  std::size_t out_stride) {
  const NumberStrip strip{field.data + rows.begin * field.stride, field.stride, rows.end - rows.begin, out,
                          out_stride};
  with_type(field.type, [&](auto value) { load_strip<decltype(value)>(strip, table.swapped); });
  if (field.bits.count != 0) keep_bits(strip, field.bits);
  if (field.scale != 1.0 || field.offset != 0.0) {
    for (std::size_t i = 0; i < strip.count; ++i)
      out[i * out_stride] = field.offset + field.scale * out[i * out_stride];
  }
}

double load_number(const char* bytes, Scalar type, bool swapped) {
  double number = 0.0;
  with_type(type, [&](auto value) { load_strip<decltype(value)>({bytes, 0, 1, &number, 1}, swapped); });
  return number;
}

const Field* find_times(const RecordTable& table) {
  return table.find(
      {"gps_time", "gpstime", "time", "t", "timestamp", "scalar_gps_time", "scalar_gpstime", "scalar_time"});
}

}  // namespace limen
