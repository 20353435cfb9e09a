// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What surfaces of the building say of pairs whose truth is known: of poses that lay a place on itself, and
// of those that lay it on another one. Rows (JSON lines) are what scripts/fit_evidence reads.
//   bench_as_built --building flats --first-seed 1 --seeds 2 --search -o rows.jsonl
//   bench_as_built LIST --set hall -o rows.jsonl        scans at hand: a line each, NAME FILE and 12 numbers,
//                                                       the rows of the pose of the scan in the set's frame
// Right poses are refined from the truth; with --search what a search finds elsewhere is asked as well.
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "known_scans.h"
#include "pair_set.h"
#include "prepared_frames.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/register/judge/common_surfaces.h"
#include "limen/register/judge/given_pose.h"
#include "limen/register/judge/look_alike_odds.h"
#include "limen/register/prepare/prepared_pair.h"
#include "limen/register/refine/refine_pose.h"
#include "limen/register/register.h"

namespace {

using namespace limen;               // NOLINT(google-build-using-namespace): a program, not a header
using namespace limen::calibration;  // NOLINT(google-build-using-namespace)

constexpr double kLeastAgreeing_m2 = 3.0;
constexpr double kNearM = 0.3;  // real sets' poses are good to decimetres
constexpr double kNearDeg = 1.5;
constexpr double kElsewhereM = 1.0;
constexpr double kElsewhereDeg = 5.0;
constexpr std::array<double, 6> kOffsetsMm = {0.0, 1.0, 2.0, 4.0, 8.0, 12.0};
constexpr std::array<double, 6> kTurnsDeg = {0.0, 0.05, 0.1, 0.2, 0.4, 0.6};
constexpr std::array<double, 6> kBendsMm = {0.3, 1.0, 2.0, 4.0, 8.0, 16.0};
constexpr std::array<double, 3> kStray = {0.05, 0.15, 0.3};

struct Settings {
  std::string list;
  std::string set;
  std::string building;
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1;
  std::size_t points = 100000;
  bool search = false;
  bool foreign = false;
  double minutes = 60.0;
  std::string output;
};

std::vector<Known> scans_of_building(const Settings& settings, std::uint64_t seed) {
  PairSetOptions options;
  options.name = settings.building;
  options.seed = seed;
  options.points = settings.points;
  PairSet set = simulate_pair_set(options);
  std::vector<Known> scans;
  for (PairSetScan& one : set.scans) {
    if (one.day != 0) continue;
    scans.push_back(
        {one.truth.name, prepare_scan(std::move(one.scan), prepare_options({})), one.truth.local_from_scan});
  }
  return scans;
}

std::string joined_numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.2f}", text.empty() ? "" : ",", value);
  return "[" + text + "]";
}

/// For every stray share one place [quality][bend], and look-alike places [kind][quality][bend], in one row.
std::string tables_of(const std::vector<CommonSurface>& surfaces) {
  std::string one_text;
  std::string look_alike_text;
  for (const double stray : kStray) {
    const AsBuiltDensity density(surfaces, stray);
    if (!density.knows_square()) return {};
    std::vector<double> one;
    std::vector<double> look_alike;
    for (const double offset : kOffsetsMm)
      for (const double turn : kTurnsDeg)
        for (const double bend : kBendsMm) {
          const BuiltQuality quality{1.0, 1e-3 * offset, radians(turn)};
          one.push_back(density.of_one_place(quality, {1.0, 1e-3 * bend}));
          for (const GoingOn same : kGoingOn)
            look_alike.push_back(density.of_look_alike(quality, {1.0, 1e-3 * bend}, same));
        }
    one_text += (one_text.empty() ? "" : ",") + joined_numbers(one);
    look_alike_text += (look_alike_text.empty() ? "" : ",") + joined_numbers(look_alike);
  }
  return fmt::format(R"(, "one": [{}], "twin": [{}])", one_text, look_alike_text);
}

class Rows {
 public:
  explicit Rows(const Settings& settings) : s_(settings), start_(std::chrono::steady_clock::now()) {
    file_.open(s_.output, std::ios::app);
  }

  void run(const std::string& set, const std::vector<Known>& scans) {
    for (std::size_t i = 0; i < scans.size(); ++i)
      for (std::size_t j = i + 1; j < scans.size(); ++j) run_pair(set, scans[i], scans[j]);
  }

