// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Quality of the openings found in simulated scans against exact truth: scenes x seeds, one line of CSV for
// each scan, and a summary.
//   bench_opening_quality --outdoor --scene museum --seeds 5 --points 800000 --curtains 0.3
//
// Words.
// - A mobile scan is compared with the outer corners of the openings in façades; a station with the corners
//   on the face that its own room has of each opening.
// - *in view*: the scanner stood before that face, and the rays that touched the opening's own parts or went
//   through it number at least `--min-rays` (60), a fifth of what its wall beside it got (points of wall
//   within 0.25 m round it, per area): an opening behind a tree, a car or a wardrobe is not in view.
// - *seen through*: in view, and rays that went through it met at least half of its 8 x 8 cells.
// - An opening found is right where it overlaps an opening's true rectangle, in view or not, in the plane
//   (within 0.1 m) with an intersection over union of at least 0.5; each true one takes the best. Others that
//   fit a true one taken already, and those that fit none, are wrong. Right ones of openings not in view
//   count neither for nor against.
// - corner error: distance of each corner of a right one from the true corner. IoU: its mean.
// - within 2 sigma: edges whose place errs by at most twice their deviation, among those below 1 m.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "kept_case.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/parallel.h"
#include "limen/extract/openings/openings.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

struct Settings {
  std::vector<std::string> scenes = {"museum"};
  int first_seed = 1;
  int seeds = 2;
  std::size_t points = 0;
  std::size_t stations = 0;
  bool outdoor = false;
  double curtains = -1.0;
  std::size_t min_rays = 60;
  int threads = 0;
  bool list = false;
  bool kept = false;
  KeepOptions keep;
  bool errors = false;
};

struct Tally {
  int in_view = 0, found = 0, through = 0, found_through = 0;
  int detected = 0, right = 0, beyond = 0, wrong = 0;
  std::vector<double> iou, corner_m, sigmas, reveal_sigmas, reveal_m;
  double seconds = 0.0;

  Tally& operator+=(const Tally& more) {
    in_view += more.in_view;
    found += more.found;
    through += more.through;
    found_through += more.found_through;
    detected += more.detected;
    right += more.right;
    beyond += more.beyond;
    wrong += more.wrong;
    seconds = std::max(seconds, more.seconds);
    iou.insert(iou.end(), more.iou.begin(), more.iou.end());
    corner_m.insert(corner_m.end(), more.corner_m.begin(), more.corner_m.end());
    sigmas.insert(sigmas.end(), more.sigmas.begin(), more.sigmas.end());
    reveal_sigmas.insert(reveal_sigmas.end(), more.reveal_sigmas.begin(), more.reveal_sigmas.end());
    reveal_m.insert(reveal_m.end(), more.reveal_m.begin(), more.reveal_m.end());
    return *this;
  }
};

double percent(int part, int whole) {
  return whole > 0 ? 100.0 * part / whole : 100.0;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// A true opening as one scan should find it, in the scan's coordinates.
struct Wanted {
  std::size_t index = 0;
  std::array<Vector3d, 4> corners;  ///< in the order of Opening::corners
  Vector3d normal = Vector3d::UnitX();
  double thickness_m = 0.0;
  bool in_view = false;
  bool through = false;
};

int bits(std::uint64_t cells) {
  int count = 0;
  for (; cells != 0; cells &= cells - 1) ++count;
  return count;
}

/// One face of an opening, corners from lower left as seen from before it, in the truth's coordinates.
Wanted face_of(const TrueOpening& opening, bool outer) {
  const auto& i = opening.inner;
  Wanted wanted;
  wanted.corners = outer ? opening.outer : std::array<Vector3d, 4>{i[1], i[0], i[3], i[2]};
  wanted.normal = outer ? opening.normal : Vector3d(-opening.normal);
  wanted.thickness_m = opening.thickness_m;
  return wanted;
}

/// Whether the scan must find the opening on this face: a façade's from the street, a room's from its
/// station.
bool faces_scan(const TrueOpening& opening, const ScanTruth& scan, bool outer) {
  if (scan.mobile) return outer && opening.exterior;
  const std::size_t room = outer ? 1 : 0;
  return opening.rooms.size() > room && opening.rooms[room] == scan.room;
}

/// Points on the wall in the frame about an opening, and on the opening's own face: per square metre.
struct Density {
  double around = 0.0;
  bool before = false;  ///< the scanner stood before the face at some of them
};

Density density_about(const Scan& scan, const Wanted& wanted) {
  constexpr double kRim_m = 0.25;
  const Vector3d across = wanted.corners[1] - wanted.corners[0];
  const Vector3d upright = wanted.corners[3] - wanted.corners[0];
  const Vector2d size(across.norm(), upright.norm());
  const PlaneFrame frame{wanted.corners[0], across / size.x(), upright / size.y()};
  Density density;
  std::size_t count = 0;
  const double reach2 = std::pow(size.norm() + kRim_m, 2);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d d = scan.points[i] - wanted.corners[0];
    if (std::abs(d.dot(wanted.normal)) > 0.03 || d.squaredNorm() > reach2) continue;
    const Vector2d p = frame.to_plane(scan.points[i]);
    if ((p.array() < -kRim_m).any() || (p.array() > (size.array() + kRim_m)).any()) continue;
    if ((p.array() > 0.0).all() && (p.array() < size.array()).all()) continue;
    ++count;
    if ((scan.centre(i) - wanted.corners[0]).dot(wanted.normal) > 0.0) density.before = true;
  }
  const double rim_m2 = (size.x() + 2.0 * kRim_m) * (size.y() + 2.0 * kRim_m) - size.prod();
  density.around = static_cast<double>(count) / rim_m2;
  return density;
}

