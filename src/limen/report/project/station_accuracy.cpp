// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/station_accuracy.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/deviation/deviation.h"
#include "limen/files/table_cells.h"
#include "limen/project/state/scan_names.h"
#include "limen/report/summary/precision.h"

namespace limen {
namespace {

std::string yes_or_no(const std::optional<bool>& answer) {
  return !answer ? "" : *answer ? "yes" : "no";
}

std::string figures(const StationAccuracy& it) {
  if (it.held_fixed) return "yes,,,,,,,";
  std::string text = "no,";
  for (const double sigma : it.sigma_m) text += fmt::format("{:.5f},", sigma);
  text += fmt::format("{:.5f},{:.5f},", degrees(it.heading_sigma_rad), it.radius_m);
  return text + (it.loa > 0 ? fmt::format("LOA{},", it.loa) : ",") + yes_or_no(it.within_tolerance);
}

std::string place(const ProjectScan& scan) {
  if (scan.stations.empty()) return ",,";
  const Vector3d& x = scan.stations.front();
  return fmt::format("{:.4f},{:.4f},{:.4f}", x.x(), x.y(), x.z());
}

}  // namespace

std::optional<StationAccuracy> accuracy_of(const ProjectResult& result, std::size_t scan) {
  const ProjectScan& it = result.scans[scan];
  if (it.model || !it.frame_from_scan) return std::nullopt;
  StationAccuracy found;
  found.held_fixed = result.sigma_scan >= 0 && static_cast<std::size_t>(result.sigma_scan) == scan;
  if (found.held_fixed) return found;
  Matrix3d shifts = it.sigma.covariance.block<3, 3>(3, 3);
  Matrix3d turns = it.sigma.covariance.block<3, 3>(0, 0);
  if (it.sigma.covariance.isZero(0.0)) {
    shifts = it.sigma.translation_m.array().square().matrix().asDiagonal();
    turns = it.sigma.rotation_rad.array().square().matrix().asDiagonal();
  }
  found.sigma_m = shifts.diagonal().cwiseMax(0.0).cwiseSqrt();
  found.heading_sigma_rad = std::sqrt(std::max(0.0, result.up.dot(turns * result.up)));
  found.radius_m = radius_95(shifts);
  found.loa = loa_class(found.radius_m);
  if (result.tolerance_m) found.within_tolerance = found.radius_m <= *result.tolerance_m;
  return found;
}

std::size_t loops_through(const ProjectResult& result, std::size_t link) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(), [&](const GraphLoop& loop) {
        return std::find(loop.links.begin(), loop.links.end(), static_cast<int>(link)) != loop.links.end();
      }));
}

std::string stations_csv(const ProjectResult& result) {
  std::string text =
      "file,state,group,x_m,y_m,z_m,held_fixed,sigma_x_m,sigma_y_m,sigma_z_m,sigma_heading_deg,radius_95_m,"
      "loa,within_tolerance,probability_wrong,reason\r\n";
  for (std::size_t k = 0; k < result.scans.size(); ++k) {
    const ProjectScan& scan = result.scans[k];
    if (scan.model) continue;
    const std::optional<StationAccuracy> accuracy = accuracy_of(result, k);
    text +=
        fmt::format("{},{},{},{},{},{},{}\r\n", csv_field(scan_name(scan)),
                    scan.readable ? to_string(scan.state) : "unreadable",
                    scan.component >= 0 ? fmt::to_string(scan.component) : "", place(scan),
                    accuracy ? figures(*accuracy) : ",,,,,,,",
                    scan.frame_from_scan ? fmt::format("{:.3g}", scan.doubt) : "", csv_field(scan.reason));
  }
  return text;
}

std::string links_csv(const ProjectResult& result) {
  std::string text =
      "source,target,state,agreeing_m2,residual_m,residual_deg,redundancy,loops,probability_look_alike,"
      "probability_other\r\n";
  for (std::size_t k = 0; k < result.links.size(); ++k) {
    const ProjectLink& link = result.links[k];
    const auto name = [&](int scan) {
      return csv_field(scan_name(result.scans[static_cast<std::size_t>(scan)]));
    };
    // What no loop checks leaves no residual.
    const std::string residual = is_checked(link) ? fmt::format("{:.5f},{:.5f}", link.solved.loop_error_m,
                                                                degrees(link.solved.loop_error_rad))
                                                  : ",";
    text += fmt::format("{},{},{},{:.2f},{},{:.2f},{},{:.3g},{:.3g}\r\n", name(link.source),
                        name(link.target), to_string(link.solved.state), link.agreeing_m2, residual,
                        link.solved.redundancy, loops_through(result, k), link.twin, link.chance);
  }
  return text;
}

}  // namespace limen
