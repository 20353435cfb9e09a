// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/laws.h"
#include "support/test_support.h"
#include <fmt/format.h>

#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/cloud/write_clouds.h"

namespace limen {
namespace {

using namespace testing_laws;

/// A cloud with columns of any number type; the first three are its coordinates.
struct AnyCloud {
  Vector3d near = Vector3d::Zero();
  std::vector<ColumnPlan> columns;
  std::vector<std::vector<double>> values;  ///< per column
  [[nodiscard]] std::size_t size() const { return values[0].size(); }
};

template <typename Integer>
double any_integer() {
  // Whole numbers up to 2^53 are the same as doubles.
  const double bound = 9007199254740992.0;
  const auto value = static_cast<double>(*rc::gen::arbitrary<Integer>());
  return std::clamp(value, -bound, bound);
}

/// A value of the type, as a double that loses nothing.
double any_value(Scalar type) {
  switch (type) {
    case Scalar::int8:
      return *rc::gen::inRange(-128, 128);
    case Scalar::uint8:
      return *rc::gen::inRange(0, 256);
    case Scalar::int16:
      return any_integer<std::int16_t>();
    case Scalar::uint16:
      return any_integer<std::uint16_t>();
    case Scalar::int32:
      return any_integer<std::int32_t>();
    case Scalar::uint32:
      return any_integer<std::uint32_t>();
    case Scalar::int64:
      return any_integer<std::int64_t>();
    case Scalar::uint64:
      return any_integer<std::uint64_t>();
    case Scalar::float32:
      return static_cast<float>(number(-1e4, 1e4) / 7.0);
    case Scalar::float64:
      return number(-1e6, 1e6) / 7.0;
  }
  return 0.0;
}

AnyCloud any_cloud() {
  AnyCloud cloud;
  cloud.near = {std::round(number(-1e6, 1e6)), std::round(number(0.0, 7e6, 1e-2)), number(-500.0, 500.0)};
  const int rows = *rc::gen::inRange(1, 60);
  for (int axis = 0; axis < 3; ++axis) {
    cloud.columns.push_back({std::string(1, "xyz"[axis]), Scalar::float64});
    auto& column = cloud.values.emplace_back();
    for (int i = 0; i < rows; ++i) column.push_back(cloud.near[axis] + number(-50.0, 50.0, 1e-5));
  }
  for (int k = *rc::gen::inRange(0, 5); k > 0; --k) {
    const auto type = static_cast<Scalar>(*rc::gen::inRange(0, 10));
    cloud.columns.push_back({fmt::format("value_{}", k), type});
    auto& column = cloud.values.emplace_back();
    for (int i = 0; i < rows; ++i) column.push_back(any_value(type));
  }
  return cloud;
}

template <typename Value>
void put_value(std::vector<char>& bytes, double value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(static_cast<Value>(value));
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void put_as(Scalar type, std::vector<char>& bytes, double value) {
  switch (type) {
    case Scalar::int8:
      return put_value<std::int8_t>(bytes, value);
    case Scalar::uint8:
      return put_value<std::uint8_t>(bytes, value);
    case Scalar::int16:
      return put_value<std::int16_t>(bytes, value);
    case Scalar::uint16:
      return put_value<std::uint16_t>(bytes, value);
    case Scalar::int32:
      return put_value<std::int32_t>(bytes, value);
    case Scalar::uint32:
      return put_value<std::uint32_t>(bytes, value);
    case Scalar::int64:
      return put_value<std::int64_t>(bytes, value);
    case Scalar::uint64:
      return put_value<std::uint64_t>(bytes, value);
    case Scalar::float32:
      return put_value<float>(bytes, value);
    case Scalar::float64:
      return put_value<double>(bytes, value);
  }
}

RecordTable rows_of(const AnyCloud& cloud, std::size_t begin, std::size_t end) {
  const auto memory = std::make_shared<std::vector<std::vector<char>>>();
  for (std::size_t k = 0; k < cloud.columns.size(); ++k) {
    std::vector<char>& bytes = memory->emplace_back();
    for (std::size_t i = begin; i < end; ++i) put_as(cloud.columns[k].type, bytes, cloud.values[k][i]);
  }
  RecordTable table;
  table.rows = end - begin;
  for (std::size_t k = 0; k < cloud.columns.size(); ++k) {
    const ColumnPlan& column = cloud.columns[k];
    table.fields.push_back({column.name, column.type, (*memory)[k].data(), size_of(column.type)});
  }
  table.keeper = memory;
  return table;
}

void write_in_pieces(const AnyCloud& cloud, std::size_t piece, const std::filesystem::path& path) {
  CloudPlan plan;
  plan.name = "any cloud";
  plan.columns = cloud.columns;
  plan.most_points = cloud.size();
  plan.near = cloud.near;
  const auto writer = make_cloud_writer(path, plan);
  for (std::size_t begin = 0; begin < cloud.size(); begin += piece)
    writer->write(rows_of(cloud, begin, std::min(cloud.size(), begin + piece)));
  writer->finish();
}

/// All values of a column, read in pieces.
std::vector<double> column_of(const OpenPoints& input, const std::string& name, std::size_t piece) {
  std::vector<double> values;
  const auto stream = input.file().read(0);
  while (const auto table = stream->next(piece)) {
    const Field* field = table->find({name});
    if (field == nullptr) return {};
    values.resize(values.size() + table->rows);
    load_numbers(*table, *field, {0, table->rows}, values.data() + values.size() - table->rows);
  }
  return values;
}

/// What is written comes back: values as they were, coordinates to `grid_m`; however it was cut into pieces
/// the bytes are the same.
void comes_back(const char* file, double grid_m) {
  const testing_io::TemporaryFolder folder;
  const AnyCloud cloud = any_cloud();
  write_in_pieces(cloud, *rc::gen::inRange<std::size_t>(1, 70), folder / file);
  const std::string bytes = testing_io::slurp(folder / file);
  write_in_pieces(cloud, 100, folder / file);
  RC_ASSERT(bytes == testing_io::slurp(folder / file));

  const Scan scan = read_scan(folder / file);
  RC_ASSERT(scan.size() == cloud.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double given = cloud.values[static_cast<std::size_t>(axis)][i];
      RC_ASSERT(std::abs(scan.local_origin[axis] - given + scan.points[i][axis]) <= 0.5 * grid_m + 3e-9);
    }
  }
  const OpenPoints input(folder / file);
  for (std::size_t k = 3; k < cloud.columns.size(); ++k) {
    RC_ASSERT(column_of(input, cloud.columns[k].name, *rc::gen::inRange<std::size_t>(1, 70)) ==
              cloud.values[k]);
  }
}

RC_GTEST_PROP(RoundTripLaws, Ply, ()) {
  comes_back("any.ply", 0.0);
}

RC_GTEST_PROP(RoundTripLaws, E57, ()) {
  comes_back("any.e57", 0.0);
}

// Steps of 10 to 100 um: write_las.cpp.
RC_GTEST_PROP(RoundTripLaws, Las, ()) {
  comes_back("any.las", 1e-4);
}

RC_GTEST_PROP(RoundTripLaws, Laz, ()) {
  comes_back("any.laz", 1e-4);
}

}  // namespace
}  // namespace limen
