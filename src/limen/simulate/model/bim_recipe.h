// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/model/bim_model.h"

namespace limen {

/// A straight prism: `profile` in the plane of `base`, extruded by `depth_m` along base.u x base.v.
struct BimPrism {
  PlaneFrame base;
  Polygon profile;
  double depth_m = 1.0;
};

/// A building element made of prisms; openings are not cut.
struct RecipeElement {
  BimKind kind = BimKind::wall;
  std::string type;  ///< "IfcWall"
  std::string name;
  int storey = 0;
  std::vector<BimPrism> solids;
};

/// A hole through the first solid of its host. In walls its base lies on the face seen from outside (or from
/// the corridor), with base.v upwards, and it runs through the whole wall.
struct RecipeOpening {
  int host = -1;
  int filling = -1;  ///< -1: nothing is in it
  BimPrism solid;
};

struct RecipeSpace {
  std::string number;
  std::string name;
  int storey = 0;
  BimPrism solid;
};

struct RecipeStorey {
  std::string name;
  double elevation_m = 0.0;
};

/// A building described as an IFC file describes it; metres, z up, about one origin.
struct BimRecipe {
  std::string name;
  std::vector<RecipeStorey> storeys;
  std::vector<RecipeElement> elements;
  std::vector<RecipeOpening> openings;
  std::vector<RecipeSpace> spaces;
};

/// Which list of a recipe a GUID is for.
enum class RecipePart { element, opening, space, relation };
/// The 22 characters of a GlobalId: always the same for the same part.
std::string recipe_guid(const BimRecipe& recipe, RecipePart part, std::size_t index);

/// The model that a reader of the recipe's IFC file should come to: openings cut out, reveals added. Openings
/// must be perpendicular to the faces they pierce.
BimModel model_of(const BimRecipe& recipe);

/// The built-in model: two storeys of 24 x 13 m with a corridor, rows of equal offices on both floors, a
/// meeting room and a hall with columns that are unique, a stairwell, windows and doors.
BimRecipe office_recipe();

/// The file's unit of length.
enum class IfcUnit { metre, millimetre };

/// The recipe as the text of an IFC4 file: project, site, building, storeys, spaces, elements as extruded
/// solids, openings that void their hosts and are filled by windows and doors. The same recipe gives the same
/// bytes. Coordinates are written to the micrometre.
std::string ifc_text(const BimRecipe& recipe, IfcUnit unit = IfcUnit::metre);

}  // namespace limen
