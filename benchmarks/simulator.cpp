// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Rays per second of the simulator's scanners: every pulse followed through panes and doorways, with its
// noise, losses and the count of what was seen (items_per_second is pulses per second).
#include <benchmark/benchmark.h>

#include "limen/simulate/recipes.h"
#include "limen/simulate/stations.h"

namespace {

limen::Recipe museum() {
  limen::SceneOptions options;
  options.name = "museum";
  return limen::make_recipe(options);
}

void run(benchmark::State& state, const limen::Recipe& recipe, const limen::RayCaster& caster,
         const limen::ScanPattern& pattern) {
  std::size_t echoes = 0;
  for (auto _ : state)
    echoes = limen::sweep(caster, recipe.world.openings, pattern, limen::ScannerOptions{}, 1).echoes.size();
  const auto pulses = static_cast<double>(pattern.lines * pattern.pulses_per_line);
  state.SetItemsProcessed(static_cast<std::int64_t>(static_cast<double>(state.iterations()) * pulses));
  state.counters["echoes"] = static_cast<double>(echoes);
  state.counters["triangles"] = static_cast<double>(recipe.world.mesh.triangles().size());
}

void station_in_a_museum(benchmark::State& state) {
  const limen::Recipe recipe = museum();
  const limen::RayCaster caster(recipe.world.mesh);
  limen::RandomStream random(1);
  const limen::Station station = limen::place_stations(recipe, caster, random).front();
  run(state, recipe, caster,
      limen::station_pattern({limen::Matrix3d::Identity(), station.position}, 1000000));
}

void street_scan_of_a_museum(benchmark::State& state) {
  const limen::Recipe recipe = museum();
  const limen::RayCaster caster(recipe.world.mesh);
  run(state, recipe, caster, limen::profiler_pattern(*recipe.path, recipe.head_turns_rad, 1000000));
}

void building_a_museum(benchmark::State& state) {
  for (auto _ : state) {
    const limen::Recipe recipe = museum();
    const limen::RayCaster caster(recipe.world.mesh);
    benchmark::DoNotOptimize(caster.mesh().triangles().size());
  }
}

BENCHMARK(station_in_a_museum)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(street_scan_of_a_museum)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(building_a_museum)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
