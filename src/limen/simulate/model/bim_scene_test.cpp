// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/simulate/model/bim_mesh.h"
#include "limen/simulate/model/bim_recipe.h"
#include "limen/simulate/model/bim_stations.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {
namespace {

BimModel office() {
  return model_of(office_recipe());
}

BimSceneOptions quick(std::uint64_t seed = 1) {
  BimSceneOptions options;
  options.seed = seed;
  options.points = 20000;
  return options;
}

BimPrism block(const Vector3d& low, const Vector3d& size) {
  return {{low, Vector3d::UnitX(), Vector3d::UnitY()},
          {{{0.0, 0.0}, {size.x(), 0.0}, {size.x(), size.y()}, {0.0, size.y()}}, {}},
          size.z()};
}

/// A room of 4 x 3 x 2.5 m of six slabs that touch.
BimRecipe closed_room() {
  BimRecipe recipe;
  recipe.name = "closed";
  recipe.storeys = {{"Ground floor", 0.0}};
  const auto add = [&](const Vector3d& low, const Vector3d& size, BimKind kind) {
    recipe.elements.push_back({kind, "IfcWall", "part", 0, {block(low, size)}});
  };
  add({-0.2, -0.2, 0.0}, {4.4, 0.2, 2.5}, BimKind::wall);
  add({-0.2, 3.0, 0.0}, {4.4, 0.2, 2.5}, BimKind::wall);
  add({-0.2, 0.0, 0.0}, {0.2, 3.0, 2.5}, BimKind::wall);
  add({4.0, 0.0, 0.0}, {0.2, 3.0, 2.5}, BimKind::wall);
  add({-0.2, -0.2, -0.2}, {4.4, 3.4, 0.2}, BimKind::slab);
  add({-0.2, -0.2, 2.5}, {4.4, 3.4, 0.2}, BimKind::slab);
  return recipe;
}

int lost_rays(const BimModel& model) {
  const BimMesh built = build_mesh(model, parts_of(model), as_planned(model));
  const RayCaster caster(built.mesh);
  int lost = 0;
  for (const Vector3d& direction : spread_directions(300000)) {
    const RayHit hit = caster.cast({1.3, 1.7, 1.1}, direction);
    lost += !hit.found() || hit.inside ? 1 : 0;
  }
  return lost;
}

TEST(BimMesh, NoRayEscapesFromAClosedRoomOfSolids) {
  EXPECT_EQ(lost_rays(model_of(closed_room())), 0);
}

TEST(BimMesh, SurfacesThatAreNoSolidsAreSeenFromBothSides) {
  // Only what looks away from the room remains: it is seen from behind.
  BimModel model = model_of(closed_room());
  std::vector<BimFace> outside;
  for (BimFace& face : model.faces)
    if (face.plane.signed_distance({1.3, 1.7, 1.1}) < 0.0) outside.push_back(face);
  ASSERT_EQ(outside.size(), model.faces.size() - 6);
  model.faces = outside;
  EXPECT_EQ(lost_rays(model), 0);
}

TEST(BimMesh, PanesAreGlassAndFramesAreNot) {
  const BimModel model = office();
  double glass = 0.0;
  double frame = 0.0;
  for (const BimPart& part : parts_of(model)) {
    const BimFace& face = model.faces[part.face];
    const BimKind kind = model.elements[static_cast<std::size_t>(face.element)].kind;
    if (kind == BimKind::door) {
      EXPECT_NE(part.element, Element::glass);
    }
    if (kind != BimKind::window) continue;
    (part.element == Element::glass ? glass : frame) += area(part.outline);
  }
  double panes = 0.0;
  for (const RecipeElement& element : office_recipe().elements)
    for (std::size_t i = 1; element.kind == BimKind::window && i < element.solids.size(); ++i)
      panes += 2.0 * area(element.solids[i].profile);
  EXPECT_NEAR(glass, panes, 1e-6);
  EXPECT_GT(frame, 1.0);
}

TEST(BimMesh, AWindowDrawnAsABlockGetsAFrameAndGlass) {
  BimRecipe recipe = closed_room();
  recipe.elements = {{BimKind::window, "IfcWindow", "block", 0, {block({0, 0, 0}, {1.2, 0.1, 1.5})}}};
  const BimModel model = model_of(recipe);
  double glass = 0.0;
  double frame = 0.0;
  for (const BimPart& part : parts_of(model))
    (part.element == Element::glass ? glass : frame) += area(part.outline);
  EXPECT_NEAR(glass, 2.0 * 1.08 * 1.38, 1e-4);
  EXPECT_NEAR(frame, 2.0 * (1.2 * 1.5 - 1.08 * 1.38) + 2.0 * 0.1 * (1.2 + 1.5), 1e-4);
}

TEST(BimRooms, KnowsTheRoomsThatAreAlike) {
  const BimModel model = office();
  const std::vector<BimRoom> rooms = rooms_of(model);
  ASSERT_EQ(rooms.size(), model.spaces.size());
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const ModelRoom stated = describe(model, rooms, i);
    const bool office_room = stated.name.find(" Office") != std::string::npos;
    if (office_room) {
      EXPECT_NEAR(stated.length_m, 5.14, 1e-6);
      EXPECT_NEAR(stated.width_m, 3.6, 1e-6);
      EXPECT_NEAR(stated.height_m, 3.1, 1e-6);
      EXPECT_GE(stated.like.size(), 8U) << stated.name;
    }
    if (stated.name.find("Meeting") != std::string::npos || stated.name.find("Hall") != std::string::npos) {
      EXPECT_TRUE(stated.like.empty()) << stated.name;
    }
  }
}

