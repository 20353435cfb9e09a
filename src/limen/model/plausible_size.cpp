// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/plausible_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "limen/base/drawn_steps.h"
#include "limen/base/error.h"
#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr std::size_t kManyPoints = 100;  // fewer may be round, or a metre high, by chance
constexpr double kSmallestScanM = 0.1;
constexpr double kLongestScanM = 1e5;   // a day of a mobile scanner
constexpr double kThickestScanM = 1e3;  // the least of its three sides; of a city less
constexpr double kSmallestModelM = 0.5;
constexpr double kMostModelM2 = 2e6;   // ten times the surface of a large hospital
constexpr double kMostOutlineM = 1e7;  // all that surface in plates of 0.8 m: 5 m of outline for each m2
constexpr std::size_t kLookedAt =
    10000;                               // points, for three numbers that distinguish metres from millimetres
constexpr std::size_t kLeftOut = 100;    // one point in so many, at either end of an axis
constexpr double kWidestDegrees = 0.05;  // five kilometres
constexpr double kDegreesPerMetre = 0.05;  // at most, of width by height: a place in degrees has 1e-5
constexpr std::size_t kPointsOfAPlane = 200;
constexpr std::size_t kPlanesOfAPose = 3;

std::string remedy_for_units(const std::string& units_option) {
  const std::string name =
      units_option.empty() ? "" : "name the unit with " + units_option + " (mm, cm, ft, in, us-ft, km), or ";
  return "limen assumes metres for a file that states no unit: " + name + "export it again in metres";
}

/// What the numbers are likely to be where the truth is a building of some metres to some hundred metres.
std::string guess(double side_m) {
  if (side_m < 0.5) return "are they kilometres?";
  return side_m > 2000.0 ? "are they millimetres?" : "are they centimetres?";
}

std::string stated(double metres) {
  return metres >= 1e4 ? fmt::format("{:.4g} km", 1e-3 * metres) : fmt::format("{:.4g} m", metres);
}

/// Extent of the points along one axis, the outermost left out.
double side_of(const std::vector<Vector3d>& points, int axis) {
  std::vector<double> values;
  for_drawn_steps(points.size(), kLookedAt, [&](std::size_t i) { values.push_back(points[i][axis]); });
  const std::size_t out = values.size() / kLeftOut;
  const double low = ranked(values, out);
  return ranked(values, values.size() - 1 - out) - low;
}

