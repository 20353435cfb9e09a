// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// The options of C++ with the defaults of C++.
#include <cstddef>
#include <optional>
#include <string>

#include "module.h"
#include "numpy_views.h"
#include <fmt/format.h>

#include "limen/base/named.h"
#include "limen/deviation/deviation.h"
#include "limen/extract/features/extract_features.h"
#include "limen/extract/openings/openings.h"
#include "limen/extract/segments/segments.h"
#include "limen/register/register.h"

namespace limen::python {
namespace {

template <typename Enum, std::size_t Size>
Enum named(const Named<Enum> (&names)[Size], const std::string& wanted, const char* option) {
  if (const std::optional<Enum> value = value_called(names, wanted)) return *value;
  throw Error(fmt::format("{} is \"{}\"", option, wanted), "",
              fmt::format("give one of: {}", fmt::join(names_in(names), ", ")));
}

/// Binds an aggregate of options: made of keywords, all others as C++ has them.
template <typename Options>
class Binder {
 public:
  Binder(py::module_& module, const char* name, const char* doc) : class_(module, name, doc) {
    class_.def(py::init([](const py::kwargs& given) {
      py::object made = py::cast(Options());
      for (const auto& [key, value] : given) {
        if (!py::hasattr(made, key))
          throw py::type_error(
              py::str("{} has no option {!r}").format(made.attr("__class__").attr("__name__"), key));
        py::setattr(made, key, value);
      }
      return made.cast<Options>();
    }));
    class_.def("__copy__", [](const Options& options) { return options; });
    class_.def("__reduce__", [](const py::object& self) {
      py::dict values;
      for (const py::handle field : self.attr("_fields")) values[field] = self.attr(py::str(field));
      return py::make_tuple(self.attr("__class__"), py::tuple(), py::make_tuple(py::none(), values));
    });
    class_.def("__repr__", [](const py::object& self) {
      py::list parts;
      for (const py::handle field : self.attr("_fields"))
        parts.append(py::str("{}={!r}").format(field, self.attr(py::str(field))));
      return py::str("{}({})").format(self.attr("__class__").attr("__name__"),
                                      py::str(", ").attr("join")(parts));
    });
  }
  ~Binder() { class_.attr("_fields") = py::tuple(fields_); }
  Binder(const Binder&) = delete;
  Binder& operator=(const Binder&) = delete;

  template <typename Value>
  Binder& field(const char* name, Value Options::*member, const char* doc) {
    class_.def_readwrite(name, member, doc);
    fields_.append(name);
    return *this;
  }

  template <typename Enum, std::size_t Size>
  Binder& choice(const char* name, Enum Options::*member, const Named<Enum> (&names)[Size],
                 const char* doc) {
    class_.def_property(
        name, [member, &names](const Options& options) { return name_of(names, options.*member); },
        [member, &names, name](Options& options, const py::object& wanted) {
          options.*member = named(names, py::str(wanted).template cast<std::string>(), name);
        },
        doc);
    fields_.append(name);
    return *this;
  }

  Binder& checked() {
    class_.def("check", &Options::check, "Raises limen.Error that names the bound that does not hold.");
    return *this;
  }

