// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Accuracy against exact truth: scenes x seeds x starting poses, one line of CSV each, and a summary.
//   bench_accuracy --scene room --seeds 5 --poses 20 --gravity unknown
// or on files whose true pose is known (4 x 4 text; without: the identity), the source moved at random:
//   bench_accuracy --source-file a.ply --target-file b.ply --truth-file pose.txt --poses 20
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/register/register.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

struct Settings {
  std::string scene = "room";
  std::string gravity = "unknown";
  int first_seed = 1;
  int seeds = 3;
  int poses = 4;
  std::size_t source = 0;
  std::size_t target = 1;
  std::size_t points_indoor = 0;
  std::size_t points_outdoor = 0;
  int facades = 0;
  bool table1 = false;
  std::string source_file;
  std::string target_file;
  std::string truth_file;
  double wrong_m = 0.05;
  double wrong_deg = 0.5;
};

struct Row {
  Outcome outcome = Outcome::no_match;
  double rotation_deg = 0.0;
  double translation_m = 0.0;
  double seconds = 0.0;
  double worst_sigma = 0.0;  ///< the largest of the six errors, in standard deviations
};

/// A random rotation (all of them, or about z) and a shift of up to 20 m.
Rigid3 random_pose(std::uint64_t seed, std::uint64_t trial, bool level) {
  RandomStream stream(seed, 1000 + trial);
  Rigid3 pose;
  if (level) {
    pose.rotation = rotation_exp({0, 0, stream.uniform(-3.14159, 3.14159)});
  } else {
    pose.rotation = uniform_rotation(stream);
  }
  pose.translation = {stream.uniform(-20, 20), stream.uniform(-20, 20), stream.uniform(-20, 20)};
  return pose;
}

/// The four starts of 2021, Table 1: metres and degrees off the true pose.
Rigid3 table1_pose(std::uint64_t seed, std::size_t row) {
  static constexpr std::array<std::array<double, 2>, 4> kRows = {
      {{0.099, 0.001}, {0.44, 0.528}, {1.27, 3.0}, {4.15, 12.0}}};
  RandomStream stream(seed, row);
  const Vector3d axis = normal_vector(stream).normalized();
  const Vector3d way = normal_vector(stream).normalized();
  return {rotation_exp(radians(kRows[row % 4][1]) * axis), kRows[row % 4][0] * way};
}

