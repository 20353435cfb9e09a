// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/segment_votes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>

#include <Eigen/LU>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kVoteCellM = 0.06;             // of the planes of shifts; wider for sets beyond 90 m
constexpr std::size_t kMostPeaks = 400;         // places of each plane of shifts that are completed
constexpr std::size_t kMostShifts = 600;        // returned
constexpr double kMostVoteCells = 1500.0;       // along one component of the shift
constexpr double kLongestVoteM = 3.0;           // a long edge is one coincidence, however long
constexpr double kMaxCosine = 0.9;              // two directions nearer to each other do not span a plane
constexpr double kMinSegmentDeterminant = 0.2;  // nor do three flatter ones span space
constexpr double kPeakShare = 0.6;              // of the best completion of a place: less is not tried
constexpr std::size_t kCompletions = 8;         // of one place

/// A segment in the coordinates of the basis.
struct Placed {
  Vector3d at;
  double length_m;
};

/// Votes over two components of the shift.
struct Grid {
  std::size_t nu = 0;
  std::size_t nv = 0;
  std::vector<float> cells;  // v * nu + u

  [[nodiscard]] float at(std::size_t u, std::size_t v) const {
    return cells.empty() ? 0.0F : cells[v * nu + u];
  }
};

struct Peak {
  float votes = 0.0F;
  std::size_t u = 0;
  std::size_t v = 0;
};

struct Cell {
  std::array<std::size_t, 3> at;
  float votes = 0.0F;
};

/// Segments of both sets along one direction.
struct Family {
  Vector3d direction = Vector3d::UnitX();
  std::vector<std::size_t> source;
  std::vector<std::size_t> target;
  double weight_m = 0.0;  // what they can have in common at most
};

class Voting {
 public:
  Voting(const VotingSegments& source, const VotingSegments& target, const Matrix3d& rotation,
         double direction_deg)
      : source_(source), target_(target), rotation_(rotation), near_(std::cos(radians(direction_deg))) {}

  [[nodiscard]] std::vector<Vector3d> run(const std::vector<AxisDirection>& directions) {
    choose_basis(directions);
    if (families_.empty()) return {};
    place();
    if (families_.size() == 1) return one_direction();
    for (std::size_t k = 0; k < 3; ++k) vote(k);
    std::vector<Cell> found;
    for (std::size_t k = 0; k < families_.size(); ++k) {
      for (const Peak& peak : peaks(k)) complete(k, peak, found);
    }
    return best_of(found);
  }

 private:
  [[nodiscard]] Family family_of(const Vector3d& direction) const {
    Family family;
    family.direction = direction;
    double from = 0.0;
    double to = 0.0;
    const Vector3d in_source = rotation_.transpose() * direction;
    for (std::size_t i = 0; i < source_.size(); ++i) {
      if (std::abs(source_.directions[i].dot(in_source)) < near_) continue;
      family.source.push_back(i);
      from += source_.lengths_m[i];
    }
    for (std::size_t j = 0; j < target_.size(); ++j) {
      if (std::abs(target_.directions[j].dot(direction)) < near_) continue;
      family.target.push_back(j);
      to += target_.lengths_m[j];
    }
    family.weight_m = std::min(from, to);
    return family;
  }

  /// Up to three independent directions that the sets can share most of; the rest of the basis is made up.
  void choose_basis(const std::vector<AxisDirection>& directions) {
    std::vector<Family> all;
    for (const AxisDirection& axis : directions) all.push_back(family_of(axis.direction));
    std::erase_if(all, [](const Family& f) { return f.source.empty() || f.target.empty(); });
    std::stable_sort(all.begin(), all.end(),
                     [](const Family& a, const Family& b) { return a.weight_m > b.weight_m; });
    for (const Family& family : all) {
      if (families_.size() == 3) break;
      const Vector3d& d = family.direction;
      if (families_.size() == 1 && std::abs(d.dot(families_[0].direction)) > kMaxCosine) continue;
      if (families_.size() == 2 &&
          std::abs(families_[0].direction.cross(families_[1].direction).dot(d)) < kMinSegmentDeterminant)
        continue;
      families_.push_back(family);
    }
    if (families_.empty()) return;
    const Vector3d first = families_[0].direction;
    const Vector3d second = families_.size() > 1 ? families_[1].direction : first.unitOrthogonal();
    const Vector3d third =
        families_.size() > 2 ? families_[2].direction : Vector3d(first.cross(second).normalized());
    basis_ << first, second, third;
  }

