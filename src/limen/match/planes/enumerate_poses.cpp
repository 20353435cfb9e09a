// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_poses.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/match/planes/enumerate_rotations.h"

namespace limen {
namespace {

constexpr std::size_t kMaxParts = 6;       // of one plane, largest first
constexpr double kMinDeterminant = 0.2;    // three axes flatter than this do not fix a shift
constexpr std::size_t kSlidingAxes = 3;    // heaviest axes that are paired for sliding poses
constexpr std::size_t kSlidingShifts = 5;  // shifts tried along each
constexpr double kMaxSweepM = 25.0;        // either way
constexpr double kSameShiftM = 0.15;       // poses nearer than this are one

/// Axis-aligned rectangle in the coordinates of an axis.
struct Box {
  Vector2d low = Vector2d::Constant(1e300);
  Vector2d high = Vector2d::Constant(-1e300);
  double fill = 1.0;  // share of the rectangle that the polygon covers

  [[nodiscard]] double overlap_area(const Box& other, const Vector2d& shift) const {
    const double w =
        std::min(high.x() + shift.x(), other.high.x()) - std::max(low.x() + shift.x(), other.low.x());
    const double h =
        std::min(high.y() + shift.y(), other.high.y()) - std::max(low.y() + shift.y(), other.low.y());
    return w > 0 && h > 0 ? w * h * fill * other.fill : 0.0;
  }
};

/// One direction of the target with in-plane coordinates, and the planes that have it.
struct Axis {
  PlaneFrame frame;  // origin 0; u, v span the planes
  Vector3d direction = Vector3d::UnitZ();
};

std::vector<Box> boxes_of(const PlanarPolygon& plane, const Matrix3d& rotation, const Axis& axis) {
  std::vector<Box> boxes;
  for (const Polygon& part : plane.parts) {
    if (boxes.size() == kMaxParts) break;
    Box box;
    for (const Vector2d& p : part.outer) {
      const Vector2d q = axis.frame.to_plane(rotation * plane.frame.to_space(p));
      box.low = box.low.cwiseMin(q);
      box.high = box.high.cwiseMax(q);
    }
    const Vector2d size = box.high - box.low;
    box.fill = std::min(1.0, area(part) / std::max(1e-9, size.x() * size.y()));
    boxes.push_back(box);
  }
  return boxes;
}

/// A plane of the source that may be a plane of the target, and the shift along the axis that makes it so.
struct Pair {
  double shift = 0.0;
  std::size_t source = 0;
  std::size_t target = 0;
  double limit_m2 = 0.0;  // no more than the smaller of the two can overlap
};

/// Candidate shift along one axis: pairs within the tolerance of it.
struct Shift {
  double value = 0.0;
  double limit_m2 = 0.0;
};

/// All pairs along one axis under one rotation, by shift.
struct AxisPairs {
  Axis axis;
  std::vector<Pair> pairs;
  std::vector<std::vector<Box>> source_boxes;  // per source plane; empty where it is not of this axis
  std::vector<std::vector<Box>> target_boxes;
  std::vector<Shift> shifts;
  double weight_m2 = 0.0;

