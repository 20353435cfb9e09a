// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/moved_columns.h"

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/table/time_column.h"

namespace limen {
namespace {

constexpr std::size_t kMovedPerPiece = 32768;
constexpr std::size_t kMovedStrip = 1024;

/// Three columns that change together.
struct NamedTriple {
  std::array<const char*, 3> names;
  bool direction;  ///< turns only
};
constexpr std::array<NamedTriple, 4> kMovedTriples{{{{"x", "y", "z"}, false},
                                                    {{"x_origin", "y_origin", "z_origin"}, false},
                                                    {{"nx", "ny", "nz"}, true},
                                                    {{"normal_x", "normal_y", "normal_z"}, true}}};

std::optional<NamedTriple> triple_with(const RecordTable& table, const std::string& name) {
  for (const NamedTriple& triple : kMovedTriples) {
    if (std::find(triple.names.begin(), triple.names.end(), name) == triple.names.end()) continue;
    const bool whole = std::all_of(triple.names.begin(), triple.names.end(),
                                   [&](const char* one) { return table.find({one}) != nullptr; });
    if (whole) return triple;
  }
  return {};
}

/// Moves each of the rows by what `bend` is at its own time.
void bend_rows(const RecordTable& table, const NamedTriple& triple, const SplineMotion& bend, RowRange rows,
               double* numbers) {
  std::array<double, kMovedStrip> times{};
  load_numbers(table, *find_times(table), rows, times.data());
  for (std::size_t i = 0; i < rows.end - rows.begin; ++i) {
    Eigen::Map<Vector3d> x(numbers + 3 * i);
    if (triple.direction)
      x = Vector3d(rotation_exp(bend.value(times[i]).head<3>()) * x);
    else
      x = bend.moved(x, times[i]);
  }
}

std::vector<double> moved_numbers(const RecordTable& table, const NamedTriple& triple, const Rigid3& motion,
                                  const SplineMotion* bend) {
  std::vector<double> numbers(3 * table.rows);
  const Vector3d shift = triple.direction ? Vector3d::Zero() : motion.translation;
  const bool turned = !motion.rotation.isIdentity(0.0);
  parallel_for(table.rows, kMovedPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; at += kMovedStrip) {
      const RowRange rows{at, std::min(end, at + kMovedStrip)};
      for (std::size_t k = 0; k < 3; ++k)
        load_numbers(table, *table.find({triple.names[k]}), rows, numbers.data() + 3 * at + k, 3);
      for (std::size_t i = rows.begin; i < rows.end; ++i) {
        Eigen::Map<Vector3d> x(numbers.data() + 3 * i);
        x = (turned ? Vector3d(motion.rotation * x) : Vector3d(x)) + shift;
      }
      if (bend != nullptr) bend_rows(table, triple, *bend, rows, numbers.data() + 3 * at);
    }
  });
  return numbers;
}

}  // namespace

/// What was made; a deque, so that nothing moves.
struct ColumnMover::Memory {
  std::shared_ptr<const void> source;
  std::deque<std::vector<double>> triples;
  std::deque<double> constants;
  std::deque<std::vector<char>> swapped;
  std::vector<std::pair<std::string, const double*>> moved;  ///< where each moved column begins
};

ColumnMover::ColumnMover(const RecordTable& source, const Rigid3& motion, const SplineMotion* bend)
    : source_(source), motion_(motion), bend_(bend), memory_(std::make_shared<Memory>()) {
  if (bend != nullptr && find_times(source) == nullptr)
    throw Error("the points have no times, which a pass that is bent needs", "points",
                "give the file that the project was made from");
  memory_->source = source.keeper;
  table_.rows = source.rows;
  table_.keeper = memory_;
}

void ColumnMover::add(const std::string& name) {
  const auto find_moved = [&] {
    return std::find_if(memory_->moved.begin(), memory_->moved.end(),
                        [&](const auto& column) { return column.first == name; });
  };
  const std::optional<NamedTriple> triple = triple_with(source_, name);
  if (triple && find_moved() == memory_->moved.end()) {
    memory_->triples.push_back(moved_numbers(source_, *triple, motion_, bend_));
    for (std::size_t k = 0; k < 3; ++k)
      memory_->moved.emplace_back(triple->names[k], memory_->triples.back().data() + k);
  }
  const auto moved = find_moved();
  if (moved != memory_->moved.end()) {
    table_.fields.push_back(
        {name, Scalar::float64, reinterpret_cast<const char*>(moved->second), 3 * sizeof(double)});
    return;
  }
  const Field& field = *source_.find({name});
  table_.fields.push_back(source_.swapped ? swapped_copy(field) : field);
}

void ColumnMover::add_constant(const std::string& name, double value) {
  memory_->constants.push_back(value);
  table_.fields.push_back(
      {name, Scalar::float64, reinterpret_cast<const char*>(&memory_->constants.back()), 0});
}

Field ColumnMover::swapped_copy(const Field& field) {
  const std::size_t size = size_of(field.type);
  std::vector<char> bytes(size * source_.rows);
  for (std::size_t i = 0; i < source_.rows; ++i)
    std::reverse_copy(field.data + i * field.stride, field.data + i * field.stride + size,
                      bytes.data() + i * size);
  memory_->swapped.push_back(std::move(bytes));
  Field copy = field;
  copy.data = memory_->swapped.back().data();
  copy.stride = size;
  return copy;
}

}  // namespace limen
