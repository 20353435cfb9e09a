// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <limen/base/version.h>
#include <limen/extract/features/extract_features.h>
#include <limen/geometry/rigid.h>
#include <limen/io/cloud/read_scan.h>
#include <limen/report/json/result_json.h>

/// Reads a file it wrote itself, finds its one plane and reports a pose: touches every library that limen
/// leans on.
int main() {
  const auto path = std::filesystem::temp_directory_path() / "limen-consumer.xyz";
  {
    std::ofstream file(path);
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < 60; ++j) file << 0.05 * i << ' ' << 0.05 * j << " 1.5\n";
    }
  }
  const limen::Scan scan = limen::read_scan(path);
  std::filesystem::remove(path);
  const limen::Features features = limen::extract_features(scan).features;
  if (scan.size() != 3600 || features.planes.size() != 1) return 1;
  std::printf("one plane of %.2f m2\n", features.planes.front().area_m2);

  limen::RegistrationReport report;
  report.result.outcome = limen::Outcome::registered;
  report.result.best.target_from_source.translation = scan.local_origin + scan.points[0];
  if (limen::result_json(report).find("\"registered\"") == std::string::npos) return 1;
  std::printf("limen %s\n%s", limen::kVersion,
              limen::transform_text(report.result.best.target_from_source).c_str());
  return 0;
}
