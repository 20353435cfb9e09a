// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_sheets.h"

#include <string>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/project/state/scan_names.h"
#include "limen/report/project/station_accuracy.h"
#include "limen/report/summary/precision.h"

namespace limen {
namespace {

SheetCell maybe(const std::optional<double>& value, int digits) {
  return value ? number_cell(*value, digits) : SheetCell{};
}

SheetCell yes_or_no(const std::optional<bool>& answer) {
  return !answer ? SheetCell{} : text_cell(*answer ? "yes" : "no");
}

void add_blank(SheetRow& row, std::size_t count) {
  row.insert(row.end(), count, SheetCell{});
}

void add_vector(SheetRow& row, const Vector3d& x, int digits) {
  for (const double one : x) row.push_back(number_cell(one + 0.0, digits));
}

void add_accuracy(SheetRow& row, const std::optional<StationAccuracy>& it) {
  if (!it || it->held_fixed) {
    row.push_back(it ? text_cell("yes") : SheetCell{});
    add_blank(row, 7);
    return;
  }
  row.push_back(text_cell("no"));
  add_vector(row, it->sigma_m, 5);
  row.push_back(number_cell(degrees(it->heading_sigma_rad), 5));
  row.push_back(number_cell(it->radius_m, 5));
  row.push_back(it->loa > 0 ? text_cell(fmt::format("LOA{}", it->loa)) : SheetCell{});
  row.push_back(yes_or_no(it->within_tolerance));
}

SheetCell name_cell(const ProjectResult& result, int scan) {
  return text_cell(scan_name(result.scans[static_cast<std::size_t>(scan)]));
}

/// What no loop checks leaves no residual.
void add_residual(SheetRow& row, const ProjectLink& link) {
  if (!is_checked(link)) {
    add_blank(row, 2);
    return;
  }
  row.push_back(number_cell(link.solved.loop_error_m, 5));
  row.push_back(number_cell(degrees(link.solved.loop_error_rad), 5));
}

}  // namespace

Sheet stations_sheet(const ProjectResult& result) {
  Sheet sheet{
      "Stations",
      {"file", "state", "group", "x_m", "y_m", "z_m", "held_fixed", "sigma_x_m", "sigma_y_m", "sigma_z_m",
       "sigma_heading_deg", "radius_95_m", "loa", "within_tolerance", "probability_wrong", "reason"},
      {}};
  for (const std::size_t k : worst_scans_first(result)) {
    const ProjectScan& scan = result.scans[k];
    if (scan.model) continue;
    SheetRow row = {text_cell(scan_name(scan)),
                    text_cell(scan.readable ? to_string(scan.state) : "unreadable"),
                    scan.component >= 0 ? count_cell(static_cast<std::size_t>(scan.component)) : SheetCell{}};
    if (scan.stations.empty())
      add_blank(row, 3);
    else
      add_vector(row, scan.stations.front(), 4);
    add_accuracy(row, accuracy_of(result, k));
    row.push_back(scan.frame_from_scan ? short_number_cell(scan.doubt) : SheetCell{});
    row.push_back(text_cell(scan.reason));
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

Sheet links_sheet(const ProjectResult& result) {
  Sheet sheet{"Links",
              {"link", "source", "target", "state", "agreeing_m2", "overlap_percent", "plane_rms_m",
               "adjusted_rms_m", "residual_m", "residual_deg", "within_tolerance", "redundancy", "loops",
               "probability_look_alike", "probability_other"},
              {}};
  for (const std::size_t k : worst_links_first(result)) {
    const ProjectLink& link = result.links[k];
    const std::optional<double> overlap = overlap_of(result, k);
    SheetRow row = {count_cell(k),
                    name_cell(result, link.source),
                    name_cell(result, link.target),
                    text_cell(to_string(link.solved.state)),
                    number_cell(link.agreeing_m2, 2),
                    overlap ? number_cell(100.0 * *overlap, 1) : SheetCell{},
                    maybe(plane_distance_rms(link.matches), 5),
                    maybe(plane_distance_rms(link.adjusted), 5)};
    add_residual(row, link);
    row.push_back(yes_or_no(within_tolerance(result, link)));
    row.push_back(number_cell(link.solved.redundancy, 2));
    row.push_back(count_cell(loops_through(result, k)));
    row.push_back(short_number_cell(link.look_alike));
    row.push_back(short_number_cell(link.chance));
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

Sheet bundle_sheet(const ProjectResult& result) {
  Sheet sheet{"Bundle", {"bundle_rms_m", "planes", "worst_source", "worst_target", "worst_rms_m"}, {}};
  if (const std::optional<BundleError> bundle = bundle_error(result)) {
    const ProjectLink& worst = result.links[bundle->worst];
    sheet.rows.push_back({number_cell(bundle->rms_m, 5), count_cell(bundle->planes),
                          name_cell(result, worst.source), name_cell(result, worst.target),
                          number_cell(bundle->worst_rms_m, 5)});
  }
  return sheet;
}

Sheet loops_sheet(const ProjectResult& result) {
  Sheet sheet{"Loops", {"links", "closes", "misclosure_m", "misclosure_deg", "chi_squared"}, {}};
  for (const GraphLoop& loop : result.loops) {
    std::string links;
    for (const int link : loop.links) links += fmt::format("{}{}", links.empty() ? "" : " ", link);
    sheet.rows.push_back({text_cell(links), text_cell(loop.closes ? "yes" : "no"),
                          number_cell(loop.error_m, 5), number_cell(degrees(loop.error_rad), 5),
                          number_cell(loop.chi_square, 2)});
  }
  return sheet;
}

Sheet points_sheet(const ProjectResult& result) {
  Sheet sheet{"Points",
              {"point", "role", "state", "scans", "x_m", "y_m", "z_m", "sigma_x_m", "sigma_y_m", "sigma_z_m",
               "residual_x_m", "residual_y_m", "residual_z_m", "reason"},
              {}};
  for (const ProjectPoint& point : result.points) {
    SheetRow row = {text_cell(point.name), text_cell(to_string(point.role)),
                    text_cell(to_string(point.state)), count_cell(point.sights.size())};
    if (point.found) {
      add_vector(row, *point.found, 4);
      add_vector(row, point.found_sigma, 5);
    } else {
      add_blank(row, 6);
    }
    if (point.found && point.given)
      add_vector(row, point.test.residual, 5);
    else
      add_blank(row, 3);
    row.push_back(text_cell(point.reason));
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

}  // namespace limen