/// Decides whether the opening is in view, and seen through.
void judge_view(const Scan& scan, const OpeningSight& sight, const Settings& settings, Wanted& wanted) {
  const double rays = static_cast<double>(sight.through + sight.parts);
  const double area_m2 =
      (wanted.corners[1] - wanted.corners[0]).norm() * (wanted.corners[3] - wanted.corners[0]).norm();
  const Density density = density_about(scan, wanted);
  wanted.in_view = density.before && rays >= static_cast<double>(settings.min_rays) &&
                   rays >= 0.2 * density.around * area_m2;
  wanted.through = wanted.in_view && bits(sight.cells) >= 32;
}

std::vector<Wanted> wanted_of(const SimulatedCase& simulated, std::size_t s, const Settings& settings) {
  const Scan& scan = simulated.scans[s];
  const ScanTruth& truth = simulated.truth.scans[s];
  // Truth is about Truth::local_origin, points about Scan::local_origin.
  const Rigid3 scan_from_local = inverse(truth.local_from_scan);
  const Vector3d shift = truth.mobile ? Vector3d(simulated.truth.local_origin - scan.local_origin)
                                      : Vector3d(-scan.local_origin);
  std::vector<Wanted> list;
  for (std::size_t k = 0; k < simulated.truth.openings.size(); ++k) {
    const TrueOpening& opening = simulated.truth.openings[k];
    for (const bool outer : {true, false}) {
      Wanted wanted = face_of(opening, outer);
      wanted.index = k;
      for (Vector3d& corner : wanted.corners)
        corner = truth.mobile ? Vector3d(corner + shift) : Vector3d(scan_from_local * corner + shift);
      if (!truth.mobile) wanted.normal = scan_from_local.rotation * wanted.normal;
      if (faces_scan(opening, truth, outer)) judge_view(scan, opening.sights[s], settings, wanted);
      list.push_back(wanted);
    }
  }
  return list;
}

/// Low and high of a found rectangle in the frame of a true one, and the distance between their planes.
struct Fit {
  double iou = 0.0;
  double inside = 0.0;                      ///< part of the found one within the true one
  std::array<double, 4> edge_error_m = {};  ///< bottom, right, top, left
};

