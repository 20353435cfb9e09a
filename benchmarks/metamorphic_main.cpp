// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What must not change the answer: a scan moved, turned, its points in another order, renamed, thinned at
// random, or with stray points among its own is the same scan. One line per law: how often the outcome and
// the planes are those of the scan as it was given, and how far apart the poses are, in standard deviations
// as stated for that one (the largest of six).
//   bench_metamorphic --scene room --seeds 2 --runs 4
//   bench_metamorphic --pair a.ply b.ply --pair c.ply d.ply --runs 20 --laws turn,permute
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/register/register.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

struct Settings {
  std::vector<std::string> scenes;
  std::vector<std::pair<std::string, std::string>> pairs;
  std::vector<std::string> laws = {"shift",  "turn", "heading", "permute",
                                   "rename", "half", "quarter", "stray"};
  int first_seed = 1;
  int seeds = 1;
  int runs = 2;
  std::size_t source = 0;
  std::size_t target = 1;
  std::size_t points_indoor = 0;
  std::size_t points_outdoor = 0;
  std::string gravity = "auto";
};

struct Pair {
  std::string name;
  Scan source;
  Scan target;
};

/// A scan that should be taken for another, and where it went: world to world.
struct Changed {
  Scan scan;
  Rigid3 changed_from_given;
};

/// Coordinates as a file of 32-bit numbers keeps them.
Scan as_filed(Scan scan) {
  for (Vector3d& x : scan.points) x = x.cast<float>().cast<double>();
  return scan;
}

Scan with_order(const Scan& scan, RandomStream& stream) {
  std::vector<std::uint32_t> order(scan.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint32_t i = static_cast<std::uint32_t>(order.size()); i > 1; --i)
    std::swap(order[i - 1], order[stream.below(i)]);
  return subset(scan, order);
}

Scan thinned_at_random(const Scan& scan, double share, RandomStream& stream) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    if (stream.uniform(0.0, 1.0) < share) kept.push_back(i);
  }
  return subset(scan, kept);
}

/// One point in a hundred is replaced by one anywhere in the box round the scan.
Scan with_strays(Scan scan, RandomStream& stream) {
  const Extent extent = extent_of(scan.points);
  for (Vector3d& x : scan.points) {
    if (stream.uniform(0.0, 1.0) >= 0.01) continue;
    for (Eigen::Index k = 0; k < 3; ++k) x[k] = stream.uniform(extent.low[k], extent.high[k]);
  }
  return scan;
}

Changed moved_somewhere(const Scan& scan, const Matrix3d& rotation, RandomStream& stream) {
  Rigid3 motion{rotation, {}};
  for (Eigen::Index k = 0; k < 3; ++k) motion.translation[k] = stream.uniform(-20.0, 20.0);
  return {as_filed(moved(scan, motion)), to_world(motion, scan.local_origin, scan.local_origin)};
}

Changed changed(const Scan& scan, const std::string& law, RandomStream stream) {
  if (law == "shift") return moved_somewhere(scan, Matrix3d::Identity(), stream);
  if (law == "heading") {
    const double angle = stream.uniform(-std::numbers::pi, std::numbers::pi);
    return moved_somewhere(scan, rotation_exp({0.0, 0.0, angle}), stream);
  }
  if (law == "turn") {
    return moved_somewhere(scan, uniform_rotation(stream), stream);
  }
  if (law == "permute") return {with_order(scan, stream), {}};
  if (law == "half") return {thinned_at_random(scan, 0.5, stream), {}};
  if (law == "quarter") return {thinned_at_random(scan, 0.25, stream), {}};
  if (law == "stray") return {with_strays(scan, stream), {}};
  Changed renamed{scan, {}};
  renamed.scan.name = "other";
  return renamed;
}

RegisterOptions options_of(const Settings& settings) {
  RegisterOptions options;
  options.picture = true;
  if (settings.gravity == "unknown") options.gravity = Gravity::unknown;
  if (settings.gravity == "up") options.gravity = Gravity::up;
  return options;
}

/// The largest of the six differences of two poses, in standard deviations of the first.
double apart_sigma(const RegistrationResult& given, const Rigid3& other) {
  const Rigid3 off = other * inverse(given.best.target_from_source);
  const Vector3d turn = rotation_log(off.rotation);
  const Vector3d shift = off * given.sigma.centre - given.sigma.centre;
  double worst = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    worst = std::max({worst, std::abs(turn[k]) / std::max(1e-12, given.sigma.rotation_rad[k]),
                      std::abs(shift[k]) / std::max(1e-12, given.sigma.translation_m[k])});
  }
  return worst;
}

