// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/scan_up.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr double kAlikeDeg = 4.0;  // directions nearer than this are one
constexpr std::size_t kMainDirections = 6;
constexpr double kAlongDeg = 5.0;           // of walls along up, and of floors across it
constexpr double kStrayShare = 0.0005;      // of the points that may lie in the blind cone: feet, reflections
constexpr std::size_t kConePoints = 40000;  // points looked at for the cone
// What each observation adds to a direction; 1 is worth about 4 degrees of blind cone.
constexpr double kPerConeDeg = 0.25;
constexpr double kMostConeDeg = 40.0;
constexpr double kLeastConeDeg = 8.0;  // any direction of a room seen by hand has as much by chance
constexpr double kAlongShare = 8.0;
constexpr double kRingDeg = 6.0;  // about a cone: what bounds it
constexpr double kClosedBelow = 2.0;
constexpr double kClosedAbove = 1.0;
constexpr double kStandsOnFloor = 2.0;
constexpr double kStandsAtEyeHeight = 1.0;
constexpr double kDoubt = 0.4;  // of what a place says that the points do not bear out
constexpr double kGroundUnderPath = 10.0;
constexpr double kFilesZ = 3.0;
constexpr double kUsersZ = 100.0;
constexpr double kLead = 1.5;  // over the next other direction: up is clear
// And no other way need be tried: wrong directions of 157 scans led by 0.03 at most, right ones by 1.1 to 11.
constexpr double kSureLead = 4.0;
constexpr double kZGoodDeg = 5.0;  // a file's z counts whole up to here, and not at all from
constexpr double kZBadDeg = 20.0;
constexpr double kLowestTripodM = 0.3;
constexpr double kHighestTripodM = 3.0;
constexpr double kLowestEyeM = 1.2;  // most are set up so that one can look at the instrument
constexpr double kHighestEyeM = 2.0;
constexpr double kLowPathM = 1.0;
constexpr double kHighPathM = 5.0;
constexpr double kPathSpreadM = 0.6;
constexpr double kSettleDeg = 0.5;    // planes off by more count less and less
constexpr double kRoadWeight = 0.05;  // roads slope, façades do not

struct AreaAxis {
  Vector3d direction;
  double area_m2 = 0.0;
};

bool alike(const Vector3d& a, const Vector3d& b) {
  return std::abs(a.dot(b)) > std::cos(radians(kAlikeDeg));
}

/// Directions of the planes, those of most area, and what is at right angles to two of them.
std::vector<AreaAxis> main_axes(const std::vector<FramePlane>& planes) {
  std::vector<AreaAxis> axes;
  for (const FramePlane& plane : planes) {
    const auto known = std::find_if(axes.begin(), axes.end(), [&](const AreaAxis& axis) {
      return alike(axis.direction, plane.plane.normal);
    });
    if (known != axes.end()) {
      known->area_m2 += plane.area_m2;
    } else {
      axes.push_back({plane.plane.normal, plane.area_m2});
    }
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const AreaAxis& a, const AreaAxis& b) { return a.area_m2 > b.area_m2; });
  if (axes.size() > kMainDirections) axes.resize(kMainDirections);
  const std::size_t seen = std::min<std::size_t>(3, axes.size());
  for (std::size_t i = 0; i < seen; ++i) {
    for (std::size_t j = i + 1; j < seen; ++j) {
      const Vector3d across = axes[i].direction.cross(axes[j].direction);
      if (across.norm() < 0.5) continue;
      const Vector3d unit = across.normalized();
      if (std::none_of(axes.begin(), axes.end(), [&](const AreaAxis& a) { return alike(a.direction, unit); }))
        axes.push_back({unit, 0.0});
    }
  }
  return axes;
}

/// Degrees from either end of an axis to the first points about it.
struct EmptyCones {
  double along_deg = 0.0;
  double against_deg = 0.0;

  [[nodiscard]] EmptyCones reversed() const { return {against_deg, along_deg}; }
};

