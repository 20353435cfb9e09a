// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "limen/bim/ifc/step_file.h"
#include "limen/model/bim_model.h"

namespace limen {

/// From the model's own axes to those of a map (IfcMapConversion): a turn about the vertical, a scale, a
/// shift.
struct MapConversion {
  Vector3d shift_m = Vector3d::Zero();  ///< eastings, northings, orthogonal height
  double cosine = 1.0;                  ///< of the model's x axis to the east
  double sine = 0.0;                    ///< and to the north
  double scale = 1.0;

  [[nodiscard]] Vector3d to_map(const Vector3d& x) const {
    return shift_m + scale * Vector3d(cosine * x.x() - sine * x.y(), sine * x.x() + cosine * x.y(), x.z());
  }
};

/// A hole in an element and what is in it, by the numbers of the entities.
struct IfcVoid {
  std::int64_t opening = 0;
  std::int64_t host = 0;
  std::int64_t filling = 0;  ///< 0: nothing
  std::string guid;
};

/// All that an IFC file tells beside shapes. Read from its text alone.
struct IfcStructure {
  double metres_per_unit = 1.0;
  std::optional<MapConversion> map;
  std::map<std::int64_t, BimElement> elements;  ///< by their numbers; kinds and types as far as known
  std::map<std::int64_t, BimSpace> spaces;      ///< without faces
  std::vector<IfcVoid> voids;                   ///< by the openings' numbers
  std::map<std::int64_t, std::vector<std::int64_t>> parts;  ///< of what is made of parts (IfcRelAggregates)
  std::vector<std::string> warnings;
};

IfcStructure read_ifc_structure(const StepFile& file);

/// The parts of an element and their parts, itself first; of very many the first 500.
std::vector<std::int64_t> with_parts(const IfcStructure& structure, std::int64_t element);

}  // namespace limen
