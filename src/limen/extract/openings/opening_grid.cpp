// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/opening_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace limen {
namespace {

constexpr int kColumns = 1440;
constexpr int kRows = 720;
constexpr double kStep_rad = 2.0 * std::numbers::pi / kColumns;
constexpr double kPole_rad = 1.4;  // elevations beyond are not distinguished by azimuth

/// arctan(t) / t of t^2 in [0, 1]: interpolated at Chebyshev's nodes, off by 2e-9 at most.
constexpr std::array<double, 10> kArctan = {
    0.999999997161,   -0.33333276292,  0.199980752807, -0.142600160801, 0.109323414917,
    -0.0834972494866, 0.0570895556962, -0.03035186463, 0.0104876492052, -0.00170117005946};

/// As std::atan2, which is exact to the last digit and takes three times as long.
double angle_of(double y, double x) {
  const double larger = std::max(std::abs(x), std::abs(y));
  if (!(larger > 0.0)) return 0.0;
  const double t = std::min(std::abs(x), std::abs(y)) / larger;
  double sum = 0.0;
  for (std::size_t k = kArctan.size(); k-- > 0;) sum = sum * t * t + kArctan[k];
  double angle = sum * t;
  if (std::abs(y) > std::abs(x)) angle = 0.5 * std::numbers::pi - angle;
  if (x < 0.0) angle = std::numbers::pi - angle;
  return y < 0.0 ? -angle : angle;
}

double azimuth_of(const Vector3d& ray) {
  return angle_of(ray.y(), ray.x()) + std::numbers::pi;
}

double elevation_of(const Vector3d& ray) {
  return angle_of(ray.z(), ray.head<2>().norm());
}

int row_of(double elevation) {
  return std::clamp(static_cast<int>((elevation + 0.5 * std::numbers::pi) / kStep_rad), 0, kRows - 1);
}

}  // namespace

DirectionMap::DirectionMap(const Scan& scan, const Vector3d& centre)
    : centre_(centre), answered_(static_cast<std::size_t>(kColumns) * kRows, 0) {
  for (const Vector3d& point : scan.points) {
    const Vector3d ray = point - centre;
    const int column = std::clamp(static_cast<int>(azimuth_of(ray) / kStep_rad), 0, kColumns - 1);
    answered_[static_cast<std::size_t>(row_of(elevation_of(ray)) * kColumns + column)] = 1;
  }
}

bool DirectionMap::silent(const Vector3d& x, double radius_rad) const {
  if (answered_.empty()) return false;
  const Vector3d ray = x - centre_;
  const double elevation = elevation_of(ray);
  if (std::abs(elevation) + radius_rad > kPole_rad) return false;
  const double azimuth = azimuth_of(ray);
  const double across_rad = radius_rad / std::cos(elevation);
  const int first = static_cast<int>(std::floor((azimuth - across_rad) / kStep_rad));
  const int last = static_cast<int>(std::floor((azimuth + across_rad) / kStep_rad));
  for (int row = row_of(elevation - radius_rad); row <= row_of(elevation + radius_rad); ++row) {
    for (int c = first; c <= last; ++c) {
      const int column = ((c % kColumns) + kColumns) % kColumns;
      if (answered_[static_cast<std::size_t>(row * kColumns + column)] != 0) return false;
    }
  }
  return true;
}

namespace {

constexpr double kCellPerSpacing = 0.9;
constexpr double kMinCell_m = 0.025;
constexpr double kMaxCell_m = 0.06;
constexpr double kMaxCells = 6e6;
constexpr double kTile_m = 0.5;           // over which the distance between samples is taken
constexpr double kReachPerSpacing = 2.5;  // how far a sample represents its surroundings
constexpr double kMaxReach_m = 0.2;

}  // namespace

OpeningGrid::OpeningGrid(const WallEvidence& evidence, const DirectionMap& directions)
    : samples_(&evidence.samples), box_(evidence.wall.box) {
  cell_m_ = std::clamp(kCellPerSpacing * evidence.wall.spacing_m, kMinCell_m, kMaxCell_m);
  const Vector2d size = box_.high - box_.low;
  cell_m_ = std::max(cell_m_, std::sqrt(size.x() * size.y() / kMaxCells));
  columns_ = static_cast<int>(size.x() / cell_m_) + 1;
  rows_ = static_cast<int>(size.y() / cell_m_) + 1;
  count_samples(evidence);
  set_spacing();
  spread();
  mark_silent(evidence.wall, directions);
}