double longest_side_of(const BimModel& model) {
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
  for (const BimFace& face : model.faces) {
    for (const Vector2d& p : face.outline.outer) {
      const Vector3d x = face.frame.to_space(p);
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  return (high - low).maxCoeff();
}

/// Whether it is of a file that says neither its unit nor where up is.
bool is_mesh(const BimModel& model) {
  return model.schema == "OBJ" || model.schema == "PLY";
}

Vector3d sides_of(const Scan& scan) {
  return {side_of(scan.points, 0), side_of(scan.points, 1), side_of(scan.points, 2)};
}

/// Longitudes and latitudes beside heights in metres: less than a metre wide by the numbers, and metres high.
bool seem_degrees(const Scan& scan, const Vector3d& sides) {
  if (scan.size() < kManyPoints) return false;
  const double widest = std::max(sides.x(), sides.y());
  if (!(widest < kWidestDegrees && widest < kDegreesPerMetre * sides.z())) return false;
  const Vector3d place = scan.local_origin + scan.points[scan.points.size() / 2];
  return std::abs(place.x()) <= 180.0 && std::abs(place.y()) <= 180.0;
}

bool plausible(const Vector3d& sides) {
  const double longest = sides.maxCoeff();
  return longest >= kSmallestScanM && longest <= kLongestScanM && sides.minCoeff() <= kThickestScanM;
}

constexpr double kSmallSideM = 1.0;  // longest side of a scan that is asked about
constexpr double kThickM = 80.0;     // least side of one
constexpr double kStoreysM[] = {1.5, 40.0};
constexpr double kTypicalStoreyM = 3.0;
constexpr double kLongestBuildingM = 2000.0;

bool is_height_and_length(double least_m, double longest_m) {
  return least_m >= kStoreysM[0] && least_m <= kStoreysM[1] && longest_m <= kLongestBuildingM;
}

/// The unit in which the least side would be nearest to a storey; empty where none brings it near.
std::string unit_for(double least_m, double longest_m) {
  std::string best;
  double nearest = 1e300;
  for (const auto& [name, factor] : {std::pair{"mm", 0.001}, {"cm", 0.01}, {"in", 0.0254}, {"km", 1000.0}}) {
    if (!is_height_and_length(factor * least_m, factor * longest_m)) continue;
    const double apart = std::abs(std::log(factor * least_m / kTypicalStoreyM));
    if (apart >= nearest) continue;
    nearest = apart;
    best = name;
  }
  return best;
}

}  // namespace

bool is_size_of_building(const Vector3d& sides_m) {
  return is_height_and_length(sides_m.minCoeff(), sides_m.maxCoeff());
}

std::string size_hint(const Scan& scan, const std::string& units_option) {
  if (scan.points.empty()) return {};
  const Vector3d sides = sides_of(scan);
  const double longest = sides.maxCoeff();
  const double least = sides.minCoeff();
  const bool odd = longest < kSmallSideM || (least > kThickM && longest < 30.0 * least);
  const std::string unit = odd ? unit_for(least, longest) : "";
  if (unit.empty()) return {};
  return fmt::format(
      "measures {} x {} x {}; are its numbers {}? Then {}", stated(sides.x()), stated(sides.y()),
      stated(sides.z()), unit,
      units_option.empty() ? "export it again in metres" : fmt::format("give {} {}", units_option, unit));
}

std::string few_points_hint(const Scan& scan) {
  constexpr std::size_t kEnough = kPointsOfAPlane * kPlanesOfAPose;
  if (scan.points.empty() || scan.points.size() >= kEnough) return {};
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : scan.points) box.extend(x);
  if (box.sizes().maxCoeff() < kSmallestScanM) return {};  // refused for its size
  return fmt::format("holds {} points, too few for a registration: a pose needs {} planes of about {} points",
                     scan.points.size(), kPlanesOfAPose, kPointsOfAPlane);
}

namespace {

/// The coarsest of the axes, of those steps to which all coordinates are rounded. `steps_at`: those that are
/// tried, of the axis of a coordinate; `is_round(x, step)`.
template <typename StepsAt, typename IsRound>
double step_of_axes(const Scan& scan, const StepsAt& steps_at, const IsRound& is_round) {
  // Rounding errors are step / sqrt(12): 1 mm, a good scanner's noise.
  constexpr double kCoarseStepM = 0.0035;
  if (scan.size() < kManyPoints) return 0.0;
  double coarsest = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double origin = scan.local_origin[k];
    for (const double step : steps_at(origin + scan.points.front()[k])) {
      if (step < kCoarseStepM || step <= coarsest) continue;
      const bool all = std::all_of(scan.points.begin(), scan.points.end(),
                                   [&](const Vector3d& x) { return is_round(origin + x[k], step); });
      if (all) coarsest = step;
    }
  }
  return coarsest;
}

double single_precision_step_m(const Scan& scan) {
  const auto step_at = [](double x) {
    const auto first = std::abs(static_cast<float>(x));
    return std::array<double, 1>{std::nextafter(first, std::numeric_limits<float>::infinity()) - first};
  };
  return step_of_axes(scan, step_at,
                      [](double x, double) { return static_cast<double>(static_cast<float>(x)) == x; });
}

double decimal_step_m(const Scan& scan) {
  constexpr double kEqual = 1e-6;  // of a step
  const auto steps = [](double) { return std::array<double, 5>{0.1, 0.05, 0.02, 0.01, 0.005}; };
  return step_of_axes(
      scan, steps, [](double x, double step) { return std::abs(x / step - std::round(x / step)) < kEqual; });
}

}  // namespace