EmptyCones empty_cones(const Scan& sample, const Vector3d& axis) {
  std::vector<double> cosines;
  cosines.reserve(kConePoints + 1);
  for (std::size_t i = 0; i < sample.size(); i += 1 + sample.size() / kConePoints) {
    const Vector3d ray = sample.points[i] - sample.centre(i);
    const double range = ray.norm();
    if (range > 0.05) cosines.push_back(ray.dot(axis) / range);
  }
  if (cosines.size() < 100) return {};
  const auto strays = static_cast<std::ptrdiff_t>(kStrayShare * static_cast<double>(cosines.size()));
  const auto stray = cosines.begin() + strays;
  const auto cone_deg = [](double cosine) { return degrees(std::acos(std::clamp(cosine, -1.0, 1.0))); };
  std::nth_element(cosines.begin(), stray, cosines.end(), std::greater<>());
  const double along_deg = cone_deg(*stray);
  std::nth_element(cosines.begin(), stray, cosines.end());
  return {along_deg, cone_deg(-*stray)};
}

/// Share of the planes' area that lies along or across `up`.
double along_share(const std::vector<FramePlane>& planes, const Vector3d& up) {
  double along = 0.0;
  double all = 0.0;
  for (const FramePlane& plane : planes) {
    const double cosine = std::abs(plane.plane.normal.dot(up));
    all += plane.area_m2;
    if (cosine > std::cos(radians(kAlongDeg)) || cosine < std::sin(radians(kAlongDeg)))
      along += plane.area_m2;
  }
  return all > 0.0 ? along / all : 0.0;
}

/// Heights of the lowest and highest plane across `up`, of those with a good share of the area.
struct Storey {
  bool seen = false;
  double floor_m = 0.0;
  double ceiling_m = 0.0;
};

Storey storey_along(const std::vector<FramePlane>& planes, const Vector3d& up) {
  double largest = 0.0;
  for (const FramePlane& plane : planes) {
    if (alike(plane.plane.normal, up)) largest = std::max(largest, plane.area_m2);
  }
  Storey storey{largest > 0.0, 1e9, -1e9};
  for (const FramePlane& plane : planes) {
    if (!alike(plane.plane.normal, up) || plane.area_m2 < 0.25 * largest) continue;
    const double height = plane.plane.project(plane.middle).dot(up);
    storey.floor_m = std::min(storey.floor_m, height);
    storey.ceiling_m = std::max(storey.ceiling_m, height);
  }
  return storey;
}

/// Share of the points more than 0.1 m beyond `height` along `direction`.
double share_beyond(const Scan& sample, const Vector3d& direction, double height) {
  std::size_t beyond = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < sample.size(); i += 1 + sample.size() / kConePoints) {
    ++all;
    beyond += sample.points[i].dot(direction) > height + 0.1 ? 1U : 0U;
  }
  return static_cast<double>(beyond) / static_cast<double>(std::max<std::size_t>(1, all));
}

double closed(double share) {
  return 1.0 - std::min(1.0, share / 0.05);
}

/// What the room's shape says for `up`.
double storey_evidence(const Scan& sample, const std::vector<FramePlane>& planes, const Vector3d& up,
                       const ScannerPlace& place) {
  const Storey storey = storey_along(planes, up);
  if (!storey.seen) return 0.0;
  double evidence = kClosedBelow * closed(share_beyond(sample, -up, -storey.floor_m)) +
                    kClosedAbove * closed(share_beyond(sample, up, storey.ceiling_m));
  if (!sample.centre_known() || sample.mobile()) return evidence;
  const double stands = sample.centre(0).dot(up) - storey.floor_m;
  const double trust = place.confirmed ? 1.0 : kDoubt;
  if (stands > kLowestTripodM && stands < kHighestTripodM) evidence += trust * kStandsOnFloor;
  if (stands > kLowestEyeM && stands < kHighestEyeM) evidence += trust * kStandsAtEyeHeight;
  return evidence;
}

