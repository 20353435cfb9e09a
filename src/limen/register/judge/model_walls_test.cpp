// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/model_walls.h"

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/rigid.h"
#include "limen/model/result.h"
#include "limen/register/prepare/prepare_model.h"
#include "limen/register/register.h"
#include "limen/simulate/model/bim_recipe.h"
#include "limen/simulate/model/bim_scene.h"

namespace limen {
namespace {

/// A furnished room of the built-in office, its scan, and the model made ready.
struct Furnished {
  SimulatedCase made;
  PreparedScan model;

  Furnished() {
    const BimModel office = model_of(office_recipe());
    BimSceneOptions options;
    options.seed = 4;
    options.as_built.on = true;
    options.as_built.hidden_wall_share = 0.5;
    made = simulate_bim(office, options);
    model = prepare_model(office);
  }
};

const Furnished& furnished() {
  static const Furnished made;
  return made;
}

/// The walls under the true pose, or that pose shifted, of a scan that may have been moved beforehand.
WallBalance balance(const Scan& scan, const Rigid3& true_from_given, const Vector3d& shift) {
  PreparedScan prepared = prepare_scan(scan, prepare_options({}));
  const Rigid3 world_from_scan_now = world_from_scan(furnished().made.truth, 0) * true_from_given;
  const Vector3d from = prepared.extracted.features.local_origin;
  Rigid3 pose;
  pose.rotation = world_from_scan_now.rotation * prepared.upright_from_scan.transpose();
  pose.translation = world_from_scan_now * from - furnished().model.extracted.features.local_origin + shift;
  return ModelWalls(prepared.view(), furnished().model.view()).under(pose);
}

TEST(ModelWalls, AreTheModelsWhereThePoseIsRightHoweverMuchFurnitureStandsThere) {
  const Scan& scan = furnished().made.scans.front();
  const WallBalance right = balance(scan, {}, Vector3d::Zero());
  EXPECT_GT(right.asked, 3.0);
  EXPECT_GT(right.share(), 0.65);
  EXPECT_LT(balance(scan, {}, Vector3d(1.3, 0.9, 0.0)).share(), 0.35);
}

TEST(ModelWalls, DoNotChangeWithHowDenselyTheScanWasTaken) {
  const Scan& scan = furnished().made.scans.front();
  RandomStream stream(8);
  std::vector<std::uint32_t> half;
  for (std::uint32_t i = 0; i < scan.size(); ++i)
    if (stream.uniform() < 0.5) half.push_back(i);
  const WallBalance whole = balance(scan, {}, Vector3d::Zero());
  const WallBalance thinned = balance(subset(scan, half), {}, Vector3d::Zero());
  EXPECT_NEAR(thinned.share(), whole.share(), 0.08);
  EXPECT_NEAR(thinned.asked, whole.asked, 0.12 * whole.asked);
}

TEST(ModelWalls, DoNotChangeWithTheFrameTheScanIsGivenIn) {
  const Scan& scan = furnished().made.scans.front();
  const Rigid3 motion{rotation_exp(Vector3d(0.7, -1.1, 2.0)), Vector3d(4.0, -7.0, 2.0)};
  const WallBalance given = balance(scan, {}, Vector3d::Zero());
  const WallBalance turned = balance(moved(scan, motion), inverse(motion), Vector3d::Zero());
  EXPECT_NEAR(turned.share(), given.share(), 0.02);
  EXPECT_NEAR(turned.asked, given.asked, 0.03 * given.asked);
}

}  // namespace
}  // namespace limen