TEST(BimScene, NoiseFreePointsLieOnTheTruePlanesOfTheirElements) {
  BimModel model = office();
  model.local_origin = {1051200.0, 6841900.0, 40.0};
  BimSceneOptions options = quick(5);
  options.stations = 2;
  options.any_rotation = true;
  options.as_built.on = true;
  options.scanner.noise_m = 0.0;
  options.scanner.angle_jitter_rad = 0.0;
  options.scanner.mixed_pixel_share = 0.0;
  const SimulatedCase simulated = simulate_bim(model, options);
  ASSERT_EQ(simulated.scans.size(), 2U);
  const Truth& truth = simulated.truth;
  EXPECT_EQ(truth.local_origin, model.local_origin);
  for (std::size_t s = 0; s < 2; ++s) {
    ASSERT_EQ(truth.scans[s].plane_of_point.size(), simulated.scans[s].size());
    ASSERT_EQ(truth.scans[s].element_of_point.size(), simulated.scans[s].size());
    for (std::size_t i = 0; i < simulated.scans[s].size(); ++i) {
      const int plane = truth.scans[s].plane_of_point[i];
      ASSERT_GE(plane, 0);
      const Vector3d x = truth.scans[s].local_from_scan * simulated.scans[s].points[i];
      // Planes within 1 mm count as one.
      ASSERT_LT(std::abs(truth.planes[static_cast<std::size_t>(plane)].plane.signed_distance(x)), 1.1e-3);
    }
  }
  // World coordinates are the model's.
  const Vector3d station = world_from_scan(truth, 0).translation - model.local_origin;
  EXPECT_LT((station - truth.scans[0].local_from_scan.translation).norm(), 1e-9);
}

TEST(BimScene, TheTruthTellsEveryShift) {
  const BimModel model = office();
  BimSceneOptions options = quick(3);
  options.as_built.on = true;
  options.scanner.noise_m = 0.0;
  options.scanner.angle_jitter_rad = 0.0;
  options.scanner.mixed_pixel_share = 0.0;
  const SimulatedCase simulated = simulate_bim(model, options);
  const ScanTruth& scan = simulated.truth.scans[0];
  std::vector<Vector3d> shift(model.elements.size(), Vector3d::Zero());
  std::set<int> gone;
  for (const ModelChange& change : simulated.truth.model->changes) {
    const auto element = static_cast<std::size_t>(change.element);
    if (change.state == ModelState::moved) {
      shift[element] = change.shift_m;
      EXPECT_EQ(change.guid, model.elements[element].guid);
    } else {
      gone.insert(change.element);
    }
  }
  std::size_t of_model = 0;
  for (std::size_t i = 0; i < simulated.scans[0].size(); ++i) {
    const int element = scan.element_of_point[i];
    if (element < 0) continue;
    ++of_model;
    ASSERT_EQ(gone.count(element), 0U);
    // Moved back, the point lies on a face of its element as planned.
    const Vector3d x =
        scan.local_from_scan * simulated.scans[0].points[i] - shift[static_cast<std::size_t>(element)];
    double nearest = 1e300;
    for (const BimFace& face : model.faces)
      if (face.element == element) nearest = std::min(nearest, std::abs(face.plane.signed_distance(x)));
    ASSERT_LT(nearest, 1e-7);
  }
  EXPECT_GT(of_model, 15000U);
  EXPECT_LT(of_model, simulated.scans[0].size());
  EXPECT_GT(simulated.truth.model->furniture, 0);
}

