// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Spheres and checkerboards found in simulated scans of a hall, against the truth.
//   bench_targets --trials 20
// One line for each range, density (points of a whole scan) and noise: how many points hit the target, the
// share found, the error of the centres, and how it compares with the stated deviation. Then the same by the
// number of points that hit, and what was found that is no target: things beside the targets, and a hall of
// look-alikes.
//
// - Boards hang plumb in one half of the trials, so that their edges lie along the rows and columns of
//   points, and at any turn in the other; slanted by up to 45 degrees. Ranges vary by 5 %, so that the steps
//   between points are no fraction of a board.
// - error: root mean square per axis, millimetres; *3-D* that of the distance. ratio: root mean square of
//   the distance over the square root of 3 and the stated deviation; below 1 the deviation is cautious.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/extract/targets/find_targets.h"
#include "limen/geometry/random_vectors.h"
#include "limen/simulate/furnishing/shapes.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/whole/site_targets.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

const TargetOptions kSizes{kSphereRadiusM, kBoardSideM};

struct Tally {
  int put_up = 0;
  int found = 0;
  double points = 0.0;
  double squares_m2 = 0.0;
  double ratios = 0.0;
  double most_m = 0.0;

  void add(double points_on, const FoundTarget* target, const Vector3d& centre) {
    ++put_up;
    points += points_on;
    if (target == nullptr) return;
    ++found;
    const double off = (target->centre - centre).squaredNorm();
    squares_m2 += off;
    ratios += off / (3.0 * target->sigma_m * target->sigma_m);
    most_m = std::max(most_m, std::sqrt(off));
  }
  [[nodiscard]] std::string words() const {
    const double n = std::max(1, found);
    return fmt::format("{:7.0f} {:6.1f} {:7.2f} {:6.2f} {:6.2f} {:6.2f}", points / std::max(1, put_up),
                       100.0 * found / std::max(1, put_up), 1e3 * std::sqrt(squares_m2 / n / 3.0),
                       1e3 * std::sqrt(squares_m2 / n), 1e3 * most_m, std::sqrt(ratios / n));
  }
};

/// The hall: 24 m long, the scanner at one end looks along x.
Mesh hall() {
  Mesh mesh;
  const auto wall = [&](const Vector3d& a, const Vector3d& u, const Vector3d& v, Element element) {
    mesh.add_polygon({a, a + u, a + u + v, a + v}, surface_of(element));
  };
  const Vector3d x(24, 0, 0);
  const Vector3d y(0, 10, 0);
  const Vector3d z(0, 0, 4.5);
  const Vector3d low(-2, -5, -1.6);
  wall(low, x, y, Element::floor);
  wall(low + z, y, x, Element::ceiling);
  wall(low, z, x, Element::wall);
  wall(low + y, x, z, Element::wall);
  wall(low + x, z, y, Element::wall);
  wall(low, y, z, Element::wall);
  return mesh;
}

struct Setting {
  double points = 2e7;
  double noise_m = 0.003;
};

/// A scan of what lies within some degrees of the x axis, as dense as a whole one of so many points.
Sweep part_of_scan(const RayCaster& caster, const Setting& setting, double half_deg, std::uint64_t seed) {
  FieldOfView view;
  view.span_deg = 2.0 * half_deg;
  view.low_deg = -std::min(60.0, half_deg);
  view.high_deg = std::min(90.0, half_deg);
  const double share = view.span_deg * (view.high_deg - view.low_deg) / (360.0 * 150.0);
  RandomStream random(seed, 5);
  const Rigid3 heading{rotation_exp({0, 0, -radians(half_deg + 0.01 * random.uniform())}), Vector3d::Zero()};
  ScannerOptions options;
  options.noise_m = setting.noise_m;
  return sweep(caster, {}, station_pattern(heading, static_cast<std::size_t>(setting.points * share), view),
               options, seed);
}

Vector3d toward(double azimuth_deg, double elevation_deg, double range_m) {
  const double a = radians(azimuth_deg);
  const double e = radians(elevation_deg);
  return range_m * Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
}

struct Trials {
  Tally sphere;
  Tally board;
  std::vector<std::pair<double, Tally>> by_points[2];
  int others = 0;
};

const FoundTarget* nearest(const std::vector<FoundTarget>& found, TargetKind kind, const Vector3d& x) {
  for (const FoundTarget& target : found)
    if (target.kind == kind && (target.centre - x).norm() < 0.03) return &target;
  return nullptr;
}