 private:
  py::class_<Options> class_;
  py::list fields_;
};

void bind_extraction(py::module_& module) {
  Binder<DetectOptions>(module, "DetectOptions", "How planes are found.")
      .choice("detector", &DetectOptions::detector, kPlaneDetectors, "auto, grow, scan_lines or msac")
      .choice("threshold", &DetectOptions::threshold, kThresholdRules, "auto, noise or a_contrario")
      .field("seed", &DetectOptions::seed, "of the detectors that draw samples")
      .field("relief", &DetectOptions::relief,
             "of mobile scans: the relief of façades apart, where no openings are sought");
  Binder<GrowOptions>(module, "GrowOptions", "Planes of an unorganised cloud.")
      .field("inlier_threshold_m", &GrowOptions::inlier_threshold_m, "0: by the rule DetectOptions.threshold")
      .field("min_inliers", &GrowOptions::min_inliers, "smallest plane, points")
      .field("finest_cell_m", &GrowOptions::finest_cell_m, "edge of the smallest cube")
      .field("coarsest_cell_m", &GrowOptions::coarsest_cell_m, "edge of the first cubes tried")
      .field("max_angle_deg", &GrowOptions::max_angle_deg, "between a cube's normal and its plane's")
      .checked();
  Binder<PolygonOptions>(module, "PolygonOptions", "Outlines of planes.")
      .field("alpha_m", &PolygonOptions::alpha_m, "radius of the alpha shape; 0: from the points' spacing")
      .field("min_part_m2", &PolygonOptions::min_part_m2, "smaller parts of a plane are dropped")
      .field("min_hole_m2", &PolygonOptions::min_hole_m2, "smaller holes are filled")
      .field("simplify_m", &PolygonOptions::simplify_m, "outlines may move by this much")
      .checked();
  Binder<ExtractOptions>(module, "ExtractOptions", "Planes of a scan and their outlines.")
      .field("detect", &ExtractOptions::detect, "how planes are found")
      .field("grow", &ExtractOptions::grow, "its threshold and smallest plane hold for every detector")
      .field("polygons", &ExtractOptions::polygons, "outlines")
      .checked();
  Binder<OpeningOptions>(module, "OpeningOptions", "Which openings are looked for.")
      .field("min_wall_m", &OpeningOptions::min_wall_m, "height of a wall")
      .field("min_depth_m", &OpeningOptions::min_depth_m, "points so far behind a wall lie in an opening")
      .field("through_m", &OpeningOptions::through_m, "farther behind they lie beyond it")
      .field("min_width_m", &OpeningOptions::min_width_m, "of an opening")
      .field("min_height_m", &OpeningOptions::min_height_m, "of an opening")
      .field("max_width_m", &OpeningOptions::max_width_m, "of an opening")
      .field("max_height_m", &OpeningOptions::max_height_m, "of an opening")
      .field("centre", &OpeningOptions::centre, "scanner position where the scan does not give it, local")
      .checked();
  Binder<SegmentOptions>(module, "SegmentOptions", "Which line segments are looked for.")
      .field("min_length_m", &SegmentOptions::min_length_m, "of a segment")
      .field("min_angle_deg", &SegmentOptions::min_angle_deg, "between two planes that make an edge")
      .field("join_gap_m", &SegmentOptions::join_gap_m,
             "pieces of one line are joined across gaps up to this")
      .field("creases", &SegmentOptions::creases, "where two planes meet")
      .field("borders", &SegmentOptions::borders, "where a plane ends")
      .field("max_border_sigma_m", &SegmentOptions::max_border_sigma_m,
             "less well known borders are left out")
      .checked();
}

}  // namespace

void bind_options(py::module_& module) {
  bind_extraction(module);
  Binder<RegisterOptions>(module, "RegisterOptions", "How a pose is searched and judged.")
      .choice("method", &RegisterOptions::method, kMethods, "auto, polygons, openings, hybrid or segments")
      .choice("gravity", &RegisterOptions::gravity, kGravities, "auto, up or unknown")
      .field("wall_thickness_m", &RegisterOptions::wall_thickness_m, "of the outer walls; 0: not known")
      .field("nothing_repeats", &RegisterOptions::nothing_repeats,
             "no room, flat or storey of the building was built like another, as you know it")
      .field("seed", &RegisterOptions::seed, "of every random choice")
      .field("extract", &RegisterOptions::extract, "planes of the scans")
      .field("refined_poses", &RegisterOptions::refined_poses, "candidates that are refined and judged")
      .field("alternatives", &RegisterOptions::alternatives, "different poses reported besides the best")
      .checked();
  Binder<DeviationOptions>(module, "DeviationOptions", "How a scan is measured against a model.")
      .field("max_distance_m", &DeviationOptions::max_distance_m,
             "matter farther from every face is not the model's")
      .field("max_angle_deg", &DeviationOptions::max_angle_deg, "between the surface at a point and its face")
      .field("tile_m", &DeviationOptions::tile_m, "edge of the tiles by which coverage is counted")
      .field("rays", &DeviationOptions::rays, "of the scan that are followed through the model, about")
      .field("min_points", &DeviationOptions::min_points, "on an element that counts as found")
      .field("cluster_m", &DeviationOptions::cluster_m,
             "matter not in the model: gaps up to this join pieces")
      .field("min_cluster_points", &DeviationOptions::min_cluster_points, "smaller pieces are not reported")
      .checked();
}

}  // namespace limen::python
