// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/opening_matcher.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "limen/base/angles.h"
#include "limen/match/solvers/rigid_from_lines.h"
#include "limen/match/solvers/rotation_from_directions.h"

namespace limen {
namespace {

/// Widths and heights of one opening differ by no more (splayed reveals).
constexpr double kOpeningSizesM = 0.25;
constexpr double kMeetingWallsDeg = 6.0;   // walls that meet differ by no more
constexpr double kLeastEdgeNoiseM = 0.01;  // least deviation between two detections of one edge
constexpr double kRobustM = 0.05;          // edges farther off than this lose weight
constexpr double kMaxToleranceM = 0.35;    // for edges that are known badly
constexpr double kMinInformation = 0.003;
constexpr double kGravityWeight = 1e4;  // against metres of edges: gravity is exact
constexpr int kFitRounds = 3;
constexpr double kAcrossCosine = 0.9999;  // a shift along the normal moves nothing within such a wall

double variance(const WallRectangle& a, const WallRectangle& b, std::size_t k) {
  return a.sigma_m[k] * a.sigma_m[k] + b.sigma_m[k] * b.sigma_m[k] + kLeastEdgeNoiseM * kLeastEdgeNoiseM;
}

bool both_see(const WallRectangle& a, const WallRectangle& b, std::size_t k) {
  return a.seen(k) && b.seen(k);
}

double edge_length(const WallRectangle& rectangle, std::size_t k) {
  return k % 2 == 0 ? rectangle.width() : rectangle.height();
}

Line line_of(const Segment& segment) {
  return {0.5 * (segment.a + segment.b), segment.direction()};
}

bool same_pairs(const std::vector<WallMeeting>& a, const std::vector<WallMeeting>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const WallMeeting& x, const WallMeeting& y) {
    return x.source_wall == y.source_wall && x.target_wall == y.target_wall && x.pairs == y.pairs;
  });
}

/// Edge k of the source under its name in the target: left and right change places from side to side.
std::size_t name_in_target(std::size_t k, WallSides sides) {
  return sides == WallSides::opposite && k % 2 == 1 ? 4 - k : k;
}

}  // namespace

OpeningMatcher::OpeningMatcher(std::vector<WallWithOpenings> source, std::vector<WallWithOpenings> target,
                               const OpeningPoseOptions& options)
    : source_(std::move(source)), target_(std::move(target)), options_(options) {
  const double squared = kOpeningEdgesM * kOpeningEdgesM;
  for (const WallWithOpenings& wall : source_) {
    source_edges_.push_back(seen_edges(wall));
    for (const Segment& edge : source_edges_.back()) source_nominal_ += edge.length() * squared;
  }
  for (WallWithOpenings& wall : target_) {
    std::stable_sort(wall.rectangles.begin(), wall.rectangles.end(),
                     [](const WallRectangle& a, const WallRectangle& b) { return a.edge[3] < b.edge[3]; });
    double widest = 0.0;
    for (const WallRectangle& r : wall.rectangles) widest = std::max(widest, r.width());
    widest_m_.push_back(widest);
    SegmentDistanceOptions distance;
    distance.max_distance_m = kOpeningEdgesM;
    distance.wall_normal = wall.normal();
    target_measures_.emplace_back(seen_edges(wall), distance);
    target_nominal_ += target_measures_.back().to({}).nominal;
  }
}

bool OpeningMatcher::alike(const WallRectangle& a, const WallRectangle& b) const {
  const bool vertical = both_see(a, b, 1) || both_see(a, b, 3);
  const bool horizontal = both_see(a, b, 0) || both_see(a, b, 2);
  if (!vertical || !horizontal) return false;
  const auto differs = [&](double size_a, double size_b, std::size_t k) {
    return both_see(a, b, k) && both_see(a, b, k + 2) && std::abs(size_a - size_b) > kOpeningSizesM;
  };
  return !differs(a.height(), b.height(), 0) && !differs(a.width(), b.width(), 1);
}

std::optional<RectangleFit> OpeningMatcher::fit_of(const WallRectangle& a, const Vector2d& shift,
                                                   const WallRectangle& b) const {
  RectangleFit fit;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!both_see(a, b, k)) continue;
    const double off = a.edge[k] + (k % 2 == 0 ? shift.y() : shift.x()) - b.edge[k];
    const double tolerance = std::min(kMaxToleranceM, kOpeningEdgesM + 2.0 * std::sqrt(variance(a, b, k)));
    if (std::abs(off) > tolerance) return std::nullopt;
    ++fit.common_edges;
    fit.length_m += std::min(edge_length(a, k), edge_length(b, k));
    fit.squares_m2 += off * off;
  }
  if (fit.common_edges == 0) return std::nullopt;
  fit.squares_m2 /= fit.common_edges;
  return fit;
}

