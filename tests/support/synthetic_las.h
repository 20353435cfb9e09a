// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "support/test_support.h"

#include "limen/base/random.h"
#include "limen/io/las/las.h"
#include "limen/io/las/las_fields.h"
#include "limen/io/las/las_records.h"

/// LAS files made by hand, byte for byte as the specification has them.
namespace limen::testing_las {

template <typename Value>
void put(std::string& bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

inline std::string record(const std::string& user, std::uint16_t number, const std::string& body) {
  std::string bytes(54, '\0');
  bytes.replace(2, user.size(), user);
  put(bytes, 18, number);
  put(bytes, 20, static_cast<std::uint16_t>(body.size()));
  return bytes + body;
}

inline std::string long_record(const std::string& user, std::uint16_t number, const std::string& body) {
  std::string bytes(60, '\0');
  bytes.replace(2, user.size(), user);
  put(bytes, 18, number);
  put(bytes, 20, static_cast<std::uint64_t>(body.size()));
  return bytes + body;
}

/// What a file made by hand holds.
struct Parts {
  int minor = 4;
  int format = 6;
  std::size_t extra = 0;             ///< bytes per point behind those of the format
  std::vector<std::string> records;  ///< before the points
  std::string points;                ///< one behind the other
  std::string tail;                  ///< extended records
  std::uint32_t tail_records = 0;
};

inline std::size_t point_bytes(const Parts& parts) {
  return las_point_bytes(parts.format) + parts.extra;
}

/// The header; the points begin behind the records.
inline std::string header(const Parts& parts, std::uint64_t count) {
  static constexpr std::size_t kSizes[] = {227, 227, 227, 235, 375};
  std::string bytes(kSizes[parts.minor], '\0');
  std::size_t records = 0;
  for (const std::string& one : parts.records) records += one.size();
  bytes.replace(0, 4, "LASF");
  bytes[24] = 1;
  bytes[25] = static_cast<char>(parts.minor);
  put(bytes, 94, static_cast<std::uint16_t>(bytes.size()));
  put(bytes, 96, static_cast<std::uint32_t>(bytes.size() + records));
  put(bytes, 100, static_cast<std::uint32_t>(parts.records.size()));
  bytes[104] = static_cast<char>(parts.format);
  put(bytes, 105, static_cast<std::uint16_t>(point_bytes(parts)));
  put(bytes, 107, parts.format < 6 ? static_cast<std::uint32_t>(count) : 0U);
  const double grid[] = {0.001, 0.001, 0.01, 500000.0, 5400000.0, 100.0};
  for (std::size_t k = 0; k < 6; ++k) put(bytes, 131 + 8 * k, grid[k]);
  const double box[] = {500010.0, 499990.0, 5400010.0, 5399990.0, 200.0, 0.0};
  for (std::size_t k = 0; k < 6; ++k) put(bytes, 179 + 8 * k, box[k]);
  if (parts.minor >= 4) put(bytes, 247, count);
  return bytes;
}

inline std::string file(const Parts& parts) {
  const std::size_t count = parts.points.size() / point_bytes(parts);
  std::string bytes = header(parts, count);
  for (const std::string& one : parts.records) bytes += one;
  bytes += parts.points;
  if (parts.minor >= 4 && !parts.tail.empty()) {
    put(bytes, 235, static_cast<std::uint64_t>(bytes.size()));
    put(bytes, 243, parts.tail_records);
  }
  return bytes + parts.tail;
}

/// Points that follow one another as a scanner's do, every bit of every field in use now and then.
inline std::string random_points(int format, std::size_t extra, std::size_t count, std::uint64_t seed) {
  const std::size_t bytes = las_point_bytes(format) + extra;
  RandomStream random(seed, static_cast<std::uint64_t>(format));
  std::string last(bytes, '\0');
  for (char& byte : last) byte = static_cast<char>(random.below(256));
  std::string points;
  double time = 1000.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t step = static_cast<std::int32_t>(random.below(2000)) - 1000;
      std::int32_t value = 0;
      std::memcpy(&value, &last[4 * k], 4);
      value = i == 0 || random.below(200) == 0 ? step : value / 2 + step;
      put(last, 4 * k, value);
    }
    for (std::size_t k = 12; k < bytes; ++k) {
      if (random.below(6) == 0) last[k] = static_cast<char>(random.below(random.below(3) == 0 ? 256 : 4));
    }
    if (const std::size_t at = las_gps_time_at(format)) {
      const std::uint32_t kind = random.below(40);
      time += kind == 0 ? random.uniform(-1e6, 1e6) : (kind < 30 ? 1e-5 * (1 + random.below(12)) : 0.0);
      put(last, at, time);
    }
    points += last;
  }
  return points;
}

/// All values of a column.
inline std::vector<double> column(std::string_view bytes, const std::string& name, std::size_t piece = 1000) {
  const auto opened = open_las(bytes, "test");
  const auto stream = opened->read(0);
  std::vector<double> values;
  while (const auto table = stream->next(piece)) {
    const Field* field = table->find({name});
    if (field == nullptr) return {};
    const std::size_t at = values.size();
    values.resize(at + table->rows);
    load_numbers(*table, *field, {0, table->rows}, values.data() + at);
  }
  return values;
}

/// The records of a file, one behind the other.
inline std::string records_of(std::string_view bytes, std::size_t piece = 1000) {
  const LasHeader about = parse_las_header(bytes, "test");
  const auto records = open_las_records(bytes, "test", about);
  std::string all;
  for (LasPiece some = records->next(piece); some.count > 0; some = records->next(piece))
    all.append(some.data, some.count * about.point_bytes);
  return all;
}

}  // namespace limen::testing_las
