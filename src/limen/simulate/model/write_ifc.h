// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/simulate/model/bim_recipe.h"

namespace limen {

/// The file's unit of length.
enum class IfcUnit { metre, millimetre };

/// The recipe as the text of an IFC4 file: project, site, building, storeys, spaces, elements as extruded
/// solids, openings that void their hosts and are filled by windows and doors. The same recipe gives the same
/// bytes. Coordinates are written to the micrometre.
std::string ifc_text(const BimRecipe& recipe, IfcUnit unit = IfcUnit::metre);

}  // namespace limen
