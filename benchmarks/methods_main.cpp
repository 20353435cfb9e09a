// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Methods compared on simulated indoor x outdoor pairs with exact truth: one line of CSV per pair and method,
// and a table.
//   bench_methods --methods polygons,openings,hybrid,auto --table methods.md
//   bench_methods --only medium --kinds museum --pairs 2
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "method_table.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/register/prepare/prepared_pair.h"
#include "limen/register/register.h"

namespace {

using namespace limen;           // NOLINT(google-build-using-namespace): a program, not a header
using namespace limen::methods;  // NOLINT(google-build-using-namespace)

const std::vector<std::string> kKinds = {"museum", "townhouse", "villa"};

Method method_of(const std::string& name) {
  if (const std::optional<Method> method = value_called(kMethods, name)) return *method;
  throw Error("no method is called '" + name + "'", "bench_methods",
              "choose of auto, polygons, openings, hybrid, segments");
}

/// A pair that was scanned, and what a run needs of its truth.
struct Pair {
  PairPlan plan;
  SimulatedCase made;
  std::size_t facades = 0;
  PreparedPair prepared = {};
  double preparing_s = 0.0;
  bool with_segments = false;  ///< `prepared` is

  [[nodiscard]] const Scan& station() const { return made.scans.front(); }
  [[nodiscard]] const Scan& street() const { return made.scans.back(); }
};

/// A building may have no room as the level asks: then that of another seed, a thousand on.
Pair make_pair(PairPlan plan) {
  for (int attempt = 0;; ++attempt) {
    Pair pair{plan, simulate(plan.scene)};
    pair.facades = facades_seen(pair.made.truth);
    if (plan.level.facades == 0 || pair.facades == plan.scene.facades || attempt == 20) return pair;
    plan.scene.seed += 1000;
  }
}

/// Features are taken once for all methods that need the same; their time counts for each.
void prepare(Pair& pair, const std::string& method) {
  RegisterOptions options;
  options.method = method_of(method);
  const bool segments = options.method == Method::segments;
  if (pair.prepared.source.space && segments == pair.with_segments) return;
  pair.with_segments = segments;
  const auto start = std::chrono::steady_clock::now();
  pair.prepared.source = prepare_scan(pair.station(), prepare_options(options));
  pair.prepared.target = prepare_scan(pair.street(), prepare_options(options));
  pair.preparing_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The thickness of the façade that an open window of the station's room is in, where it was measured: inner
/// walls that are seen through doors have one too.
void compare_thickness(const Pair& pair, const RegistrationResult& result, Row& row) {
  constexpr double kInPlaneM = 0.05;
  constexpr double kAlong = 0.99;
  const Truth& truth = pair.made.truth;
  const Features& features = pair.prepared.source.extracted.features;
  for (const TrueOpening& opening : truth.openings) {
    if (!opening.exterior || opening.curtained || opening.rooms[0] != truth.scans[0].room) continue;
    const Vector3d middle = 0.5 * (opening.inner[0] + opening.inner[2]);
    const Vector3d in_scan = inverse(truth.scans[0].local_from_scan) * middle;
    const Matrix3d& upright = pair.prepared.source.upright_from_scan;
    const Vector3d prepared = upright * (in_scan - features.local_origin);
    const Vector3d normal = upright * truth.scans[0].local_from_scan.rotation.transpose() * opening.normal;
    for (const MeasuredThickness& measured : result.thickness) {
      const Plane& plane = features.planes.at(static_cast<std::size_t>(measured.source_plane)).plane;
      if (std::abs(plane.normal.dot(normal)) < kAlong ||
          std::abs(plane.signed_distance(prepared)) > kInPlaneM)
        continue;
      row.thickness_error_m = measured.value_m - opening.thickness_m;
      row.thickness_sigma_m = measured.sigma_m;
      return;
    }
  }
}

Row run(const Pair& pair, const std::string& method) {
  RegisterOptions options;
  options.method = method_of(method);
  const Rigid3 truth = true_target_from_source(pair.made.truth, 0, pair.made.scans.size() - 1);
  const auto start = std::chrono::steady_clock::now();
  const RegistrationResult result = register_prepared(pair.prepared, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  Row row{.level = pair.plan.level.name,
          .kind = pair.plan.scene.name,
          .seed = pair.plan.scene.seed,
          .method = method,
          .facades = pair.facades,
          .outcome = result.outcome,
          .seconds = pair.preparing_s + seconds.count(),
          .alike = pair.plan.level.alike};
  if (row.outcome == Outcome::no_match) return row;
  const Vector3d centre = pair.station().centres[0] + pair.station().local_origin;
  const Miss miss = miss_of(result.best.target_from_source, truth, centre);
  row.rotation_deg = miss.rotation_deg;
  row.translation_m = miss.translation_m;
  row.near = miss.within(pair.plan.level);
  row.listed =
      row.near ||
      std::any_of(result.alternatives.begin(), result.alternatives.end(), [&](const Hypothesis& other) {
        return miss_of(other.target_from_source, truth, centre).within(pair.plan.level);
      });
  row.sigmas = errors_in_sigmas(result, truth);
  compare_thickness(pair, result, row);
  return row;
}

void print_header() {
  fmt::print(
      "level,kind,seed,method,facades,outcome,rotation_deg,translation_m,near,wrong,listed,"
      "sigma_rx,sigma_ry,sigma_rz,sigma_tx,sigma_ty,sigma_tz,thickness_error_m,thickness_sigma_m,seconds\n");
}

void print(const Row& row) {
  fmt::print("{},{},{},{},{},{},{:.5f},{:.6f},{:d},{:d},{:d}", row.level, row.kind, row.seed, row.method,
             row.facades, to_string(row.outcome), row.rotation_deg, row.translation_m, row.near, row.wrong(),
             row.listed);
  for (const double error : row.sigmas) fmt::print(",{:.2f}", error);
  fmt::print(",{:.4f},{:.4f},{:.2f}\n", row.thickness_error_m, row.thickness_sigma_m, row.seconds);
  std::fflush(stdout);
}

constexpr const char* kPage =
    R"(# Methods compared

Made by `scripts/compare_methods{}`; do not edit.

Simulated pairs of one indoor station and one street scan, exact truth. The station sees at least two fifths of an open
window in each façade counted here; seeds where it does not are passed over.

- easy: the room has open windows in two façades, curtains on 10 % of all windows
- medium: one façade, 30 % curtains
- hard: one façade, 60 % curtains, the street scan's trajectory drifts by 1 cm
- any_rotation: as easy, every other room with one façade only; the station at any rotation
- identical: rooms that repeat, nothing distinguishes them

*Right* means `registered` within the level's bar: 2 cm and 0.2°, in hard 5 cm and 0.5°; in identical it means
`ambiguous` with the true pose among those listed. *Wrong* means any other `registered`. Freedoms are the six of each
registered pose, counted one by one. Thickness: of the outer wall with most openings, where its stated deviation is below
5 cm. Times are of the machine this was made on.

{}
Right, by kind of building:

{})";

/// What was asked for on the command line, and where the page goes.
struct Request {
  Selection selection;
  std::vector<std::string> methods = {"auto"};
  std::string table_file;
  std::string arguments;  ///< as typed, for the page
};

/// A misspelt name must not pass for a run without pairs.
void check_names(const std::vector<std::string>& asked, const std::vector<std::string>& known) {
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw Error("nothing is called '" + name + "'", "bench_methods",
                fmt::format("choose of {}", fmt::join(known, ", ")));
  }
}

void check(const Request& request) {
  for (const std::string& method : request.methods) method_of(method);
  std::vector<std::string> levels;
  for (const Level& level : all_levels()) levels.push_back(level.name);
  check_names(request.selection.levels, levels);
  check_names(request.selection.kinds, kKinds);
}

int run_all(const Request& request) {
  const std::vector<std::string>& methods = request.methods;
  check(request);
  std::vector<Row> rows;
  print_header();
  for (const PairPlan& plan : plan_pairs(kKinds, request.selection)) {
    Pair pair = make_pair(plan);
    for (const std::string& method : methods) {
      prepare(pair, method);
      rows.push_back(run(pair, method));
      print(rows.back());
    }
  }
  fmt::print("{}", table(rows, methods));
  if (!request.table_file.empty()) {
    write_file(request.table_file,
               fmt::format(kPage, request.arguments, table(rows, methods), table_by_kind(rows, methods)));
  }
  return std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.wrong(); }) ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  Selection& selection = request.selection;
  CLI::App app(
      "Registration methods on simulated indoor x outdoor pairs; exit 1 where a wrong pose was registered");
  app.add_option("--methods", request.methods, "of polygons, openings, hybrid, segments, auto")
      ->delimiter(',');
  app.add_option("--only", selection.levels, "of easy, medium, hard, any_rotation, identical")
      ->delimiter(',');
  app.add_option("--kinds", selection.kinds, "kinds of building")->delimiter(',');
  app.add_option("--first-seed", selection.first_seed, "first seed");
  app.add_option("--pairs", selection.pairs, "pairs per kind and level; 0: the full number");
  app.add_option("--points-indoor", selection.points_indoor, "points of the station");
  app.add_option("--points-outdoor", selection.points_outdoor, "points of the street scan");
  app.add_option("--table", request.table_file, "markdown file to write");
  CLI11_PARSE(app, argc, argv);
  for (int i = 1; i < argc; ++i) request.arguments += std::string(" ") + argv[i];
  try {
    return run_all(request);
  } catch (const Error& error) {
    fmt::print(stderr, "bench_methods: {}\n", error.what());
    return 2;
  }
}
