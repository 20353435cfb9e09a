// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "module.h"
#include "numpy_views.h"
#include "work.h"

#include "limen/report/json/truth_json.h"
#include "limen/simulate/scene.h"

namespace limen::python {
namespace {

/// Scene options by their names; those that are None stay as C++ has them.
SceneOptions options_from(const std::string& name, const py::dict& given) {
  SceneOptions options;
  options.name = name;
  for (const auto& [key, value] : given) {
    if (value.is_none()) continue;
    const auto option = key.cast<std::string>();
    if (option == "seed") options.seed = value.cast<std::uint64_t>();
    if (option == "points_indoor") options.points_indoor = value.cast<std::size_t>();
    if (option == "points_outdoor") options.points_outdoor = value.cast<std::size_t>();
    if (option == "stations") options.stations = value.cast<std::size_t>();
    if (option == "facades") options.facades = value.cast<std::size_t>();
    if (option == "as_built") options.as_built = value.cast<bool>();
    if (option == "any_rotation") options.any_rotation = value.cast<bool>();
    if (option == "curtain_share") options.curtain_share = value.cast<double>();
    if (option == "drift_m") options.drift_m = value.cast<double>();
    if (option == "noise_m") options.scanner.noise_m = value.cast<double>();
  }
  options.check();
  return options;
}

}  // namespace

void bind_simulation(py::module_& module) {
  module.def("scene_names", &scene_names);
  module.def("simulate", [](const std::string& name, const py::dict& given, const py::object& progress) {
    const SceneOptions options = options_from(name, given);
    SimulatedCase made = run(progress, [&](Monitor& monitor) { return limen::simulate(options, monitor); });
    py::list scans;
    for (Scan& scan : made.scans) scans.append(std::make_shared<Scan>(std::move(scan)));
    py::list poses;
    for (std::size_t k = 0; k < made.truth.scans.size(); ++k)
      poses.append(to_matrix(world_from_scan(made.truth, k)));
    return py::make_tuple(scans, poses, truth_json(made.truth));
  });
}

}  // namespace limen::python
