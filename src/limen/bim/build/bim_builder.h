// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/bim/solid/solid.h"
#include "limen/model/bim_model.h"

namespace limen {

/// An element and its surface in world coordinates, openings not yet cut.
struct RawElement {
  BimElement about;
  std::vector<Solid> shapes;
};

/// A closed solid to be taken out of elements.
struct RawOpening {
  std::string guid;
  std::vector<std::int32_t> hosts;  ///< indices into RawModel::elements: the wall first, then its parts
  std::int32_t filling = -1;        ///< the same, or -1
  std::vector<Solid> shapes;
};

/// A room and its boundary.
struct RawSpace {
  BimSpace about;  ///< without faces
  std::vector<Solid> shapes;
};

/// What every reader of models brings its file to: surfaces in world coordinates, metres, in the file's
/// order.
struct RawModel {
  BimModel head;  ///< name, schema, units and warnings; without elements
  std::vector<RawElement> elements;
  std::vector<RawOpening> openings;
  std::vector<RawSpace> spaces;
};

/// Makes the model: picks the local origin, makes flat faces, cuts openings, questions odd sizes. Throws
/// Error where there is no surface at all.
BimModel built(RawModel raw, Monitor& monitor = silent_monitor());

}  // namespace limen
