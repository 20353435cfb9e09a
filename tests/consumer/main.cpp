// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <limen/base/version.h>
#include <limen/geometry/rigid.h>
#include <limen/io/read_scan.h>
#include <limen/report/result_json.h>

/// Reads a file it wrote itself and reports a pose: touches every library that limen leans on.
int main() {
  const auto path = std::filesystem::temp_directory_path() / "limen-consumer.xyz";
  std::ofstream(path) << "0 0 0\n1 0 0\n0 2 0\n0 0 3\n";
  const limen::Scan scan = limen::read_scan(path);
  std::filesystem::remove(path);
  if (scan.size() != 4) return 1;

  limen::RegistrationReport report;
  report.result.outcome = limen::Outcome::registered;
  report.result.best.target_from_source.translation = scan.local_origin + scan.points[3];
  if (limen::result_json(report).find("\"registered\"") == std::string::npos) return 1;
  std::printf("limen %s\n%s", limen::kVersion,
              limen::transform_text(report.result.best.target_from_source).c_str());
  return 0;
}