 private:
  [[nodiscard]] bool over() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count() > 60.0 * s_.minutes;
  }

  void run_pair(const std::string& set, const Known& from, const Known& to) {
    if (over()) return;
    PreparedPair pair{from.scan, to.scan};
    const ScanView source = pair.source.view();
    const ScanView target = pair.target.view();
    const bool foreign = s_.foreign && from.name.substr(0, 3) != to.name.substr(0, 3);
    if (s_.foreign && !foreign) return;
    const Rigid3 truth = in_prepared_frames(inverse(to.set_from_scan) * from.set_from_scan, pair);
    std::vector<std::pair<std::string, Rigid3>> poses;
    if (!foreign) {
      const Rigid3 refined = refine_pose(source, target, truth, {}).target_from_source;
      if (is_near(refined, truth, pair, kNearM, kNearDeg)) poses.emplace_back("right", refined);
    }
    if (s_.search) {
      const RegistrationResult result = register_prepared(pair);
      std::vector<Hypothesis> found = result.alternatives;
      found.insert(found.begin(), result.best);
      for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 4); ++k) {
        const Rigid3 pose = in_prepared_frames(found[k].target_from_source, pair);
        if (foreign || !is_near(pose, truth, pair, kElsewhereM, kElsewhereDeg))
          poses.emplace_back(foreign ? "foreign" : "wrong", pose);
      }
    }
    for (const auto& [kind, pose] : poses) add(set, from.name + "-" + to.name, kind, pose, pair);
  }

  void add(const std::string& set, const std::string& names, const std::string& kind, const Rigid3& pose,
           const PreparedPair& pair) {
    const ScanView source = pair.source.view();
    const ScanView target = pair.target.view();
    const PoseScore score = score_pose(source, target, pose, fine_score(source, target, Method::automatic));
    if (score.agreeing_m2 < kLeastAgreeing_m2) return;
    const auto start = std::chrono::steady_clock::now();
    const CommonSurfaces surfaces =
        CommonSurfaceFinder(source, BuiltPlanes(source), target, BuiltPlanes(target))(pose);
    const double nats = built_nats(built_evidence(surfaces.all), {bends_beforehand(0.0)});
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const SeenClutter clutter = seen_clutter(source, target, pose);
    LookAlikeEvidence said = weigh_look_alike(clutter);
    const double after = probability_of(said);
    said.built = {};
    std::string list;
    for (const CommonSurface& one : surfaces.all)
      list += fmt::format("{}[{:.2f},{:.3f},{:.3f},{:.2f},{:.3f},{:.3f},{:.2f}]", list.empty() ? "" : ",",
                          1e3 * one.deviation[0], degrees(one.deviation[1]), degrees(one.deviation[2]),
                          1e3 * std::sqrt(one.measured(0, 0)), degrees(std::sqrt(one.measured(1, 1))),
                          degrees(std::sqrt(one.measured(2, 2))), one.normal.z());
    file_
        << fmt::format(
               R"({{"set": "{}", "pair": "{}", "kind": "{}", "agreeing": {:.1f}, "contradicted": {:.1f}, )"
               R"("nats": {:.2f}, "without": {:.3g}, "with": {:.3g}, "otherwise": {:.2f}, "alike": {:.2f}, )"
               R"("scatter_mm": {:.2f}, "noise_mm": {:.2f}, "seconds": {:.4f}, "surfaces": [{}]{}}})",
               set, names, kind, score.agreeing_m2, score.contradicted_m2, nats, probability_of(said), after,
               otherwise_nats(said), alike_nats(said), 1e3 * surfaces.scatter_m,
               1e3 * std::max(source.features->noise_m, target.features->noise_m), spent.count(), list,
               tables_of(surfaces.all))
        << "\n"
        << std::flush;
  }

  const Settings& s_;
  std::chrono::steady_clock::time_point start_;
  std::ofstream file_;
};

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("What surfaces of the building say of pairs whose truth is known");
  app.add_option("list", settings.list, "scans with their poses");
  app.add_option("--set", settings.set, "name of the rows' building");
  app.add_option("--building", settings.building, "simulated buildings of this kind instead");
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of seeds");
  app.add_option("--points", settings.points, "points of a station, about");
  app.add_flag("--search", settings.search, "poses that a search finds elsewhere as well");
  app.add_flag("--foreign", settings.foreign,
               "only pairs whose names begin with other three letters: they share nothing");
  app.add_option("--minutes", settings.minutes, "stop after so long");
  app.add_option("-o,--output", settings.output, "rows are added to this file")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    Rows rows(settings);
    if (!settings.list.empty()) rows.run(settings.set, scans_of_list(settings.list));
    for (std::uint64_t seed = settings.first_seed;
         !settings.building.empty() && seed < settings.first_seed + settings.seeds; ++seed)
      rows.run(fmt::format("{}_{}", settings.building, seed), scans_of_building(settings, seed));
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_as_built: {}\n", error.what());
    return 1;
  }
  return 0;
}
