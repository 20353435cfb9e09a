// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include <limen/limen.h>

namespace {

using limen::Vector3d;

/// An upright box, turned about z.
struct Box {
  Vector3d middle;
  Vector3d half;
  double heading = 0.0;
};

constexpr std::array<std::array<double, 2>, 7> kCorners = {
    {{-1.5, -2}, {5, -2}, {5, 1}, {1.2, 1}, {1.2, 4}, {-1.5, 4}, {-1.5, -2}}};
constexpr double kFloor = -1.4;
constexpr double kCeiling = 1.6;

/// What is about in the L-shaped room: no two things alike, none parallel to a wall.
std::vector<Box> furniture() {
  return {{{3.9, -1.2, -1.03}, {0.70, 0.40, 0.37}, 0.31},  {{2.3, 0.3, -1.17}, {0.24, 0.26, 0.23}, 0.83},
          {{-0.9, 3.0, -0.72}, {0.42, 0.21, 0.68}, -0.22}, {{0.5, 2.7, -1.12}, {0.31, 0.52, 0.28}, 1.13},
          {{-1.0, -1.4, -0.9}, {0.28, 0.33, 0.50}, 0.54},  {{1.4, -1.5, -1.2}, {0.37, 0.22, 0.20}, -0.61},
          {{4.5, 0.4, -0.8}, {0.22, 0.34, 0.60}, 0.12},    {{-0.8, 0.9, -1.15}, {0.26, 0.20, 0.25}, 1.37}};
}

/// Where a ray from `at` first meets the box, in lengths of `way`; infinity: nowhere.
double reach(const Box& box, const Vector3d& at, const Vector3d& way) {
  const Eigen::AngleAxisd turn(-box.heading, Vector3d::UnitZ());
  const Vector3d start = turn * (at - box.middle);
  const Vector3d along = turn * way;
  double enters = 0.0;
  double leaves = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-box.half[axis] - start[axis]) / along[axis];
    const double b = (box.half[axis] - start[axis]) / along[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters < leaves ? enters : std::numeric_limits<double>::infinity();
}

/// The same of the room's walls, floor and ceiling.
double reach_of_shell(const Vector3d& at, const Vector3d& way) {
  double nearest = (way.z() > 0 ? kCeiling - at.z() : kFloor - at.z()) / way.z();
  for (std::size_t k = 0; k + 1 < kCorners.size(); ++k) {
    const double x = kCorners[k][0];
    const double y = kCorners[k][1];
    const double dx = kCorners[k + 1][0] - x;
    const double dy = kCorners[k + 1][1] - y;
    const double across = way.x() * dy - way.y() * dx;
    const double range = ((x - at.x()) * dy - (y - at.y()) * dx) / across;
    const double share = ((x - at.x()) * way.y() - (y - at.y()) * way.x()) / across;
    if (range > 0 && share >= 0 && share <= 1) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// A scan from `station` in the room, as a file that limen reads: in the scanner's frame, which is in the
/// room as it likes.
limen::Scan scan_of_room(const char* name, const Vector3d& station, double heading, double step_deg) {
  const std::vector<Box> things = furniture();
  const Eigen::AngleAxisd scanner_from_room(-heading, Vector3d::UnitZ());
  const auto path = std::filesystem::temp_directory_path() / name;
  {
    std::ofstream file(path);
    file.precision(9);
    const double step = step_deg * M_PI / 180.0;
    for (double up = -1.2 + 0.4 * step; up < 1.4; up += step) {
      for (double round = 0.3 * step; round < 2.0 * M_PI; round += step) {
        const Vector3d way(std::cos(up) * std::cos(round), std::cos(up) * std::sin(round), std::sin(up));
        double range = reach_of_shell(station, way);
        for (const Box& box : things) range = std::min(range, reach(box, station, way));
        const Vector3d x = scanner_from_room * (range * way);
        file << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
      }
    }
  }
  limen::Scan scan = limen::read_scan(path);
  std::filesystem::remove(path);
  scan.centres = {-scan.local_origin};
  return scan;
}

}  // namespace

/// Registers two scans of one furnished room, from two places, written and read as files: touches every
/// library that limen leans on.
int main() {
  const Vector3d first(0.0, 0.0, 0.1);
  const Vector3d second(1.9, -0.7, 0.25);
  constexpr double kHeading = 2.0;
  const limen::Scan source = scan_of_room("limen-consumer-source.xyz", first, 0.0, 0.45);
  const limen::Scan target = scan_of_room("limen-consumer-target.xyz", second, kHeading, 0.5);
  limen::Rigid3 truth;
  truth.rotation = Eigen::AngleAxisd(-kHeading, Vector3d::UnitZ()).toRotationMatrix();
  truth.translation = truth.rotation * (first - second);

  const limen::Features features = limen::extract_features(source).features;
  std::printf("%zu points, %zu planes\n", source.size(), features.planes.size());
  if (features.planes.size() < 8) return 1;

  limen::RegistrationReport report;
  report.source = limen::summarise("source", source);
  report.target = limen::summarise("target", target);
  report.result = limen::register_scans(source, target);
  const limen::Rigid3& found = report.result.best.target_from_source;
  std::printf("limen %s: %s\n%s", limen::kVersion, to_string(report.result.outcome),
              limen::transform_text(found).c_str());
  if (report.result.outcome != limen::Outcome::registered) return 1;
  if ((found.translation - truth.translation).norm() > 0.002) return 1;
  if (!found.rotation.isApprox(truth.rotation, 1e-3)) return 1;
  return limen::result_json(report).find(to_string(report.result.outcome)) == std::string::npos ? 1 : 0;
}