  /// Coordinates of all segments and the range of shifts.
  void place() {
    const Matrix3d to_basis = basis_.inverse();
    Vector3d low[2] = {Vector3d::Constant(1e300), Vector3d::Constant(1e300)};
    Vector3d high[2] = {Vector3d::Constant(-1e300), Vector3d::Constant(-1e300)};
    const auto add = [&](std::size_t side, const Vector3d& at) {
      low[side] = low[side].cwiseMin(at);
      high[side] = high[side].cwiseMax(at);
    };
    for (std::size_t k = 0; k < families_.size(); ++k) {
      for (const std::size_t i : families_[k].source) {
        placed_source_[k].push_back({to_basis * (rotation_ * source_.middles[i]), source_.lengths_m[i]});
        add(0, placed_source_[k].back().at);
      }
      for (const std::size_t j : families_[k].target) {
        placed_target_[k].push_back({to_basis * target_.middles[j], target_.lengths_m[j]});
        add(1, placed_target_[k].back().at);
      }
    }
    middle_shift_ = 0.5 * (low[1] + high[1] - low[0] - high[0]);
    const Vector3d range = high[1] - low[0] - (low[1] - high[0]);
    cell_m_ = std::max(kVoteCellM, range.maxCoeff() / kMostVoteCells);
    low_shift_ = (low[1] - high[0]).array() - cell_m_;
    for (std::size_t k = 0; k < 3; ++k)
      count_[k] = static_cast<std::size_t>(range[static_cast<Eigen::Index>(k)] / cell_m_) + 4;
  }

  /// Pairs of direction k vote for the other two components, each for the four cells round its place.
  void vote(std::size_t k) {
    Grid& grid = grids_[k];
    const std::size_t u = (k + 1) % 3;
    const std::size_t v = (k + 2) % 3;
    grid.nu = count_[u];
    grid.nv = count_[v];
    if (k >= families_.size()) return;
    grid.cells.assign(grid.nu * grid.nv, 0.0F);
    const auto iu = static_cast<Eigen::Index>(u);
    const auto iv = static_cast<Eigen::Index>(v);
    const double scale = 1.0 / cell_m_;
    for (const Placed& a : placed_source_[k]) {
      const double off_u = a.at[iu] + low_shift_[iu];
      const double off_v = a.at[iv] + low_shift_[iv];
      const double most = std::min(a.length_m, kLongestVoteM);
      for (const Placed& b : placed_target_[k]) {
        const double x = (b.at[iu] - off_u) * scale;
        const double y = (b.at[iv] - off_v) * scale;
        const auto cu = static_cast<std::size_t>(x);
        const auto cv = static_cast<std::size_t>(y);
        const auto fu = static_cast<float>(x - static_cast<double>(cu));
        const auto fv = static_cast<float>(y - static_cast<double>(cv));
        const auto weight = static_cast<float>(std::min(most, b.length_m));
        float* cell = grid.cells.data() + cv * grid.nu + cu;
        cell[0] += weight * (1.0F - fu) * (1.0F - fv);
        cell[1] += weight * fu * (1.0F - fv);
        cell[grid.nu] += weight * (1.0F - fu) * fv;
        cell[grid.nu + 1] += weight * fu * fv;
      }
    }
  }

  /// The highest local maxima of a grid.
  [[nodiscard]] std::vector<Peak> peaks(std::size_t k) const {
    const Grid& grid = grids_[k];
    std::vector<Peak> found;
    for (std::size_t v = 1; v + 1 < grid.nv; ++v) {
      for (std::size_t u = 1; u + 1 < grid.nu; ++u) {
        const float* c = grid.cells.data() + v * grid.nu + u;
        const float here = *c;
        if (!(here > 0.0F) || c[-1] > here || c[1] > here) continue;
        const float* below = c - grid.nu;
        const float* above = c + grid.nu;
        if (below[-1] > here || below[0] > here || below[1] > here) continue;
        if (above[-1] > here || above[0] > here || above[1] > here) continue;
        found.push_back({here, u, v});
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Peak& a, const Peak& b) { return a.votes > b.votes; });
    if (found.size() > kMostPeaks) found.resize(kMostPeaks);
    return found;
  }

