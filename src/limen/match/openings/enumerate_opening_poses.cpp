// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/enumerate_opening_poses.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/match/openings/distinct_poses.h"
#include "limen/match/openings/opening_matcher.h"
#include "limen/match/solvers/rigid_from_lines.h"

namespace limen {
namespace {

constexpr double kEdgeNoiseM = 0.01;      // of one edge, on top of its own deviation
constexpr double kCornerDeg = 30.0;       // walls that differ by more hold each other's normal
constexpr double kSameRotationDeg = 4.0;  // pairs of walls that may belong to one pose
constexpr double kCornerHeightM = 0.25;   // by which two walls' shifts may differ in height before the fit
constexpr std::size_t kCornerThicknesses = 4;  // kept per shift
constexpr std::size_t kCornerShifts = 150;     // of every other pair of walls that are asked
constexpr double kFrameM = 0.07;               // a window's frame between its two reveals
constexpr std::size_t kCandidatesPerPiece = 16;

/// A shift in a wall that brings openings together, with the overlap that supports it.
struct OpeningShift {
  Vector2d shift = Vector2d::Zero();
  double vote = 0.0;  // metres of edges, less what they miss
};

/// A wall of each scan, the rotation that lays one on the other, and the shifts within it.
struct WallPair {
  std::size_t source = 0;
  std::size_t target = 0;
  Matrix3d rotation = Matrix3d::Identity();
  Vector3d start = Vector3d::Zero();  // translation for shift 0 and thickness 0
  std::vector<OpeningShift> shifts;   // most votes first
};

/// A pose to be fitted, and the thicknesses it shall be listed with where nothing holds that.
struct OpeningCandidate {
  const WallPair* pair = nullptr;
  Rigid3 target_from_source;
  double vote = 0.0;
  double thickness_m = 0.0;
  std::vector<double> others_m;
};

class OpeningEnumerator {
 public:
  OpeningEnumerator(const Features& source, const Features& target, const OpeningMatcher& matcher,
                    WallSides sides, const OpeningPoseOptions& options)
      : source_(source), target_(target), matcher_(matcher), sides_(sides), options_(options) {}