int OpeningGrid::column(double u) const {
  return static_cast<int>(std::floor((u - box_.low.x()) / cell_m_));
}

int OpeningGrid::row(double v) const {
  return static_cast<int>(std::floor((v - box_.low.y()) / cell_m_));
}

OpeningGrid::Cell OpeningGrid::at(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return Cell::unknown;
  return cells_[index(column, row)];
}

std::size_t OpeningGrid::tile(int column, int row) const {
  return static_cast<std::size_t>(row / tile_cells_) * static_cast<std::size_t>(tile_columns_) +
         static_cast<std::size_t>(column / tile_cells_);
}

/// Sorts the samples into cells; a cell with samples is what most of them say.
void OpeningGrid::count_samples(const WallEvidence& evidence) {
  const std::size_t size = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  std::vector<std::uint32_t> cell_of;
  cell_of.reserve(evidence.samples.size());
  begin_.assign(size + 1, 0);
  for (const WallSample& sample : evidence.samples) {
    const int c = std::clamp(column(sample.u), 0, columns_ - 1);
    const int r = std::clamp(row(sample.v), 0, rows_ - 1);
    cell_of.push_back(static_cast<std::uint32_t>(index(c, r)));
    ++begin_[cell_of.back() + 1];
  }
  for (std::size_t i = 0; i < size; ++i) begin_[i + 1] += begin_[i];
  order_.resize(evidence.samples.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < cell_of.size(); ++i) order_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
  cells_.assign(size, Cell::unknown);
  for (std::size_t i = 0; i < size; ++i) {
    std::array<std::uint32_t, 4> count{};
    for (std::uint32_t k = begin_[i]; k < begin_[i + 1]; ++k)
      ++count[static_cast<std::size_t>(evidence.samples[order_[k]].kind)];
    const auto wall = count[static_cast<std::size_t>(SampleKind::wall)];
    const auto open = count[static_cast<std::size_t>(SampleKind::open)];
    if (wall + open > 0) {
      cells_[i] = open > wall ? Cell::open : Cell::wall;
    } else if (count[static_cast<std::size_t>(SampleKind::cover)] > 0) {
      cells_[i] = Cell::cover;
    }
  }
}

/// The typical distance between samples, tile by tile.
void OpeningGrid::set_spacing() {
  tile_cells_ = std::max(1, static_cast<int>(std::lround(kTile_m / cell_m_)));
  tile_columns_ = (columns_ + tile_cells_ - 1) / tile_cells_;
  const double tile_m2 = tile_cells_ * tile_cells_ * cell_m_ * cell_m_;
  for (int low = 0; low < rows_; low += tile_cells_) {
    for (int left = 0; left < columns_; left += tile_cells_) {
      const int right = std::min(columns_, left + tile_cells_) - 1;
      std::uint32_t count = 0;
      for (int r = low; r < std::min(rows_, low + tile_cells_); ++r)
        count += begin_[index(right, r) + 1] - begin_[index(left, r)];
      tile_spacing_m_.push_back(static_cast<float>(std::sqrt(tile_m2 / std::max(count, 1U))));
    }
  }
}

/// Every cell without samples becomes what the nearest cell with samples is, if that is near enough.
void OpeningGrid::spread() {
  const NearestCells nearest(columns_, rows_,
                             [&](int c, int r) { return cells_[index(c, r)] != Cell::unknown; });
  std::vector<Cell> spread = cells_;
  for (int r = 0; r < rows_; ++r) {
    for (int left = 0; left < columns_; left += tile_cells_) {
      const double reach_m = std::min(kMaxReach_m, kReachPerSpacing * tile_spacing_m_[tile(left, r)]);
      const double reach = std::max(1.5, reach_m / cell_m_);
      for (int c = left; c < std::min(columns_, left + tile_cells_); ++c) {
        const NearestCells::Way& way = nearest.from(c, r);
        if (way.known() && static_cast<double>(way.squared()) <= reach * reach)
          spread[index(c, r)] = cells_[index(c + way.columns, r + way.rows)];
      }
    }
  }
  cells_ = std::move(spread);
}

