// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// A unit of length by its short name.
struct LengthUnit {
  const char* name;        ///< "mm", as options take it
  double metres_per_unit;  ///< exact
};

/// m, mm, cm, ft (international foot, 0.3048 m), us-ft (US survey foot, 1200/3937 m), in, km.
const std::vector<LengthUnit>& length_units();

/// The unit of this name; nothing where there is none.
std::optional<LengthUnit> length_unit(std::string_view name);

/// "mm" for 0.001; "0.25 m" where no unit has that name.
std::string unit_name(double metres_per_unit);

}  // namespace limen
