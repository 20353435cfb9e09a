// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/split_at_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "limen/base/ranked.h"
#include "limen/geometry/cell_numbers.h"

namespace limen {
namespace {

constexpr double kPointsOfCell = 16.0;  // about so many points of a cell of the plane
constexpr double kFinestM = 0.012;      // edge of the smallest cell
constexpr double kCoarsestM = 0.5;      // and of the largest
constexpr double kLeastOfPart = 30.0;   // smaller parts that join no other are left out

/// Sums of heights h over places (u, v) of a plane.
struct HeightSums {
  double n = 0.0;
  double u = 0.0;
  double v = 0.0;
  double h = 0.0;
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
  double uh = 0.0;
  double vh = 0.0;
  double hh = 0.0;

  void add(double pu, double pv, double ph) {
    n += 1.0;
    u += pu;
    v += pv;
    h += ph;
    uu += pu * pu;
    uv += pu * pv;
    vv += pv * pv;
    uh += pu * ph;
    vh += pv * ph;
    hh += ph * ph;
  }
  void add(const HeightSums& o) {
    n += o.n;
    u += o.u;
    v += o.v;
    h += o.h;
    uu += o.uu;
    uv += o.uv;
    vv += o.vv;
    uh += o.uh;
    vh += o.vh;
    hh += o.hh;
  }
  /// Squares about the plane that explains them best, its slopes held by `ridge` (noise over slope, squared).
  [[nodiscard]] double squares(double ridge) const {
    const double m = 1.0 / n;
    const double cuu = uu - u * u * m + ridge;
    const double cuv = uv - u * v * m;
    const double cvv = vv - v * v * m + ridge;
    const double cuh = uh - u * h * m;
    const double cvh = vh - v * h * m;
    const double det = cuu * cvv - cuv * cuv;
    return hh - h * h * m - (cvv * cuh * cuh - 2.0 * cuv * cuh * cvh + cuu * cvh * cvh) / det;
  }
};

constexpr double kStepChiSquared = 16.3;  // of three freedoms, exceeded once in a thousand
constexpr double kSlope = 0.01;           // one standard deviation: a part is turned from its plane by little
constexpr double kLeastCellNoiseM = 0.0005;
constexpr int kInnerCells = 12;  // of a part that may be a piece of a bulging surface
constexpr double kShared = 3.0;  // pairs of cells at a border that share a cell, about
constexpr double kBorderPairs = 6.0;

/// What two touching parts show where they touch: mean of the second less that of the first.
struct Border {
  double sum = 0.0;
  double weight = 0.0;
  double pairs = 0.0;
};

/// The cells of a plane and their parts.
class StepParts {
 public:
  StepParts(const Scan& scan, const PlaneFit& fit, const std::vector<std::uint32_t>& points,
            const StepOptions& options)
      : o_(options), points_(points), table_(points.size() / 2) {
    const PlaneFrame frame = make_frame(fit.plane, fit.centroid);
    places_.reserve(points.size());
    for (const std::uint32_t i : points) {
      const Vector2d p = frame.to_plane(scan.points[i]);
      places_.push_back({p.x(), p.y(), fit.plane.signed_distance(scan.points[i])});
    }
    bin(edge());
    noise_ = noise();
    ridge_ = noise_ * noise_ / (kSlope * kSlope);
  }

  std::vector<std::vector<std::uint32_t>> run() {
    parts_.resize(cells_.size());
    std::iota(parts_.begin(), parts_.end(), 0);
    squares_.reserve(cells_.size());
    for (const HeightSums& cell : cells_) squares_.push_back(cell.squares(ridge_));
    join_blocks();
    join_alike();
    join_bulging();
    join_apart();
    return parts();
  }

 private:
  struct Place {
    double u, v, h;
  };

