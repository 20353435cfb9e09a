// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "limen/geometry/polygon.h"

namespace limen {

/// What an element of a model is to a laser: something built that stays, or something that moves or lets
/// light pass.
enum class BimKind : std::uint8_t {
  wall,  ///< curtain walls' panels are plates or windows
  slab,
  roof,
  column,
  beam,
  stair,  ///< and ramps
  railing,
  covering,  ///< ceilings, floorings, claddings
  plate,
  window,
  door,
  furniture,  ///< and appliances, sanitary ware
  terrain,
  other
};
const char* to_string(BimKind kind);

/// One building element as the file names it.
struct BimElement {
  BimKind kind = BimKind::other;
  std::string type;          ///< "IfcWallStandardCase"; of a mesh: the group's or object's name, or "mesh"
  std::string guid;          ///< the 22 characters of an IFC GlobalId; empty for a mesh
  std::string name;          ///< as its author named it, UTF-8; may be empty
  std::string storey;        ///< name of the storey that holds it; may be empty
  std::int64_t file_id = 0;  ///< the file's own number of it (#123 of a STEP file), 0: none
};

/// A flat face of one element, seen from the side its normal points to. Faces of an element are maximal: no
/// two that touch in one plane are apart. Curved surfaces are many faces.
struct BimFace {
  Plane plane;                ///< about the model's local origin; the normal points out of the solid
  PlaneFrame frame;           ///< 2-D coordinates of `outline`, right-handed with the normal
  Polygon outline;            ///< outer ring counter-clockwise, holes clockwise, openings already cut out
  double area_m2 = 0.0;       ///< holes taken out
  std::int32_t element = -1;  ///< index into BimModel::elements
};

/// A window, a door or a bare opening in a wall, as a box through it.
struct BimOpening {
  /// On the face of the wall whose outward normal is `normal`, seen from there: lower left, lower right,
  /// upper right, upper left. The same corners less thickness_m * normal lie on the wall's other face.
  Vector3d corners[4] = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  Vector3d normal = Vector3d::UnitX();  ///< unit
  double thickness_m = 0.0;             ///< of the wall there
  std::int32_t host = -1;               ///< the wall: index into BimModel::elements
  std::int32_t filling = -1;            ///< the window or door in it, or -1
  std::string guid;                     ///< of the opening element
};

/// A room that the model names.
struct BimSpace {
  std::string guid;
  std::string name;  ///< number and long name, as far as the file has them
  std::string storey;
  std::vector<BimFace> faces;  ///< its closed boundary, normals outward; `element` is -1
};

/// A building information model, or a mesh taken for one: flat faces of elements about a local origin.
///
/// x_in_world = local_origin + x; metres, z up. World coordinates are the file's own, in metres, or the map's
/// where the file has an IfcMapConversion. The order of everything is the file's.
struct BimModel {
  std::string name;                          ///< for messages and reports
  std::string schema;                        ///< "IFC2X3", "IFC4", "OBJ", "PLY"
  Vector3d local_origin = Vector3d::Zero();  ///< whole metres
  std::vector<BimElement> elements;
  std::vector<BimFace> faces;  ///< element by element
  std::vector<BimOpening> openings;
  std::vector<BimSpace> spaces;
  double metres_per_unit = 1.0;       ///< of the file, already applied
  bool georeferenced = false;         ///< world coordinates are those of a map projection
  std::vector<std::string> warnings;  ///< what could not be read or seems wrong, one sentence each

  /// Throws Error(Fault::internal) where indices or frames are not what is said above.
  void check() const;
};

}  // namespace limen