TEST(BimScene, MostOfWhatIsSeenStandsWhereItShould) {
  const BimModel model = office();
  int moved_walls = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    BimSceneOptions options = quick(seed);
    options.as_built.on = true;
    options.as_built.moved_share = 0.6;
    const SimulatedCase simulated = simulate_bim(model, options);
    std::vector<Vector3d> shift(model.elements.size(), Vector3d::Zero());
    for (const ModelChange& change : simulated.truth.model->changes) {
      shift[static_cast<std::size_t>(change.element)] = change.shift_m;
      moved_walls += change.kind == "wall" && change.state == ModelState::moved ? 1 : 0;
      // A window's own shift may add to its wall's.
      EXPECT_LT(change.shift_m.norm(), 0.11);
    }
    const ScanTruth& scan = simulated.truth.scans[0];
    for (const Vector3d& axis : {Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY())}) {
      double all = 0.0;
      double moved = 0.0;
      for (std::size_t i = 0; i < scan.plane_of_point.size(); ++i) {
        const int plane = scan.plane_of_point[i];
        const int element = scan.element_of_point[i];
        if (plane < 0 || element < 0) continue;
        const Vector3d& normal = simulated.truth.planes[static_cast<std::size_t>(plane)].plane.normal;
        if (std::abs(normal.dot(axis)) < 0.9) continue;
        // Each point represents the surface it covers.
        const Vector3d& x = simulated.scans[0].points[i];
        const double weight =
            x.squaredNorm() /
            std::max(0.1, std::abs(normal.dot(scan.local_from_scan.rotation * x.normalized())));
        all += weight;
        if (std::abs(shift[static_cast<std::size_t>(element)].dot(axis)) > 0.005) moved += weight;
      }
      EXPECT_LT(moved, 0.5 * all) << "seed " << seed;
    }
  }
  EXPECT_GT(moved_walls, 20);
}

TEST(BimScene, ChoosesRoomsAsAsked) {
  const BimModel model = office();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    BimSceneOptions options = quick(seed);
    options.room = RoomChoice::unique;
    EXPECT_TRUE(simulate_bim(model, options).truth.model->rooms[0].like.empty());
    options.room = RoomChoice::repeated;
    EXPECT_FALSE(simulate_bim(model, options).truth.model->rooms[0].like.empty());
  }
}

TEST(BimScene, StationsGoThroughAllRoomsInTurn) {
  const BimModel model = office();
  BimSceneOptions options = quick();
  options.room = RoomChoice::each;
  options.points = 2000;
  options.stations = 12;
  const Truth truth = simulate_bim(model, options).truth;
  std::set<int> rooms;
  for (const ScanTruth& scan : truth.scans) rooms.insert(scan.room);
  EXPECT_EQ(rooms.size(), 12U);
  EXPECT_EQ(rooms.count(-1), 0U);
  options.stations = 2000;
  EXPECT_THROW(simulate_bim(model, options), Error);
}

TEST(BimScene, StationsSeeOneAnotherFromOneRoomOrAnother) {
  const BimModel model = office();
  int elsewhere = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    BimSceneOptions options = quick(seed);
    options.stations = 3;
    options.points = 2000;
    options.open_door_share = 1.0;
    const Truth truth = simulate_bim(model, options).truth;
    ASSERT_EQ(truth.scans.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GE(truth.scans[i].room, 0);
      const double z = truth.scans[i].local_from_scan.translation.z();
      const double above = z > 3.4 ? z - 3.4 : z;
      EXPECT_TRUE(above > 1.39 && above < 1.81) << above;
      elsewhere += truth.scans[i].room != truth.scans[0].room ? 1 : 0;
    }
  }
  EXPECT_GT(elsewhere, 0);
}