  /// So that a cell holds some points where the plane is as dense as for most of its points.
  [[nodiscard]] double edge() const {
    constexpr double kLookM = 0.1;
    constexpr std::size_t kLooks = 4096;
    const std::size_t step = std::max<std::size_t>(1, places_.size() / kLooks);
    CellNumbers look(kLooks / 2);
    std::vector<std::uint32_t> of;
    std::vector<double> counts;
    for (std::size_t k = 0; k < places_.size(); k += step) {
      of.push_back(look.insert(static_cast<std::int32_t>(std::floor(places_[k].u / kLookM)),
                               static_cast<std::int32_t>(std::floor(places_[k].v / kLookM))));
      counts.resize(std::max(counts.size(), std::size_t{of.back()} + 1));
      counts[of.back()] += static_cast<double>(step);
    }
    std::vector<double> around;
    around.reserve(of.size());
    for (const std::uint32_t c : of) around.push_back(counts[c]);
    return std::clamp(kLookM * std::sqrt(kPointsOfCell / median(around)), kFinestM, kCoarsestM);
  }

  void bin(double edge) {
    cell_of_.reserve(places_.size());
    for (const Place& p : places_) {
      const std::uint32_t c = table_.insert(static_cast<std::int32_t>(std::floor(p.u / edge)),
                                            static_cast<std::int32_t>(std::floor(p.v / edge)));
      if (c == cells_.size()) cells_.emplace_back();
      cells_[c].add(p.u, p.v, p.h);
      cell_of_.push_back(c);
    }
    own_ = cells_;
  }

  /// Within the cells.
  [[nodiscard]] double noise() const {
    constexpr double kUnknownM = 0.01;
    double squares = 0.0;
    double freedoms = 0.0;
    for (const HeightSums& c : cells_) {
      if (c.n < 4.0) continue;
      squares += c.hh - c.h * c.h / c.n;
      freedoms += c.n - 1.0;
    }
    return freedoms > 0.0 ? std::max(kLeastCellNoiseM, std::sqrt(squares / freedoms)) : kUnknownM;
  }

  std::size_t root_of(std::size_t c) {
    while (static_cast<std::size_t>(parts_[c]) != c) {
      parts_[c] = parts_[static_cast<std::size_t>(parts_[c])];
      c = static_cast<std::size_t>(parts_[c]);
    }
    return c;
  }

  struct Joined {
    HeightSums sums;
    double squares = 0.0;
    double strain = 0.0;  ///< what the common plane adds, in units of what is allowed
  };
  [[nodiscard]] Joined joined(std::size_t a, std::size_t b, double drift_m) const {
    Joined both{cells_[a]};
    both.sums.add(cells_[b]);
    both.squares = both.sums.squares(ridge_);
    const double together = cells_[a].n * cells_[b].n / both.sums.n;
    both.strain = (both.squares - squares_[a] - squares_[b]) /
                  (kStepChiSquared * noise_ * noise_ + together * drift_m * drift_m);
    return both;
  }
  void join(std::size_t a, std::size_t b, const Joined& both) {
    if (cells_[a].n < cells_[b].n) std::swap(a, b);
    cells_[a] = both.sums;
    squares_[a] = both.squares;
    parts_[b] = static_cast<std::int32_t>(a);
  }

