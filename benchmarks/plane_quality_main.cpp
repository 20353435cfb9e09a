// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Quality of the plane detectors against exact truth: scenes x seeds x stations, one line of CSV each, and a
// summary.
//   bench_plane_quality --scene room --seeds 3 --points 260000 --detector grow
//
// Words. A point's true plane is what the simulator says; points on leaves, trunks, folds of curtains and
// mixed pixels have none. Coplanar faces that look the same way are one plane, and so are, here, those within
// 0.1 degrees and `--same-m` (6 mm, twice the noise) of each other in the middle of either's points: a
// detector that puts the pieces of one wall together must put these together. Nor can anybody tell from its
// place to which of two surfaces a point belongs that is an inlier of both: a point *fits* every true plane
// that passes within `--fit-m` (8 mm, 2.7 times the noise) of it and has points in its cube of 5 cm or one of
// the cubes around; where it fits another than its own, it is shared. With both options 0 the simulator's
// planes count as they are. A true plane counts where the scan has at least `--min-true` (1000) points on it
// that are not shared.
// - A detected plane is *pure* where at least 80 % of its points fit one true plane, its owner (the one that
//   most of them fit).
// - recall: share of the counting true planes that are found: the owner of a pure detected plane that holds
//   at least half of the points of that true plane that are not shared. Such a detected plane is the only
//   one, and it has one owner, so the pairs are one to one.
// - precision: share of the detected planes that are pure, their owner of any size. Detected planes most of
//   whose points have no true plane lie on objects that are not planar: they are distinguished, as `other`.
// - pieces: pure detected planes, of at least 5 % of their owner's points, beyond the owner's first, where
//   the owner counts (over-segmentation).
// - fused: counting true planes that have more than half of their points in a detected plane that another
//   one owns, or that most points of fit (under-segmentation).
// - `--list` names what was missed and what was not pure.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "kept_case.h"
#include "plane_truth.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/parallel.h"
#include "limen/extract/planes/detect_planes.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

constexpr double kCovered = 0.5;
constexpr double kPiece = 0.05;

struct Settings {
  std::vector<std::string> scenes = {"room", "flat", "museum"};
  int first_seed = 1;
  int seeds = 2;
  std::size_t points = 260000;
  int stations = 1;
  bool outdoor = false;
  std::string detector = "auto";
  std::string threshold = "auto";
  double threshold_m = 0.0;
  double noise_m = 0.003;
  double drift_m = 0.0;
  FitOptions fit;
  std::size_t min_true = 1000;
  int min_inliers = 200;
  double coarsest_cell_m = GrowOptions{}.coarsest_cell_m;
  double finest_cell_m = GrowOptions{}.finest_cell_m;
  int threads = 0;
  int repeats = 1;
  bool list = false;
  bool no_relief = false;
  bool kept = false;
  KeepOptions keep;
};

struct Counts {
  int true_planes = 0;
  int found = 0;
  int detected = 0;
  int pure = 0;
  int pieces = 0;
  int fused = 0;
  int other = 0;  ///< on objects that are not planar

  Counts& operator+=(const Counts& more) {
    true_planes += more.true_planes;
    found += more.found;
    detected += more.detected;
    pure += more.pure;
    pieces += more.pieces;
    fused += more.fused;
    other += more.other;
    return *this;
  }
  [[nodiscard]] double recall() const { return true_planes > 0 ? 100.0 * found / true_planes : 100.0; }
  [[nodiscard]] double precision() const { return detected > 0 ? 100.0 * pure / detected : 100.0; }
};

std::string describe(const Truth& truth, std::int32_t plane) {
  if (plane < 0) return "none";
  const TruePlane& it = truth.planes[static_cast<std::size_t>(plane)];
  return fmt::format("{} {} (n {:.2f} {:.2f} {:.2f} d {:.3f}, {:.2f} m2)", to_string(it.element), plane,
                     it.plane.normal.x(), it.plane.normal.y(), it.plane.normal.z(), it.plane.offset,
                     it.area_m2);
}

void list_missed(const Overlaps& overlaps, const Truth& truth, std::int32_t plane) {
  fmt::print("#  missed {} with {} points:", describe(truth, plane), overlaps.true_size.at(plane));
  for (std::size_t k = 0; k < overlaps.size.size(); ++k) {
    if (overlaps.cover(k, plane) < kPiece) continue;
    fmt::print(" {:.0f} % in #{} of {}", 100.0 * overlaps.cover(k, plane), k,
               describe(truth, overlaps.main_truth(k)));
  }
  fmt::print("\n");
}

