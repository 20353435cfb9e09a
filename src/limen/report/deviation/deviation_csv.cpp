// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "limen/files/table_cells.h"
#include "limen/report/deviation/deviation_report.h"

namespace limen {
namespace {

std::string directions(const std::vector<Vector3d>& open) {
  std::string text;
  for (const Vector3d& d : open)
    text += fmt::format("{}({:.2f} {:.2f} {:.2f})", text.empty() ? "" : " ", d.x(), d.y(), d.z());
  return text;
}

/// The figures of an element that points lie on.
std::string figures(const ElementDeviation& it) {
  if (it.points == 0) return ",,,,,,,,,,,,";
  const ElementShift& shift = it.shift;
  std::string text =
      fmt::format("{:.5f},{:.5f},{:.5f},{:.5f},", it.median_m, it.mean_m, it.sigma_m, it.p95_m);
  text += it.loa > 0 ? fmt::format("LOA{},", it.loa) : ",";
  for (Eigen::Index k = 0; k < 3; ++k) text += fmt::format("{:.5f},", shift.shift_m[k] + 0.0);
  for (Eigen::Index k = 0; k < 3; ++k) text += fmt::format("{:.5f},", shift.sigma_m[k]);
  return text + fmt::format("{},{}", shift.held, directions(shift.open));
}

}  // namespace

std::string deviation_columns() {
  return "element,kind,type,guid,name,storey,presence,points,area_m2,covered_m2,passed_m2,covered_share,"
         "median_m,mean_m,sigma_m,p95_m,loa,shift_x_m,shift_y_m,shift_z_m,shift_sigma_x_m,shift_sigma_y_m,"
         "shift_sigma_z_m,shift_held,shift_open";
}

std::string deviation_row(const ElementDeviation& it, const BimElement& element) {
  std::string text = fmt::format("{},{},{},{},{},{},{},{},", it.element, to_string(element.kind),
                                 csv_field(element.type), csv_field(element.guid), csv_field(element.name),
                                 csv_field(element.storey), to_string(it.presence), it.points);
  return text + fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{}", it.area_m2, it.covered_m2, it.passed_m2,
                            it.covered_share, figures(it));
}

std::string deviation_csv(const DeviationReport& report, const BimModel& model) {
  std::string text = deviation_columns() + "\r\n";
  for (const ElementDeviation& it : report.deviation.elements)
    text += deviation_row(it, model.elements[static_cast<std::size_t>(it.element)]) + "\r\n";
  return text;
}

}  // namespace limen