void add_trial(double nominal_range_m, const Setting& setting, std::uint64_t seed, Trials& trials) {
  RandomStream random(seed, 1);
  const double range_m = nominal_range_m * random.uniform(0.95, 1.05);
  Mesh mesh = hall();
  const double aside_deg = degrees(std::atan(0.3 / range_m));
  const Vector3d ball = toward(aside_deg, random.uniform(-0.3, 0.3) * aside_deg, range_m);
  const Vector3d middle = toward(-aside_deg, random.uniform(-0.3, 0.3) * aside_deg, range_m);
  const int first_of_ball = static_cast<int>(mesh.mark().surfaces);
  add_sphere(mesh, ball);
  mesh.add_box({ball - Vector3d(0, 0, 1.0), 0.0}, {0.02, 0.02, 1.0 - kSphereRadiusM},
               surface_of(Element::furniture));
  const double slant = radians(random.uniform(-45.0, 45.0));
  const double roll = seed % 2 == 0 ? 0.0 : random.uniform(0.0, std::numbers::pi);
  const Matrix3d turn = rotation_exp({0, 0, slant}) * rotation_exp({roll, 0, 0});
  const int first_of_board = static_cast<int>(mesh.mark().surfaces);
  add_board(mesh, {middle, turn * Vector3d(0, -1, 0), turn * Vector3d(0, 0, 1)});
  const RayCaster caster(mesh);
  const Sweep result = part_of_scan(caster, setting, 2.6 * aside_deg, seed);
  double on_ball = 0.0;
  double on_board = 0.0;
  for (const Echo& echo : result.echoes) {
    if (echo.surface == first_of_ball) ++on_ball;
    if (echo.surface >= first_of_board) ++on_board;
  }
  const std::vector<FoundTarget> found = find_targets(station_scan("hall", result, {}), kSizes);
  const FoundTarget* sphere = nearest(found, TargetKind::sphere, ball);
  const FoundTarget* board = nearest(found, TargetKind::board, middle);
  trials.sphere.add(on_ball, sphere, ball);
  trials.board.add(on_board, board, middle);
  trials.others += static_cast<int>(found.size()) - (sphere != nullptr ? 1 : 0) - (board != nullptr ? 1 : 0);
  const auto by_points = [&](std::size_t kind, double on, const FoundTarget* target, const Vector3d& centre) {
    for (auto& [least, tally] : trials.by_points[kind])
      if (on >= least && on < 2.0 * least) tally.add(on, target, centre);
  };
  by_points(0, on_ball, sphere, ball);
  by_points(1, on_board, board, middle);
}

/// Things that look like targets: none may be found.
std::vector<std::string> found_among_look_alikes(const Setting& setting, std::uint64_t seed) {
  RandomStream random(seed, 2);
  Mesh mesh = hall();
  const Surface thing = surface_of(Element::furniture);
  std::vector<std::pair<std::string, Vector3d>> put_up;
  const auto place = [&](const char* what) {
    const double azimuth = random.uniform(-40, 40);
    const double elevation = random.uniform(-15, 15);
    put_up.emplace_back(what, toward(azimuth, elevation, random.uniform(1.5, 12)));
    return put_up.back().second;
  };
  for (const double share : {0.5, 0.7, 0.8, 0.88, 1.12, 1.2, 1.35, 1.6})  // lamps, balls
    add_sphere(mesh, place("ball"), share * kSphereRadiusM);
  for (int k = 0; k < 6; ++k)  // heads
    ShapeBuilder(mesh, place("head"), Vector2d::UnitX(), 0.5)
        .ellipsoid(Vector3d::Zero(), {0.09, 0.075, 0.115});
  for (int k = 0; k < 6; ++k) {  // domes on the ceiling and the wall
    const Vector3d spot = place("dome");
    add_sphere(mesh, {spot.x(), spot.y(), 2.9 + random.uniform(0.03, 0.06)});
  }
  for (int k = 0; k < 6; ++k) {  // pipes
    const Vector3d spot = place("pipe");
    std::vector<Vector3d> ring;
    for (int side = 0; side < 40; ++side)
      ring.push_back({spot.x() + kSphereRadiusM * std::cos(side * std::numbers::pi / 20),
                      spot.y() + kSphereRadiusM * std::sin(side * std::numbers::pi / 20), -1.6});
    mesh.add_prism(ring, 3.0, thing);
  }
  // A chequered floor, wall tiles, larger and smaller boards, frames of pictures, stripes.
  for (const double tile : {0.5, 1.0, 0.35, 0.8}) {
    const double step = tile * kBoardSideM;
    const Vector3d corner = place("tiles") + Vector3d(0.5, 0, 0);
    const bool lies = tile > 0.9;
    for (int a = 0; a < 6; ++a) {
      for (int b = 0; b < 6; ++b) {
        Surface paper = thing;
        paper.reflectivity = (a + b) % 2 == 0 ? 0.85 : 0.06;
        const Vector3d u = step * (lies ? Vector3d(1, 0, 0) : Vector3d(0, -1, 0));
        const Vector3d v = step * (lies ? Vector3d(0, 1, 0) : Vector3d(0, 0, 1));
        const Vector3d at = (lies ? Vector3d(corner.x(), corner.y(), -1.59) : corner) + a * u + b * v;
        mesh.add_polygon({at, at + u, at + u + v, at + v}, paper);
      }
    }
  }
  for (const double share : {0.4, 0.6, 0.75, 1.25, 1.5, 2.0})
    add_board(mesh, {place("board"), {0, -1, 0}, {0, 0, 1}}, share * kBoardSideM);
  for (int k = 0; k < 8; ++k) {
    const Vector3d middle = place("picture");
    Surface paper = thing;
    paper.reflectivity = 0.06;
    const double side = random.uniform(0.2, 0.5);
    mesh.add_polygon({middle, middle + Vector3d(0, -side, 0), middle + Vector3d(0, -side, side),
                      middle + Vector3d(0, 0, side)},
                     paper);
    paper.reflectivity = 0.85;
    const Vector3d inner = middle + Vector3d(-0.003, -0.2 * side, 0.3 * side);
    mesh.add_polygon({inner, inner + Vector3d(0, -0.5 * side, 0),
                      inner + Vector3d(0, -0.5 * side, 0.3 * side), inner + Vector3d(0, 0, 0.3 * side)},
                     paper);
  }
  const RayCaster caster(mesh);
  std::vector<std::string> words;
  for (const FoundTarget& it :
       find_targets(station_scan("hall", part_of_scan(caster, setting, 50.0, seed), {}), kSizes)) {
    const auto near = std::min_element(put_up.begin(), put_up.end(), [&](const auto& a, const auto& b) {
      return (a.second - it.centre).norm() < (b.second - it.centre).norm();
    });
    words.push_back(fmt::format("{} of {} points, {:.2f} m from a {}", to_string(it.kind), it.points,
                                (near->second - it.centre).norm(), near->first));
  }
  return words;
}

