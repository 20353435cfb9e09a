// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernels by themselves, on simulated scans: planes, polygons, ray tracing, matching.
#include <benchmark/benchmark.h>

#include "limen/base/random.h"
#include "limen/extract/features/extract_features.h"
#include "limen/geometry/alpha_shape.h"
#include "limen/match/planes/enumerate_poses.h"
#include "limen/register/judge/score_pose.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/register/refine/refine_pose.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

const SimulatedCase& room() {
  static const SimulatedCase simulated = simulate({});
  return simulated;
}

const SimulatedCase& museum() {
  static const SimulatedCase simulated = [] {
    SceneOptions options;
    options.name = "museum";
    options.stations = 1;
    return simulate(options);
  }();
  return simulated;
}

void points_per_second(benchmark::State& state, const Scan& scan) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scan.size()));
}

void planes_of_a_room(benchmark::State& state) {
  const Scan& scan = room().scans[0];
  for (auto _ : state) benchmark::DoNotOptimize(grow_planes(scan));
  points_per_second(state, scan);
}

void features_of_a_room(benchmark::State& state) {
  const Scan& scan = room().scans[0];
  for (auto _ : state) benchmark::DoNotOptimize(extract_features(scan));
  points_per_second(state, scan);
}

void polygons_of_a_room(benchmark::State& state) {
  const Scan& scan = room().scans[0];
  const PlaneLabels labels = grow_planes(scan).planes;
  for (auto _ : state) benchmark::DoNotOptimize(make_polygons(scan, labels));
  points_per_second(state, scan);
}

void alpha_shape_of_a_wall(benchmark::State& state) {
  const bool thin = state.range(0) != 0;
  RandomStream stream(1);
  std::vector<Vector2d> points(100000);
  for (Vector2d& p : points) p = {stream.uniform(0, 5), stream.uniform(0, 3)};
  AlphaShapeOptions options;
  options.alpha_m = 0.2;
  options.thin = thin;
  for (auto _ : state) benchmark::DoNotOptimize(alpha_shape(points, options));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void interior_points_of_a_street(benchmark::State& state) {
  const Scan& scan = museum().scans.back();
  const std::vector<PlanarPolygon> planes = make_polygons(scan, grow_planes(scan).planes);
  const std::vector<int> facades = find_facades(planes, Vector3d::UnitZ());
  for (auto _ : state) benchmark::DoNotOptimize(find_interior_points(scan, planes, facades));
  points_per_second(state, scan);
}

void poses_of_two_stations(benchmark::State& state) {
  const Features source = extract_features(room().scans[0]).features;
  const Features target = extract_features(room().scans[1]).features;
  PoseEnumerationOptions options;
  options.gravity_known = state.range(0) != 0;
  for (auto _ : state) benchmark::DoNotOptimize(enumerate_poses(source, target, options));
}

void score_of_a_pose(benchmark::State& state) {
  const PreparedScan source = prepare_scan(room().scans[0], {});
  const PreparedScan target = prepare_scan(room().scans[1], {});
  for (auto _ : state) benchmark::DoNotOptimize(score_pose(source.view(), target.view(), {}, {}));
  const std::size_t samples =
      source.extracted.features.samples.size() + target.extracted.features.samples.size();
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}

void refinement_of_a_pose(benchmark::State& state) {
  const PreparedScan source = prepare_scan(room().scans[0], {});
  const PreparedScan target = prepare_scan(room().scans[1], {});
  const Rigid3 truth = true_target_from_source(room().truth, 0, 1);
  for (auto _ : state) benchmark::DoNotOptimize(refine_pose(source.view(), target.view(), truth, {}));
}

BENCHMARK(planes_of_a_room)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(features_of_a_room)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(polygons_of_a_room)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(alpha_shape_of_a_wall)
    ->ArgName("thin")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(interior_points_of_a_street)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(poses_of_two_stations)
    ->ArgName("level")
    ->Arg(1)
    ->Arg(0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(score_of_a_pose)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(refinement_of_a_pose)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