  [[nodiscard]] std::vector<OpeningPose> run() const {
    std::vector<WallPair> pairs;
    for (std::size_t a = 0; a < matcher_.source().size(); ++a) {
      for (std::size_t b = 0; b < matcher_.target().size(); ++b) pairs.push_back(wall_pair(a, b));
    }
    parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) pairs[i].shifts = shifts_of(pairs[i]);
    });
    const std::vector<OpeningCandidate> candidates = candidates_of(pairs);
    std::vector<std::vector<OpeningPose>> poses(candidates.size());
    parallel_for(candidates.size(), kCandidatesPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) poses[i] = fitted(candidates[i]);
    });
    std::vector<OpeningPose> all;
    for (const auto& some : poses) all.insert(all.end(), some.begin(), some.end());
    return all;
  }

 private:
  /// Equations 15 and 16 with the walls' own directions: right and up are known in both scans.
  [[nodiscard]] WallPair wall_pair(std::size_t a, std::size_t b) const {
    const WallWithOpenings& from = matcher_.source()[a];
    const WallWithOpenings& to = matcher_.target()[b];
    const double side = sides_ == WallSides::opposite ? -1.0 : 1.0;
    LinePair vertical;
    vertical.source.direction = from.frame.v;
    vertical.target.direction = to.frame.v;
    LinePair horizontal;
    horizontal.source.direction = side * from.frame.u;
    horizontal.target.direction = to.frame.u;
    WallPair pair{a, b, rotation_from_lines(vertical, horizontal), Vector3d::Zero(), {}};
    pair.start = to.frame.origin - pair.rotation * from.frame.origin;
    return pair;
  }

  [[nodiscard]] std::vector<WallRectangle> as_seen_in_target(std::size_t source_wall) const {
    std::vector<WallRectangle> rectangles = matcher_.source()[source_wall].rectangles;
    if (sides_ == WallSides::opposite) {
      for (WallRectangle& r : rectangles) r = seen_from_behind(r);
    }
    return rectangles;
  }

  /// Equation 19 for one pair of rectangles: edges at right angles, so every axis is a weighted mean.
  [[nodiscard]] static Vector2d shift_between(const WallRectangle& a, const WallRectangle& b) {
    Vector2d sum = Vector2d::Zero();
    Vector2d weight = Vector2d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      if (!a.seen(k) || !b.seen(k)) continue;
      const double w =
          1.0 / (a.sigma_m[k] * a.sigma_m[k] + b.sigma_m[k] * b.sigma_m[k] + kEdgeNoiseM * kEdgeNoiseM);
      const Eigen::Index axis = k % 2 == 0 ? 1 : 0;
      sum[axis] += w * (b.edge[k] - a.edge[k]);
      weight[axis] += w;
    }
    return sum.cwiseQuotient(weight);
  }

  [[nodiscard]] OpeningShift voted(const std::vector<WallRectangle>& rectangles, std::size_t wall,
                                   const Vector2d& shift) const {
    OpeningShift result{shift, 0.0};
    const double tolerance = kOpeningEdgesM + 2.0 * kEdgeNoiseM;
    for (const auto& [i, j] : matcher_.pairs_at(rectangles, wall, shift)) {
      const auto fit = matcher_.fit_of(rectangles[i], shift, matcher_.target()[wall].rectangles[j]);
      if (fit) result.vote += fit->length_m * std::max(0.1, 1.0 - fit->squares_m2 / (tolerance * tolerance));
    }
    return result;
  }

  [[nodiscard]] std::vector<OpeningShift> shifts_of(const WallPair& pair) const {
    const std::vector<WallRectangle> rectangles = as_seen_in_target(pair.source);
    std::vector<OpeningShift> all;
    for (const WallRectangle& a : rectangles) {
      for (const WallRectangle& b : matcher_.target()[pair.target].rectangles) {
        if (!matcher_.alike(a, b)) continue;
        const OpeningShift shift = voted(rectangles, pair.target, shift_between(a, b));
        if (shift.vote > 0.0) all.push_back(shift);
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const OpeningShift& x, const OpeningShift& y) { return x.vote > y.vote; });
    std::vector<OpeningShift> kept;
    for (const OpeningShift& shift : all) {
      if (kept.size() == options_.max_poses) break;
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const OpeningShift& other) {
        return (other.shift - shift.shift).cwiseAbs().maxCoeff() < kSameInWallM;
      });
      if (!known) kept.push_back(shift);
    }
    return kept;
  }

  [[nodiscard]] Rigid3 pose_at(const WallPair& pair, const Vector2d& shift, double thickness) const {
    const WallWithOpenings& wall = matcher_.target()[pair.target];
    return {pair.rotation,
            pair.start + shift.x() * wall.frame.u + shift.y() * wall.frame.v - thickness * wall.normal()};
  }

  /// Thicknesses of the pair's wall that bring openings of two other walls together too, most votes first.
  [[nodiscard]] std::vector<OpeningShift> corner_thicknesses(const std::vector<WallPair>& pairs,
                                                             const WallPair& pair,
                                                             const Vector2d& shift) const {
    const Rigid3 base = pose_at(pair, shift, 0.0);
    const Vector3d normal = matcher_.target()[pair.target].normal();
    std::vector<OpeningShift> found;  // x: thickness
    for (const WallPair& other : pairs) {
      const WallWithOpenings& wall = matcher_.target()[other.target];
      const double along = wall.frame.u.dot(normal);
      if (std::abs(along) < std::sin(radians(kCornerDeg)) || &other == &pair) continue;
      if (rotation_angle(pair.rotation.transpose() * other.rotation) > radians(kSameRotationDeg)) continue;
      const Vector3d middle = matcher_.source()[other.source].frame.origin;
      const Vector3d off = base * middle - wall.frame.origin;
      const std::size_t count = std::min(other.shifts.size(), kCornerShifts);
      for (std::size_t i = 0; i < count; ++i) {
        const OpeningShift& s = other.shifts[i];
        if (std::abs(wall.frame.v.dot(off) - s.shift.y()) > kCornerHeightM) continue;
        const double thickness = (wall.frame.u.dot(off) - s.shift.x()) / along;
        const double others = -wall.normal().dot(off - thickness * normal);
        if (possible(thickness) && possible(others)) found.push_back({Vector2d(thickness, 0.0), s.vote});
      }
    }
    return strongest(std::move(found));
  }

  [[nodiscard]] std::vector<OpeningShift> strongest(std::vector<OpeningShift> found) const {
    std::stable_sort(found.begin(), found.end(),
                     [](const OpeningShift& x, const OpeningShift& y) { return x.vote > y.vote; });
    std::vector<OpeningShift> kept;
    for (const OpeningShift& one : found) {
      if (kept.size() == kCornerThicknesses) break;
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const OpeningShift& other) {
        return std::abs(other.shift.x() - one.shift.x()) < kSameAcrossWallM;
      });
      if (!known) kept.push_back(one);
    }
    return kept;
  }

  [[nodiscard]] bool possible(double thickness) const {
    if (sides_ == WallSides::same) return std::abs(thickness) <= kSameFaceM;
    return thickness >= options_.min_thickness_m && thickness <= options_.max_thickness_m;
  }

  /// What is assumed where nothing holds the normal: what the pair's reveals say, then the usual ones.
  [[nodiscard]] std::vector<double> assumed_thicknesses(const WallPair& pair, const Vector2d& shift) const {
    if (sides_ == WallSides::same) return {0.0};
    std::vector<double> list;
    const auto propose = [&](double thickness) {
      const bool known = std::any_of(list.begin(), list.end(), [&](double other) {
        return std::abs(other - thickness) < kSameAcrossWallM;
      });
      if (!known && possible(thickness)) list.push_back(thickness);
    };
    const WallWithOpenings& from = matcher_.source()[pair.source];
    const WallWithOpenings& to = matcher_.target()[pair.target];
    for (const auto& [i, j] : matcher_.pairs_at(as_seen_in_target(pair.source), pair.target, shift)) {
      const Opening& a = source_.openings[static_cast<std::size_t>(from.rectangles[i].opening)];
      const Opening& b = target_.openings[static_cast<std::size_t>(to.rectangles[j].opening)];
      if (a.reveal_complete) propose(a.reveal_depth_m);
      if (b.reveal_complete) propose(b.reveal_depth_m);
      if (a.reveal_depth_m > 0.0 && b.reveal_depth_m > 0.0 && !a.reveal_complete && !b.reveal_complete) {
        propose(a.reveal_depth_m + b.reveal_depth_m + kFrameM);
      }
    }
    for (const double thickness : options_.thicknesses_m) propose(thickness);
    return list;
  }

  [[nodiscard]] std::vector<OpeningCandidate> candidates_of(const std::vector<WallPair>& pairs) const {
    std::vector<OpeningCandidate> all;
    for (const WallPair& pair : pairs) {
      for (const OpeningShift& shift : pair.shifts) {
        for (const OpeningShift& corner : corner_thicknesses(pairs, pair, shift.shift)) {
          const double thickness = corner.shift.x();
          all.push_back(
              {&pair, pose_at(pair, shift.shift, thickness), shift.vote + corner.vote, thickness, {}});
        }
        std::vector<double> list = assumed_thicknesses(pair, shift.shift);
        if (list.empty()) continue;
        const double first = list.front();
        list.erase(list.begin());
        all.push_back({&pair, pose_at(pair, shift.shift, first), shift.vote, first, std::move(list)});
      }
    }
    return shared_out(std::move(all));
  }

  /// Most votes first, every wall of the source having its turn: a wall with one window must not be crowded
  /// out by the twenty of the house across the street, some of which fit everywhere.
  [[nodiscard]] std::vector<OpeningCandidate> shared_out(std::vector<OpeningCandidate> all) const {
    std::stable_sort(all.begin(), all.end(),
                     [](const OpeningCandidate& x, const OpeningCandidate& y) { return x.vote > y.vote; });
    std::vector<std::size_t> turns(matcher_.source().size(), 0);
    std::vector<std::pair<std::size_t, std::size_t>> order;  // turn, place
    for (std::size_t i = 0; i < all.size(); ++i) order.emplace_back(turns[all[i].pair->source]++, i);
    std::sort(order.begin(), order.end());
    if (order.size() > options_.max_poses) {
      order.resize(options_.max_poses);
    }
    std::vector<OpeningCandidate> kept;
    for (const auto& [turn, place] : order) kept.push_back(std::move(all[place]));
    return kept;
  }

  /// A candidate, fitted; with every thickness where nothing holds it.
  [[nodiscard]] std::vector<OpeningPose> fitted(const OpeningCandidate& candidate) const {
    const auto fit = matcher_.fit(candidate.target_from_source, sides_);
    if (!fit) return {};
    std::vector<OpeningPose> poses = {described(candidate, *fit)};
    std::vector<double> shifts_m = {0.0};
    if (!poses.front().thickness_held) {
      for (const double thickness : candidate.others_m) {
        OpeningPose pose = poses.front();
        shifts_m.push_back(candidate.thickness_m - thickness);
        pose.target_from_source.translation += shifts_m.back() * pose.wall_normal;
        pose.thickness_m -= shifts_m.back();
        poses.push_back(std::move(pose));
      }
    }
    const auto distances = matcher_.distances_along(poses.front().target_from_source, sides_,
                                                    poses.front().wall_normal, shifts_m);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].distance = distances[i].distance;
      poses[i].support_m = 0.5 * (distances[i].source_covered_m + distances[i].target_covered_m);
    }
    return poses;
  }

  /// A pose is supported by the walls that proposed it, else by those with most openings in common.
  [[nodiscard]] static bool speaks_before(const WallMeeting& one, const WallMeeting& other,
                                          const WallPair& pair) {
    const auto own = [&](const WallMeeting& m) {
      return m.source_wall == pair.source && m.target_wall == pair.target;
    };
    if (own(one) != own(other)) return own(one);
    return one.pairs.size() > other.pairs.size();
  }

  [[nodiscard]] OpeningPose described(const OpeningCandidate& candidate,
                                      const OpeningMatcher::Fit& fit) const {
    OpeningPose pose;
    pose.target_from_source = fit.target_from_source;
    pose.sides = sides_;
    pose.thickness_held = fit.normal_held || sides_ == WallSides::same;
    const WallMeeting* speaker = &fit.meetings.front();
    for (const WallMeeting& meeting : fit.meetings) {
      const WallWithOpenings& from = matcher_.source()[meeting.source_wall];
      const WallWithOpenings& to = matcher_.target()[meeting.target_wall];
      for (const auto& [i, j] : meeting.pairs) {
        pose.pairs.push_back({from.rectangles[i].opening, to.rectangles[j].opening});
      }
      if (speaks_before(meeting, *speaker, *candidate.pair)) speaker = &meeting;
    }
    pose.source_wall = matcher_.source()[speaker->source_wall].facade;
    pose.target_wall = matcher_.target()[speaker->target_wall].facade;
    pose.wall_normal = matcher_.target()[speaker->target_wall].normal();
    pose.thickness_m = speaker->thickness_m;
    pose.matched_openings = static_cast<int>(pose.pairs.size());
    return pose;
  }

  const Features& source_;
  const Features& target_;
  const OpeningMatcher& matcher_;
  WallSides sides_;
  const OpeningPoseOptions& options_;
};

Vector3d middle_of(const std::vector<WallWithOpenings>& walls) {
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  for (const WallWithOpenings& wall : walls) {
    sum += static_cast<double>(wall.rectangles.size()) * wall.frame.origin;
    count += static_cast<double>(wall.rectangles.size());
  }
  return count > 0.0 ? Vector3d(sum / count) : sum;
}

}  // namespace

std::vector<OpeningPose> enumerate_opening_poses(const Features& source, const Features& target,
                                                 const OpeningPoseOptions& options) {
  std::optional<Vector3d> up;
  if (options.gravity_known) up = Vector3d::UnitZ();
  const std::vector<WallWithOpenings> source_walls = walls_with_openings(source, up);
  const std::vector<WallWithOpenings> target_walls = walls_with_openings(target, up);
  std::vector<OpeningPose> all;
  const OpeningMatcher matcher(source_walls, target_walls, options);
  for (const WallSides sides : {WallSides::opposite, WallSides::same}) {
    const auto some = OpeningEnumerator(source, target, matcher, sides, options).run();
    all.insert(all.end(), some.begin(), some.end());
  }
  return distinct_poses(std::move(all), middle_of(source_walls));
}

}  // namespace limen