void print_look_alikes(int trials) {
  std::size_t found = 0;
  for (int k = 0; k < trials; ++k) {
    const Setting setting{2e7, k % 2 == 0 ? 0.002 : 0.004};
    for (const std::string& words : found_among_look_alikes(setting, 900U + static_cast<unsigned>(k))) {
      ++found;
      fmt::print("  false: {}\n", words);
    }
  }
  fmt::print("halls of look-alikes: {}; targets found in them: {}\n", trials, found);
}

void run(int count, const std::vector<double>& ranges) {
  Trials all;
  for (auto& bins : all.by_points)
    for (double least = 10.0; least < 1e6; least *= 2.0) bins.emplace_back(least, Tally{});
  const char* head = "points found_% error_mm   3-D   most  ratio";
  fmt::print("range points_of_scan noise_mm | sphere: {} | board: {}\n", head, head);
  std::uint64_t seed = 1;
  for (const double range_m : ranges) {
    for (const double points : {2e6, 1e7, 4e7}) {
      for (const double noise_m : {0.001, 0.003, 0.005}) {
        Trials trials;
        trials.by_points[0].swap(all.by_points[0]);
        trials.by_points[1].swap(all.by_points[1]);
        for (int k = 0; k < count; ++k) add_trial(range_m, {points, noise_m}, ++seed, trials);
        trials.by_points[0].swap(all.by_points[0]);
        trials.by_points[1].swap(all.by_points[1]);
        all.others += trials.others;
        fmt::print("{:5.0f} {:8.0e} {:8.0f}      | {} | {}\n", range_m, points, 1e3 * noise_m,
                   trials.sphere.words(), trials.board.words());
        std::fflush(stdout);
      }
    }
  }
  for (const std::size_t kind : {0, 1}) {
    fmt::print("{} by points that hit: {}\n", kind == 0 ? "spheres" : "boards", head);
    for (const auto& [least, tally] : all.by_points[kind])
      if (tally.put_up > 0)
        fmt::print("  {:6.0f} to {:6.0f} ({:4} put up) {}\n", least, 2.0 * least, tally.put_up,
                   tally.words());
  }
  fmt::print("found beside the targets: {}\n", all.others);
}

}  // namespace

int main(int argc, char** argv) {
  int trials = 20;
  int look_alikes = 20;
  std::vector<double> ranges = {1.0, 2.0, 5.0, 10.0, 15.0, 20.0};
  CLI::App app("Targets found in simulated scans");
  app.add_option("--trials", trials);
  app.add_option("--look-alikes", look_alikes);
  app.add_option("--ranges", ranges);
  CLI11_PARSE(app, argc, argv);
  if (trials > 0) run(trials, ranges);
  print_look_alikes(look_alikes);
  return 0;
}