  /// f(cell, neighbour) for each pair of cells that touch.
  template <typename F>
  void for_touching(const F& f) const {
    constexpr std::array<std::pair<int, int>, 4> kHalf{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
    for (std::size_t c = 0; c < own_.size(); ++c) {
      for (const auto& [dx, dy] : kHalf) {
        const std::uint32_t other = table_.find(table_.x(c) + dx, table_.y(c) + dy);
        if (other != CellNumbers::kNone) f(c, other);
      }
    }
  }

  /// A square of two by two smaller ones.
  struct Block {
    HeightSums sums;
    double squares_of_parts = 0.0;
    double squares = 0.0;
    std::int32_t first = -1;  ///< of its cells
    bool even = true;         ///< it and all squares in it have no step
  };

  /// Where nothing shows a step cells become one part square by square, two by two: what chance makes alike
  /// is not sought out, and there is less to join.
  void join_blocks() {
    constexpr int kLevels = 7;
    CellNumbers places = table_;
    std::vector<Block> blocks(own_.size());
    std::vector<std::int32_t> block_of(own_.size());  // by cell: its largest even block at this level, or -1
    for (std::size_t c = 0; c < own_.size(); ++c) {
      blocks[c] = {own_[c], squares_[c], squares_[c], static_cast<std::int32_t>(c)};
      block_of[c] = static_cast<std::int32_t>(c);
    }
    for (int level = 0; level < kLevels; ++level) {
      CellNumbers larger(blocks.size() / 2);
      std::vector<Block> parents;
      std::vector<std::uint32_t> parent_of(blocks.size());
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        parent_of[b] = larger.insert(places.x(b) >> 1, places.y(b) >> 1);
        if (parent_of[b] == parents.size()) {
          parents.emplace_back();
          parents.back().first = blocks[b].first;
        }
        Block& parent = parents[parent_of[b]];
        parent.sums.add(blocks[b].sums);
        parent.squares_of_parts += blocks[b].squares;
        parent.even = parent.even && blocks[b].even;
      }
      for (Block& parent : parents) even_out(parent);
      for (std::size_t c = 0; c < own_.size(); ++c) {
        if (block_of[c] < 0) continue;
        const std::uint32_t parent = parent_of[static_cast<std::size_t>(block_of[c])];
        const Block& block = parents[parent];
        block_of[c] = block.even ? static_cast<std::int32_t>(parent) : -1;
        if (!block.even) continue;
        parts_[c] = block.first;
        cells_[static_cast<std::size_t>(block.first)] = block.sums;
        squares_[static_cast<std::size_t>(block.first)] = block.squares;
      }
      blocks = std::move(parents);
      places = std::move(larger);
    }
  }
  void even_out(Block& block) const {
    if (!block.even) return;
    block.squares = block.sums.squares(ridge_);
    const double allowed = 7.8 * noise_ * noise_ + 0.25 * block.sums.n * o_.drift_m * o_.drift_m;
    block.even = block.squares - block.squares_of_parts <= allowed;
  }

  void join_alike() {
    struct Edge {
      double strain;
      double count;  ///< points of both parts when the edge was queued
      std::size_t a, b;
      bool operator<(const Edge& o) const { return std::tie(strain, a, b) > std::tie(o.strain, o.a, o.b); }
    };
    std::priority_queue<Edge> edges;
    std::vector<std::pair<std::size_t, std::size_t>> touching;
    for_touching([&](std::size_t a, std::size_t b) {
      const std::size_t i = root_of(a);
      const std::size_t j = root_of(b);
      if (i != j) touching.emplace_back(std::min(i, j), std::max(i, j));
    });
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
    for (const auto& [a, b] : touching) {
      const double strain = joined(a, b, o_.drift_m).strain;
      if (strain <= 1.0) edges.push({strain, cells_[a].n + cells_[b].n, a, b});
    }
    while (!edges.empty()) {
      Edge top = edges.top();
      edges.pop();
      const std::size_t a = root_of(top.a);
      const std::size_t b = root_of(top.b);
      if (a == b) continue;
      const Joined both = joined(a, b, o_.drift_m);
      if (both.sums.n == top.count) {
        join(a, b, both);
      } else if (both.strain <= 1.0) {
        edges.push({both.strain, both.sums.n, top.a, top.b});
      }
    }
  }

  /// Cells all of whose neighbours are of their part.
  std::vector<int> inner_cells() {
    std::vector<int> neighbours(cells_.size(), 0);
    for_touching([&](std::size_t a, std::size_t b) {
      const int same = root_of(a) == root_of(b) ? 1 : -8;
      neighbours[a] += same;
      neighbours[b] += same;
    });
    std::vector<int> inner(cells_.size(), 0);
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      constexpr int kMost = 5;
      if (neighbours[c] >= kMost) ++inner[root_of(c)];
    }
    return inner;
  }

