// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/wall_thickness.h"

#include <algorithm>
#include <cmath>

#include "limen/base/error.h"
#include "limen/match/opening_matcher.h"
#include "limen/match/plane_shifts.h"

namespace limen {
namespace {

constexpr double kAgreeingSigmas = 3.0;   // measures farther apart than this contradict each other
constexpr double kOpeningSigmaM = 0.015;  // of a pose that openings in another wall hold
constexpr double kMinNormalHold = 0.3;    // |cosine| from which a wall in another direction holds the normal

/// One measure of a thickness.
struct Measure {
  double value_m = 0.0;
  double sigma_m = 0.0;
  ThicknessSource source = ThicknessSource::assumed;
};

/// The mean by deviations of what agrees with the first measure, the most trusted one.
Measure combined(const std::vector<Measure>& measures) {
  Measure result = measures.front();
  for (std::size_t i = 1; i < measures.size(); ++i) {
    const Measure& next = measures[i];
    const double both = std::hypot(result.sigma_m, next.sigma_m);
    if (std::abs(next.value_m - result.value_m) > kAgreeingSigmas * both) continue;
    const double a = 1.0 / (result.sigma_m * result.sigma_m);
    const double b = 1.0 / (next.sigma_m * next.sigma_m);
    result.value_m = (a * result.value_m + b * next.value_m) / (a + b);
    result.sigma_m = 1.0 / std::sqrt(a + b);
  }
  return result;
}

class ThicknessEstimator {
 public:
  ThicknessEstimator(const Features& source, const Features& target, const Rigid3& pose,
                     const WallThicknessOptions& options)
      : source_(source),
        target_(target),
        pose_(pose),
        options_(options),
        matcher_(walls_of(source), walls_of(target), options.openings),
        meetings_(matcher_.meetings(pose, WallSides::opposite)),
        finder_(source, target, up_of(matcher_.source()), up_of(matcher_.target())) {}

  [[nodiscard]] std::vector<WallThickness> run() const {
    std::vector<WallThickness> result;
    for (const WallMeeting& meeting : meetings_) result.push_back(estimate(meeting));
    std::stable_sort(result.begin(), result.end(),
                     [](const WallThickness& a, const WallThickness& b) { return a.openings > b.openings; });
    return result;
  }

 private:
  [[nodiscard]] std::vector<OpeningWall> walls_of(const Features& features) const {
    OpeningWallOptions walls;
    if (options_.openings.gravity_known) walls.up = Vector3d::UnitZ();
    return opening_walls(features, walls);
  }

  [[nodiscard]] static Vector3d up_of(const std::vector<OpeningWall>& walls) {
    return walls.empty() ? Vector3d(Vector3d::UnitZ()) : walls.front().frame.v;
  }