void list_impure(const Overlaps& overlaps, const Truth& truth, std::size_t k) {
  fmt::print("#  not pure #{} with {} points:", k, overlaps.size[k]);
  for (const auto& [plane, count] : overlaps.fitting[k]) {
    const double share = static_cast<double>(count) / static_cast<double>(overlaps.size[k]);
    if (share > kPiece) fmt::print(" {:.0f} % {}", 100.0 * share, describe(truth, plane));
  }
  fmt::print("\n");
}

void list_pieces(const Overlaps& overlaps, const Truth& truth, std::int32_t plane) {
  fmt::print("#  in pieces {}:", describe(truth, plane));
  for (std::size_t k = 0; k < overlaps.size.size(); ++k) {
    if (overlaps.owner(k) == plane) fmt::print(" #{} with {}", k, overlaps.size[k]);
  }
  fmt::print("\n");
}

Counts compare(const Overlaps& overlaps, const Truth& truth, const Settings& settings) {
  Counts counts;
  std::map<std::int32_t, int> large_pieces;
  for (std::size_t k = 0; k < overlaps.size.size(); ++k) {
    if (!overlaps.planar(k)) {
      ++counts.other;
      continue;
    }
    ++counts.detected;
    const std::int32_t owner = overlaps.owner(k);
    if (owner >= 0) {
      ++counts.pure;
      if (overlaps.cover(k, owner) >= kPiece) ++large_pieces[owner];
    } else if (settings.list) {
      list_impure(overlaps, truth, k);
    }
  }
  for (const auto& [plane, size] : overlaps.true_size) {
    if (size < settings.min_true) continue;
    ++counts.true_planes;
    counts.pieces += std::max(0, large_pieces[plane] - 1);
    if (settings.list && large_pieces[plane] > 1) list_pieces(overlaps, truth, plane);
    bool found = false;
    for (std::size_t k = 0; k < overlaps.size.size(); ++k) {
      if (overlaps.cover(k, plane) < kCovered) continue;
      if (overlaps.owner(k) == plane) found = true;
      if (overlaps.main_truth(k) != plane) ++counts.fused;
    }
    if (found) ++counts.found;
    if (!found && settings.list) list_missed(overlaps, truth, plane);
  }
  return counts;
}

/// Lines and pulses of a simulated station, which keeps none: columns run upwards, so a new one begins where
/// the elevation falls.
ScanTopology station_lines(const Scan& scan) {
  ScanTopology topology;
  double before = -10.0;
  std::int32_t line = -1;
  const auto pulses_per_rad = std::sqrt(static_cast<double>(scan.size()) * 2.4 / 6.28) / 2.618;
  for (const Vector3d& x : scan.points) {
    const double elevation = std::asin(x.z() / x.norm());
    if (line < 0 || elevation < before - 0.02) ++line;
    before = elevation;
    topology.line.push_back(line);
    topology.index.push_back(static_cast<std::int32_t>(std::lround(elevation * pulses_per_rad * 4.0)));
  }
  return topology;
}

DetectOptions detect_options(const Settings& settings) {
  DetectOptions options;
  options.relief = !settings.no_relief;
  options.detector = value_called(kPlaneDetectors, settings.detector).value_or(PlaneDetector::automatic);
  if (settings.threshold == "noise") options.threshold = ThresholdRule::noise;
  if (settings.threshold == "a_contrario") options.threshold = ThresholdRule::a_contrario;
  return options;
}

struct Timed {
  DetectedPlanes detected;
  double seconds = 0.0;
};

/// The fastest of several runs: the others waited for the machine.
Timed detect(const Scan& scan, const Settings& settings) {
  GrowOptions grow;
  grow.inlier_threshold_m = settings.threshold_m;
  grow.min_inliers = settings.min_inliers;
  grow.coarsest_cell_m = settings.coarsest_cell_m;
  grow.finest_cell_m = settings.finest_cell_m;
  Timed timed;
  for (int k = 0; k < settings.repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    timed.detected = detect_planes(scan, detect_options(settings), grow);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    timed.seconds = k == 0 ? seconds.count() : std::min(timed.seconds, seconds.count());
  }
  return timed;
}

