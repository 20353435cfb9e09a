// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/model/scan.h"

namespace limen {

/// What a surface of the simulated world belongs to.
enum class Element : std::uint8_t {
  wall,
  floor,
  ceiling,
  roof,
  reveal,
  frame,
  mullion,
  glass,
  curtain,
  blind,
  door,
  furniture,
  stairs,
  ground,
  pavement,
  ornament,
  car,
  tree,
  pole,
  portal  ///< the empty cross-section of an opening without glass: seen by nobody, counted by the simulator
};

/// The element's name as it is in truth.json.
inline const char* to_string(Element element) {
  static constexpr std::array<const char*, 20> names = {
      "wall",     "floor",    "ceiling", "roof", "reveal",    "frame",  "mullion",
      "glass",    "curtain",  "blind",   "door", "furniture", "stairs", "ground",
      "pavement", "ornament", "car",     "tree", "pole",      "portal"};
  return names[static_cast<std::size_t>(element)];
}

/// How a wall's face leaves its plane: along the normal by height * sin(pi a) * sin(pi b) at shares a, b of
/// the way from one border to the other.
struct Bulge {
  double height_m = 0.0;
  Vector3d origin = Vector3d::Zero();
  Vector3d u = Vector3d::Zero();  ///< a = u . (x - origin), kept within [0, 1]
  Vector3d v = Vector3d::Zero();  ///< b

