// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "module.h"
#include "numpy_views.h"
#include "work.h"

#include "limen/base/length_unit.h"
#include "limen/bim/read_bim.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/io/table/scan_builder.h"
#include "limen/io/ply/ply.h"

namespace limen::python {

std::vector<Vector3d> points_from(const DoubleArray& array, const Vector3d& origin, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw Error(std::string(name) + " has another shape than (n, 3)", "",
                "give one row of x, y, z per point");
  const auto in = array.unchecked<2>();
  std::vector<Vector3d> points(static_cast<std::size_t>(in.shape(0)));
  for (py::ssize_t i = 0; i < in.shape(0); ++i) {
    Vector3d& x = points[static_cast<std::size_t>(i)];
    x = Vector3d(in(i, 0), in(i, 1), in(i, 2)) - origin;
    if (!x.allFinite())
      throw Error("a coordinate is not finite", std::string(name) + "[" + std::to_string(i) + "]",
                  "leave such points out: points[numpy.isfinite(points).all(axis=1)]");
  }
  return points;
}

DoubleArray doubles_from(const py::object& given, const char* name) {
  if (auto array = DoubleArray::ensure(given)) return array;
  PyErr_Clear();
  throw Error(std::string(name) + " are not numbers", "",
              "give an array of them; one with named columns becomes one by "
              "numpy.lib.recfunctions.structured_to_unstructured");
}

namespace {

/// The origin near the middle of world coordinates.
Vector3d origin_of(const DoubleArray& points) {
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
  if (points.ndim() == 2 && points.shape(0) > 0 && points.shape(1) == 3) {
    const auto in = points.unchecked<2>();
    low = high = Vector3d(in(0, 0), in(0, 1), in(0, 2));
    for (py::ssize_t i = 1; i < in.shape(0); ++i) {
      const Vector3d x(in(i, 0), in(i, 1), in(i, 2));
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  const Vector3d middle = 0.5 * (low + high);
  return middle.allFinite() ? round_origin_near(middle) : Vector3d::Zero();
}

std::vector<Vector3d> centres_from(const py::object& centres, const Vector3d& origin, std::size_t points) {
  if (centres.is_none()) return {};
  DoubleArray array = doubles_from(centres, "centres");
  if (array.ndim() == 1 && array.size() == 3) array = array.reshape({1, 3});
  std::vector<Vector3d> list = points_from(array, origin, "centres");
  if (list.size() != 1 && list.size() != points)
    throw Error(
        "there are " + std::to_string(list.size()) + " centres for " + std::to_string(points) + " points", "",
        "give one place, or one row per point");
  return list;
}

/// What Scan(...) is given beside the points.
struct ScanParts {
  py::object centres, times, intensities, colours, lines, indices, local_origin;
};

Vector3d local_origin_from(const py::object& given) {
  const DoubleArray array = doubles_from(given, "local_origin");
  const Vector3d origin = array.ndim() == 1 && array.size() == 3 ? Vector3d(array.at(0), array.at(1), array.at(2))
                                                                 : Vector3d::Constant(NAN);
  if (!origin.allFinite()) throw Error("local_origin is no place", "", "give x, y, z, finite");
  return origin;
}

Scan make_scan(const py::object& given, const ScanParts& parts, std::string name, bool level) {
  const DoubleArray points = doubles_from(given, "points");
  Scan scan;
  scan.name = std::move(name);
  scan.level = level;
  if (parts.local_origin.is_none()) {
    scan.local_origin = origin_of(points);
    scan.points = points_from(points, scan.local_origin, "points");
    scan.centres = centres_from(parts.centres, scan.local_origin, scan.size());
  } else {
    scan.local_origin = local_origin_from(parts.local_origin);
    scan.points = points_from(points, Vector3d::Zero(), "points");
    scan.centres = centres_from(parts.centres, Vector3d::Zero(), scan.size());
  }
  if (scan.centres.size() == 1) scan.centre_source = PlaceSource::stated_by_user;
  if (scan.points.empty()) throw Error("there are no points", scan.name, "give at least one");
  scan.times_s = values_from<double>(parts.times, scan.size(), "times");
  scan.intensities = values_from<float>(parts.intensities, scan.size(), "intensities");
  scan.colours = values_from<std::uint8_t>(parts.colours, scan.size(), "colours", 3);
  scan.topology.line = values_from<std::int32_t>(parts.lines, scan.size(), "lines");
  scan.topology.index = values_from<std::int32_t>(parts.indices, scan.size(), "indices");
  if (scan.topology.line.size() != scan.topology.index.size())
    throw Error("lines and indices belong together", scan.name, "give both, or neither");
  scan.check();
  return scan;
}

template <typename Value>
py::object values_or_none(const std::vector<Value>& values, std::vector<py::ssize_t> shape,
                          const py::object& owner) {
  if (values.empty()) return py::none();
  return view(values, std::move(shape), owner);
}

py::ssize_t rows(const Scan& scan) {
  return static_cast<py::ssize_t>(scan.size());
}

void bind_scan(py::module_& module) {
  using Held = std::shared_ptr<Scan>;
  py::class_<Scan, Held> scan(module, "Scan");
  scan.def(py::init([](const py::object& points, py::object centres, py::object times,
                       py::object intensities, py::object colours, py::object lines, py::object indices,
                       std::string name, bool level, py::object local_origin) {
             const ScanParts parts{std::move(centres),     std::move(times), std::move(intensities),
                                   std::move(colours),     std::move(lines), std::move(indices),
                                   std::move(local_origin)};
             return std::make_shared<Scan>(make_scan(points, parts, std::move(name), level));
           }),
           py::arg("points"), py::kw_only(), py::arg("centres") = py::none(), py::arg("times") = py::none(),
           py::arg("intensities") = py::none(), py::arg("colours") = py::none(),
           py::arg("lines") = py::none(), py::arg("indices") = py::none(), py::arg("name") = "",
           py::arg("level") = ReadOptions{}.level, py::arg("local_origin") = py::none());
  const auto shown = [&scan](const char* name, auto getter) {
    scan.def_property_readonly(
        name, [getter](const py::object& self) { return getter(self.cast<const Scan&>(), self); });
  };
  shown("points", [](const Scan& it, const py::object& self) { return view(it.points, self); });
  shown("centres", [](const Scan& it, const py::object& self) -> py::object {
    if (!it.centre_known()) return py::none();
    return view(it.centres, self);
  });
  shown("times",
        [](const Scan& it, const py::object& self) { return values_or_none(it.times_s, {rows(it)}, self); });
  shown("intensities", [](const Scan& it, const py::object& self) {
    return values_or_none(it.intensities, {rows(it)}, self);
  });
  shown("colours", [](const Scan& it, const py::object& self) {
    return values_or_none(it.colours, {rows(it), 3}, self);
  });
  shown("lines", [](const Scan& it, const py::object& self) {
    return values_or_none(it.topology.line, {rows(it)}, self);
  });
  shown("indices", [](const Scan& it, const py::object& self) {
    return values_or_none(it.topology.index, {rows(it)}, self);
  });
  scan.def_property_readonly("world_points",
                             [](const Scan& it) { return points_array(it.points, it.local_origin); });
  scan.def_property_readonly("local_origin", [](const Scan& it) { return it.local_origin; });
  scan.def_property_readonly("mobile", &Scan::mobile);
  scan.def_readwrite("name", &Scan::name);
  scan.def_readwrite("level", &Scan::level);
  // Who says where the scanner stood: kept by pickles.
  scan.def_property(
      "_centre_source", [](const Scan& it) { return static_cast<int>(it.centre_source); },
      [](Scan& it, int source) { it.centre_source = static_cast<PlaceSource>(source); });
  scan.def("__len__", &Scan::size);
  scan.def(
      "save",
      [](const Scan& it, const std::filesystem::path& path) {
        if (path.extension() != ".ply" && path.extension() != ".PLY")
          throw Error("a scan is saved as PLY", path.string(),
                      "end the name with .ply; limen.transform_file changes the format of a file");
        write_ply(path, it);
      },
      py::arg("path"), py::call_guard<py::gil_scoped_release>());
}

void bind_model(py::module_& module) {
  py::class_<BimModel, std::shared_ptr<BimModel>> model(module, "Model");
  model.def_readonly("name", &BimModel::name);
  model.def_readonly("schema", &BimModel::schema);
  model.def_readonly("warnings", &BimModel::warnings);
  model.def_readonly("georeferenced", &BimModel::georeferenced);
  model.def_property_readonly("local_origin", [](const BimModel& it) { return it.local_origin; });
  model.def_property_readonly("faces", [](const BimModel& it) { return it.faces.size(); });
  model.def_property_readonly("openings", [](const BimModel& it) { return it.openings.size(); });
  model.def_property_readonly("spaces", [](const BimModel& it) {
    py::list names;
    for (const BimSpace& space : it.spaces) names.append(space.name);
    return names;
  });
  model.def("_elements", [](const BimModel& it) {
    py::list elements;
    for (const BimElement& element : it.elements)
      elements.append(
          py::make_tuple(to_string(element.kind), element.type, element.guid, element.name, element.storey));
    return elements;
  });
}

/// Metres per unit of a name; nothing for an empty one. Throws Error for a name that is none.
std::optional<double> unit_from(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (const std::optional<LengthUnit> unit = length_unit(name)) return unit->metres_per_unit;
  throw Error(name + " is no unit of length", "units", "give m, mm, cm, ft, us-ft, in or km");
}

py::dict thinned_file(const std::filesystem::path& input, const std::filesystem::path& output,
                       std::uint64_t points, double spacing_m, const py::object& progress) {
  ThinOptions thinning;
  thinning.most_points = points;
  thinning.spacing_m = spacing_m;
  thinning.check();
  const WrittenClouds written = run(progress, [&](Monitor& monitor) {
    monitor.begin_stage("thinning");
    const OpenPoints open(input);
    return limen::thin_file(open, thinning, output, monitor);
  });
  py::dict values;
  values["points_read"] = written.read;
  values["points_written"] = written.written;
  values["spacing_m"] = written.spacing_m;
  return values;
}

py::dict transform_file(const std::filesystem::path& input, const Matrix4d& pose,
                        const std::filesystem::path& output, const py::object& progress) {
  const Rigid3 target_from_source = from_matrix(pose);
  const TransformedCloud cloud = run(progress, [&](Monitor& monitor) {
    return transform_cloud(input, target_from_source, output, {}, monitor);
  });
  py::dict values;
  values["points"] = cloud.points;
  values["format"] = cloud.format;
  values["notes"] = cloud.notes;
  return values;
}

}  // namespace

void bind_scans(py::module_& module) {
  bind_scan(module);
  bind_model(module);
  module.attr("LEVEL") = ReadOptions{}.level;
  module.def(
      "read_scan",
      [](const std::filesystem::path& path, const std::optional<Vector3d>& origin, bool level,
         const std::string& units, const py::object& progress) {
        ReadOptions options{origin, level};
        options.metres_per_unit = unit_from(units);
        return std::make_shared<Scan>(
            run(progress, [&](Monitor& monitor) { return limen::read_scan(path, options, monitor); }));
      },
      py::arg("path"), py::arg("origin"), py::arg("level"), py::arg("units"), py::arg("progress"));
  module.def(
      "read_model",
      [](const std::filesystem::path& path, const std::string& units, const py::object& progress) {
        const std::optional<double> unit = unit_from(units);
        return std::make_shared<BimModel>(
            run(progress, [&](Monitor& monitor) { return read_bim(path, monitor, unit); }));
      },
      py::arg("path"), py::arg("units"), py::arg("progress"));
  module.def("is_model_file", &is_bim_file, py::arg("path"));
  module.def("transform_file", &transform_file);
  module.def("thin_file", &thinned_file);
  module.def("require_pose", [](const Matrix4d& pose) { from_matrix(pose); });
  module.def(
      "transform_scan",
      [](const Scan& scan, const Matrix4d& pose) {
        return std::make_shared<Scan>(transformed(scan, from_matrix(pose)));
      },
      py::call_guard<py::gil_scoped_release>());
  module.def("transform_points", [](const py::object& points, const Matrix4d& pose) {
    const Rigid3 target_from_source = from_matrix(pose);
    std::vector<Vector3d> moved = points_from(doubles_from(points, "points"), Vector3d::Zero(), "points");
    for (Vector3d& x : moved) x = target_from_source * x;
    return points_array(moved);
  });
}

}  // namespace limen::python