/// Whether a plane across `up` lies a constant 1 to 5 m under the path, and under it, not beside.
bool ground_under_path(const Scan& sample, const std::vector<FramePlane>& planes, const Vector3d& up) {
  const std::size_t step = 1 + sample.size() / 2000;
  return std::any_of(planes.begin(), planes.end(), [&](const FramePlane& plane) {
    if (!alike(plane.plane.normal, up)) return false;
    const double sign = plane.plane.normal.dot(up) < 0 ? -1.0 : 1.0;
    std::vector<double> heights;
    std::vector<double> nearest;
    Vector3d middle = Vector3d::Zero();
    for (std::size_t i = 0; i < sample.size(); i += step) {
      heights.push_back(sign * plane.plane.signed_distance(sample.centre(i)));
      middle += sample.centre(i);
    }
    middle /= static_cast<double>(heights.size());
    std::sort(heights.begin(), heights.end());
    const double low = heights[heights.size() / 20];
    const double high = heights[heights.size() - 1 - heights.size() / 20];
    if (low < kLowPathM || high > kHighPathM || high - low > kPathSpreadM) return false;
    const Vector3d foot = plane.plane.project(middle);
    double near = 1e9;
    for (const Vector3d& x : sample.points) {
      if (std::abs(plane.plane.signed_distance(x)) < 0.05) near = std::min(near, (x - foot).norm());
    }
    return near < kHighPathM;
  });
}

/// Share of what bounds the empty cone below that lies on the floor, of which a blind cone leaves a disc out.
double share_cut_from_floor(const Scan& sample, const Vector3d& up, double cone_deg, double floor_m) {
  const double inner = std::cos(radians(cone_deg));
  const double outer = std::cos(radians(cone_deg + kRingDeg));
  std::size_t ring = 0;
  std::size_t on_floor = 0;
  for (std::size_t i = 0; i < sample.size(); i += 1 + sample.size() / kConePoints) {
    const Vector3d ray = sample.points[i] - sample.centre(i);
    const double cosine = -ray.normalized().dot(up);
    if (cosine > inner || cosine < outer) continue;
    ++ring;
    on_floor += std::abs(sample.points[i].dot(up) - floor_m) < 0.1 ? 1U : 0U;
  }
  return ring == 0 ? 0.0 : static_cast<double>(on_floor) / static_cast<double>(ring);
}

/// What the directions say in which nothing was seen. Every scanner is blind below it; some see no zenith
/// either, and of two blind cones the wider may be either. Where the points do not bear out that rays started
/// at the place, an empty cone may be a sky, and counts as far as it is cut out of a floor; where somebody
/// stated the place no less than what else is said of it.
double cone_evidence(const Scan& sample, const std::vector<FramePlane>& planes, const Vector3d& up,
                     const EmptyCones& cones, const ScannerPlace& place) {
  const double below = cones.against_deg;
  const double above = cones.along_deg;
  const auto counted = [](double cone) { return std::min(cone, kMostConeDeg) - kLeastConeDeg; };
  if (below <= kLeastConeDeg) return 0.0;
  const double blind_below = std::min(1.0, below / kLeastConeDeg - 1.0);
  const double deg = counted(below) + blind_below * std::max(0.0, counted(above) - counted(below));
  if (place.confirmed) return kPerConeDeg * deg;
  const double from_floor = share_cut_from_floor(sample, up, below, storey_along(planes, up).floor_m);
  const double trust = std::max(place.source == PlaceSource::assumed ? 0.0 : kDoubt, from_floor);
  return trust * kPerConeDeg * deg;
}

double evidence_for(const Scan& sample, const std::vector<FramePlane>& planes, const Vector3d& up,
                    const EmptyCones& cones, Gravity gravity, const ScannerPlace& place) {
  double evidence = kAlongShare * along_share(planes, up) + storey_evidence(sample, planes, up, place);
  if (sample.mobile()) {
    if (ground_under_path(sample, planes, up)) evidence += kGroundUnderPath;
  } else if (sample.centre_known()) {
    evidence += cone_evidence(sample, planes, up, cones, place);
  }
  if (gravity == Gravity::unknown) return evidence;
  const double off = degrees(std::acos(std::clamp(up.z(), -1.0, 1.0)));
  const double z = std::clamp((kZBadDeg - off) / (kZBadDeg - kZGoodDeg), 0.0, 1.0);
  return evidence + (gravity == Gravity::up ? kUsersZ : kFilesZ) * z;
}

}  // namespace

