// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// The papers' own methods beside limen's: error and time from the four starts of 2021, Table 1, between two
// stations of one building, and between a station and the street from a start that is nearly right. Markdown.
//   bench_papers                     all of it, minutes
//   bench_papers --seeds 1 --kinds museum --points-outdoor 400000
#include <array>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/register/register.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

struct Settings {
  std::vector<std::string> kinds = {"museum", "townhouse"};
  std::uint64_t first_seed = 1;
  int seeds = 2;
  std::size_t points_indoor = 100000;
  std::size_t points_outdoor = 1000000;
};

/// How far a start is off.
struct Start {
  double shift_m = 0.0;
  double turn_deg = 0.0;
};

/// 2021, Table 1.
constexpr std::array<Start, 4> kTable1 = {{{0.099, 0.001}, {0.44, 0.528}, {1.27, 3.0}, {4.15, 12.0}}};

/// Two scans, the true pose between them, and from where the source was taken.
struct Case {
  std::string name;
  Scan source;
  Scan target;
  Rigid3 truth;  // target from source, world
  Vector3d station = Vector3d::Zero();
};

Vector3d any_direction(RandomStream& random) {
  return normal_vector(random).normalized();
}

/// The source put where it belongs, but for `start`: turned about its station and shifted, any way.
Case started(const SimulatedCase& made, std::size_t source, std::size_t target, const Start& start,
             RandomStream& random) {
  Case at;
  at.source = made.scans.at(source);
  at.target = made.scans.at(target);
  const Rigid3 truth = true_target_from_source(made.truth, source, target);
  const Vector3d station = truth * (at.source.centre(0) + at.source.local_origin);
  const Matrix3d turn = rotation_exp(radians(start.turn_deg) * any_direction(random));
  const Rigid3 off{turn, station - turn * station + start.shift_m * any_direction(random)};
  const Rigid3 placed = off * truth;
  const Vector3d origin = placed * at.source.local_origin;
  for (Vector3d& x : at.source.points) x = placed.rotation * x;
  for (Vector3d& x : at.source.centres) x = placed.rotation * x;
  at.source.local_origin = origin;
  at.truth = inverse(off);
  at.station = at.source.centre(0) + origin;
  return at;
}

/// One line of the table: `registered` in bold, for only that is a claim.
void print_row(const Case& at, const std::string& method, const RegistrationResult& result, double seconds) {
  std::string error = "| | |";
  if (result.outcome != Outcome::no_match) {
    const Rigid3& pose = result.best.target_from_source;
    error = fmt::format("| {:.4f} m | {:.3f}° |", (pose * at.station - at.truth * at.station).norm(),
                        degrees(rotation_angle(at.truth.rotation.transpose() * pose.rotation)));
  }
  const bool claimed = result.outcome == Outcome::registered;
  fmt::print("| {} | {} | {}{}{} {} {:.1f} s |\n", at.name, method, claimed ? "**" : "",
             to_string(result.outcome), claimed ? "**" : "", error, seconds);
  std::fflush(stdout);
}

void run_one(const Case& at, const std::string& name, const RegisterOptions& options) {
  // Processor time of all threads: it does not depend on what else the machine does.
  const std::clock_t start = std::clock();
  const RegistrationResult result = register_scans(at.source, at.target, options);
  print_row(at, name, result, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
}

/// Every published method, then `auto`, each from the points on.
void run_all(const Case& at) {
  for (const auto& [method, name] : kPublishedMethods) {
    RegisterOptions options;
    options.as_published = method;
    run_one(at, name, options);
  }
  run_one(at, "auto", {});
}

void print_head(const char* title) {
  fmt::print(
      "\n{}\n\n| case | method | outcome | shift off | turn off | processor time "
      "|\n|---|---|---|---|---|---|\n",
      title);
}

void table1(const Settings& settings) {
  print_head("Two stations of one room, from the starts of 2021, Table 1");
  SceneOptions scene;
  scene.name = "room";
  scene.seed = settings.first_seed;
  scene.points_indoor = settings.points_indoor;
  const SimulatedCase made = simulate(scene);
  for (std::size_t row = 0; row < kTable1.size(); ++row) {
    RandomStream random(settings.first_seed, row);
    Case at = started(made, 0, 1, kTable1[row], random);
    at.name = fmt::format("{} m, {}°", kTable1[row].shift_m, kTable1[row].turn_deg);
    run_all(at);
  }
}

void indoor_outdoor(const Settings& settings) {
  print_head("A station and the street, from starts 0.44 m and 0.528° off");
  for (const std::string& kind : settings.kinds) {
    for (int i = 0; i < settings.seeds; ++i) {
      SceneOptions scene;
      scene.name = kind;
      scene.seed = settings.first_seed + static_cast<std::uint64_t>(i);
      scene.stations = 1;
      scene.facades = 2;  // the room has open windows in two façades
      scene.curtain_share = 0.1;
      scene.points_indoor = settings.points_indoor;
      scene.points_outdoor = settings.points_outdoor;
      const SimulatedCase made = simulate(scene);
      RandomStream random(scene.seed, 100);
      Case at = started(made, 0, made.scans.size() - 1, kTable1[1], random);
      at.name = fmt::format("{} {}", kind, scene.seed);
      run_all(at);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("The papers' own methods beside limen's");
  app.add_option("--kinds", settings.kinds, "kinds of building, indoor x outdoor")->delimiter(',');
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "pairs per kind of building");
  app.add_option("--points-indoor", settings.points_indoor, "points of a station");
  app.add_option("--points-outdoor", settings.points_outdoor, "points of the street scan");
  CLI11_PARSE(app, argc, argv);
  try {
    table1(settings);
    indoor_outdoor(settings);
  } catch (const Error& error) {
    fmt::print(stderr, "bench_papers: {}\n", error.what());
    return 2;
  }
  return 0;
}
