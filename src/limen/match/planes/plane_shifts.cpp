// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/plane_shifts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kMeetingDeg = 6.0;     // planes that meet differ by no more
constexpr double kMeetingM2 = 0.05;     // that their bounding rectangles have in common
constexpr double kHoldingCosine = 0.5;  // planes more oblique to the direction do not hold a shift along it
/// Of each scan: those seen through openings first, then the largest.
constexpr std::size_t kMostShiftedPlanes = 96;
constexpr std::size_t kMaxPartsShifted = 6;  // of one plane, largest first

/// A frame of the plane whose v is `up` as far as the plane allows.
PlaneFrame upright_frame(const Plane& plane, const Vector3d& near, const Vector3d& up) {
  const Vector3d v = up - up.dot(plane.normal) * plane.normal;
  if (v.norm() < 0.1) return make_frame(plane, near);
  const Vector3d unit = v.normalized();
  return {plane.project(near), unit.cross(plane.normal), unit};
}

}  // namespace

PlaneShiftFinder::PlaneShiftFinder(const Features& source, const Features& target, const Vector3d& source_up,
                                   const Vector3d& target_up)
    : source_(boxed(source, source_up)), target_(boxed(target, target_up)) {}

PlaneShiftFinder::BoxedPlane PlaneShiftFinder::boxed(const PlanarPolygon& polygon, const Vector3d& up) {
  BoxedPlane result;
  result.plane = polygon.plane;
  result.oriented = polygon.oriented;
  result.frame = upright_frame(polygon.plane, polygon.centroid, up);
  for (const Polygon& part : polygon.parts) {
    if (result.boxes.size() == kMaxPartsShifted) break;
    Box box{Vector2d::Constant(1e300), Vector2d::Constant(-1e300), 1.0};
    for (const Vector2d& p : part.outer) {
      const Vector2d q = result.frame.to_plane(polygon.frame.to_space(p));
      box.low = box.low.cwiseMin(q);
      box.high = box.high.cwiseMax(q);
    }
    const Vector2d size = box.high - box.low;
    if (!(size.minCoeff() > 0.0)) continue;
    box.fill = std::min(1.0, area(part) / size.prod());
    result.boxes.push_back(box);
  }
  return result;
}

std::vector<PlaneShiftFinder::BoxedPlane> PlaneShiftFinder::boxed(const Features& features,
                                                                  const Vector3d& up) {
  std::vector<int> order;
  for (std::size_t i = 0; i < features.planes.size(); ++i) order.push_back(static_cast<int>(i));
  const auto plane = [&](int i) -> const PlanarPolygon& {
    return features.planes[static_cast<std::size_t>(i)];
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    if (plane(a).interior != plane(b).interior) return plane(a).interior;
    return plane(a).area_m2 > plane(b).area_m2;
  });
  if (order.size() > kMostShiftedPlanes) order.resize(kMostShiftedPlanes);
  std::vector<BoxedPlane> planes;
  for (const int i : order) {
    planes.push_back(boxed(plane(i), up));
    planes.back().index = i;
  }
  return planes;
}

PlaneShiftFinder::Overlap PlaneShiftFinder::overlap(const Rigid3& target_from_source,
                                                    const BoxedPlane& source, const BoxedPlane& target) {
  Overlap result;
  for (const Box& box : source.boxes) {
    Vector2d low = Vector2d::Constant(1e300);
    Vector2d high = Vector2d::Constant(-1e300);
    for (const double x : {box.low.x(), box.high.x()}) {
      for (const double y : {box.low.y(), box.high.y()}) {
        const Vector2d p = target.frame.to_plane(target_from_source * source.frame.to_space(Vector2d(x, y)));
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    for (const Box& other : target.boxes) {
      const Vector2d from = low.cwiseMax(other.low);
      const Vector2d to = high.cwiseMin(other.high);
      if (!((to - from).minCoeff() > 0.0)) continue;
      const double common = (to - from).prod() * box.fill * other.fill;
      result.area_m2 += common;
      result.middle += common * 0.5 * (from + to);
    }
  }
  if (result.area_m2 > 0.0) result.middle /= result.area_m2;
  return result;
}

std::vector<PlaneShift> PlaneShiftFinder::along(const Rigid3& target_from_source, const Vector3d& direction,
                                                double low_m, double high_m) const {
  const double min_cosine = std::cos(radians(kMeetingDeg));
  std::vector<PlaneShift> found;
  for (const BoxedPlane& p : source_) {
    const Plane moved = transformed(target_from_source, p.plane);
    const double along = moved.normal.dot(direction);
    if (std::abs(along) < kHoldingCosine) continue;
    for (const BoxedPlane& q : target_) {
      const double cosine = moved.normal.dot(q.plane.normal);
      if ((p.oriented && q.oriented ? cosine : std::abs(cosine)) < min_cosine) continue;
      // A first shift by the middle of the target plane, then by the middle of what overlaps there.
      const auto shift_at = [&](const Vector3d& x) { return moved.signed_distance(x) / along; };
      double shift = shift_at(q.frame.origin);
      if (shift < low_m - 1.0 || shift > high_m + 1.0) continue;
      const Rigid3 shifted{target_from_source.rotation, target_from_source.translation + shift * direction};
      const Overlap common = overlap(shifted, p, q);
      if (!(common.area_m2 > 0.0) || common.area_m2 < kMeetingM2) continue;
      shift = shift_at(q.frame.to_space(common.middle));
      if (shift >= low_m && shift <= high_m) found.push_back({shift, common.area_m2, p.index, q.index});
    }
  }
  std::sort(found.begin(), found.end(), [](const PlaneShift& a, const PlaneShift& b) {
    return std::tie(a.shift_m, a.source, a.target) < std::tie(b.shift_m, b.source, b.target);
  });
  return found;
}

std::vector<CommonShift> common_shifts(const std::vector<PlaneShift>& shifts, double tolerance_m, int most) {
  std::vector<CommonShift> all;
  std::size_t low = 0;
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    while (shifts[low].shift_m < shifts[i].shift_m - tolerance_m) ++low;
    CommonShift common;
    for (std::size_t k = low; k < shifts.size() && shifts[k].shift_m <= shifts[i].shift_m + tolerance_m;
         ++k) {
      const double off = (shifts[k].shift_m - shifts[i].shift_m) / tolerance_m;
      const double weight = shifts[k].overlap_m2 * std::max(0.01, 1.0 - off * off);
      common.overlap_m2 += weight;
      common.shift_m += weight * shifts[k].shift_m;
    }
    common.shift_m /= common.overlap_m2;
    all.push_back(common);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const CommonShift& a, const CommonShift& b) { return a.overlap_m2 > b.overlap_m2; });
  std::vector<CommonShift> kept;
  for (const CommonShift& shift : all) {
    if (static_cast<int>(kept.size()) == most) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const CommonShift& other) {
      return std::abs(other.shift_m - shift.shift_m) < tolerance_m;
    });
    if (!known) kept.push_back(shift);
  }
  return kept;
}

}  // namespace limen
