// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_poses.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/geometry/points_apart.h"
#include "limen/match/planes/axis_pairs.h"
#include "limen/match/planes/enumerate_rotations.h"
#include "limen/match/planes/least_precedence.h"
#include "limen/match/planes/shift_triples.h"

namespace limen {
namespace {

constexpr double kMinDeterminant = 0.2;    // three axes flatter than this do not fix a shift
constexpr std::size_t kSlidingAxes = 3;    // heaviest axes that are paired for sliding poses
constexpr std::size_t kSlidingShifts = 5;  // shifts tried along each
constexpr double kMaxSweepM = 25.0;        // either way
constexpr double kSameShiftM = 0.15;       // poses nearer than this are one
constexpr std::size_t kMostOfRotation = 4000;
constexpr double kSameOffsetM = 0.06;  // planes nearer than this are taken for one
constexpr int kShiftsPerAxis = 48;     // candidates per axis and rotation
constexpr int kMostPlanes = 96;        // largest planes of each scan that are matched

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
      : source_(largest_planes(source, kMostPlanes)),
        target_(largest_planes(target, kMostPlanes)),
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
    keep_best(all, static_cast<std::size_t>(options_.max_poses));
    return all;
  }

 private:
  /// The axes on which planes meet, largest first.
  [[nodiscard]] std::vector<AxisPairs> axes_under(const Matrix3d& rotation) const {
    std::vector<AxisPairs> axes;
    for (const AxisDirection& direction : target_axes_) axes.push_back(pairs_along(direction, rotation));
    std::erase_if(axes, [](const AxisPairs& a) { return a.pairs.empty(); });
    std::stable_sort(axes.begin(), axes.end(),
                     [](const AxisPairs& a, const AxisPairs& b) { return a.weight_m2 > b.weight_m2; });
    return axes;
  }

  [[nodiscard]] std::vector<Matrix3d> all_rotations() const {
    RotationOptions rotation_options;
    rotation_options.gravity_known = options_.gravity_known;
    rotation_options.gravity_tolerance_deg = options_.gravity_tolerance_deg;
    rotation_options.direction_deg = options_.direction_deg;
    return enumerate_rotations(source_axes_, target_axes_, rotation_options);
  }

