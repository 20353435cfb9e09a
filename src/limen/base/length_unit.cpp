// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/length_unit.h"

#include <cmath>

#include <fmt/format.h>

namespace limen {

const std::vector<LengthUnit>& length_units() {
  static const std::vector<LengthUnit> units = {{"m", 1.0},     {"mm", 0.001},  {"cm", 0.01},
                                                {"ft", 0.3048}, {"in", 0.0254}, {"us-ft", 1200.0 / 3937.0},
                                                {"km", 1000.0}};
  return units;
}

std::optional<LengthUnit> length_unit(std::string_view name) {
  for (const LengthUnit& unit : length_units()) {
    if (name == unit.name) return unit;
  }
  return std::nullopt;
}

std::string unit_name(double metres_per_unit) {
  for (const LengthUnit& unit : length_units()) {
    // Two feet differ by two millionths.
    if (std::abs(metres_per_unit / unit.metres_per_unit - 1.0) < 1e-7) return unit.name;
  }
  return fmt::format("{:.6g} m", metres_per_unit);
}

}  // namespace limen