Fit compare(const Opening& opening, const Wanted& wanted) {
  Fit fit;
  const Vector3d across = wanted.corners[1] - wanted.corners[0];
  const Vector3d upright = wanted.corners[3] - wanted.corners[0];
  const Vector2d size(across.norm(), upright.norm());
  const PlaneFrame frame{wanted.corners[0], across / size.x(), upright / size.y()};
  if (std::abs((opening.middle() - wanted.corners[0]).dot(wanted.normal)) > 0.1) return fit;
  const Vector3d normal =
      (opening.corners[1] - opening.corners[0]).cross(opening.corners[3] - opening.corners[0]);
  if (normal.dot(wanted.normal) < 0.9 * normal.norm()) return fit;
  Vector2d low(1e9, 1e9);
  Vector2d high(-1e9, -1e9);
  for (const Vector3d& corner : opening.corners) {
    low = low.cwiseMin(frame.to_plane(corner));
    high = high.cwiseMax(frame.to_plane(corner));
  }
  const Vector2d common = high.cwiseMin(size) - low.cwiseMax(Vector2d::Zero());
  if ((common.array() <= 0.0).any()) return fit;
  fit.iou = common.prod() / (size.prod() + (high - low).prod() - common.prod());
  fit.inside = common.prod() / (high - low).prod();
  fit.edge_error_m = {low.y(), high.x() - size.x(), high.y() - size.y(), low.x()};
  return fit;
}

void record(const Opening& opening, const Wanted& wanted, const Fit& fit, Tally& tally) {
  tally.iou.push_back(fit.iou);
  for (std::size_t k = 0; k < 4; ++k) {
    tally.corner_m.push_back((opening.corners[k] - wanted.corners[k]).norm());
    if (opening.edge_sigma_m[k] < 1.0)
      tally.sigmas.push_back(std::abs(fit.edge_error_m[k]) / opening.edge_sigma_m[k]);
  }
  if (opening.reveal_complete) {
    tally.reveal_m.push_back(std::abs(opening.reveal_depth_m - wanted.thickness_m));
    tally.reveal_sigmas.push_back(tally.reveal_m.back() / std::max(1e-9, opening.reveal_sigma_m));
  }
}

/// What the wall of an opening is in truth: the element most of its points belong to.
std::string wall_element(const Truth& truth, std::size_t scan, const std::vector<std::int32_t>& labels,
                         int facade) {
  std::array<int, 20> count{};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::int32_t plane = truth.scans[scan].plane_of_point[i];
    if (labels[i] == facade && plane >= 0)
      ++count[static_cast<std::size_t>(truth.planes[static_cast<std::size_t>(plane)].element)];
  }
  const auto most = std::max_element(count.begin(), count.end()) - count.begin();
  return to_string(static_cast<Element>(most));
}

void list_opening(const char* what, const Opening& opening) {
  const Vector3d& a = opening.corners[0];
  fmt::print(
      "#  {} {} {:.2f} x {:.2f} m at ({:.2f} {:.2f} {:.2f}) plane {} evidence {} sigma {:.3f} {:.3f} {:.3f} "
      "{:.3f}\n",
      what, to_string(opening.view), (opening.corners[1] - a).norm(), (opening.corners[3] - a).norm(), a.x(),
      a.y(), a.z(), opening.facade, opening.evidence, opening.edge_sigma_m[0], opening.edge_sigma_m[1],
      opening.edge_sigma_m[2], opening.edge_sigma_m[3]);
}

void print_errors(const Opening& opening, const Fit& fit, const TrueOpening& truth) {
  constexpr std::array<double, 4> kOutward = {-1.0, 1.0, 1.0, -1.0};
  for (std::size_t k = 0; k < 4; ++k)
    fmt::print("edge,{},{},{},{},{:.4f},{:.4f}\n", truth.kind, truth.curtained ? "curtained" : "open",
               to_string(opening.view), k, kOutward[k] * fit.edge_error_m[k], opening.edge_sigma_m[k]);
  fmt::print("reveal,{},{},{},{},{:.4f},{:.4f},{:.4f}\n", truth.kind, truth.curtained ? "curtained" : "open",
             to_string(opening.view), opening.reveal_complete ? "complete" : "seen", opening.reveal_depth_m,
             opening.reveal_sigma_m, truth.thickness_m);
}

void list_errors(const Opening& opening, const Wanted& wanted, const Fit& fit, const TrueOpening& truth) {
  const auto& e = fit.edge_error_m;
  list_opening("far off", opening);
  fmt::print("#    {} {}{} iou {:.2f} errors {:.3f} {:.3f} {:.3f} {:.3f} reveal {:.3f} of {:.3f}\n",
             truth.kind, wanted.index, truth.curtained ? " curtained" : "", fit.iou, e[0], e[1], e[2], e[3],
             opening.reveal_depth_m, wanted.thickness_m);
}

