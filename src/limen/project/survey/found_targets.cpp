// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/survey/found_targets.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/files/table_cells.h"
#include "limen/project/control/control_file.h"
#include "limen/project/control/match_points.h"

namespace limen {
namespace {

/// Points that targets are compared with, about one of them.
struct ReferencePoints {
  std::vector<std::string> names;
  std::vector<MeasuredPoint> points;
};

std::vector<MeasuredPoint> points_of_targets(const std::vector<FoundTarget>& targets) {
  std::vector<MeasuredPoint> points;
  for (const FoundTarget& target : targets)
    points.push_back({target.centre - targets.front().centre, target.sigma_m});
  return points;
}

ReferencePoints surveyed(const ProjectInputs& inputs) {
  ReferencePoints reference;
  Vector3d origin = Vector3d::Zero();
  for (const std::string& file : {inputs.control, inputs.check}) {
    if (file.empty()) continue;
    for (const SurveyedPoint& point : read_surveyed_points(file)) {
      if (reference.points.empty()) origin = point.x;
      reference.names.push_back(point.name);
      reference.points.push_back({point.x - origin, std::sqrt(point.covariance.diagonal().maxCoeff())});
    }
  }
  return reference;
}

/// Of the scan with the most targets; the first by name where several have as many.
ReferencePoints of_one_scan(const std::vector<TargetsOfScan>& scans) {
  const auto most = std::max_element(
      scans.begin(), scans.end(),
      [](const TargetsOfScan& a, const TargetsOfScan& b) { return a.targets.size() < b.targets.size(); });
  ReferencePoints reference;
  if (most == scans.end() || most->targets.empty()) return reference;
  reference.points = points_of_targets(most->targets);
  for (std::size_t k = 0; k < reference.points.size(); ++k)
    reference.names.push_back(fmt::format("T{}", k + 1));
  return reference;
}

}  // namespace

TargetTable table_of_targets(const std::vector<TargetsOfScan>& scans, const ProjectInputs& inputs) {
  const bool known = !inputs.control.empty() || !inputs.check.empty();
  const ReferencePoints reference = known ? surveyed(inputs) : of_one_scan(scans);
  TargetTable table{"name,scan,x,y,z,sigma,kind,points\n", {}};
  std::size_t count = 0;
  std::size_t unknown = 0;
  std::size_t seeing = 0;
  for (const TargetsOfScan& scan : scans) {
    const std::vector<int> matched = match_points(points_of_targets(scan.targets), reference.points);
    seeing += scan.targets.empty() ? 0 : 1;
    for (std::size_t k = 0; k < scan.targets.size(); ++k) {
      const FoundTarget& target = scan.targets[k];
      const std::string name = matched[k] < 0 ? fmt::format("unknown_{}", ++unknown)
                                              : reference.names[static_cast<std::size_t>(matched[k])];
      table.text += fmt::format("{},{},{:.5f},{:.5f},{:.5f},{:.5f},{},{}\n", csv_field(name),
                                csv_field(scan.scan), target.centre.x(), target.centre.y(), target.centre.z(),
                                target.sigma_m, to_string(target.kind), target.points);
      ++count;
    }
  }
  table.words = fmt::format("{} target{} found in {} scan{}", count, count == 1 ? "" : "s", seeing,
                            seeing == 1 ? "" : "s");
  if (count > 0)
    table.words += fmt::format(", {} of them {} (targets.csv)", count - unknown,
                               known ? "matched to control or check points" : "matched between scans");
  return table;
}

}  // namespace limen
