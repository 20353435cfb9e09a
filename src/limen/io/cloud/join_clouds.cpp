// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/join_clouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/files/scan_in_file.h"
#include "limen/geometry/rigid.h"
#include "limen/io/crs/coordinate_system.h"
#include "limen/io/table/moved_columns.h"
#include "limen/io/table/packed_rows.h"
#include "limen/io/table/record_table.h"
#include "limen/io/table/value_tops.h"

namespace limen {
namespace {

/// Makes a table of chosen columns of another one, moved: x y z and x_origin y_origin z_origin by the motion,
/// nx ny nz by its turn, the others as they are. `bend` (none: nullptr) moves each point, after the motion,
/// by what it is at the point's own time; it must outlive what is made, and the table must have times. All in
/// this machine's order of bytes. What is made may point into the source.
class ColumnMover {
 public:
  ColumnMover(const RecordTable& source, const Rigid3& motion, const SplineMotion* bend = nullptr);

  /// The column of this name; `as_numbers`: as float64, whatever it is, times `factor`.
  void add(const std::string& name, bool as_numbers, double factor);
  /// A column with the same value in every row.
  void add_constant(const std::string& name, double value);
  [[nodiscard]] RecordTable table() const { return table_; }

 private:
  struct Memory;
  [[nodiscard]] Field swapped_copy(const Field& field);