  [[nodiscard]] const Opening& source_opening(const WallMeeting& meeting, std::size_t i) const {
    const int k = matcher_.source()[meeting.source_wall].rectangles[i].opening;
    return source_.openings[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] const Opening& target_opening(const WallMeeting& meeting, std::size_t j) const {
    const int k = matcher_.target()[meeting.target_wall].rectangles[j].opening;
    return target_.openings[static_cast<std::size_t>(k)];
  }

  /// The point of an opening's own plane in its middle: faces of one wall may lie in several planes.
  [[nodiscard]] static Vector3d face_point(const Features& features, const Opening& opening) {
    const Vector3d middle =
        0.25 * (opening.corners[0] + opening.corners[1] + opening.corners[2] + opening.corners[3]);
    if (opening.facade < 0 || static_cast<std::size_t>(opening.facade) >= features.planes.size())
      return middle;
    return features.planes[static_cast<std::size_t>(opening.facade)].plane.project(middle);
  }

  /// The distance between the faces at this pose, mean over the openings.
  [[nodiscard]] double face_distance(const WallMeeting& meeting) const {
    const Vector3d normal = matcher_.target()[meeting.target_wall].normal();
    double sum = 0.0;
    for (const auto& [i, j] : meeting.pairs) {
      sum += normal.dot(face_point(target_, target_opening(meeting, j)) -
                        pose_ * face_point(source_, source_opening(meeting, i)));
    }
    return sum / static_cast<double>(meeting.pairs.size());
  }

  /// The faces' distance at the shift that planes seen by both scans ask for.
  [[nodiscard]] std::optional<Measure> by_planes(const Vector3d& normal, double face_distance_m) const {
    const auto shifts = finder_.along(pose_, normal, -options_.plane_tolerance_m, options_.plane_tolerance_m);
    double weight = 0.0;
    double mean = 0.0;
    double squares = 0.0;
    for (const PlaneShift& shift : shifts) {
      weight += shift.overlap_m2;
      mean += shift.overlap_m2 * shift.shift_m;
      squares += shift.overlap_m2 * shift.shift_m * shift.shift_m;
    }
    if (!(weight > 0.0)) return std::nullopt;
    mean /= weight;
    const double spread = squares / weight - mean * mean;  // m^2, 0 for one pair
    const double count = static_cast<double>(shifts.size());
    const double planes = 2.0 * options_.plane_sigma_m * options_.plane_sigma_m;  // the wall's two faces
    const double held = std::max(planes, spread) / count;
    return Measure{face_distance_m - mean,
                   std::sqrt(planes + held + options_.pose_sigma_m * options_.pose_sigma_m),
                   ThicknessSource::planes};
  }

  [[nodiscard]] bool held_by_openings(const Vector3d& normal) const {
    return std::any_of(meetings_.begin(), meetings_.end(), [&](const WallMeeting& other) {
      return std::abs(matcher_.target()[other.target_wall].frame.u.dot(normal)) > kMinNormalHold;
    });
  }

  [[nodiscard]] std::optional<Measure> by_reveals(const WallMeeting& meeting) const {
    double sum = 0.0;
    double weight = 0.0;
    const auto add = [&](const Opening& one) {
      if (!one.reveal_complete || !(one.reveal_depth_m > 0.0)) return;
      const double w = 1.0 / std::pow(std::max(options_.plane_sigma_m, one.reveal_sigma_m), 2);
      sum += w * one.reveal_depth_m;
      weight += w;
    };
    for (const auto& [i, j] : meeting.pairs) {
      add(source_opening(meeting, i));
      add(target_opening(meeting, j));
    }
    if (!(weight > 0.0)) return std::nullopt;
    return Measure{sum / weight, std::hypot(1.0 / std::sqrt(weight), options_.plane_sigma_m),
                   ThicknessSource::reveals};
  }

  [[nodiscard]] WallThickness estimate(const WallMeeting& meeting) const {
    const OpeningWall& to = matcher_.target()[meeting.target_wall];
    const double distance = face_distance(meeting);
    std::vector<Measure> measures;  // most trusted first
    if (const auto planes = by_planes(to.normal(), distance)) {
      measures.push_back(*planes);
    } else if (held_by_openings(to.normal())) {
      measures.push_back(
          {distance, std::hypot(kOpeningSigmaM, options_.plane_sigma_m), ThicknessSource::openings});
    }
    const auto reveals = by_reveals(meeting);
    if (reveals) measures.push_back(*reveals);
    if (options_.wall_thickness_m) {
      measures.push_back({*options_.wall_thickness_m, options_.user_sigma_m, ThicknessSource::user});
    }
    if (measures.empty()) {
      const double range = options_.openings.max_thickness_m - options_.openings.min_thickness_m;
      measures.push_back({distance, range / std::sqrt(12.0), ThicknessSource::assumed});
    }
    const Measure all = combined(measures);
    WallThickness result;
    result.value_m = all.value_m;
    result.sigma_m = all.sigma_m;
    result.source = all.source;
    result.source_wall = matcher_.source()[meeting.source_wall].facade;
    result.target_wall = to.facade;
    result.openings = static_cast<int>(meeting.pairs.size());
    if (reveals) result.from_reveals_m = reveals->value_m;
    return result;
  }

  const Features& source_;
  const Features& target_;
  const Rigid3& pose_;
  const WallThicknessOptions& options_;
  OpeningMatcher matcher_;
  std::vector<WallMeeting> meetings_;
  PlaneShiftFinder finder_;
};

}  // namespace

void WallThicknessOptions::check() const {
  openings.check();
  const auto positive = [](const char* name, double value) {
    if (!(value > 0.0)) throw_bad_option(name, value, "> 0");
  };
  if (wall_thickness_m) positive("wall_thickness_m", *wall_thickness_m);
  positive("user_sigma_m", user_sigma_m);
  positive("pose_sigma_m", pose_sigma_m);
  positive("plane_sigma_m", plane_sigma_m);
  positive("plane_tolerance_m", plane_tolerance_m);
}

std::vector<WallThickness> estimate_thickness(const Features& source, const Features& target,
                                              const Rigid3& target_from_source,
                                              const WallThicknessOptions& options) {
  options.check();
  return ThicknessEstimator(source, target, target_from_source, options).run();
}

}  // namespace limen