Counts run(const std::string& scene, int seed, const Settings& settings) {
  SceneOptions options;
  options.name = scene;
  options.seed = static_cast<std::uint64_t>(seed);
  (settings.outdoor ? options.points_outdoor : options.points_indoor) = settings.points;
  options.scanner.noise_m = settings.noise_m;
  options.drift_m = settings.drift_m;
  SimulatedCase simulated = simulate(options);
  if (settings.kept) keep_as_features_do(simulated, settings.keep);
  Counts sum;
  int stations = 0;
  for (std::size_t i = 0; i < simulated.scans.size(); ++i) {
    Scan& scan = simulated.scans[i];
    if (scan.mobile() != settings.outdoor || (!settings.outdoor && stations++ >= settings.stations)) continue;
    if (settings.detector == "scan_lines" && !scan.topology.known()) scan.topology = station_lines(scan);
    const Timed timed = detect(scan, settings);
    const Overlaps overlaps = overlaps_of(timed.detected.planes, Fitting(simulated, i, settings.fit));
    const Counts counts = compare(overlaps, simulated.truth, settings);
    fmt::print("{},{},{},{},{:.1f},{},{},{:.1f},{},{},{:.1f},{},{},{},{:.3f}\n", scene, seed, scan.name,
               scan.size(), 1e3 * timed.detected.planes.inlier_threshold_m, counts.true_planes, counts.found,
               counts.recall(), counts.detected, counts.pure, counts.precision(), counts.other, counts.pieces,
               counts.fused, timed.seconds);
    std::fflush(stdout);
    sum += counts;
  }
  return sum;
}

void add_options(CLI::App& app, Settings& settings) {
  app.add_option("--scene", settings.scenes, "built-in scenes (default room flat museum)");
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of buildings");
  app.add_option("--points", settings.points, "points of each scan");
  app.add_option("--stations", settings.stations, "stations of each building");
  app.add_flag("--outdoor", settings.outdoor, "the mobile scan instead of the stations");
  app.add_option("--detector", settings.detector, "auto, grow, scan_lines or msac");
  app.add_option("--threshold", settings.threshold, "auto, noise or a_contrario");
  app.add_option("--threshold-m", settings.threshold_m, "inlier threshold; 0: by --threshold");
  app.add_option("--noise-m", settings.noise_m, "range noise of the scanner");
  app.add_option("--drift-m", settings.drift_m, "slow error of a mobile scan's trajectory, per axis");
  app.add_option("--fit-m", settings.fit.fit_m, "a point fits the true planes within this; 0: its own alone");
  app.add_option("--same-m", settings.fit.same_m, "true planes nearer than this, facing one way, are one");
  app.add_option("--min-true", settings.min_true, "points of a true plane that counts");
  app.add_option("--min-inliers", settings.min_inliers, "points of the smallest detected plane");
  app.add_option("--coarsest-cell-m", settings.coarsest_cell_m, "of grow: edge of the first cubes");
  app.add_option("--finest-cell-m", settings.finest_cell_m, "of grow: edge of the last cubes");
  app.add_option("--threads", settings.threads, "0: the machine's");
  app.add_option("--repeats", settings.repeats, "runs of each detection; the fastest counts");
  app.add_flag("--kept", settings.kept, "of dense scans the points that features are found on");
  app.add_option("--kept-per-m2", settings.keep.most_per_m2,
                 "with --kept: so many on a square metre, of stations");
  app.add_option("--kept-per-m2-of-way", settings.keep.most_per_m2_of_way, "the same of mobile scans");
  app.add_flag("--no-relief", settings.no_relief,
               "of mobile scans: as registration does, fewer and larger planes");
  app.add_flag("--list", settings.list, "name what was missed and what was not pure");
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Quality of limen's plane detectors against the simulator's exact truth");
  add_options(app, settings);
  CLI11_PARSE(app, argc, argv);
  set_thread_count(settings.threads);
  fmt::print(
      "scene,seed,scan,points,threshold_mm,true,found,recall,detected,pure,precision,other,pieces,fused,"
      "seconds\n");
  Counts all;
  for (const std::string& scene : settings.scenes) {
    Counts sum;
    for (int seed = settings.first_seed; seed < settings.first_seed + settings.seeds; ++seed)
      sum += run(scene, seed, settings);
    fmt::print("# {}: recall {:.1f} %, precision {:.1f} %, {} pieces, {} fused\n", scene, sum.recall(),
               sum.precision(), sum.pieces, sum.fused);
    all += sum;
  }
  fmt::print("# all: recall {:.1f} % ({} of {}), precision {:.1f} % ({} of {}), {} pieces, {} fused\n",
             all.recall(), all.found, all.true_planes, all.precision(), all.pure, all.detected, all.pieces,
             all.fused);
  return 0;
}