struct Tally {
  int runs = 0;
  int same_outcome = 0;
  int same_planes = 0;
  int same_openings = 0;
  std::vector<double> apart;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void hold(const Pair& pair, const Settings& settings, std::vector<Tally>& tallies) {
  const RegistrationResult given = register_scans(pair.source, pair.target, options_of(settings));
  fmt::print("{}: {}, {} planes, {} openings\n", pair.name, to_string(given.outcome),
             given.picture->source.features.planes.size(), given.picture->source.features.openings.size());
  for (std::size_t l = 0; l < settings.laws.size(); ++l) {
    for (int run = 0; run < settings.runs; ++run) {
      const Changed other =
          changed(pair.source, settings.laws[l], RandomStream(17 + l, static_cast<std::uint64_t>(run)));
      const RegistrationResult result = register_scans(other.scan, pair.target, options_of(settings));
      const Features& before = given.picture->source.features;
      const Features& after = result.picture->source.features;
      Tally& tally = tallies[l];
      ++tally.runs;
      tally.same_outcome += result.outcome == given.outcome ? 1 : 0;
      tally.same_planes += before.planes.size() == after.planes.size() ? 1 : 0;
      tally.same_openings += before.openings.size() == after.openings.size() ? 1 : 0;
      double apart = -1.0;
      if (result.outcome == Outcome::registered && given.outcome == Outcome::registered) {
        apart = apart_sigma(given, result.best.target_from_source * other.changed_from_given);
        tally.apart.push_back(apart);
      }
      fmt::print("  {} {}: {}, {} planes, {} openings, {:.3f} sigma apart\n", settings.laws[l], run,
                 to_string(result.outcome), after.planes.size(), after.openings.size(), apart);
      std::fflush(stdout);
    }
  }
}

void print_table(const Settings& settings, const std::vector<Tally>& tallies) {
  fmt::print(
      "\n| law | runs | same outcome | as many planes | openings | apart, sigma: median | 95 % | most |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (std::size_t l = 0; l < settings.laws.size(); ++l) {
    const Tally& it = tallies[l];
    fmt::print("| {} | {} | {} | {} | {} | {:.3f} | {:.3f} | {:.3f} |\n", settings.laws[l], it.runs,
               it.same_outcome, it.same_planes, it.same_openings, quantile(it.apart, 0.5),
               quantile(it.apart, 0.95), quantile(it.apart, 1.0));
  }
}

Pair simulated(const std::string& scene, int seed, const Settings& settings) {
  SceneOptions options;
  options.name = scene;
  options.seed = static_cast<std::uint64_t>(seed);
  options.points_indoor = settings.points_indoor;
  options.points_outdoor = settings.points_outdoor;
  const SimulatedCase simulated = simulate(options);
  return {fmt::format("{} {}", scene, seed), simulated.scans.at(settings.source),
          simulated.scans.at(settings.target)};
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("What must not change the answer of a registration");
  app.add_option("--scene", settings.scenes, "built-in scenes");
  app.add_option("--pair", settings.pairs, "two files of scans; several times");
  app.add_option("--laws", settings.laws, "shift, heading, turn, permute, rename, half, quarter, stray")
      ->delimiter(',');
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of buildings per scene");
  app.add_option("--runs", settings.runs, "runs per law and pair");
  app.add_option("--source", settings.source, "index of the source scan");
  app.add_option("--target", settings.target, "index of the target scan");
  app.add_option("--points-indoor", settings.points_indoor, "points of a station");
  app.add_option("--points-outdoor", settings.points_outdoor, "points of a mobile scan");
  app.add_option("--gravity", settings.gravity, "up, unknown or auto");
  CLI11_PARSE(app, argc, argv);
  std::vector<Tally> tallies(settings.laws.size());
  for (const std::string& scene : settings.scenes) {
    for (int k = 0; k < settings.seeds; ++k)
      hold(simulated(scene, settings.first_seed + k, settings), settings, tallies);
  }
  for (const auto& [source, target] : settings.pairs)
    hold({source, read_scan(source), read_scan(target)}, settings, tallies);
  print_table(settings, tallies);
  return 0;
}
