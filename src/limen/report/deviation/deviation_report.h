// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "limen/deviation/deviation.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// All that the files of a deviation tell beside the points themselves.
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
/// matter that the model does not have, world coordinates).
std::string deviation_json(const DeviationReport& report, const BimModel& model);

/// The text of deviation.csv: one row for each element, after a row of names. RFC 4180, UTF-8, decimal
/// points.
std::string deviation_csv(const DeviationReport& report, const BimModel& model);

/// Red, green and blue of a deviation: blue for missing matter (negative), light grey at 0, orange for matter
/// that stands out; full colour from `limit_m` on. Told apart with every kind of colour vision.
struct Colour {
  unsigned char red = 0;
  unsigned char green = 0;
  unsigned char blue = 0;
};
Colour deviation_colour(double deviation_m, double limit_m);

/// Writes the scan's points in the model's world coordinates as binary PLY, with their colour, `deviation_m`
/// (NaN: on no face) and `element` (-1: on none). Points on no face are grey. The file appears whole or not
/// at all.
void write_deviation_ply(const std::filesystem::path& path, const Scan& scan, const DeviationReport& report,
                         double colour_limit_m);

}  // namespace limen