  /// Adds the shifts of one place: the components along direction k that most of the other pairs want.
  void complete(std::size_t k, const Peak& peak, std::vector<Cell>& found) const {
    const Grid& first = grids_[(k + 1) % 3];   // over (k + 2, k)
    const Grid& second = grids_[(k + 2) % 3];  // over (k, k + 1)
    std::vector<float> line(count_[k]);
    for (std::size_t c = 0; c < line.size(); ++c) line[c] = first.at(peak.v, c) + second.at(c, peak.u);
    std::vector<std::pair<float, std::size_t>> best;
    for (std::size_t c = 1; c + 1 < line.size(); ++c) {
      if (line[c] > 0.0F && line[c] >= line[c - 1] && line[c] >= line[c + 1]) best.emplace_back(line[c], c);
    }
    const std::size_t most = std::min(kCompletions, best.size());
    std::partial_sort(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(most), best.end(),
                      [](const auto& a, const auto& b) {
                        return a.first != b.first ? a.first > b.first : a.second < b.second;
                      });
    for (std::size_t i = 0; i < most && best[i].first >= kPeakShare * best[0].first; ++i) {
      Cell cell;
      cell.at[k] = best[i].second;
      cell.at[(k + 1) % 3] = peak.u;
      cell.at[(k + 2) % 3] = peak.v;
      cell.votes = best[i].first + peak.votes;
      found.push_back(cell);
    }
  }

  [[nodiscard]] Vector3d shift_at(const Cell& cell) const {
    const Vector3d place(static_cast<double>(cell.at[0]), static_cast<double>(cell.at[1]),
                         static_cast<double>(cell.at[2]));
    return basis_ * (low_shift_ + cell_m_ * place);
  }

  /// Most votes first, no two in neighbouring cells.
  [[nodiscard]] std::vector<Vector3d> best_of(std::vector<Cell>& found) const {
    std::stable_sort(found.begin(), found.end(),
                     [](const Cell& a, const Cell& b) { return a.votes > b.votes; });
    const auto key = [](std::size_t x, std::size_t y, std::size_t z) { return (x << 42U) | (y << 21U) | z; };
    std::unordered_set<std::size_t> taken;
    std::vector<Vector3d> shifts;
    for (const Cell& cell : found) {
      if (shifts.size() == kMostShifts) break;
      if (taken.count(key(cell.at[0], cell.at[1], cell.at[2])) > 0) continue;
      for (std::size_t n = 0; n < 27; ++n) {
        taken.insert(key(cell.at[0] + n % 3 - 1, cell.at[1] + n / 3 % 3 - 1, cell.at[2] + n / 9 - 1));
      }
      shifts.push_back(shift_at(cell));
    }
    return shifts;
  }

  /// All segments in common are parallel: along them the middles of the sets are laid on one another.
  [[nodiscard]] std::vector<Vector3d> one_direction() {
    vote(0);
    std::vector<Vector3d> shifts;
    for (const Peak& peak : peaks(0)) {
      Vector3d shift = low_shift_;
      shift[0] = middle_shift_[0];
      shift[1] += cell_m_ * static_cast<double>(peak.u);
      shift[2] += cell_m_ * static_cast<double>(peak.v);
      shifts.push_back(basis_ * shift);
      if (shifts.size() == kMostShifts) break;
    }
    return shifts;
  }

  const VotingSegments& source_;
  const VotingSegments& target_;
  const Matrix3d& rotation_;
  double near_;  // cosine of two directions that are one
  std::vector<Family> families_;
  Matrix3d basis_ = Matrix3d::Identity();
  std::array<std::vector<Placed>, 3> placed_source_;
  std::array<std::vector<Placed>, 3> placed_target_;
  Vector3d low_shift_ = Vector3d::Zero();
  Vector3d middle_shift_ = Vector3d::Zero();
  double cell_m_ = 0.0;
  std::array<std::size_t, 3> count_ = {0, 0, 0};
  std::array<Grid, 3> grids_;
};

}  // namespace

VotingSegments::VotingSegments(const std::vector<Segment>& segments, std::size_t most) {
  constexpr double kNoVotingLengthM = 1e-6;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double length = segments[i].length();
    if (length > kNoVotingLengthM && std::isfinite(length)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return segments[a].length() > segments[b].length(); });
  if (order.size() > most) order.resize(most);
  for (const std::size_t i : order) {
    middles.emplace_back(0.5 * (segments[i].a + segments[i].b));
    directions.push_back(segments[i].direction());
    lengths_m.push_back(segments[i].length());
  }
}

double VotingSegments::total_length_m() const {
  return std::accumulate(lengths_m.begin(), lengths_m.end(), 0.0);
}

std::vector<Vector3d> vote_shifts(const VotingSegments& source, const VotingSegments& target,
                                  const Matrix3d& rotation, const std::vector<AxisDirection>& directions,
                                  double direction_deg) {
  return Voting(source, target, rotation, direction_deg).run(directions);
}

}  // namespace limen
