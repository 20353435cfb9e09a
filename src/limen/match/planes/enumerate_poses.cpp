// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include <Eigen/LU>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/geometry/cell_key.h"
#include "limen/match/planes/axis_pairs.h"
#include "limen/match/planes/enumerate_rotations.h"
#include "limen/match/planes/least_precedence.h"

namespace limen {
namespace {

constexpr double kMinDeterminant = 0.2;    // three axes flatter than this do not fix a shift
constexpr std::size_t kSlidingAxes = 3;    // heaviest axes that are paired for sliding poses
constexpr std::size_t kSlidingShifts = 5;  // shifts tried along each
constexpr double kMaxSweepM = 25.0;        // either way
constexpr double kSameShiftM = 0.15;       // poses nearer than this are one
constexpr std::size_t kMostOfRotation = 4000;

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
    LeastPrecedence least(static_cast<std::size_t>(options_.max_poses));
    parallel_for(rotations.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        found[i] = poses_of(rotations[i], least);
        least.add(found[i]);
      }
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
                     [](const ShiftPair& a, const ShiftPair& b) { return a.shift < b.shift; });
    along.index(options_.offset_tolerance_m);
    along.shifts = best_shifts(along.pairs, options_.offset_tolerance_m, options_.max_shifts_per_axis);
    for (const AxisShift& shift : along.shifts) along.weight_m2 += shift.limit_m2;
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
      for (const ShiftPair& pair : axes[k].pairs) {
        const Vector3d gap =
            target_.planes[pair.target].centroid - rotation * source_.planes[pair.source].centroid;
        sum += pair.limit_m2 * gap.dot(open.axis.direction);
        weight += pair.limit_m2;
      }
    }
    if (weight > 0) open.shifts.push_back({sum / weight, 0.0});
    return open;
  }

  [[nodiscard]] std::vector<PoseCandidate> poses_of(const Matrix3d& rotation,
                                                    const LeastPrecedence& of_all) const {
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
    return poses_of_triples(rotation, axes, basis, open, of_all);
  }

  /// The most that a shift along one axis of the basis brings together where the shift along a second is
  /// known as well: it moves the planes of the first across. Reckoned where it is asked for.
  struct TwoShifts {
    Vector2d way = Vector2d::UnitX();  ///< across the first axis, where the second points
    double per_own = 0.0;              ///< the way gone, by metres along the first ...
    double per_other = 0.0;            ///< ... and the second
    std::size_t others = 0;
    std::vector<double> most_m2;  ///< by own shift and other shift; less than 0: not reckoned yet
  };

  static TwoShifts two_shifts(const AxisPairs& own, const AxisPairs& other) {
    TwoShifts two;
    const Vector3d& along = own.axis.direction;
    const double common = other.axis.direction.dot(along);
    const Vector3d across = other.axis.direction - common * along;
    const double length = across.norm();
    two.way = {own.axis.frame.u.dot(across) / length, own.axis.frame.v.dot(across) / length};
    two.per_own = -common / length;
    two.per_other = 1.0 / length;
    two.others = other.shifts.size();
    two.most_m2.assign(own.shifts.size() * other.shifts.size(), -1.0);
    return two;
  }

  /// The three axes whose shifts make a pose, with what each of their shifts brings together.
  struct Basis {
    std::array<std::size_t, 3> axis{};
    std::array<std::vector<ShiftSupport>, 3> supports;
    Matrix3d solve = Matrix3d::Identity();        ///< shift from the three values along the axes
    std::vector<std::size_t> others;              ///< all other axes
    double others_m2 = 0.0;                       ///< the most that they can add
    std::array<std::array<TwoShifts, 3>, 3> two;  ///< of the one axis, where another's shift is known too
  };

  /// The most that the k-th axis of the basis brings together at one triple of shifts.
  [[nodiscard]] static double most_of(const std::vector<AxisPairs>& axes, Basis& basis, std::size_t k,
                                      const std::array<std::size_t, 3>& at) {
    const ShiftSupport& support = basis.supports[k][at[k]];
    double most = support.most();
    if (most == 0.0) return 0.0;
    for (std::size_t m = 0; m < 3; ++m) {
      if (m == k) continue;
      TwoShifts& two = basis.two[k][m];
      double& known = two.most_m2[at[k] * two.others + at[m]];
      if (known < 0.0)
        known = support.most_where(two.way, two.per_own * axes[basis.axis[k]].shifts[at[k]].value +
                                                two.per_other * axes[basis.axis[m]].shifts[at[m]].value);
      most = std::min(most, known);
    }
    return most;
  }

  [[nodiscard]] Basis prepared(const std::vector<AxisPairs>& axes, const std::vector<std::size_t>& of) const {
    Basis basis;
    Matrix3d normals;
    for (std::size_t k = 0; k < 3; ++k) {
      basis.axis[k] = of[k];
      normals.row(static_cast<Eigen::Index>(k)) = axes[of[k]].axis.direction.transpose();
      for (const AxisShift& shift : axes[of[k]].shifts)
        basis.supports[k].push_back(axes[of[k]].support_at(shift.value, options_.offset_tolerance_m));
    }
    basis.solve = normals.inverse();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t m = 0; m < 3; ++m) {
        if (m != k) basis.two[k][m] = two_shifts(axes[of[k]], axes[of[m]]);
      }
    }
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const bool in_basis = std::find(of.begin(), of.end(), k) != of.end();
      if (in_basis || axes[k].pairs.empty()) continue;
      basis.others.push_back(k);
      basis.others_m2 += axes[k].shifts.front().limit_m2;
    }
    return basis;
  }

  /// The surface that comes together at a shift; 0 once it is plain that it is no more than `least`.
  [[nodiscard]] double precedence_of(const Vector3d& translation, const std::vector<AxisPairs>& axes,
                                     Basis& basis, const std::array<std::size_t, 3>& at, double least) const {
    double bound = basis.others_m2;
    std::array<double, 3> most{};
    for (std::size_t k = 0; k < 3; ++k) bound += basis.supports[k][at[k]].most();
    if (bound <= least) return 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      most[k] = most_of(axes, basis, k, at);
      bound += most[k] - basis.supports[k][at[k]].most();
      if (bound <= least) return 0.0;
    }
    bound -= basis.others_m2;
    for (const std::size_t k : basis.others)
      bound += axes[k].most_near(axes[k].axis.direction.dot(translation));
    if (bound <= least) return 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const AxisPairs& along = axes[basis.axis[k]];
      const double here = basis.supports[k][at[k]].at(
          {along.axis.frame.u.dot(translation), along.axis.frame.v.dot(translation)},
          least - (bound - most[k]));
      sum += here;
      bound += here - most[k];
      if (bound <= least) return 0.0;
    }
    for (const std::size_t k : basis.others) {
      const double here = axes[k].support(translation, options_.offset_tolerance_m);
      sum += here;
      bound += here - axes[k].most_near(axes[k].axis.direction.dot(translation));
      if (bound <= least) return 0.0;
    }
    return sum;
  }

  [[nodiscard]] std::vector<PoseCandidate> poses_of_triples(const Matrix3d& rotation,
                                                            const std::vector<AxisPairs>& axes,
                                                            const std::vector<std::size_t>& basis_axes,
                                                            int open, const LeastPrecedence& of_all) const {
    Basis basis = prepared(axes, basis_axes);
    // Shifts come heaviest first, so that a loop ends where even the limits cannot reach the best so far.
    const double others = basis.others_m2;
    const std::vector<AxisShift>& first = axes[basis.axis[0]].shifts;
    const std::vector<AxisShift>& second = axes[basis.axis[1]].shifts;
    const std::vector<AxisShift>& third = axes[basis.axis[2]].shifts;
    const std::size_t most =
        std::min<std::size_t>(kMostOfRotation, 2 * static_cast<std::size_t>(options_.max_poses));
    double least = of_all.value();
    std::vector<PoseCandidate> poses;
    for (std::size_t i = 0; i < first.size(); ++i) {
      const AxisShift& a = first[i];
      if (a.limit_m2 + second.front().limit_m2 + third.front().limit_m2 + others <= least) break;
      for (std::size_t j = 0; j < second.size(); ++j) {
        const AxisShift& b = second[j];
        if (a.limit_m2 + b.limit_m2 + third.front().limit_m2 + others <= least) break;
        for (std::size_t k = 0; k < third.size(); ++k) {
          const AxisShift& c = third[k];
          if (a.limit_m2 + b.limit_m2 + c.limit_m2 + others <= least) break;
          PoseCandidate pose;
          pose.target_from_source = {rotation, basis.solve * Vector3d(a.value, b.value, c.value)};
          pose.precedence = precedence_of(pose.target_from_source.translation, axes, basis, {i, j, k}, least);
          pose.free_translations = open;
          if (pose.precedence > least) poses.push_back(pose);
        }
      }
      if (poses.size() > most + most / 4) {
        keep_best(poses, most);
        least = std::max(poses.back().precedence, of_all.value());
      }
    }
    return distinct(poses);
  }

  /// The best poses of one rotation, no two nearer than kSameShiftM.
  [[nodiscard]] std::vector<PoseCandidate> distinct(std::vector<PoseCandidate>& poses) const {
    keep_best(poses, kMostOfRotation);
    std::vector<PoseCandidate> kept;
    std::unordered_map<std::int64_t, std::vector<Vector3d>> known;  // by cubes as wide as poses are apart
    for (const PoseCandidate& pose : poses) {
      const Vector3d& at = pose.target_from_source.translation;
      const Vector3d cell = cell_of(at, kSameShiftM);
      bool near = false;
      for (int k = 0; k < 27 && !near; ++k) {
        const auto found = known.find(cell_key(cell + way_to_cell(k)));
        if (found == known.end()) continue;
        near = std::any_of(found->second.begin(), found->second.end(),
                           [&](const Vector3d& other) { return (other - at).norm() < kSameShiftM; });
      }
      if (near) continue;
      kept.push_back(pose);
      known[cell_key(cell)].push_back(at);
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
