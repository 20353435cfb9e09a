// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>

#include <limen/limen.h>

namespace {

using limen::Vector3d;

/// Calls `put` for points of an L-shaped room of 3 m height, `step_m` apart, all seen from 0, 0, 0.
void sample_room(double step_m, const std::function<void(const Vector3d&)>& put) {
  const double corners[7][2] = {{-1.5, -2}, {5, -2}, {5, 1}, {1.2, 1}, {1.2, 4}, {-1.5, 4}, {-1.5, -2}};
  for (int k = 0; k < 6; ++k) {
    const Vector3d from(corners[k][0], corners[k][1], -1.4);
    const Vector3d to(corners[k + 1][0], corners[k + 1][1], -1.4);
    const int steps = static_cast<int>((to - from).norm() / step_m);
    for (int i = 0; i < steps; ++i) {
      for (double z = 0.5 * step_m; z < 3.0; z += step_m) {
        put(from + (to - from) * ((i + 0.5) / steps) + Vector3d(0, 0, z));
      }
    }
  }
  for (double x = -1.5 + 0.5 * step_m; x < 5.0; x += step_m) {
    for (double y = -2.0 + 0.5 * step_m; y < (x < 1.2 ? 4.0 : 1.0); y += step_m) {
      put({x, y, -1.4});
      put({x, y, 1.6});
    }
  }
}

/// The room as a file that limen reads: in its own frame, or in one that was moved.
limen::Scan scan_of_room(const char* name, double step_m, const limen::Rigid3& moved_from_room) {
  const auto path = std::filesystem::temp_directory_path() / name;
  {
    std::ofstream file(path);
    file.precision(12);
    sample_room(step_m, [&](const Vector3d& x_in_room) {
      const Vector3d x = moved_from_room * x_in_room;
      file << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    });
  }
  limen::Scan scan = limen::read_scan(path);
  std::filesystem::remove(path);
  scan.centres = {moved_from_room.translation - scan.local_origin};
  return scan;
}

}  // namespace

/// Registers two scans of one room, written and read as files, and reports the pose: touches every
/// library that limen leans on.
int main() {
  limen::Rigid3 truth;
  truth.rotation = Eigen::AngleAxisd(2.0, Vector3d::UnitZ()).toRotationMatrix();
  truth.translation = Vector3d(12.0, -7.5, 0.8);
  const limen::Scan source = scan_of_room("limen-consumer-source.xyz", 0.06, {});
  const limen::Scan target = scan_of_room("limen-consumer-target.xyz", 0.07, truth);

  const limen::Features features = limen::extract_features(source).features;
  std::printf("%zu points, %zu planes\n", source.size(), features.planes.size());
  if (features.planes.size() != 8) return 1;

  limen::RegistrationReport report;
  report.source = limen::summarise("source", source);
  report.target = limen::summarise("target", target);
  report.result = limen::register_scans(source, target);
  const limen::Rigid3& found = report.result.best.target_from_source;
  std::printf("limen %s: %s\n%s", limen::kVersion, to_string(report.result.outcome),
              limen::transform_text(found).c_str());
  // An empty room could be its twin next door: the verdict may leave that open, the pose is the same.
  if (report.result.outcome == limen::Outcome::no_match) return 1;
  if ((found.translation - truth.translation).norm() > 0.005) return 1;
  if (!found.rotation.isApprox(truth.rotation, 1e-3)) return 1;
  return limen::result_json(report).find(to_string(report.result.outcome)) == std::string::npos ? 1 : 0;
}