  void join_bulging() {
    const std::vector<int> inner = inner_cells();
    std::map<std::pair<std::size_t, std::size_t>, Border> borders;
    for_touching([&](std::size_t a, std::size_t b) {
      std::size_t i = root_of(a);
      std::size_t j = root_of(b);
      if (i == j || inner[i] < kInnerCells || inner[j] < kInnerCells) return;
      if (i > j) {
        std::swap(i, j);
        std::swap(a, b);
      }
      const double weight = own_[a].n * own_[b].n / (own_[a].n + own_[b].n);
      Border& border = borders[{i, j}];
      border.sum += weight * (own_[b].h / own_[b].n - own_[a].h / own_[a].n);
      border.weight += weight;
      border.pairs += 1.0;
    });
    for (const auto& [parts, border] : borders) {
      const double step = std::abs(border.sum) / border.weight;
      const double sigma = noise_ * std::sqrt(kShared / border.weight);
      if (border.pairs < kBorderPairs || step > o_.step_m || 2.0 * sigma > o_.step_m) continue;
      const std::size_t a = root_of(parts.first);
      const std::size_t b = root_of(parts.second);
      if (a != b) join(a, b, joined(a, b, o_.drift_m));
    }
  }

  /// By which the part strays from its plane beside the noise.
  [[nodiscard]] double bulge(std::size_t part) const {
    return std::sqrt(std::max(0.0, squares_[part] / cells_[part].n - noise_ * noise_));
  }

  void join_apart() {
    std::vector<std::size_t> roots;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (root_of(c) == c) roots.push_back(c);
    }
    std::stable_sort(roots.begin(), roots.end(),
                     [&](std::size_t a, std::size_t b) { return cells_[a].n > cells_[b].n; });
    std::vector<std::size_t> kept;
    for (const std::size_t c : roots) {
      Joined best;
      best.strain = 1.0;
      std::size_t with = c;
      for (const std::size_t k : kept) {
        const Joined both = joined(k, c, std::max({o_.drift_m, bulge(k), bulge(c)}));
        if (both.strain > best.strain) continue;
        best = both;
        with = k;
      }
      if (with != c) {
        join(with, c, best);
      } else if (cells_[c].n >= kLeastOfPart) {
        kept.push_back(c);
      }
    }
  }

  std::vector<std::vector<std::uint32_t>> parts() {
    std::vector<std::int32_t> number(cells_.size(), -1);
    std::vector<std::vector<std::uint32_t>> parts;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const std::size_t root = root_of(cell_of_[k]);
      if (cells_[root].n < kLeastOfPart) continue;
      if (number[root] < 0) {
        number[root] = static_cast<std::int32_t>(parts.size());
        parts.emplace_back();
      }
      parts[static_cast<std::size_t>(number[root])].push_back(points_[k]);
    }
    return parts;
  }

  StepOptions o_;
  const std::vector<std::uint32_t>& points_;
  CellNumbers table_;
  std::vector<Place> places_;
  std::vector<std::uint32_t> cell_of_;  ///< by point
  std::vector<HeightSums> own_;         ///< of each cell
  std::vector<HeightSums> cells_;       ///< at a part's root those of the part
  std::vector<double> squares_;         ///< likewise, about its plane
  std::vector<std::int32_t> parts_;     ///< by cell: towards the root of its part
  double noise_ = 0.0;
  double ridge_ = 0.0;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> split_at_steps(const Scan& scan, const PlaneFit& fit,
                                                       const std::vector<std::uint32_t>& points,
                                                       const StepOptions& options) {
  if (points.empty()) return {};
  return StepParts(scan, fit, points, options).run();
}

}  // namespace limen