TEST(BimScene, ModelsWithoutRoomsAreSearchedForThem) {
  BimModel model = office();
  model.spaces.clear();
  const Truth truth = simulate_bim(model, quick(2)).truth;
  const Vector3d& at = truth.scans[0].local_from_scan.translation;
  EXPECT_TRUE(at.x() > 0.36 && at.x() < 23.64 && at.y() > 0.36 && at.y() < 12.64);
  EXPECT_EQ(truth.scans[0].room, -1);
  EXPECT_GT(truth.planes.size(), 4U);
}

TEST(BimScene, IsTheSameForAnyThreadCount) {
  const BimModel model = office();
  BimSceneOptions options = quick(4);
  options.stations = 2;
  options.as_built.on = true;
  set_thread_count(1);
  const SimulatedCase one = simulate_bim(model, options);
  set_thread_count(4);
  const SimulatedCase four = simulate_bim(model, options);
  set_thread_count(0);
  for (std::size_t s = 0; s < 2; ++s) {
    ASSERT_EQ(one.scans[s].points, four.scans[s].points);
    EXPECT_EQ(to_matrix(one.truth.scans[s].local_from_scan), to_matrix(four.truth.scans[s].local_from_scan));
  }
}

TEST(BimScene, SaysWhereThereIsNoPlaceForAScanner) {
  BimRecipe recipe = closed_room();
  recipe.elements.resize(1);  // one wall in the open
  EXPECT_THROW((void)simulate_bim(model_of(recipe), quick()), Error);
  BimSceneOptions options = quick();
  options.stations = 0;
  EXPECT_THROW((void)simulate_bim(office(), options), Error);
}

TEST(BimScene, SpheresAreSeenThreeByThreeWhereTheTruthHasThem) {
  BimSceneOptions options = quick();
  options.room = RoomChoice::doorways;
  options.open_door_share = 1.0;
  options.stations = 12;
  options.points = 60000;
  options.targets = 6;
  const SimulatedCase made = simulate_bim(office(), options);
  const std::vector<SiteTarget>& targets = made.truth.model->targets;
  ASSERT_EQ(targets.size(), 6U);
  std::size_t seen_by_most[2] = {0, 0};
  for (std::size_t k = 0; k < made.scans.size(); ++k) {
    std::size_t seen[2] = {0, 0};
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const Vector3d centre = inverse(made.truth.scans[k].local_from_scan) * targets[t].centre;
      std::size_t on_it = 0;
      for (const Vector3d& x : made.scans[k].points)
        on_it += std::abs((x - centre).norm() - 0.0725) < 0.01 ? 1 : 0;
      seen[t / 3] += on_it >= 12 ? 1 : 0;
    }
    for (const std::size_t room : {0U, 1U}) seen_by_most[room] = std::max(seen_by_most[room], seen[room]);
  }
  EXPECT_EQ(seen_by_most[0], 3U);
  EXPECT_EQ(seen_by_most[1], 3U);
}

TEST(BimScene, StationsStandInDoorwaysFirst) {
  const BimModel model = office();
  BimSceneOptions options = quick();
  options.room = RoomChoice::doorways;
  options.open_door_share = 1.0;
  options.stations = 12;
  const SimulatedCase made = simulate_bim(model, options);
  std::size_t in_doors = 0;
  for (const ScanTruth& scan : made.truth.scans) {
    const Vector3d& at = scan.local_from_scan.translation;
    in_doors += std::any_of(model.openings.begin(), model.openings.end(), [&](const BimOpening& opening) {
      const Vector3d foot =
          0.5 * (opening.corners[0] + opening.corners[1]) - 0.5 * opening.thickness_m * opening.normal;
      return (foot - at).head<2>().norm() < 0.01 && at.z() - foot.z() > 1.3 && at.z() - foot.z() < 1.9;
    });
  }
  EXPECT_GE(in_doors, 8U);
}

}  // namespace
}  // namespace limen