std::vector<std::pair<std::size_t, std::size_t>> OpeningMatcher::pairs_at(
    const std::vector<WallRectangle>& rectangles, std::size_t target_wall, const Vector2d& shift) const {
  const std::vector<WallRectangle>& others = target_[target_wall].rectangles;
  std::vector<std::tuple<double, std::size_t, std::size_t>> found;  // squares, source, target
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    // Either side of the opening may be the one that was seen, so it need only overlap.
    const double low = rectangles[i].edge[3] + shift.x() - widest_m_[target_wall];
    const double high = rectangles[i].edge[1] + shift.x();
    auto it = std::lower_bound(others.begin(), others.end(), low - kMaxToleranceM,
                               [](const WallRectangle& r, double value) { return r.edge[3] < value; });
    for (; it != others.end() && it->edge[3] <= high + kMaxToleranceM; ++it) {
      const auto fit = fit_of(rectangles[i], shift, *it);
      if (fit && alike(rectangles[i], *it)) {
        found.emplace_back(fit->squares_m2, i, static_cast<std::size_t>(it - others.begin()));
      }
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<char> taken_source(rectangles.size(), 0);
  std::vector<char> taken_target(others.size(), 0);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [squares, i, j] : found) {
    if (taken_source[i] != 0 || taken_target[j] != 0) continue;
    taken_source[i] = taken_target[j] = 1;
    pairs.emplace_back(i, j);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool OpeningMatcher::possible(double thickness_m, WallSides sides) const {
  if (sides == WallSides::same) return std::abs(thickness_m) <= kSameFaceM;
  return thickness_m >= options_.min_thickness_m && thickness_m <= options_.max_thickness_m;
}

bool OpeningMatcher::face(const Matrix3d& rotation, std::size_t source_wall, std::size_t target_wall,
                          WallSides sides) const {
  const double cosine = (rotation * source_[source_wall].normal()).dot(target_[target_wall].normal());
  return (sides == WallSides::same ? cosine : -cosine) > std::cos(radians(kMeetingWallsDeg));
}

double OpeningMatcher::thickness_at(const Rigid3& target_from_source, std::size_t source_wall,
                                    std::size_t target_wall) const {
  const WallWithOpenings& wall = target_[target_wall];
  return wall.normal().dot(wall.frame.origin - target_from_source * source_[source_wall].frame.origin);
}

/// The rectangles of a source wall in the frame of a target wall, as its scanner would see them. Turns within
/// the wall move their centres only: they are small.
std::vector<WallRectangle> OpeningMatcher::in_target_wall(const Rigid3& target_from_source,
                                                          std::size_t source_wall, std::size_t target_wall,
                                                          WallSides sides) const {
  std::vector<WallRectangle> rectangles = source_[source_wall].rectangles;
  const PlaneFrame& from = source_[source_wall].frame;
  const PlaneFrame& to = target_[target_wall].frame;
  for (WallRectangle& r : rectangles) {
    const Vector2d centre(0.5 * (r.edge[1] + r.edge[3]), 0.5 * (r.edge[0] + r.edge[2]));
    const Vector2d moved = to.to_plane(target_from_source * from.to_space(centre));
    const double half_width = 0.5 * r.width();
    const double half_height = 0.5 * r.height();
    if (sides == WallSides::opposite) r = seen_from_behind(r);
    r.edge = {moved.y() - half_height, moved.x() + half_width, moved.y() + half_height,
              moved.x() - half_width};
  }
  return rectangles;
}

std::vector<WallMeeting> OpeningMatcher::meetings(const Rigid3& target_from_source, WallSides sides) const {
  std::vector<WallMeeting> result;
  for (std::size_t a = 0; a < source_.size(); ++a) {
    for (std::size_t b = 0; b < target_.size(); ++b) {
      if (!face(target_from_source.rotation, a, b, sides)) continue;
      WallMeeting meeting{a, b, thickness_at(target_from_source, a, b), {}};
      if (!possible(meeting.thickness_m, sides)) continue;
      meeting.pairs = pairs_at(in_target_wall(target_from_source, a, b, sides), b, Vector2d::Zero());
      if (!meeting.pairs.empty()) result.push_back(std::move(meeting));
    }
  }
  return result;
}

std::vector<SetDistance> OpeningMatcher::best_of_wall(std::size_t source_wall,
                                                      const Rigid3& target_from_source, WallSides sides,
                                                      const Vector3d& direction,
                                                      const std::vector<double>& shifts_m) const {
  std::vector<SetDistance> best(shifts_m.size());
  for (std::size_t b = 0; b < target_.size(); ++b) {
    if (!face(target_from_source.rotation, source_wall, b, sides)) continue;
    const double thickness = thickness_at(target_from_source, source_wall, b);
    const double thinner = target_[b].normal().dot(direction);  // per metre of shift
    std::optional<SetDistance> any;
    for (std::size_t i = 0; i < shifts_m.size(); ++i) {
      if (!possible(thickness - shifts_m[i] * thinner, sides)) continue;
      if (!any || std::abs(thinner) < kAcrossCosine) {
        const Rigid3 shifted{target_from_source.rotation,
                             target_from_source.translation + shifts_m[i] * direction};
        any = target_measures_[b].to(source_edges_[source_wall], shifted);
      }
      if (any->nominal - any->distance > best[i].nominal - best[i].distance) best[i] = *any;
    }
  }
  return best;
}

std::vector<SetDistance> OpeningMatcher::distances_along(const Rigid3& target_from_source, WallSides sides,
                                                         const Vector3d& direction,
                                                         const std::vector<double>& shifts_m) const {
  SetDistance nothing;
  nothing.nominal = source_nominal_ + target_nominal_;
  nothing.distance = nothing.nominal;
  std::vector<SetDistance> totals(shifts_m.size(), nothing);
  for (std::size_t a = 0; a < source_.size(); ++a) {
    const auto best = best_of_wall(a, target_from_source, sides, direction, shifts_m);
    for (std::size_t i = 0; i < totals.size(); ++i) {
      totals[i].distance = std::max(0.0, totals[i].distance - (best[i].nominal - best[i].distance));
      totals[i].source_covered_m += best[i].source_covered_m;
      totals[i].target_covered_m += best[i].target_covered_m;
    }
  }
  return totals;
}

/// Walls on walls and up on up (Wahba over the meetings); metres of edges weigh.
Matrix3d OpeningMatcher::rotation_of(const std::vector<WallMeeting>& meetings, WallSides sides) const {
  std::vector<DirectionPair> directions;
  for (const WallMeeting& meeting : meetings) {
    const WallWithOpenings& from = source_[meeting.source_wall];
    const WallWithOpenings& to = target_[meeting.target_wall];
    double length = 0.0;
    for (const auto& [i, j] : meeting.pairs)
      length += from.rectangles[i].width() + from.rectangles[i].height();
    const Vector3d normal = sides == WallSides::same ? to.normal() : Vector3d(-to.normal());
    directions.push_back({from.normal(), normal, length});
    directions.push_back(
        {from.frame.v, to.frame.v, options_.gravity_known ? kGravityWeight * length : length});
  }
  return rotation_from_directions(directions).rotation;
}

OpeningMatcher::Fit OpeningMatcher::improved(const Fit& old, WallSides sides) const {
  std::vector<LinePair> lines;
  Vector3d centre = Vector3d::Zero();
  for (const WallMeeting& meeting : old.meetings) {
    const WallWithOpenings& from = source_[meeting.source_wall];
    const WallWithOpenings& to = target_[meeting.target_wall];
    for (const auto& [i, j] : meeting.pairs) {
      const WallRectangle& r = from.rectangles[i];
      const WallRectangle seen = sides == WallSides::opposite ? seen_from_behind(r) : r;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t k_source = name_in_target(k, sides);
        if (!both_see(seen, to.rectangles[j], k)) continue;
        LinePair line{line_of(edge_segment(from, r, k_source)),
                      line_of(edge_segment(to, to.rectangles[j], k)), 1.0, to.normal()};
        const Vector3d across = line.wall_normal->cross(line.target.direction);
        const double off = across.dot(line.target.point - old.target_from_source * line.source.point);
        line.weight = 1.0 / (variance(seen, to.rectangles[j], k) * (1.0 + off * off / (kRobustM * kRobustM)));
        centre += line.source.point;
        lines.push_back(line);
      }
    }
  }
  centre /= static_cast<double>(lines.size());
  Fit fit;
  fit.target_from_source.rotation = rotation_of(old.meetings, sides);
  // The middle of the edges stays where it is along directions that the edges do not hold.
  const Vector3d start = old.target_from_source * centre - fit.target_from_source.rotation * centre;
  const TranslationFit shift =
      translation_from_lines(fit.target_from_source.rotation, lines, start, kMinInformation);
  fit.target_from_source.translation = shift.translation;
  fit.normal_held = shift.unobserved.empty();
  return fit;
}

std::optional<OpeningMatcher::Fit> OpeningMatcher::fit(const Rigid3& start, WallSides sides) const {
  Fit fit{start, meetings(start, sides), false};
  for (int round = 0; round < kFitRounds && !fit.meetings.empty(); ++round) {
    Fit better = improved(fit, sides);
    better.meetings = meetings(better.target_from_source, sides);
    const bool settled = same_pairs(better.meetings, fit.meetings);
    fit = std::move(better);
    if (settled) break;
  }
  if (fit.meetings.empty()) return std::nullopt;
  return fit;
}

}  // namespace limen