  [[nodiscard]] double support(const Vector3d& translation, double tolerance) const {
    const double value = axis.direction.dot(translation);
    const Vector2d in_plane(axis.frame.u.dot(translation), axis.frame.v.dot(translation));
    const auto below = [](const Pair& pair, double s) { return pair.shift < s; };
    double sum = 0.0;
    for (auto it = std::lower_bound(pairs.begin(), pairs.end(), value - tolerance, below);
         it != pairs.end() && it->shift <= value + tolerance; ++it) {
      double overlap = 0.0;
      for (const Box& a : source_boxes[it->source]) {
        for (const Box& b : target_boxes[it->target]) overlap += a.overlap_area(b, in_plane);
      }
      const double off = (it->shift - value) / tolerance;
      sum += std::min(overlap, it->limit_m2) * (1.0 - off * off);
    }
    return sum;
  }
};

/// Shifts that bring most surface together, heaviest first, no two nearer than half the tolerance.
std::vector<Shift> best_shifts(const std::vector<Pair>& pairs, double tolerance, int most) {
  std::vector<Shift> all;
  std::size_t low = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (pairs[low].shift < pairs[i].shift - tolerance) ++low;
    Shift shift;
    double mean = 0.0;
    for (std::size_t k = low; k < pairs.size() && pairs[k].shift <= pairs[i].shift + tolerance; ++k) {
      shift.limit_m2 += pairs[k].limit_m2;
      mean += pairs[k].limit_m2 * pairs[k].shift;
    }
    shift.value = mean / shift.limit_m2;
    all.push_back(shift);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Shift& a, const Shift& b) { return a.limit_m2 > b.limit_m2; });
  std::vector<Shift> kept;
  for (const Shift& shift : all) {
    if (static_cast<int>(kept.size()) == most) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Shift& other) {
      return std::abs(other.value - shift.value) < 0.5 * tolerance;
    });
    if (!known) kept.push_back(shift);
  }
  return kept;
}

/// The planes with the largest areas, nothing else; those seen through openings first, for both scans share
/// them.
Features largest_planes(const Features& features, int most) {
  Features part;
  part.planes = features.planes;
  std::stable_sort(part.planes.begin(), part.planes.end(),
                   [](const PlanarPolygon& a, const PlanarPolygon& b) {
                     return a.interior != b.interior ? a.interior : a.area_m2 > b.area_m2;
                   });
  if (part.planes.size() > static_cast<std::size_t>(most)) part.planes.resize(static_cast<std::size_t>(most));
  return part;
}

class PoseEnumerator {
 public:
  PoseEnumerator(const Features& source, const Features& target, const PoseEnumerationOptions& options)
      : source_(largest_planes(source, options.max_planes)),
        target_(largest_planes(target, options.max_planes)),
        options_(options) {
    source_axes_ = axis_directions(source_, options.direction_deg);
    target_axes_ = axis_directions(target_, options.direction_deg);
  }

