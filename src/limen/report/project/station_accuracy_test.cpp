// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/station_accuracy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/report/project/project_sheets.h"

namespace limen {
namespace {

ProjectScan scan_known_to(double sigma_m, const std::string& file) {
  ProjectScan scan;
  scan.file = file;
  scan.component = 0;
  scan.state = NodeState::registered;
  scan.frame_from_scan = Rigid3{};
  scan.sigma.covariance = Matrix6d::Identity() * sigma_m * sigma_m;
  scan.sigma.covariance(2, 2) = radians(0.01) * radians(0.01);
  scan.sigma.translation_m = Vector3d::Constant(sigma_m);
  return scan;
}

ProjectResult three_scans() {
  ProjectResult result;
  result.scans = {scan_known_to(0.0, "a.ply"), scan_known_to(0.001, "b.ply"), scan_known_to(0.004, "=c.ply")};
  result.sigma_scan = 0;
  result.tolerance_m = 0.006;
  ProjectLink loop;
  loop.source = 1;
  loop.target = 0;
  loop.solved.state = LinkState::verified;
  loop.solved.loop_error_m = 0.002;
  ProjectLink single = loop;
  single.source = 2;
  single.solved.state = LinkState::bridge;
  result.links = {loop, single};
  result.loops.push_back({{0}, 0.0, 0.0, 0.0, true});
  return result;
}

TEST(StationAccuracy, IsTheRadiusOf95PercentWithItsClass) {
  const ProjectResult result = three_scans();
  const std::optional<StationAccuracy> good = accuracy_of(result, 1);
  ASSERT_TRUE(good.has_value());
  // Of three equal deviations: 2.795.
  EXPECT_NEAR(good->radius_m, 0.0028, 0.0001);
  EXPECT_NEAR(degrees(good->heading_sigma_rad), 0.01, 1e-9);
  EXPECT_EQ(good->loa, 40);
  EXPECT_EQ(good->within_tolerance, std::optional(true));
  EXPECT_EQ(accuracy_of(result, 2)->loa, 30);
  EXPECT_EQ(accuracy_of(result, 2)->within_tolerance, std::optional(false));
}

TEST(StationAccuracy, TheReferenceIsHeldFixedAndWhatIsInNoFrameHasNone) {
  ProjectResult result = three_scans();
  EXPECT_TRUE(accuracy_of(result, 0)->held_fixed);
  result.scans[1].frame_from_scan.reset();
  EXPECT_FALSE(accuracy_of(result, 1).has_value());
}

TEST(StationAccuracy, ALinkThatNoLoopChecksNeitherPassesNorFails) {
  const ProjectResult result = three_scans();
  EXPECT_EQ(within_tolerance(result, result.links[0]), std::optional(true));
  EXPECT_FALSE(within_tolerance(result, result.links[1]).has_value());
}

TEST(StationAccuracy, OverlapIsAShareOfTheSmallerScan) {
  ProjectResult result = three_scans();
  EXPECT_FALSE(overlap_of(result, 0).has_value());
  result.scans[0].surface_m2 = 40.0;
  result.scans[1].surface_m2 = 20.0;
  result.links[0].matches = {{0, 0, 0.003, 0.0, 3.0}, {1, 2, -0.001, 0.0, 2.0}};
  EXPECT_NEAR(overlap_of(result, 0).value_or(0.0), 0.25, 1e-12);
}

TEST(StationAccuracy, TheBundleErrorIsWeightedByOverlapAndNamesTheWorstLink) {
  ProjectResult result = three_scans();
  EXPECT_FALSE(bundle_error(result).has_value());
  EXPECT_TRUE(bundle_sheet(result).rows.empty());
  result.links[0].adjusted = {{0, 0, 0.001, 0.0, 3.0}};
  result.links[1].adjusted = {{0, 0, -0.003, 0.0, 1.0}, {1, 1, 0.003, 0.0, 1.0}};
  const std::optional<BundleError> error = bundle_error(result);
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->rms_m, std::sqrt((3.0 * 1e-6 + 2.0 * 9e-6) / 5.0), 1e-12);
  EXPECT_EQ(error->planes, 3U);
  EXPECT_EQ(error->worst, 1U);
  EXPECT_NEAR(error->worst_rms_m, 0.003, 1e-12);
  EXPECT_NE(csv_of(bundle_sheet(result)).find("\n0.00205,3,"), std::string::npos);
}

TEST(StationAccuracy, TheWorstComesFirst) {
  ProjectResult result = three_scans();
  result.scans.push_back(scan_known_to(0.001, "d.ply"));
  result.scans.back().state = NodeState::ambiguous;
  EXPECT_EQ(worst_scans_first(result), std::vector<std::size_t>({3, 2, 1, 0}));
  ProjectLink better = result.links[0];
  better.solved.loop_error_m = 0.001;
  ProjectLink rejected = result.links[0];
  rejected.solved.state = LinkState::rejected;
  result.links = {rejected, better, better, result.links[0], result.links[1]};
  EXPECT_EQ(worst_links_first(result), std::vector<std::size_t>({4, 3, 1, 2, 0}));
}

TEST(StationAccuracy, AWeakLinkThatNothingChecksHasNoResidual) {
  ProjectLink weak;
  weak.solved.pose = 0;
  EXPECT_FALSE(is_checked(weak));
  weak.solved.redundancy = 1.5;
  EXPECT_TRUE(is_checked(weak));
  ProjectLink rejected;
  rejected.solved.state = LinkState::rejected;
  EXPECT_FALSE(is_checked(rejected)) << "its ends are not joined";
  rejected.solved.loop_error_m = 6.9;
  EXPECT_TRUE(is_checked(rejected));
}

TEST(StationAccuracy, SheetsHaveARowForEachAndNoResidualOfAnUncheckedLink) {
  const ProjectResult result = three_scans();
  const std::string stations = csv_of(stations_sheet(result));
  EXPECT_NE(stations.find("a.ply,registered,0,,,,yes,"), std::string::npos) << stations;
  EXPECT_NE(stations.find(",LOA40,yes,"), std::string::npos) << stations;
  EXPECT_EQ(stations.find("\n=c.ply"), std::string::npos) << "a spreadsheet would take it for a formula";
  const std::string links = csv_of(links_sheet(result));
  EXPECT_NE(links.find("0,b.ply,a.ply,verified,0.00,,,,0.00200,0.00000,yes,0.00,1,"), std::string::npos)
      << links;
  EXPECT_NE(links.find(",bridge,0.00,,,,,,,0.00,0,"), std::string::npos) << links;
  EXPECT_EQ(loops_sheet(result).rows.size(), 1U);
  EXPECT_TRUE(points_sheet(result).rows.empty());
}

}  // namespace
}  // namespace limen