Row run(const Scan& source, const Scan& target, const Rigid3& truth, const Settings& settings) {
  RegisterOptions options;
  if (settings.gravity == "unknown") options.gravity = Gravity::unknown;
  if (settings.gravity == "up") options.gravity = Gravity::up;
  const auto start = std::chrono::steady_clock::now();
  const RegistrationResult result = register_scans(source, target, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  Row row;
  row.outcome = result.outcome;
  row.seconds = seconds.count();
  const Rigid3 error = inverse(truth) * result.best.target_from_source;
  const Extent extent = extent_of(source.points);
  const Vector3d middle = source.centres.size() == 1
                              ? Vector3d(source.centres[0] + source.local_origin)
                              : Vector3d(0.5 * (extent.low + extent.high) + source.local_origin);
  row.rotation_deg = degrees(rotation_angle(error.rotation));
  row.translation_m = (error * middle - middle).norm();
  // The six errors in the target's frame about the centre that the sigmas refer to.
  const Rigid3 off = result.best.target_from_source * inverse(truth);
  const Vector3d turn = rotation_log(off.rotation);
  const Vector3d shift = off * result.sigma.centre - result.sigma.centre;
  for (Eigen::Index k = 0; k < 3; ++k) {
    row.worst_sigma =
        std::max({row.worst_sigma, std::abs(turn[k]) / std::max(1e-12, result.sigma.rotation_rad[k]),
                  std::abs(shift[k]) / std::max(1e-12, result.sigma.translation_m[k])});
  }
  return row;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void summarise(const std::vector<Row>& rows, const Settings& settings) {
  std::vector<double> rotations;
  std::vector<double> translations;
  std::vector<double> seconds;
  int count[5] = {};
  int wrong = 0;
  int within_two = 0;
  std::vector<double> worst;
  for (const Row& row : rows) {
    ++count[static_cast<int>(row.outcome)];
    seconds.push_back(row.seconds);
    if (row.outcome != Outcome::registered) continue;
    rotations.push_back(row.rotation_deg);
    translations.push_back(row.translation_m);
    worst.push_back(row.worst_sigma);
    if (row.worst_sigma <= 2.0) ++within_two;
    if (row.translation_m > settings.wrong_m || row.rotation_deg > settings.wrong_deg) ++wrong;
  }
  fmt::print(
      "# {} runs: registered {}, probable {}, ambiguous {}, under_constrained {}, no_match {}, WRONG {}\n",
      rows.size(), count[0], count[1], count[2], count[3], count[4], wrong);
  fmt::print("# registered: median {:.3f} mm {:.4f} deg, 95 % {:.3f} mm {:.4f} deg; {:.2f} s median\n",
             1000 * quantile(translations, 0.5), quantile(rotations, 0.5),
             1000 * quantile(translations, 0.95), quantile(rotations, 0.95), quantile(seconds, 0.5));
  fmt::print(
      "# all six errors within 2 sigma in {} of {}; the worst of six: median {:.2f}, 95 % {:.2f} sigma\n",
      within_two, worst.size(), quantile(worst, 0.5), quantile(worst, 0.95));
}

/// The same pair from `settings.poses` random starts.
void run_starts(const Scan& source, const Scan& target, const Rigid3& truth, const Settings& settings,
                const std::string& name, int seed, std::vector<Row>& rows) {
  for (int p = 0; p < settings.poses; ++p) {
    const bool level = settings.gravity != "unknown";
    // A start of Table 1 is off the true pose; a random one is anywhere.
    const Rigid3 start =
        settings.table1 ? truth * table1_pose(static_cast<std::uint64_t>(seed), static_cast<std::size_t>(p))
                        : random_pose(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(p), level);
    // The start acts on world coordinates; points are kept about the scan's origin.
    const Rigid3 local_start = to_local(start, source.local_origin, source.local_origin);
    const Row row = run(moved(source, local_start), target, truth * inverse(start), settings);
    rows.push_back(row);
    fmt::print("{},{},{},{},{:.5f},{:.6f},{:.3f}\n", name, seed, p, to_string(row.outcome), row.rotation_deg,
               row.translation_m, row.seconds);
    std::fflush(stdout);
  }
}

void run_files(const Settings& settings, std::vector<Row>& rows) {
  Rigid3 truth;
  if (!settings.truth_file.empty()) {
    std::ifstream file(settings.truth_file);
    Matrix4d matrix;
    for (Eigen::Index i = 0; i < 16; ++i) file >> matrix(i / 4, i % 4);
    truth = from_matrix(matrix, 1e-4);
  }
  run_starts(read_scan(settings.source_file), read_scan(settings.target_file), truth, settings,
             settings.source_file, 1, rows);
}

void run_scene(const Settings& settings, int seed, std::vector<Row>& rows) {
  SceneOptions scene;
  scene.name = settings.scene;
  scene.seed = static_cast<std::uint64_t>(seed);
  scene.points_indoor = settings.points_indoor;
  scene.points_outdoor = settings.points_outdoor;
  scene.facades = static_cast<std::size_t>(settings.facades);
  const SimulatedCase simulated = simulate(scene);
  const Rigid3 truth = true_target_from_source(simulated.truth, settings.source, settings.target);
  run_starts(simulated.scans.at(settings.source), simulated.scans.at(settings.target), truth, settings,
             settings.scene, seed, rows);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Accuracy of limen against the simulator's exact truth");
  app.add_option("--scene", settings.scene, "built-in scene");
  app.add_option("--gravity", settings.gravity, "up, unknown or auto");
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of buildings");
  app.add_option("--poses", settings.poses, "starting poses per building");
  app.add_option("--source", settings.source, "index of the source scan");
  app.add_option("--target", settings.target, "index of the target scan");
  app.add_option("--points-indoor", settings.points_indoor, "points of a station");
  app.add_option("--points-outdoor", settings.points_outdoor, "points of a mobile scan");
  app.add_option("--facades", settings.facades, "façades that the museum's room looks through: 0 any, 1, 2");
  app.add_flag("--table1", settings.table1,
               "start from the four poses of 2021, Table 1, instead of random ones");
  app.add_option("--source-file", settings.source_file, "a scan instead of a scene");
  app.add_option("--target-file", settings.target_file, "a scan instead of a scene");
  app.add_option("--truth-file", settings.truth_file, "4 x 4 text: target from source");
  app.add_option("--wrong-m", settings.wrong_m, "a registered pose farther off is wrong");
  app.add_option("--wrong-deg", settings.wrong_deg, "a registered pose turned more is wrong");
  CLI11_PARSE(app, argc, argv);
  std::vector<Row> rows;
  fmt::print("case,seed,pose,outcome,rotation_deg,translation_m,seconds\n");
  if (!settings.source_file.empty()) {
    run_files(settings, rows);
  } else {
    for (int s = settings.first_seed; s < settings.first_seed + settings.seeds; ++s)
      run_scene(settings, s, rows);
  }
  summarise(rows, settings);
  return 0;
}
