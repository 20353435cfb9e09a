// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/panorama_look.h"

#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "limen/sight/joined_space.h"
#include "limen/sight/panorama.h"

namespace limen {
namespace {

constexpr int kFacets = 12;

/// A room of random planes, seen from `centre` in pixels that each hold any of them, or clutter, or nothing.
struct RandomView {
  Features features;
  std::shared_ptr<const Panorama> view;

  RandomView(unsigned seed, const Vector3d& centre) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::uniform_int_distribution<int> label(-1, kFacets - 1);
    for (int i = 0; i < kFacets; ++i) {
      PlanarPolygon polygon;
      const Vector3d normal = Vector3d(unit(random), unit(random), unit(random)).normalized();
      polygon.plane = {normal, 3.0 + unit(random)};
      polygon.oriented = i % 2 == 0;
      features.planes.push_back(polygon);
    }
    PanoramaState state;
    state.centre = centre;
    state.edge = 24;
    for (std::size_t k = 0; k < 6 * 24 * 24; ++k) {
      const bool empty = k % 9 == 0;
      const auto near = static_cast<float>(3.0 + unit(random));
      const int plane = label(random);
      state.near_m.push_back(empty ? 0.0F : near);
      state.far_m.push_back(empty ? 0.0F : near + (k % 3 == 0 ? 0.4F : 0.0F));
      state.near_plane.push_back(empty ? -1 : plane);
      state.far_plane.push_back(empty ? -1 : k % 3 == 0 ? label(random) : plane);
    }
    view = std::make_shared<Panorama>(state, features);
  }
};

/// Pieces everywhere about the room, planar ones with a plane's own normal, so that many meet it.
SurfaceColumns random_pieces(const Features& features, std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  SurfaceColumns pieces;
  for (std::size_t k = 0; k < count; ++k) {
    SurfaceSample sample;
    sample.mean = 4.0 * Vector3d(unit(random), unit(random), unit(random));
    if (k % 3 != 0) {
      sample.plane = static_cast<std::int32_t>(k % kFacets);
      const Plane& plane = features.planes[k % kFacets].plane;
      sample.normal = plane.normal;
      sample.mean -= (plane.signed_distance(sample.mean) - 0.07 * unit(random)) * plane.normal;
    }
    pieces.add(sample, k % 2 == 0);
  }
  return pieces;
}

struct Tally {
  std::size_t apart = 0;
  std::size_t surface = 0;
  std::size_t free = 0;
  std::size_t hidden = 0;
};

/// Compares a view's own look at many pieces with the look that SpaceView takes at one after the other.
Tally compare(const SpaceView& view, const SurfaceColumns& pieces, const Rigid3& pose) {
  Tally tally;
  const LookTolerances tolerances{0.05, 0.075, 0.10};
  for (std::size_t begin = 0; begin < pieces.size(); begin += kLookBatch) {
    const std::size_t size = std::min(kLookBatch, pieces.size() - begin);
    Looks together;
    Looks singly;
    view.look_at_surface(pieces, begin, size, pose, tolerances, together);
    view.SpaceView::look_at_surface(pieces, begin, size, pose, tolerances, singly);
    for (std::size_t k = 0; k < size; ++k) {
      const auto kind = static_cast<SightKind>(singly.kind[k]);
      tally.surface += kind == SightKind::surface ? 1 : 0;
      tally.free += kind == SightKind::free ? 1 : 0;
      tally.hidden += kind == SightKind::hidden ? 1 : 0;
      const bool off =
          kind == SightKind::surface && !(std::abs(together.distance_m[k] - singly.distance_m[k]) < 1e-5F);
      tally.apart +=
          together.kind[k] != singly.kind[k] || together.plane[k] != singly.plane[k] || off ? 1 : 0;
    }
  }
  return tally;
}

Rigid3 some_pose() {
  Rigid3 pose;
  pose.rotation = Eigen::AngleAxisd(0.7, Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  pose.translation = {0.2, -0.1, 0.3};
  return pose;
}

TEST(PanoramaLook, SaysTogetherWhatItSaysOneByOne) {
  const RandomView room(1, {0.1, 0.2, -0.1});
  const SurfaceColumns pieces = random_pieces(room.features, 200003);
  for (const Rigid3& pose : {Rigid3{}, some_pose()}) {
    const Tally tally = compare(*room.view, pieces, pose);
    // In single precision a piece at the border of a pixel may fall into its neighbour.
    EXPECT_LE(tally.apart, 40U);
    EXPECT_GT(tally.surface, 250U);
    EXPECT_GT(tally.free, 1000U);
    EXPECT_GT(tally.hidden, 1000U);
  }
}

TEST(PanoramaLook, SeveralScannersAnswerAsOne) {
  const RandomView first(1, {0.1, 0.2, -0.1});
  const RandomView second(2, {1.0, -0.5, 0.0});
  std::vector<std::int32_t> joint(kFacets);
  for (int i = 0; i < kFacets; ++i) joint[static_cast<std::size_t>(i)] = i;
  const JoinedSpace both({{first.view, joint}, {second.view, joint}});
  const Tally tally = compare(both, random_pieces(first.features, 200003), some_pose());
  EXPECT_LE(tally.apart, 80U);
  EXPECT_GT(tally.surface, 250U);
}

TEST(PanoramaLook, ThePlaceOfTheScannerIsFree) {
  const RandomView room(1, Vector3d::Zero());
  SurfaceColumns pieces;
  SurfaceSample sample;
  pieces.add(sample, false);
  Looks looks;
  room.view->look_at_surface(pieces, 0, 1, {}, {}, looks);
  EXPECT_EQ(static_cast<SightKind>(looks.kind[0]), SightKind::free);
}

}  // namespace
}  // namespace limen