  [[nodiscard]] std::vector<PoseCandidate> sliding_poses_of(const Matrix3d& rotation, double step_m) const {
    std::vector<AxisPairs> axes = axes_under(rotation);
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
                           a.shifts[k].limit_m2 + b.shifts[l].limit_m2});
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
    along.index(kSameOffsetM);
    along.shifts = best_shifts(along.pairs, kSameOffsetM, kShiftsPerAxis);
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
    std::vector<AxisPairs> axes = axes_under(rotation);
    std::vector<std::size_t> basis = basis_of(axes);
    if (basis.size() < 2) return {};
    if (basis.size() == 2) {
      axes.push_back(free_axis(axes, basis, rotation));
      basis.push_back(axes.size() - 1);
    }
    return poses_of_triples(rotation, axes, basis, of_all);
  }

  /// What the axes outside the basis, of `axes`, can bring together.
  struct OtherAxes {
    std::vector<const AxisPairs*> list;
    double most_m2 = 0.0;
  };

  static OtherAxes others_of(const std::vector<AxisPairs>& axes, const std::vector<std::size_t>& basis) {
    OtherAxes others;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const bool in_basis = std::find(basis.begin(), basis.end(), k) != basis.end();
      if (in_basis || axes[k].pairs.empty()) continue;
      others.list.push_back(&axes[k]);
      others.most_m2 += axes[k].shifts.front().limit_m2;
    }
    return others;
  }

  /// The three axes whose shifts make a pose.
  struct Basis {
    std::array<const AxisPairs*, 3> axis{};
    Matrix3d solve = Matrix3d::Identity();  ///< shift from the three values along the axes
    OtherAxes others;

    [[nodiscard]] Vector3d translation(const ShiftPlaces& at) const {
      return solve * Vector3d(axis[0]->shifts[at[0]].value, axis[1]->shifts[at[1]].value,
                              axis[2]->shifts[at[2]].value);
    }
  };

  static Basis make_basis(const std::vector<AxisPairs>& axes, const std::vector<std::size_t>& of) {
    Basis basis;
    Matrix3d normals;
    for (std::size_t k = 0; k < 3; ++k) {
      basis.axis[k] = &axes[of[k]];
      normals.row(static_cast<Eigen::Index>(k)) = axes[of[k]].axis.direction.transpose();
    }
    basis.solve = normals.inverse();
    basis.others = others_of(axes, of);
    return basis;
  }

  /// The surface that comes together at a triple of shifts; 0 once it is plain that it is no more than
  /// `least`.
  [[nodiscard]] double precedence_of(const Basis& basis, const ShiftTriples& triples,
                                     const ShiftTriples::Triple& triple, double least) const {
    const Vector3d translation = basis.translation(triple.at);
    double bound = triple.most_m2 - basis.others.most_m2;
    for (const AxisPairs* axis : basis.others.list)
      bound += axis->most_near(axis->axis.direction.dot(translation));
    if (bound <= least) return 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const PlaneFrame& frame = basis.axis[k]->axis.frame;
      const double most = triples.most_of(k, triple.at);
      const double here =
          triples.support(k, triple.at[k])
              .at({frame.u.dot(translation), frame.v.dot(translation)}, least - (bound - most));
      sum += here;
      bound += here - most;
      if (bound <= least) return 0.0;
    }
    for (const AxisPairs* axis : basis.others.list) {
      const double here = axis->support(translation, kSameOffsetM);
      sum += here;
      bound += here - axis->most_near(axis->axis.direction.dot(translation));
      if (bound <= least) return 0.0;
    }
    return sum;
  }

  /// A triple of shifts, and what comes together there.
  struct RatedShifts {
    double precedence = 0.0;
    ShiftPlaces at{};

    /// A strict order: which of them are the best does not depend on the order in which they are found.
    bool operator<(const RatedShifts& other) const {
      return precedence != other.precedence ? precedence > other.precedence : at < other.at;
    }
  };

  /// The best `most` triples, best first. Those that can bring most together are asked first, so that soon
  /// most of the others cannot be among the best.
  [[nodiscard]] std::vector<RatedShifts> best_triples(const Basis& basis, const ShiftTriples& triples,
                                                      std::size_t most, const LeastPrecedence& of_all) const {
    double least = of_all.value();
    std::vector<RatedShifts> best;
    for (const ShiftTriples::Triple& triple : triples.best_first()) {
      if (triple.most_m2 <= least) continue;
      const double precedence = precedence_of(basis, triples, triple, least);
      if (precedence <= least) continue;
      best.push_back({precedence, triple.at});
      if (best.size() <= most + most / 4) continue;
      const auto last = best.begin() + static_cast<std::ptrdiff_t>(most - 1);
      std::nth_element(best.begin(), last, best.end());
      // A little less: those that are equal to it may still be among the best.
      least = std::max(last->precedence * (1.0 - 1e-9), of_all.value());
      best.resize(most);
    }
    std::sort(best.begin(), best.end());
    if (best.size() > most) best.resize(most);
    return best;
  }

  [[nodiscard]] std::vector<PoseCandidate> poses_of_triples(const Matrix3d& rotation,
                                                            const std::vector<AxisPairs>& axes,
                                                            const std::vector<std::size_t>& basis_axes,
                                                            const LeastPrecedence& of_all) const {
    const Basis basis = make_basis(axes, basis_axes);
    const ShiftTriples triples(axes, {basis_axes[0], basis_axes[1], basis_axes[2]}, basis.others.most_m2,
                               kSameOffsetM, of_all.value());
    const std::size_t most =
        std::min<std::size_t>(kMostOfRotation, 2 * static_cast<std::size_t>(options_.max_poses));
    std::vector<PoseCandidate> poses;
    for (const RatedShifts& rated : best_triples(basis, triples, most, of_all))
      poses.push_back({{rotation, basis.translation(rated.at)}, rated.precedence});
    return distinct(poses);
  }

  /// Of poses of one rotation, best first, those of which no two are nearer than kSameShiftM.
  [[nodiscard]] std::vector<PoseCandidate> distinct(const std::vector<PoseCandidate>& poses) const {
    std::vector<PoseCandidate> kept;
    PointsApart shifts(kSameShiftM);
    for (const PoseCandidate& pose : poses) {
      if (!shifts.add(pose.target_from_source.translation)) continue;
      kept.push_back(pose);
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
