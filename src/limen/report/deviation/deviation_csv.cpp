// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

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
void add_figures(SheetRow& row, const ElementDeviation& it) {
  if (it.points == 0) {
    row.insert(row.end(), 13, SheetCell{});
    return;
  }
  const ElementShift& shift = it.shift;
  for (const double metres : {it.median_m, it.mean_m, it.sigma_m, it.p95_m})
    row.push_back(number_cell(metres, 5));
  row.push_back(it.loa > 0 ? text_cell(fmt::format("LOA{}", it.loa)) : SheetCell{});
  for (const Vector3d& vector : {shift.shift_m, shift.sigma_m}) {
    for (const double metres : vector)
      row.push_back(shift.held > 0 ? number_cell(metres + 0.0, 5) : SheetCell{});
  }
  row.push_back(count_cell(static_cast<std::size_t>(shift.held)));
  row.push_back(text_cell(directions(shift.open)));
}

}  // namespace

std::vector<std::string> deviation_columns() {
  return {"element",
          "kind",
          "type",
          "guid",
          "name",
          "storey",
          "presence",
          "points",
          "area_m2",
          "covered_m2",
          "passed_m2",
          "covered_share",
          "median_m",
          "mean_m",
          "sigma_m",
          "p95_m",
          "loa",
          "shift_x_m",
          "shift_y_m",
          "shift_z_m",
          "shift_sigma_x_m",
          "shift_sigma_y_m",
          "shift_sigma_z_m",
          "shift_held",
          "shift_open"};
}

SheetRow deviation_row(const ElementDeviation& it, const BimElement& element) {
  SheetRow row = {count_cell(static_cast<std::size_t>(it.element)),
                  text_cell(to_string(element.kind)),
                  text_cell(element.type),
                  text_cell(element.guid),
                  text_cell(element.name),
                  text_cell(element.storey),
                  text_cell(to_string(it.presence)),
                  count_cell(it.points)};
  for (const double one : {it.area_m2, it.covered_m2, it.passed_m2, it.covered_share})
    row.push_back(number_cell(one, 4));
  add_figures(row, it);
  return row;
}

Sheet deviation_sheet(const DeviationReport& report, const BimModel& model) {
  Sheet sheet{"Elements", deviation_columns(), {}};
  for (const ElementDeviation& it : report.deviation.elements)
    sheet.rows.push_back(deviation_row(it, model.elements[static_cast<std::size_t>(it.element)]));
  return sheet;
}

}  // namespace limen