double coordinate_step_m(const Scan& scan) {
  return std::max(single_precision_step_m(scan), decimal_step_m(scan));
}

std::string rounding_hint(const Scan& scan) {
  const double step_m = single_precision_step_m(scan);
  if (step_m == 0.0) return {};
  return fmt::format(
      "its coordinates are rounded to {}, single precision: export them with double, or less an offset",
      stated(step_m));
}

std::string degrees_hint(const Scan& scan) {
  if (scan.points.empty()) return {};
  const Vector3d sides = sides_of(scan);
  if (!seem_degrees(scan, sides)) return {};
  return fmt::format("x and y seem to be degrees of longitude and latitude: they span {:.2g} x {:.2g}, z {}",
                     sides.x(), sides.y(), stated(sides.z()));
}

std::vector<std::string> hints_about(const Scan& scan, const std::string& units_option) {
  std::vector<std::string> hints;
  for (std::string hint :
       {size_hint(scan, units_option), degrees_hint(scan), few_points_hint(scan), rounding_hint(scan)}) {
    if (!hint.empty()) hints.push_back(std::move(hint));
  }
  return hints;
}

std::string up_hint(const Vector3d& up_in_scan) {
  constexpr double kAlong = 0.9;
  if (up_in_scan.y() < kAlong * up_in_scan.norm() || up_in_scan.isZero(0.0)) return {};
  return "its y axis seems to point up: export it with z up to be certain";
}

std::string axes_hint(const BimModel& model) {
  if (!is_mesh(model)) return {};
  Vector3d facing = Vector3d::Zero();  // m^2 of faces along each axis
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
  for (const BimFace& face : model.faces) {
    Eigen::Index axis = 0;
    if (face.plane.normal.cwiseAbs().maxCoeff(&axis) > 0.9) facing[axis] += face.area_m2;
    for (const Vector2d& p : face.outline.outer) {
      const Vector3d x = face.frame.to_space(p);
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  const Vector3d size = high - low;
  const bool flat_in_y = size.y() < 0.7 * std::min(size.x(), size.z());
  const bool floors_face_y = facing.y() > 1.3 * std::max(facing.x(), facing.z());
  if (!flat_in_y || !floors_face_y) return {};
  return "its y axis seems to point up: export it with z up, or register with --gravity unknown";
}

bool has_plausible_size(const Scan& scan) {
  return scan.points.empty() || (plausible(sides_of(scan)) && degrees_hint(scan).empty());
}

void require_plausible_size(const Scan& scan, const std::string& units_option) {
  if (scan.points.empty()) return;
  if (std::string degrees = degrees_hint(scan); !degrees.empty())
    throw Error(std::move(degrees), scan.name, "bring it to a map in metres first, as UTM");
  const Vector3d sides = sides_of(scan);
  const double longest = sides.maxCoeff();
  if (plausible(sides)) return;
  throw Error(
      fmt::format("the points measure {} x {} x {}, which is implausible for a scan of a building: {}",
                  stated(sides.x()), stated(sides.y()), stated(sides.z()), guess(longest)),
      scan.name, remedy_for_units(units_option));
}

void require_plausible_size(const BimModel& model, const std::string& units_option) {
  if (model.faces.empty()) return;
  const double side = longest_side_of(model);
  double area_m2 = 0.0;
  double outline_m = 0.0;
  for (const BimFace& face : model.faces) {
    area_m2 += face.area_m2;
    outline_m += outline_length(face.outline);
  }
  if (side >= kSmallestModelM && area_m2 <= kMostModelM2 && outline_m <= kMostOutlineM) return;
  throw Error(
      fmt::format("the model measures {} from end to end and has {:.3g} m2 of surface with {:.3g} m of "
                  "outlines, which is implausible for a building (1 unit of the file = {:.6g} m): {}",
                  stated(side), area_m2, outline_m, model.metres_per_unit, guess(side)),
      model.name,
      is_mesh(model) ? remedy_for_units(units_option)
                     : "check the unit of the file and export it again in metres, or leave out what "
                       "lies around the building");
}

}  // namespace limen