  const RecordTable& source_;
  Rigid3 motion_;
  const SplineMotion* bend_;
  RecordTable table_;
  std::shared_ptr<Memory> memory_;
};

constexpr std::size_t kMovedPerPiece = 32768;
constexpr std::size_t kMovedStrip = 1024;

std::optional<MovedNames> triple_with(const RecordTable& table, const std::string& name) {
  for (const MovedNames& triple : kMovedColumns) {
    if (std::find(triple.names.begin(), triple.names.end(), name) == triple.names.end()) continue;
    const bool whole = std::all_of(triple.names.begin(), triple.names.end(),
                                   [&](const char* one) { return table.find({one}) != nullptr; });
    if (whole) return triple;
  }
  return {};
}

/// Moves each of the rows by what `bend` is at its own time.
void bend_rows(const RecordTable& table, const MovedNames& triple, const SplineMotion& bend, RowRange rows,
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

std::vector<double> moved_numbers(const RecordTable& table, const MovedNames& triple, const Rigid3& motion,
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

/// What was made; a deque, so that nothing moves.
struct ColumnMover::Memory {
  std::shared_ptr<const void> source;
  std::deque<std::vector<double>> triples;
  std::deque<std::vector<double>> numbers;
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

void ColumnMover::add(const std::string& name, bool as_numbers, double factor) {
  const auto find_moved = [&] {
    return std::find_if(memory_->moved.begin(), memory_->moved.end(),
                        [&](const auto& column) { return column.first == name; });
  };
  const std::optional<MovedNames> triple = triple_with(source_, name);
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
  if (as_numbers) {
    std::vector<double>& numbers = memory_->numbers.emplace_back(source_.rows);
    load_numbers(source_, field, {0, source_.rows}, numbers.data());
    if (factor != 1.0)
      for (double& number : numbers) number = std::round(factor * number);
    table_.fields.push_back(
        {name, Scalar::float64, reinterpret_cast<const char*>(numbers.data()), sizeof(double)});
    return;
  }
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

const std::array<std::string, 3> kPoint{"x", "y", "z"};
const std::array<std::string, 3> kOrigin{"x_origin", "y_origin", "z_origin"};
const std::string kSourceColumn = "source_cloud";

/// The motion from the numbers of a cloud to the frame of the output.
Rigid3 motion_of(const PlacedCloud& placed) {
  const TableFacts& facts = placed.input->file().clouds()[placed.cloud].table;
  Rigid3 world_from_numbers = facts.pose.value_or(Rigid3{});
  world_from_numbers.translation += facts.offset;
  const bool still = to_matrix(placed.target_from_world).isIdentity(0.0);
  return still ? world_from_numbers : placed.target_from_world * world_from_numbers;
}

/// The first rows of a cloud, which tell its columns; none where it is empty.
std::optional<RecordTable> first_rows(const PlacedCloud& placed, std::unique_ptr<PointStream>& stream) {
  constexpr std::size_t kFew = 1000;
  stream = placed.input->file().read(placed.cloud);
  return stream->next(kFew);
}

/// The type a column has in a file that keeps its values.
Scalar kept_type(const Field& field) {
  if (field.scale != 1.0 || field.offset != 0.0) return Scalar::float64;
  if (field.bits.count == 0) return field.type;
  if (field.bits.count <= 8) return Scalar::uint8;
  if (field.bits.count <= 16) return Scalar::uint16;
  return field.bits.count <= 32 ? Scalar::uint32 : Scalar::uint64;
}

/// Bits of whole numbers that a type holds; the sign counts as one.
int digits_of(Scalar type) {
  if (type == Scalar::float32) return 24;
  if (type == Scalar::float64) return 53;
  return 8 * static_cast<int>(size_of(type));
}

bool is_signed(Scalar type) {
  return type == Scalar::int8 || type == Scalar::int16 || type == Scalar::int32 || type == Scalar::int64;
}

/// A type for the values of two columns of one name.
Scalar common_type(Scalar a, Scalar b) {
  if (a == b) return a;
  if (!is_integer(a) || !is_integer(b)) {
    const bool fits = digits_of(a) <= 24 && digits_of(b) <= 24;
    return fits ? Scalar::float32 : Scalar::float64;
  }
  if (is_signed(a) == is_signed(b)) return digits_of(a) > digits_of(b) ? a : b;
  const Scalar without = is_signed(a) ? b : a;
  const int digits = std::max(digits_of(is_signed(a) ? a : b), 2 * digits_of(without));
  if (digits <= 16) return Scalar::int16;
  if (digits <= 32) return Scalar::int32;
  return digits <= 64 ? Scalar::int64 : Scalar::float64;
}

/// The name as the file has it, where it differs from the column's in case only.
std::string written_name(const std::string& column, const CloudFacts& facts) {
  for (const std::string& field : facts.fields) {
    if (lower_case(field) == column) return field;
  }
  return column;
}

double resolution_of(const RecordTable& table) {
  double finest = 0.0;
  for (const std::string& name : kPoint) {
    const Field* field = table.find({name});
    if (field == nullptr || !is_integer(field->type)) return 0.0;
    finest = finest == 0.0 ? std::abs(field->scale) : std::min(finest, std::abs(field->scale));
  }
  return finest;
}

/// The first point with finite coordinates, moved.
std::optional<Vector3d> first_point(const RecordTable& table, const Rigid3& motion) {
  for (std::size_t i = 0; i < table.rows; ++i) {
    Vector3d x;
    for (int k = 0; k < 3; ++k)
      load_numbers(table, *table.find({kPoint[static_cast<std::size_t>(k)]}), {i, i + 1}, &x[k]);
    if (x.allFinite()) return motion * x;
  }
  return {};
}

}  // namespace

JoinedClouds::JoinedClouds(std::vector<PlacedCloud> clouds, bool tell_source, const std::string& system)
    : clouds_(std::move(clouds)), tell_source_(tell_source) {
  for (const std::string& name : kPoint) plan_.columns.push_back({name, Scalar::float64});
  std::vector<PlacedCloud> full;
  std::map<std::string, std::pair<Field, std::size_t>> seen;  // columns, and how many clouds have them
  bool near_known = false;
  for (const PlacedCloud& placed : clouds_) {
    const CloudFacts& facts = placed.input->file().clouds()[placed.cloud];
    std::unique_ptr<PointStream> stream;
    const std::optional<RecordTable> table = first_rows(placed, stream);
    if (!table) continue;
    add_columns(*table, facts);
    for (const Field& field : table->fields) {
      auto& [first, count] = seen.try_emplace(field.name, field, std::size_t{0}).first->second;
      if (!same_kind(first, field)) mixed_.insert(field.name);
      ++count;
    }
    const double resolution = resolution_of(*table);
    const bool finer = full.empty() || resolution < plan_.resolution_m;
    if (finer) plan_.resolution_m = resolution;
    const auto near = near_known ? std::nullopt : first_point(*table, motion_of(placed));
    if (near) plan_.near = *near;
    near_known = near_known || near;
    plan_.most_points += facts.points;
    full.push_back(placed);
  }
  if (full.empty()) throw Error("there are no points", clouds_.front().input->name(), "check the input");
  clouds_ = std::move(full);
  for (const auto& [name, column] : seen)
    if (column.second < clouds_.size()) mixed_.insert(name);
  const OpenPoints& first = *clouds_.front().input;
  plan_.name = std::filesystem::path(file_of_scan(first.name())).stem().string();
  if (clouds_.size() == 1 && (first.chosen() || first.file().clouds().size() > 1))
    plan_.name += fmt::format("_{}", first.number_in_file(clouds_.front().cloud));
  for (const std::string& text : clouds_.front().input->georeference()) {
    // A number becomes text where PROJ knows it: more formats can tell that.
    const CoordinateSystem known =
        text.find('[') == std::string::npos ? stated_system(text) : CoordinateSystem{};
    plan_.georeference.push_back(known.wkt.empty() ? text : known.wkt);
  }
  if (!system.empty()) plan_.georeference = {system};
  settle_centres();
  settle_colours();
  if (tell_source_) add_column(kSourceColumn, Scalar::uint8);
}

void JoinedClouds::add_column(const std::string& name, Scalar type) {
  const std::string lower = lower_case(name);
  for (ColumnPlan& column : plan_.columns) {
    if (lower_case(column.name) != lower) continue;
    column.type = common_type(column.type, type);
    return;
  }
  plan_.columns.push_back({name, type});
}

void JoinedClouds::add_columns(const RecordTable& table, const CloudFacts& facts) {
  for (const std::string& name : kPoint) {
    if (table.find({name}) == nullptr)
      throw Error("the points have no " + name, facts.table.name, "export the points with x, y and z");
  }
  const bool split_colour = table.find({"red"}) != nullptr;
  for (const Field& field : table.fields) {
    if (field.name == "_" || (tell_source_ && field.name == kSourceColumn)) continue;
    // Colours packed into one number come as three columns too.
    if (split_colour && (field.name == "rgb" || field.name == "rgba")) continue;
    const bool moves = std::find(kPoint.begin(), kPoint.end(), field.name) != kPoint.end() ||
                       std::find(kOrigin.begin(), kOrigin.end(), field.name) != kOrigin.end();
    add_column(written_name(field.name, facts), moves ? Scalar::float64 : kept_type(field));
  }
}

/// The scanner position of a single cloud goes into the plan, those of several into columns.
void JoinedClouds::settle_centres() {
  const auto has_column = [&] {
    return std::any_of(plan_.columns.begin(), plan_.columns.end(),
                       [](const ColumnPlan& column) { return lower_case(column.name) == kOrigin[0]; });
  };
  const bool known = std::any_of(clouds_.begin(), clouds_.end(),
                                 [](const PlacedCloud& placed) { return placed.centre.has_value(); });
  if (has_column() || (known && clouds_.size() > 1)) {
    for (const std::string& name : kOrigin) add_column(name, Scalar::float64);
  } else if (known) {
    plan_.centre = clouds_[0].target_from_world * *clouds_[0].centre;
  }
}

/// Of the columns of these names, the largest finite values of a cloud as it is stored.
std::map<std::string, double> largest_of(const PlacedCloud& placed, const std::set<std::string>& names) {
  std::map<std::string, double> largest;
  const std::unique_ptr<PointStream> stream = placed.input->file().read(placed.cloud);
  while (const std::optional<RecordTable> piece = stream->next(kPointsAtOnce)) {
    CancelScope::check();
    placed.input->forget();
    for (const std::string& name : names) {
      const Field* field = piece->find({name});
      if (field != nullptr) largest[name] = std::max(largest[name], largest_value(*piece, *field));
    }
  }
  return largest;
}

/// Clouds whose colours are of different kinds get factors to the one that all have then.
void JoinedClouds::settle_colours() {
  if (clouds_.size() < 2) return;
  double top = 0.0;
  std::vector<double> tops;
  for (const PlacedCloud& placed : clouds_) {
    std::unique_ptr<PointStream> stream;
    const std::optional<RecordTable> table = first_rows(placed, stream);
    bool bytes = true;
    bool integer = true;
    std::set<std::string> names;
    for (const Field& field : table->fields) {
      if (!is_colour(field.name)) continue;
      names.insert(field.name);
      bytes = bytes && kept_type(field) == Scalar::uint8;
      integer = integer && is_integer(kept_type(field));
    }
    double largest = 0.0;
    if (!bytes)
      for (const auto& [name, most] : largest_of(placed, names)) largest = std::max(largest, most);
    tops.push_back(names.empty() ? 0.0 : (bytes ? 255.0 : colour_top(largest, integer)));
    top = std::max(top, tops.back());
  }
  const bool alike =
      std::all_of(tops.begin(), tops.end(), [&](double one) { return one == 0.0 || one == top; });
  if (alike) return;
  for (std::size_t k = 0; k < clouds_.size(); ++k)
    clouds_[k].colour_factor = tops[k] > 0.0 ? top / tops[k] : 1.0;
  for (ColumnPlan& column : plan_.columns) {
    if (!is_colour(lower_case(column.name))) continue;
    column.type = top > 255.0 ? Scalar::uint16 : Scalar::uint8;
    mixed_.insert(lower_case(column.name));
  }
}

CloudPlan JoinedClouds::plan_with_largest() const {
  CloudPlan plan = plan_;
  std::set<std::string> asked;
  for (const ColumnPlan& column : plan.columns) {
    const std::string name = lower_case(column.name);
    const bool fraction = name == "intensity" && !is_integer(column.type);
    const bool colour = is_colour(name) && column.type != Scalar::uint8 && column.type != Scalar::uint16;
    if (fraction || colour) asked.insert(name);
  }
  if (asked.empty()) return plan;
  for (const PlacedCloud& placed : clouds_) {
    for (const auto& [name, most] : largest_of(placed, asked)) {
      for (ColumnPlan& column : plan.columns) {
        if (lower_case(column.name) == name) column.largest = std::max(column.largest.value_or(0.0), most);
      }
    }
  }
  return plan;
}

/// Reads one cloud after the other.
class JoinedStream : public PointStream {
 public:
  JoinedStream(const std::vector<PlacedCloud>& clouds, const CloudPlan& plan,
               const std::set<std::string>& mixed, bool tell_source)
      : clouds_(clouds), plan_(plan), mixed_(mixed), tell_source_(tell_source) {}

  std::optional<RecordTable> next(std::size_t most_rows) override {
    for (; at_ < clouds_.size(); ++at_, stream_.reset()) {
      const PlacedCloud& placed = clouds_[at_];
      if (!stream_) stream_ = placed.input->file().read(placed.cloud);
      placed.input->forget();
      const std::optional<RecordTable> piece = stream_->next(most_rows);
      if (piece) return moved(*piece, placed);
    }
    return {};
  }

 private:
  [[nodiscard]] RecordTable moved(const RecordTable& piece, const PlacedCloud& placed) const {
    ColumnMover mover(piece, motion_of(placed), placed.bend.get());
    std::optional<Vector3d> centre;
    if (placed.centre) centre = placed.target_from_world * *placed.centre;
    for (const ColumnPlan& column : plan_.columns) {
      const std::string name = lower_case(column.name);
      const auto origin = std::find(kOrigin.begin(), kOrigin.end(), name);
      if (tell_source_ && name == kSourceColumn) {
        mover.add_constant(name, static_cast<double>(placed.source));
      } else if (piece.find({name}) != nullptr) {
        mover.add(name, mixed_.count(name) > 0, is_colour(name) ? placed.colour_factor : 1.0);
      } else if (origin != kOrigin.end() && centre) {
        mover.add_constant(name, (*centre)[origin - kOrigin.begin()]);
      } else {
        mover.add_constant(name, is_integer(column.type) ? 0.0 : std::nan(""));
      }
    }
    return mover.table();
  }

  const std::vector<PlacedCloud>& clouds_;
  const CloudPlan& plan_;
  const std::set<std::string>& mixed_;
  bool tell_source_;
  std::size_t at_ = 0;
  std::unique_ptr<PointStream> stream_;
};

std::unique_ptr<PointStream> JoinedClouds::read() const {
  return std::make_unique<JoinedStream>(clouds_, plan_, mixed_, tell_source_);
}

}  // namespace limen