  [[nodiscard]] std::vector<PoseCandidate> run() const {
    const std::vector<Matrix3d> rotations = all_rotations();
    std::vector<std::vector<PoseCandidate>> found(rotations.size());
    parallel_for(rotations.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = poses_of(rotations[i]);
    });
    std::vector<PoseCandidate> all;
    for (const std::vector<PoseCandidate>& poses : found) all.insert(all.end(), poses.begin(), poses.end());
    keep_best(all, static_cast<std::size_t>(options_.max_poses));
    return all;
  }

  [[nodiscard]] std::vector<PoseCandidate> run_sliding(double step_m) const {
    const std::vector<Matrix3d> rotations = all_rotations();
    std::vector<std::vector<PoseCandidate>> found(rotations.size());
    parallel_for(rotations.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = sliding_poses_of(rotations[i], step_m);
    });

    std::vector<PoseCandidate> all;
    for (const std::vector<PoseCandidate>& poses : found) all.insert(all.end(), poses.begin(), poses.end());
    return all;
  }

 private:
  [[nodiscard]] std::vector<Matrix3d> all_rotations() const {
    RotationOptions rotation_options;
    rotation_options.gravity_known = options_.gravity_known;
    rotation_options.gravity_tolerance_deg = options_.gravity_tolerance_deg;
    rotation_options.direction_deg = options_.direction_deg;
    return enumerate_rotations(source_axes_, target_axes_, rotation_options);
  }

  [[nodiscard]] std::vector<PoseCandidate> sliding_poses_of(const Matrix3d& rotation, double step_m) const {
    std::vector<AxisPairs> axes;
    for (const AxisDirection& direction : target_axes_) axes.push_back(pairs_along(direction, rotation));
    std::erase_if(axes, [](const AxisPairs& a) { return a.pairs.empty(); });
    std::stable_sort(axes.begin(), axes.end(),
                     [](const AxisPairs& a, const AxisPairs& b) { return a.weight_m2 > b.weight_m2; });
    if (axes.size() > kSlidingAxes) axes.resize(kSlidingAxes);
    std::vector<PoseCandidate> poses;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      for (std::size_t j = i + 1; j < axes.size(); ++j) slide(rotation, axes[i], axes[j], step_m, poses);
    }
    return poses;
  }

  /// Appends the poses of the best shifts along two axes, swept along their cross product.
  void slide(const Matrix3d& rotation, const AxisPairs& a, const AxisPairs& b, double step_m,
             std::vector<PoseCandidate>& poses) const {
    const Vector3d free = a.axis.direction.cross(b.axis.direction);
    if (free.norm() < 0.5) return;
    Matrix3d normals;
    normals << a.axis.direction.transpose(), b.axis.direction.transpose(), free.normalized().transpose();
    const Matrix3d solve = normals.inverse();
    const auto range = sweep_range(rotation, free.normalized());
    for (std::size_t k = 0; k < std::min(kSlidingShifts, a.shifts.size()); ++k) {
      for (std::size_t l = 0; l < std::min(kSlidingShifts, b.shifts.size()); ++l) {
        for (double c = range.first; c <= range.second; c += step_m) {
          poses.push_back({{rotation, solve * Vector3d(a.shifts[k].value, b.shifts[l].value, c)},
                           a.shifts[k].limit_m2 + b.shifts[l].limit_m2,
                           1});
        }
      }
    }
  }

  /// Shifts along `direction` that bring any plane of the source beside any of the target.
  [[nodiscard]] std::pair<double, double> sweep_range(const Matrix3d& rotation,
                                                      const Vector3d& direction) const {
    std::pair<double, double> from(1e300, -1e300);
    std::pair<double, double> to(1e300, -1e300);
    for (const PlanarPolygon& plane : source_.planes) {
      const double x = direction.dot(rotation * plane.centroid);
      from = {std::min(from.first, x), std::max(from.second, x)};
    }
    for (const PlanarPolygon& plane : target_.planes) {
      const double x = direction.dot(plane.centroid);
      to = {std::min(to.first, x), std::max(to.second, x)};
    }
    const double middle = 0.5 * (to.first + to.second - from.first - from.second);
    const double reach = std::min(kMaxSweepM, 0.5 * (to.second - to.first + from.second - from.first));
    return {middle - reach, middle + reach};
  }

  static void keep_best(std::vector<PoseCandidate>& poses, std::size_t most) {
    std::stable_sort(poses.begin(), poses.end(), [](const PoseCandidate& a, const PoseCandidate& b) {
      return a.precedence > b.precedence;
    });
    if (poses.size() > most) poses.resize(most);
  }

  [[nodiscard]] AxisPairs pairs_along(const AxisDirection& direction, const Matrix3d& rotation) const {
    AxisPairs along;
    along.axis.direction = direction.direction;
    along.axis.frame = make_frame({direction.direction, 0.0}, Vector3d::Zero());
    along.source_boxes.resize(source_.planes.size());
    along.target_boxes.resize(target_.planes.size());
    const double near = std::cos(radians(options_.direction_deg));
    for (std::size_t j = 0; j < target_.planes.size(); ++j) {
      const PlanarPolygon& b = target_.planes[j];
      const double cosine_b = b.plane.normal.dot(direction.direction);
      if (std::abs(cosine_b) < near) continue;
      along.target_boxes[j] = boxes_of(b, Matrix3d::Identity(), along.axis);
      for (std::size_t i = 0; i < source_.planes.size(); ++i) {
        const PlanarPolygon& a = source_.planes[i];
        const double cosine = (rotation * a.plane.normal).dot(b.plane.normal);
        if ((a.oriented && b.oriented ? cosine : std::abs(cosine)) < near) continue;
        if (along.source_boxes[i].empty()) along.source_boxes[i] = boxes_of(a, rotation, along.axis);
        const double sign = cosine_b < 0 ? -1.0 : 1.0;
        const double shift = sign * (b.plane.offset - b.plane.normal.dot(rotation * a.centroid));
        const double limit = std::min(a.area_m2, b.area_m2);
        if (limit > 0) along.pairs.push_back({shift, i, j, limit});
      }
    }
    std::stable_sort(along.pairs.begin(), along.pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.shift < b.shift; });
    along.shifts = best_shifts(along.pairs, options_.offset_tolerance_m, options_.max_shifts_per_axis);
    for (const Shift& shift : along.shifts) along.weight_m2 += shift.limit_m2;
    return along;
  }

  /// The three axes that carry most and are independent; fewer where the scene has fewer.
  [[nodiscard]] static std::vector<std::size_t> basis_of(const std::vector<AxisPairs>& axes) {
    std::vector<std::size_t> basis;
    for (std::size_t k = 0; k < axes.size() && basis.size() < 3; ++k) {
      if (axes[k].pairs.empty()) continue;
      const Vector3d& d = axes[k].axis.direction;
      if (basis.size() == 1 && std::abs(d.dot(axes[basis[0]].axis.direction)) > 0.9) continue;
      if (basis.size() == 2) {
        const Vector3d normal = axes[basis[0]].axis.direction.cross(axes[basis[1]].axis.direction);
        if (std::abs(normal.dot(d)) < kMinDeterminant) continue;
      }
      basis.push_back(k);
    }
    return basis;
  }

  /// Where no plane fixes a direction, the middles of the planes that can meet are laid on one another.
  [[nodiscard]] AxisPairs free_axis(const std::vector<AxisPairs>& axes, const std::vector<std::size_t>& basis,
                                    const Matrix3d& rotation) const {
    AxisPairs open;
    const Vector3d first = basis.empty() ? Vector3d::UnitZ() : axes[basis[0]].axis.direction;
    const Vector3d second = basis.size() > 1 ? axes[basis[1]].axis.direction : first.unitOrthogonal();
    open.axis.direction = first.cross(second).normalized();
    if (basis.empty()) open.axis.direction = Vector3d::UnitX();
    double weight = 0.0;
    double sum = 0.0;
    for (const std::size_t k : basis) {
      for (const Pair& pair : axes[k].pairs) {
        const Vector3d gap =
            target_.planes[pair.target].centroid - rotation * source_.planes[pair.source].centroid;
        sum += pair.limit_m2 * gap.dot(open.axis.direction);
        weight += pair.limit_m2;
      }
    }
    if (weight > 0) open.shifts.push_back({sum / weight, 0.0});
    return open;
  }

  [[nodiscard]] std::vector<PoseCandidate> poses_of(const Matrix3d& rotation) const {
    std::vector<AxisPairs> axes;
    for (const AxisDirection& direction : target_axes_) axes.push_back(pairs_along(direction, rotation));
    std::erase_if(axes, [](const AxisPairs& a) { return a.pairs.empty(); });
    std::stable_sort(axes.begin(), axes.end(),
                     [](const AxisPairs& a, const AxisPairs& b) { return a.weight_m2 > b.weight_m2; });
    std::vector<std::size_t> basis = basis_of(axes);
    const int open = 3 - static_cast<int>(basis.size());
    if (open > 1) return {};
    if (open == 1) {
      axes.push_back(free_axis(axes, basis, rotation));
      basis.push_back(axes.size() - 1);
    }
    return poses_of_triples(rotation, axes, basis, open);
  }

  [[nodiscard]] std::vector<PoseCandidate> poses_of_triples(const Matrix3d& rotation,
                                                            const std::vector<AxisPairs>& axes,
                                                            const std::vector<std::size_t>& basis,
                                                            int open) const {
    Matrix3d normals;
    for (Eigen::Index k = 0; k < 3; ++k) {
      normals.row(k) = axes[basis[static_cast<std::size_t>(k)]].axis.direction.transpose();
    }
    const Matrix3d solve = normals.inverse();
    // Shifts come heaviest first, so that a loop ends where even the limits cannot reach the best so far.
    double others = 0.0;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const bool in_basis = std::find(basis.begin(), basis.end(), k) != basis.end();
      if (!in_basis && !axes[k].shifts.empty()) others += axes[k].shifts.front().limit_m2;
    }
    const std::vector<Shift>& first = axes[basis[0]].shifts;
    const std::vector<Shift>& second = axes[basis[1]].shifts;
    const std::vector<Shift>& third = axes[basis[2]].shifts;
    const std::size_t most = 2 * static_cast<std::size_t>(options_.max_poses);
    double least = 0.0;
    std::vector<PoseCandidate> poses;
    for (const Shift& a : first) {
      if (a.limit_m2 + second.front().limit_m2 + third.front().limit_m2 + others <= least) break;
      for (const Shift& b : second) {
        if (a.limit_m2 + b.limit_m2 + third.front().limit_m2 + others <= least) break;
        for (const Shift& c : third) {
          if (a.limit_m2 + b.limit_m2 + c.limit_m2 + others <= least) break;
          PoseCandidate pose;
          pose.target_from_source = {rotation, solve * Vector3d(a.value, b.value, c.value)};
          for (const AxisPairs& along : axes) {
            if (along.pairs.empty()) continue;
            pose.precedence +=
                along.support(pose.target_from_source.translation, options_.offset_tolerance_m);
          }
          pose.free_translations = open;
          if (pose.precedence > least) poses.push_back(pose);
        }
      }
      if (poses.size() > 2 * most) {
        keep_best(poses, most);
        least = poses.back().precedence;
      }
    }
    return distinct(poses);
  }

  /// The best poses of one rotation, no two nearer than kSameShiftM.
  [[nodiscard]] std::vector<PoseCandidate> distinct(std::vector<PoseCandidate>& poses) const {
    keep_best(poses, 4000);
    std::vector<PoseCandidate> kept;
    for (const PoseCandidate& pose : poses) {
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const PoseCandidate& other) {
        return (other.target_from_source.translation - pose.target_from_source.translation).norm() <
               kSameShiftM;
      });
      if (!known) kept.push_back(pose);
      if (kept.size() >= static_cast<std::size_t>(options_.max_poses)) break;
    }
    return kept;
  }

  Features source_;
  Features target_;
  const PoseEnumerationOptions& options_;
  std::vector<AxisDirection> source_axes_;
  std::vector<AxisDirection> target_axes_;
};

}  // namespace

