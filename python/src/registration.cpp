// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <utility>

#include "module.h"
#include "numpy_views.h"
#include "work.h"

#include "limen/base/atomic_file.h"
#include "limen/io/cloud/point_print.h"
#include "limen/model/plausible_size.h"
#include "limen/register/register.h"
#include "limen/report/html/html_report.h"
#include "limen/report/json/result_json.h"

namespace limen::python {
namespace {

/// One side as Python gives it: scans with their places, or a model.
struct PythonSide {
  std::vector<std::pair<const Scan*, Rigid3>> scans;
  const BimModel* model = nullptr;
};

PythonSide side_from(const py::object& given) {
  PythonSide side;
  if (py::isinstance<BimModel>(given)) {
    side.model = &given.cast<const BimModel&>();
    return side;
  }
  for (const py::handle entry : given) {
    const auto pair = entry.cast<std::pair<py::object, Matrix4d>>();
    side.scans.emplace_back(&pair.first.cast<const Scan&>(), from_matrix(pair.second));
  }
  return side;
}

RegisterInput input_of(const PythonSide& side) {
  RegisterInput input;
  for (const auto& [scan, pose] : side.scans) input.scans.push_back({*scan, pose});
  if (side.model != nullptr) input.model = *side.model;
  return input;
}

InputSummary summary_of(const PythonSide& side) {
  if (side.model != nullptr) return summarise(side.model->name, *side.model);
  if (side.scans.empty()) return {};
  InputSummary summary = summarise(side.scans.front().first->name, *side.scans.front().first);
  for (std::size_t k = 1; k < side.scans.size(); ++k) {
    summary.with.push_back(side.scans[k].first->name);
    summary.points += side.scans[k].first->size();
  }
  return summary;
}

py::tuple sigma_tuple(const PoseSigma& sigma) {
  return py::make_tuple(sigma.rotation_rad, sigma.translation_m, sigma.centre, sigma.covariance);
}

py::dict hypothesis_dict(const Hypothesis& it) {
  py::dict values;
  values["target_from_source"] = to_matrix(it.target_from_source);
  values["score"] = it.score;
  values["agreeing_m2"] = it.agreeing_m2;
  values["contradicted_m2"] = it.contradicted_m2;
  values["rms_m"] = it.rms_m;
  values["matched_planes"] = it.matched_planes;
  values["matched_openings"] = it.matched_openings;
  values["explained_share"] = it.explained_share;
  values["room"] = it.room;
  values["probability"] = it.probability;
  values["tie"] = it.tie;
  values["matched_segments"] = it.matched_segments;
  values["sigma"] = sigma_tuple(it.sigma);
  return values;
}

template <typename Item, typename Convert>
py::list list_of(const std::vector<Item>& items, const Convert& convert) {
  py::list list;
  for (const Item& item : items) list.append(convert(item));
  return list;
}

py::dict result_dict(const RegistrationResult& result) {
  py::dict values;
  values["outcome"] = to_string(result.outcome);
  values["reason"] = result.reason;
  values["best"] = result.outcome == Outcome::no_match ? py::object(py::none()) : hypothesis_dict(result.best);
  values["sigma"] = sigma_tuple(result.sigma);
  values["unobserved"] = list_of(result.unobserved, [](const UnobservedFreedom& it) {
    return py::make_tuple(it.name, it.rotation, it.direction);
  });
  values["alternatives"] = list_of(result.alternatives, hypothesis_dict);
  const auto plane_match = [](const PlaneMatch& it) {
    return py::make_tuple(it.source, it.target, it.distance_m, it.angle_rad, it.overlap_m2);
  };
  values["matches"] = list_of(result.matches, plane_match);
  values["moved_planes"] = list_of(result.moved, plane_match);
  values["openings"] = list_of(result.openings, [](const MatchedOpenings& it) {
    return py::make_tuple(it.source, it.target, it.shift_across_m, it.shift_up_m);
  });
  values["thickness"] = list_of(result.thickness, [](const MeasuredThickness& it) {
    return py::make_tuple(it.value_m, it.sigma_m, it.openings);
  });
  values["stages"] =
      list_of(result.stages, [](const StageTime& it) { return py::make_tuple(it.name, it.seconds); });
  return values;
}

/// A registration and what its report draws.
struct Registered {
  RegistrationReport report;
  ReportScene scene;
};

/// The files that limen register writes, the numbers first.
void save(const Registered& registered, const std::filesystem::path& path, bool with_report) {
  const OutputFolder folder(path);
  remove_report(folder.path());
  write_numbers(folder.path(), registered.report);
  if (with_report) write_report(folder.path(), registered.report, registered.scene);
}

Registered register_sides(const PythonSide& source, const PythonSide& target, RegisterOptions options,
                          Monitor& monitor) {
  options.picture = true;
  Registered registered;
  RegistrationReport& report = registered.report;
  report.source = summary_of(source);
  report.target = summary_of(target);
  report.seed = options.seed;
  const RegisterInput from = input_of(source);
  const RegisterInput to = input_of(target);
  report.result = register_inputs(from, to, options, monitor);
  report.source.place = report.result.source_place;
  report.target.place = report.result.target_place;
  for (const auto& [input, side] : {std::pair(&from, "SOURCE"), std::pair(&to, "TARGET")}) {
    for (const auto& [scan, pose] : input->scans) {
      for (const std::string& hint : hints_about(scan))
        report.notes.push_back((scan.name.empty() ? side : scan.name) + ": " + hint);
    }
  }
  if (!from.scans.empty() && !to.scans.empty()) {
    const std::string note =
        same_points_note(print_of(from.scans.front().scan), print_of(to.scans.front().scan));
    if (!note.empty()) report.notes.push_back(note);
  }
  if (const auto& picture = report.result.picture)
    registered.scene = {with_picture(scene_side(from), picture->source),
                        with_picture(scene_side(to), picture->target)};
  return registered;
}

}  // namespace

void bind_registration(py::module_& module) {
  py::class_<Registered>(module, "RegistrationReport")
      .def("values", [](const Registered& it) { return result_dict(it.report.result); })
      .def("json", [](const Registered& it) { return result_json(it.report); })
      .def("save", &save, py::arg("folder"), py::arg("with_report"), py::call_guard<py::gil_scoped_release>());
  module.def("register", [](const py::object& source, const py::object& target, const py::object& asked,
                            const py::object& progress) {
    const auto& options = asked.cast<const RegisterOptions&>();
    options.check();
    const PythonSide from = side_from(source);
    const PythonSide to = side_from(target);
    Registered registered =
        run(progress, [&](Monitor& monitor) { return register_sides(from, to, options, monitor); });
    OptionList& stated = registered.report.options;
    for (const char* name : {"method", "gravity"})
      stated.emplace_back(name, asked.attr(name).cast<std::string>());
    if (options.nothing_repeats) stated.emplace_back("repeats", "none");
    if (options.wall_thickness_m > 0) stated.emplace_back("wall_thickness_m", options.wall_thickness_m);
    return registered;
  });
}

}  // namespace limen::python