void list_missed(const Wanted& wanted, const TrueOpening& truth, std::size_t scan) {
  const Vector3d& a = wanted.corners[0];
  const OpeningSight& sight = truth.sights[scan];
  fmt::print(
      "#  missed {} {}{}{} {:.2f} x {:.2f} m at ({:.2f} {:.2f} {:.2f}): {} rays through, {} on parts, {} "
      "cells\n",
      truth.kind, wanted.index, truth.curtained ? " curtained" : "", wanted.through ? " seen through" : "",
      (wanted.corners[1] - a).norm(), (wanted.corners[3] - a).norm(), a.x(), a.y(), a.z(), sight.through,
      sight.parts, bits(sight.cells));
}

/// The seen part of an opening that is not in view as a whole.
bool part_of_hidden(const Opening& opening, const std::vector<Wanted>& wanted) {
  return std::any_of(wanted.begin(), wanted.end(),
                     [&](const Wanted& it) { return !it.in_view && compare(opening, it).inside > 0.8; });
}

Tally match(const std::vector<Opening>& openings, const std::vector<Wanted>& wanted, const Truth& truth,
            std::size_t scan, const std::vector<std::int32_t>& labels, const Settings& settings) {
  struct Pair {
    double iou;
    std::size_t found, wanted;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < openings.size(); ++i) {
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      const double iou = compare(openings[i], wanted[j]).iou;
      if (iou >= 0.5) pairs.push_back({iou, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.iou > b.iou; });
  std::vector<char> used(openings.size(), 0);
  std::vector<char> taken(wanted.size(), 0);
  Tally tally;
  tally.detected = static_cast<int>(openings.size());
  for (const Pair& pair : pairs) {
    if (used[pair.found] != 0 || taken[pair.wanted] != 0) continue;
    used[pair.found] = taken[pair.wanted] = 1;
    const Wanted& it = wanted[pair.wanted];
    ++(it.in_view ? tally.right : tally.beyond);
    if (!it.in_view) continue;
    const Fit fit = compare(openings[pair.found], it);
    record(openings[pair.found], it, fit, tally);
    if (settings.errors) print_errors(openings[pair.found], fit, truth.openings[it.index]);
    if (settings.list && fit.iou < 0.9) list_errors(openings[pair.found], it, fit, truth.openings[it.index]);
  }
  for (std::size_t i = 0; i < openings.size(); ++i) {
    if (used[i] != 0) continue;
    if (part_of_hidden(openings[i], wanted)) {
      ++tally.beyond;
      continue;
    }
    ++tally.wrong;
    if (settings.list)
      list_opening(("wrong " + wall_element(truth, scan, labels, openings[i].facade)).c_str(), openings[i]);
  }
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    if (!wanted[j].in_view) continue;
    ++tally.in_view;
    tally.found += taken[j];
    tally.through += wanted[j].through ? 1 : 0;
    tally.found_through += wanted[j].through ? taken[j] : 0;
    if (settings.list && taken[j] == 0) list_missed(wanted[j], truth.openings[wanted[j].index], scan);
  }
  return tally;
}

Tally run_scan(const SimulatedCase& simulated, std::size_t s, const Settings& settings) {
  const Scan& scan = simulated.scans[s];
  ExtractOptions extract;
  extract.detect.relief = false;  // as openings are sought by the program
  const ExtractedFeatures extracted = extract_features(scan, extract);
  // A simulated station may lie at any rotation: its vertical is known from the truth.
  const ScanTruth& truth = simulated.truth.scans[s];
  const Vector3d up = truth.mobile ? Vector3d(Vector3d::UnitZ())
                                   : Vector3d(truth.local_from_scan.rotation.transpose() * Vector3d::UnitZ());
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Opening> openings = find_openings(scan, extracted, up);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  Tally tally =
      match(openings, wanted_of(simulated, s, settings), simulated.truth, s, extracted.labels, settings);
  tally.seconds = seconds.count();
  return tally;
}