  [[nodiscard]] double at(const Vector3d& x) const {
    const auto wave = [&](const Vector3d& axis) {
      return std::sin(std::numbers::pi * std::clamp(axis.dot(x - origin), 0.0, 1.0));
    };
    return height_m == 0.0 ? 0.0 : height_m * wave(u) * wave(v);
  }
};

/// The bulge seen in another frame.
inline Bulge transformed(const Rigid3& b_from_a, const Bulge& in_a) {
  return {in_a.height_m, b_from_a * in_a.origin, b_from_a.rotation * in_a.u, b_from_a.rotation * in_a.v};
}

/// Surface that two scans both saw.
struct SharedSurface {
  std::size_t a = 0;  ///< a < b
  std::size_t b = 0;
  double m2 = 0.0;
};

/// A plane of the simulated world that at least one scan has a point on. Coplanar faces looking the same way
/// are one plane.
struct TruePlane {
  Plane plane;                       ///< about Truth::local_origin; the normal points to the visible side
  Element element = Element::wall;   ///< of the face with the largest area
  double area_m2 = 0.0;              ///< of all its faces, openings taken out
  std::vector<std::size_t> inliers;  ///< points of each scan on it
  Bulge bulge = {};                  ///< of a wall as built
};

/// How one scan saw one opening.
struct OpeningSight {
  std::size_t crossed = 0;  ///< rays with an echo that crossed the glass or the free cross-section
  std::size_t through = 0;  ///< of these, rays that came back from beyond the opening's own parts
  std::size_t parts = 0;    ///< echoes on its reveals, frame, glass, curtain, door leaf
  /// 8 x 8 cells of the opening's rectangle with a ray through: bit 8 * row + column
  std::uint64_t cells = 0;
};

/// A window or door with its clear opening on both faces of the wall. Corners of the bounding rectangle about
/// Truth::local_origin, in order round the rectangle, seen from outside: lower left, lower right, upper
/// right, upper left.
struct TrueOpening {
  std::string kind;                  ///< "window" or "door"
  std::array<Vector3d, 4> outer;     ///< on the outer face (for inner walls: room rooms[1]'s face)
  std::array<Vector3d, 4> inner;     ///< on the inner face (room rooms[0]'s)
  std::string head = "rectangular";  ///< or "segmental", "semicircle", "round"
  /// The clear opening as it is built on either face; the corners stand on its bounding rectangle. The four
  /// corners where the head is rectangular.
  std::vector<Vector3d> outer_outline;
  std::vector<Vector3d> inner_outline;
  Vector3d normal = Vector3d::UnitX();  ///< of the outer face
  double thickness_m = 0.0;             ///< of the wall
  bool exterior = false;                ///< between a room and the outside
  bool glazed = false;
  bool curtained = false;            ///< curtain or blind drawn, or door closed: nothing to see through
  std::vector<int> rooms;            ///< one or two room numbers
  std::vector<OpeningSight> sights;  ///< one per scan
};

/// What is true of one scan.
struct ScanTruth {
  std::string name;             ///< Scan::name
  std::string ending = ".ply";  ///< of its file
  bool mobile = false;
  double drift_m = 0.0;    ///< error of the trajectory that was put in, one standard deviation per axis
  int room = -1;           ///< the room a station is in
  Rigid3 local_from_scan;  ///< scan frame to world less Truth::local_origin
  std::vector<std::int32_t> plane_of_point;  ///< index into Truth::planes or -1 (not planar, mixed pixel)
  /// Of a scanned model: index into BimModel::elements or -1 (furniture, mixed pixel). Empty elsewhere.
  std::vector<std::int32_t> element_of_point = {};
};

/// What became of an element of a model in the building that was scanned.
enum class ModelState : std::uint8_t {
  moved,    ///< built elsewhere: shift_m
  missing,  ///< never built
  open      ///< a door that is wide open: nothing of it is to be seen
};
inline const char* to_string(ModelState state) {
  static constexpr std::array<const char*, 3> names = {"moved", "missing", "open"};
  return names[static_cast<std::size_t>(state)];
}

struct ModelChange {
  int element = -1;  ///< index into BimModel::elements
  std::string guid;
  std::string kind;  ///< "wall", "door", ...
  ModelState state = ModelState::moved;
  Vector3d shift_m = Vector3d::Zero();  ///< as built less as planned, world axes
};

/// The room a station is in.
struct ModelRoom {
  int space = -1;  ///< index into BimModel::spaces; -1: the model names none there
  std::string guid;
  std::string name;
  double length_m = 0.0;  ///< of the smallest rectangle round its plan, the longer side
  double width_m = 0.0;
  double height_m = 0.0;
  double area_m2 = 0.0;
  std::vector<int> like;  ///< other spaces of the same plan, height and openings: the model repeats the room
};

/// A target that was put up in the building.
struct SiteTarget {
  std::string name;
  Vector3d centre = Vector3d::Zero();  ///< world less the truth's local_origin
};

/// What is true of a scanned model.
struct ModelTruth {
  std::string file;  ///< name of the model's file
  bool as_built = false;
  std::vector<ModelChange> changes;
  std::vector<ModelRoom> rooms;  ///< one per scan
  int furniture = 0;             ///< boxes that the model does not have
  std::vector<SiteTarget> targets = {};
};

/// The exact truth of a simulated case. Coordinates are about local_origin (a whole number of metres):
/// x_in_world = local_origin + x.
struct Truth {
  std::string scene;
  std::uint64_t seed = 0;
  Vector3d local_origin = Vector3d::Zero();
  Rigid3 local_from_scene;  ///< from the frame in which the building was built, that of Recipe::world
  std::vector<TruePlane> planes;
  std::vector<TrueOpening> openings;
  std::vector<ScanTruth> scans;
  bool as_built = false;                           ///< off the drawing, as real buildings are
  std::vector<SharedSurface> shared = {};          ///< where it was counted: of pairs of scans, sorted
  std::optional<ModelTruth> model = std::nullopt;  ///< of a scanned model; its coordinates are the world's
};

/// Counts the points of each scan on every plane, drops the planes nobody saw a point of, and renumbers.
Truth of_seen_planes(Truth truth);

/// The scan's own coordinates (local_origin included) to world coordinates.
inline Rigid3 world_from_scan(const Truth& truth, std::size_t scan) {
  Rigid3 pose = truth.scans[scan].local_from_scan;
  // A mobile scan is already in world coordinates: there the pose is the identity, exactly.
  if (!truth.scans[scan].mobile) pose.translation += truth.local_origin;
  return pose;
}

/// The true pose between two scans, x_in_target = pose * x_in_source, each in its file's coordinates.
inline Rigid3 true_target_from_source(const Truth& truth, std::size_t source, std::size_t target) {
  const ScanTruth& from = truth.scans[source];
  const ScanTruth& to = truth.scans[target];
  const Rigid3 local = inverse(to.local_from_scan) * from.local_from_scan;
  return to_world(local, from.mobile ? truth.local_origin : Vector3d::Zero(),
                  to.mobile ? truth.local_origin : Vector3d::Zero());
}

/// Scans as a scanner would give them, and separately the truth.
struct SimulatedCase {
  std::vector<Scan> scans;
  Truth truth;
};

}  // namespace limen