void PoseEnumerationOptions::check() const {
  if (!(gravity_tolerance_deg > 0))
    throw_bad_option("gravity_tolerance_deg", gravity_tolerance_deg, "more than 0");
  if (!(direction_deg > 0 && direction_deg < 45))
    throw_bad_option("direction_deg", direction_deg, "within (0, 45)");
  if (!(offset_tolerance_m > 0)) throw_bad_option("offset_tolerance_m", offset_tolerance_m, "more than 0");
  if (max_shifts_per_axis < 1) throw_bad_option("max_shifts_per_axis", max_shifts_per_axis, "1 or more");
  if (max_planes < 1) throw_bad_option("max_planes", max_planes, "1 or more");
  if (max_poses < 1) throw_bad_option("max_poses", max_poses, "1 or more");
}

std::vector<PoseCandidate> enumerate_poses(const Features& source, const Features& target,
                                           const PoseEnumerationOptions& options) {
  options.check();
  return PoseEnumerator(source, target, options).run();
}

std::vector<PoseCandidate> enumerate_sliding_poses(const Features& source, const Features& target,
                                                   double step_m, const PoseEnumerationOptions& options) {
  options.check();
  if (!(step_m > 0)) throw_bad_option("step_m", step_m, "more than 0");
  return PoseEnumerator(source, target, options).run_sliding(step_m);
}

}  // namespace limen
