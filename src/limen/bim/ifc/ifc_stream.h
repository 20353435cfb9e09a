// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limen/bim/solid/solid.h"

namespace limen {

/// The shapes of one product of an IFC file.
struct IfcProductShapes {
  std::int64_t id = 0;
  std::string type;           ///< "IfcWall"
  std::vector<Solid> shapes;  ///< world coordinates, metres as limen_ifc understood the units
};

/// What limen_ifc wrote, as far as it is sound.
struct IfcShapes {
  double metres_per_unit = 1.0;
  std::vector<IfcProductShapes> products;
  std::vector<std::pair<std::int64_t, std::string>> messages;  ///< by entity, 0: none
  bool loaded = false;                                         ///< the file was understood
  bool complete = false;                                       ///< the end was written and all is there
  bool broken = false;                                         ///< the stream is not what was agreed
  std::int64_t begun = 0;  ///< the entity whose shape was begun last and not finished, or 0
  std::string refused;     ///< why the file cannot be read; empty: it can
};

/// Reads the stream of ifc_stream_format.h. Nothing in it is trusted: counts, indices and depths are checked.
/// What comes before the first fault is kept.
IfcShapes parse_ifc_stream(std::string_view bytes);

}  // namespace limen