void OpeningGrid::mark_silent(const OpeningWall& wall, const DirectionMap& directions) {
  constexpr double kMinRadius_rad = 0.006;
  constexpr double kRadiusPerSpacing = 1.5;
  const double off_m = wall.plane.signed_distance(directions.centre());
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      if (cells_[index(c, r)] != Cell::unknown) continue;
      const Vector3d x = wall.frame.to_space(middle(c, r));
      const double range_m = (x - directions.centre()).norm();
      // The wall's own spacing, seen from the scanner across the wall.
      const double radius = kRadiusPerSpacing * wall.spacing_m * std::sqrt(off_m / range_m) / range_m;
      if (directions.silent(x, std::max(kMinRadius_rad, radius))) cells_[index(c, r)] = Cell::silent;
    }
  }
}

std::vector<std::uint32_t> OpeningGrid::samples_in(const Box2& box) const {
  std::vector<std::uint32_t> found;
  const int c0 = std::clamp(column(box.low.x()), 0, columns_ - 1);
  const int c1 = std::clamp(column(box.high.x()), 0, columns_ - 1);
  const int r0 = std::clamp(row(box.low.y()), 0, rows_ - 1);
  const int r1 = std::clamp(row(box.high.y()), 0, rows_ - 1);
  for (int r = r0; r <= r1; ++r) {
    for (std::uint32_t k = begin_[index(c0, r)]; k < begin_[index(c1, r) + 1]; ++k) {
      const WallSample& sample = (*samples_)[order_[k]];
      if (box.contains({sample.u, sample.v})) found.push_back(order_[k]);
    }
  }
  return found;
}

double OpeningGrid::spacing_m(const Vector2d& at) const {
  const int c = std::clamp(column(at.x()), 0, columns_ - 1);
  const int r = std::clamp(row(at.y()), 0, rows_ - 1);
  return tile_spacing_m_[tile(c, r)];
}

/// For each cell of `kind` how many steps (also across corners) it is to the next cell of another kind.
std::vector<std::uint16_t> OpeningGrid::steps_within(Cell kind) const {
  std::vector<std::uint16_t> steps(cells_.size(), 0);
  const auto is_kind = [&](Cell cell) {
    return cell == kind || (kind == Cell::open && cell == Cell::silent);
  };
  const auto step = [&](int c, int r) -> int {
    return c < 0 || r < 0 || c >= columns_ || r >= rows_ ? 0 : steps[index(c, r)];
  };
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      if (!is_kind(cells_[index(c, r)])) continue;
      const int least = std::min({step(c - 1, r), step(c - 1, r - 1), step(c, r - 1), step(c + 1, r - 1)});
      steps[index(c, r)] = static_cast<std::uint16_t>(std::min(least + 1, 60000));
    }
  }
  for (int r = rows_ - 1; r >= 0; --r) {
    for (int c = columns_ - 1; c >= 0; --c) {
      if (!is_kind(cells_[index(c, r)])) continue;
      const int least = std::min({step(c + 1, r), step(c + 1, r + 1), step(c, r + 1), step(c - 1, r + 1)});
      steps[index(c, r)] = static_cast<std::uint16_t>(std::min<int>(steps[index(c, r)], least + 1));
    }
  }
  return steps;
}

std::vector<Box2> OpeningGrid::regions(Cell kind, double neck_m) const {
  const int core = std::max(1, static_cast<int>(std::lround(neck_m / cell_m_)));
  const std::vector<std::uint16_t> steps = steps_within(kind);
  std::vector<char> seen(cells_.size(), 0);
  std::vector<Box2> boxes;
  std::vector<std::pair<int, int>> stack;
  const auto push = [&](int c, int r) {
    if (c < 0 || r < 0 || c >= columns_ || r >= rows_) return;
    const std::size_t i = index(c, r);
    if (seen[i] != 0 || steps[i] <= core) return;
    seen[i] = 1;
    stack.emplace_back(c, r);
  };
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      push(c, r);
      Box2 box;
      while (!stack.empty()) {
        const auto [x, y] = stack.back();
        stack.pop_back();
        box.add({x - core, y - core});
        box.add({x + core + 1, y + core + 1});
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) push(x + dx, y + dy);
      }
      if (box.empty()) continue;
      box.low = box_.low + cell_m_ * box.low;
      box.high = box_.low + cell_m_ * box.high;
      boxes.push_back(box);
    }
  }
  return boxes;
}

}  // namespace limen
