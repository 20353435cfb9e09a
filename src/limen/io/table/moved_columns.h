// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// The names of three columns that a motion changes together.
struct MovedNames {
  std::array<const char*, 3> names;
  bool direction;  ///< turns only
};

inline constexpr std::array<MovedNames, 4> kMovedColumns{{{{"x", "y", "z"}, false},
                                                          {{"x_origin", "y_origin", "z_origin"}, false},
                                                          {{"nx", "ny", "nz"}, true},
                                                          {{"normal_x", "normal_y", "normal_z"}, true}}};

/// Three columns of one file that a motion changes together.
struct MovedColumns {
  std::array<std::size_t, 3> column{};
  bool direction = false;

  [[nodiscard]] Vector3d moved(const Rigid3& motion, const Vector3d& x) const {
    return direction ? Vector3d(motion.rotation * x) : motion * x;
  }
};

/// Those of which a file has all three; `find(name, direction)` gives a column's number, or nothing where it
/// cannot be moved.
template <typename Find>
std::vector<MovedColumns> moved_columns(const Find& find) {
  std::vector<MovedColumns> all;
  for (const MovedNames& each : kMovedColumns) {
    MovedColumns moved{{}, each.direction};
    bool whole = true;
    for (std::size_t k = 0; k < 3 && whole; ++k) {
      const std::optional<std::size_t> found = find(std::string_view(each.names[k]), each.direction);
      whole = found.has_value();
      if (whole) moved.column[k] = *found;
    }
    if (whole) all.push_back(moved);
  }
  return all;
}

}  // namespace limen
