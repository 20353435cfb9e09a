// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "module.h"
#include "numpy_views.h"
#include "work.h"

#include "limen/base/atomic_file.h"
#include "limen/report/deviation/deviation_report.h"

namespace limen::python {
namespace {

/// A deviation and what it was measured of, for its files.
struct MeasuredDeviation {
  DeviationReport report;
  std::shared_ptr<Scan> scan;
  std::shared_ptr<BimModel> model;
};

py::dict shift_dict(const ElementShift& shift) {
  py::dict values;
  values["shift_m"] = shift.shift_m;
  values["sigma_m"] = shift.sigma_m;
  values["held"] = shift.held;
  return values;
}

py::dict element_dict(const ElementDeviation& it, const BimModel& model) {
  const BimElement& element = model.elements[static_cast<std::size_t>(it.element)];
  py::dict values;
  values["name"] = element.name;
  values["kind"] = to_string(element.kind);
  values["guid"] = element.guid;
  values["presence"] = to_string(it.presence);
  values["points"] = it.points;
  values["median_m"] = it.median_m;
  values["sigma_m"] = it.sigma_m;
  values["p95_m"] = it.p95_m;
  values["loa"] = it.loa;
  values["covered_share"] = it.covered_share;
  values["shift_m"] = it.shift.shift_m;
  values["shift_sigma_m"] = it.shift.sigma_m;
  return values;
}

py::dict values(const MeasuredDeviation& measured) {
  const Deviation& deviation = measured.report.deviation;
  py::list elements;
  for (const ElementDeviation& it : deviation.elements) elements.append(element_dict(it, *measured.model));
  py::list unmodelled;
  for (const UnmodelledObject& it : deviation.unmodelled) {
    const Vector3d& origin = measured.model->local_origin;
    unmodelled.append(py::make_tuple(it.points, Vector3d(origin + it.low), Vector3d(origin + it.high)));
  }
  py::dict values;
  values["elements"] = elements;
  values["unmodelled"] = unmodelled;
  values["common_shift"] = shift_dict(deviation.common);
  values["matched"] = deviation.matched;
  values["far"] = deviation.far;
  return values;
}

void save_deviation(const MeasuredDeviation& measured, const std::filesystem::path& path, double colour_limit_m) {
  const OutputFolder folder(path);
  write_deviation(folder.path(), measured.report, *measured.model, *measured.scan, colour_limit_m);
}

}  // namespace

void bind_deviation(py::module_& module) {
  py::class_<MeasuredDeviation>(module, "MeasuredDeviation")
      .def("values", &values)
      .def_property_readonly("distance_m",
                             [](const py::object& self) {
                               const auto& it =
                                   self.cast<const MeasuredDeviation&>().report.deviation.distance_m;
                               return view(it, {static_cast<py::ssize_t>(it.size())}, self);
                             })
      .def_property_readonly("element",
                             [](const py::object& self) {
                               const auto& it =
                                   self.cast<const MeasuredDeviation&>().report.deviation.element;
                               return view(it, {static_cast<py::ssize_t>(it.size())}, self);
                             })
      .def("save", &save_deviation, py::arg("folder"), py::arg("colour_limit_m"));
  module.def("deviation",
             [](std::shared_ptr<Scan> scan, std::shared_ptr<BimModel> model, const Matrix4d& pose,
                const DeviationOptions& options, const py::object& progress) {
               options.check();
               MeasuredDeviation measured{{}, std::move(scan), std::move(model)};
               measured.report.model_from_scan = from_matrix(pose);
               measured.report.measured = options;
               measured.report.scan = summarise(measured.scan->name, *measured.scan);
               measured.report.model = summarise(measured.model->name, *measured.model);
               measured.report.deviation = run(progress, [&](Monitor& monitor) {
                 const Rigid3 local = to_local(measured.report.model_from_scan, measured.scan->local_origin,
                                               measured.model->local_origin);
                 return measure_deviation(*measured.scan, *measured.model, local, options, monitor);
               });
               return measured;
             });
}

}  // namespace limen::python
