// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/deviation/deviation.h"
#include "limen/report/json/result_json.h"
#include "limen/report/sheet/sheet.h"

namespace limen {

/// All that the files of a deviation contain beside the points themselves.
struct DeviationReport {
  Deviation deviation;
  InputSummary scan;
  InputSummary model;
  std::string result_path;     ///< where the pose came from; empty: the identity
  std::string result_outcome;  ///< "registered", ...; empty where the file does not say
  Rigid3 model_from_scan;      ///< world to world
  DeviationOptions measured;
  OptionList options;
};

/// The text of deviation.json: `inputs`, `pose`, `options`, `summary` (points, elements by presence and by
/// LOA, `common_shift`), `elements` (each of the model, with its figures, metres), `unmodelled` (pieces of
/// an object not in the model, world coordinates).
std::string deviation_json(const DeviationReport& report, const BimModel& model);

/// A row for each element, as deviation.csv and deviation.xlsx have it.
Sheet deviation_sheet(const DeviationReport& report, const BimModel& model);

/// The names of its columns, and the row of an element.
std::vector<std::string> deviation_columns();
SheetRow deviation_row(const ElementDeviation& it, const BimElement& element);

/// Red, green and blue of a deviation: blue for a missing surface (negative), light grey at 0, orange for
/// surface that is out; full colour from `limit_m` on. Distinguishable with every kind of colour vision.
struct Colour {
  unsigned char red = 0;
  unsigned char green = 0;
  unsigned char blue = 0;
};
Colour deviation_colour(double deviation_m, double limit_m);

/// A point of the coloured cloud.
struct DeviationPoint {
  Vector3d x = Vector3d::Zero();  ///< world
  float deviation_m = 0.0F;       ///< NaN: on no face
  std::int32_t element = -1;      ///< -1: on none
};
/// Writes `count` of them as binary PLY. The file appears whole or not at all.
void write_deviation_points(const std::filesystem::path& path, std::size_t count,
                            const std::function<DeviationPoint(std::size_t)>& point, double colour_limit_m);

/// Writes the scan's points in the model's world coordinates as binary PLY, with their colour, `deviation_m`
/// (NaN: on no face) and `element` (-1: on none). Points on no face are grey. The file appears whole or not
/// at all.
void write_deviation_ply(const std::filesystem::path& path, const Scan& scan, const DeviationReport& report,
                         double colour_limit_m);

/// Writes deviation.json, .csv, .xlsx and, as write_deviation_ply() does, .ply into a folder.
void write_deviation(const std::filesystem::path& folder, const DeviationReport& report,
                     const BimModel& model, const Scan& scan, double colour_limit_m);

}  // namespace limen