ScanUp find_up(const Scan& sample, const std::vector<FramePlane>& planes, Gravity gravity,
               const ScannerPlace& place) {
  std::vector<AreaAxis> axes = main_axes(planes);
  const bool z_stated = gravity != Gravity::unknown;
  const auto near_z = [](const AreaAxis& axis) {
    return std::abs(axis.direction.z()) > std::cos(radians(kZGoodDeg));
  };
  if (z_stated && std::none_of(axes.begin(), axes.end(), near_z)) axes.push_back({Vector3d::UnitZ(), 0.0});
  struct Rated {
    Vector3d up;
    double evidence;
  };
  std::vector<Rated> rated;
  const bool sees_cones = sample.centre_known() && !sample.mobile();
  for (const AreaAxis& axis : axes) {
    const EmptyCones cones = sees_cones ? empty_cones(sample, axis.direction) : EmptyCones{};
    rated.push_back({axis.direction, evidence_for(sample, planes, axis.direction, cones, gravity, place)});
    rated.push_back(
        {-axis.direction, evidence_for(sample, planes, -axis.direction, cones.reversed(), gravity, place)});
  }
  std::stable_sort(rated.begin(), rated.end(),
                   [](const Rated& a, const Rated& b) { return a.evidence > b.evidence; });
  ScanUp found;
  if (rated.empty()) {
    found.clear = found.sure = gravity == Gravity::up;
    return found;
  }
  found.up = rated.front().up;
  const auto next = std::find_if(rated.begin(), rated.end(), [&](const Rated& other) {
    return other.up.dot(found.up) < std::cos(radians(3.0 * kAlikeDeg));
  });
  const bool compared = !planes.empty() && next != rated.end();
  const double lead = compared ? rated.front().evidence - next->evidence : 0.0;
  found.clear = gravity == Gravity::up || lead > kLead;
  found.sure = gravity == Gravity::up || lead > kSureLead;
  return found;
}

Vector3d settled_up(const Vector3d& up, const std::vector<FramePlane>& planes, bool mobile) {
  double largest = 0.0;
  for (const FramePlane& plane : planes) largest = std::max(largest, plane.area_m2);
  Vector3d settled = up;
  for (int round = 0; round < 20; ++round) {
    // The files' or planes' own direction holds what nothing else does.
    Matrix3d sums = -1e-3 * up * up.transpose();
    for (const FramePlane& plane : planes) {
      const Vector3d& n = plane.plane.normal;
      const double cosine = std::abs(n.dot(settled));
      const bool across = cosine > std::cos(radians(kAlongDeg));
      if (!across && cosine > std::sin(radians(kAlongDeg))) continue;
      const double off = degrees(across ? std::acos(std::min(1.0, cosine)) : std::asin(cosine)) / kSettleDeg;
      // Small planes come and go with where the cubes lie: they count nothing, and no plane begins to at
      // once.
      const double weight =
          std::max(0.0, plane.area_m2 / largest - 0.1) / ((1.0 + off * off) * (1.0 + off * off));
      sums += (across ? (mobile ? -kRoadWeight : -1.0) : 1.0) * weight * n * n.transpose();
    }
    const Spectrum3 spectrum = spectrum_of(sums);
    Vector3d next = spectrum.vectors.col(0);
    if (next.dot(up) < 0) next = -next;
    const double moved = (next - settled).norm();
    settled = next;
    if (moved < 1e-12) break;
  }
  return settled.dot(up) > std::cos(radians(2.0 * kAlongDeg)) ? settled : up;
}

}  // namespace limen