void print_row(const std::string& scene, int seed, const Scan& scan, const Tally& t) {
  fmt::print("{},{},{},{},{},{},{},{},{},{},{},{:.3f},{:.4f},{:.4f},{:.3f}\n", scene, seed, scan.name,
             scan.size(), t.through, t.found_through, t.in_view, t.found, t.detected, t.right, t.wrong,
             t.iou.empty() ? 0.0 : quantile(t.iou, 0.5), quantile(t.corner_m, 0.5),
             quantile(t.corner_m, 0.95), t.seconds);
  std::fflush(stdout);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double share_below(const std::vector<double>& values, double bound) {
  const auto below = std::count_if(values.begin(), values.end(), [&](double v) { return v <= bound; });
  return percent(static_cast<int>(below), static_cast<int>(values.size()));
}

void summarise(const std::string& name, const Tally& t) {
  fmt::print(
      "# {}: recall seen through {:.1f} % ({} of {}), all in view {:.1f} % ({} of {}), precision {:.1f} % "
      "({} wrong, {} right), IoU {:.3f}, corner median {:.1f} mm, 95 % {:.1f} mm; edges within 1 sigma "
      "{:.1f} %, "
      "2 sigma {:.1f} %; wall thickness from {} reveals: median error {:.1f} mm, within 2 sigma {:.1f} %; "
      "{:.2f} s\n",
      name, percent(t.found_through, t.through), t.found_through, t.through, percent(t.found, t.in_view),
      t.found, t.in_view, percent(t.right, t.right + t.wrong), t.wrong, t.right, mean(t.iou),
      1e3 * quantile(t.corner_m, 0.5), 1e3 * quantile(t.corner_m, 0.95), share_below(t.sigmas, 1.0),
      share_below(t.sigmas, 2.0), t.reveal_m.size(), 1e3 * quantile(t.reveal_m, 0.5),
      share_below(t.reveal_sigmas, 2.0), t.seconds);
}

Tally run(const std::string& scene, int seed, const Settings& settings) {
  SceneOptions options;
  options.name = scene;
  options.seed = static_cast<std::uint64_t>(seed);
  options.curtain_share = settings.curtains;
  if (settings.outdoor) {
    options.points_outdoor = settings.points > 0 ? settings.points : 800000;
    options.points_indoor = 2000;
    options.stations = 1;
  } else {
    options.points_indoor = settings.points;
    options.stations = settings.stations;
    options.points_outdoor = 0;
  }
  SimulatedCase simulated = simulate(options);
  if (settings.kept) keep_as_features_do(simulated, settings.keep);
  Tally sum;
  for (std::size_t s = 0; s < simulated.scans.size(); ++s) {
    if (simulated.truth.scans[s].mobile != settings.outdoor) continue;
    const Tally tally = run_scan(simulated, s, settings);
    print_row(scene, seed, simulated.scans[s], tally);
    sum += tally;
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Quality of limen's openings against the simulator's exact truth");
  app.add_option("--scene", settings.scenes, "built-in scenes (default museum)");
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of buildings");
  app.add_option("--points", settings.points, "points of each scan; 0: the scene's own, 800000 outdoors");
  app.add_option("--stations", settings.stations, "stations of each building; 0: the scene's own");
  app.add_flag("--outdoor", settings.outdoor, "the mobile scan instead of the stations");
  app.add_option("--curtains", settings.curtains, "share of curtained windows; negative: the scene's own");
  app.add_option("--min-rays", settings.min_rays, "rays that met an opening in view");
  app.add_option("--threads", settings.threads, "0: the machine's");
  app.add_flag("--errors", settings.errors, "a line for each edge: outward error, deviation");
  app.add_flag("--kept", settings.kept, "of dense scans the points that features are found on");
  app.add_option("--kept-per-m2", settings.keep.most_per_m2,
                 "with --kept: so many on a square metre, of stations");
  app.add_option("--kept-per-m2-of-way", settings.keep.most_per_m2_of_way, "the same of mobile scans");
  app.add_flag("--list", settings.list, "name what was missed, wrong, or far off");
  CLI11_PARSE(app, argc, argv);
  set_thread_count(settings.threads);
  fmt::print(
      "scene,seed,scan,points,through,found_through,in_view,found,detected,right,wrong,median_iou,"
      "median_corner_m,p95_corner_m,seconds\n");
  Tally all;
  for (const std::string& scene : settings.scenes) {
    Tally sum;
    for (int seed = settings.first_seed; seed < settings.first_seed + settings.seeds; ++seed)
      sum += run(scene, seed, settings);
    summarise(scene, sum);
    all += sum;
  }
  if (settings.scenes.size() > 1) summarise("all", all);
  return 0;
}
