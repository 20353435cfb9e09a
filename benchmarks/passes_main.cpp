// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Mobile passes that drift, held against the truth: a building is simulated, put into one frame with passes
// that stay rigid and with passes that are bent, and the distances of points of the passes and of the
// stations from the truth are printed, with what a spline of the same knots fitted to the truth itself would
// leave.
//   bench_passes --building museum --stations 0 --passes 4 --drift-m 0.02 --drift walk --seeds 3
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/geometry/linear.h"
#include "limen/geometry/spline_motion.h"
#include "limen/io/ply/ply.h"
#include "limen/project/project.h"
#include "limen/simulate/whole/project_scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header
namespace fs = std::filesystem;

struct Settings {
  ProjectSceneOptions scene;
  std::string drift = "walk";
  int seeds = 1;
  std::string folder = "bench_passes";
};

/// A point of a pass as it was measured and as it is, about the truth's local origin.
struct PassPoint {
  double time_s = 0.0;
  Vector3d measured = Vector3d::Zero();
  Vector3d truth = Vector3d::Zero();
};

struct SimulatedProject {
  ProjectTruth truth;
  ProjectInputs inputs;
  std::map<std::string, std::vector<PassPoint>> points;  ///< of passes, by the file's name
};

Vector3d drift_at(const std::vector<DriftSample>& drift, double time_s) {
  const auto after = std::upper_bound(drift.begin(), drift.end(), time_s,
                                      [](double t, const DriftSample& sample) { return t < sample.time_s; });
  if (after == drift.begin()) return drift.front().error;
  if (after == drift.end()) return drift.back().error;
  const DriftSample& a = *(after - 1);
  const double share = (time_s - a.time_s) / (after->time_s - a.time_s);
  return (1.0 - share) * a.error + share * after->error;
}

SimulatedProject simulate(const Settings& settings, const fs::path& folder) {
  constexpr std::size_t kEvery = 37;
  fs::create_directories(folder);
  SimulatedProject made;
  std::vector<Scan> passes;
  made.truth = simulate_project(settings.scene, [&](const Scan& scan) {
    const std::string file = (folder / (scan.name + ".ply")).string();
    write_ply(file, scan);
    made.inputs.scans.push_back(file);
    if (scan.mobile()) passes.push_back(scan);
  });
  for (const SimulatedScan& scan : made.truth.scans) {
    if (!scan.mobile) continue;
    const Scan& pass =
        *std::find_if(passes.begin(), passes.end(), [&](const Scan& one) { return one.name == scan.name; });
    std::vector<PassPoint>& points = made.points[(folder / (scan.name + ".ply")).string()];
    const Vector3d shift = pass.local_origin - made.truth.local_origin;
    for (std::size_t i = 0; i < pass.size(); i += kEvery) {
      const Vector3d measured = pass.points[i] + shift;
      points.push_back({pass.times_s[i], measured, measured - drift_at(scan.drift, pass.times_s[i])});
    }
  }
  return made;
}

/// The rigid motion that brings points best to others.
Rigid3 fitted(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
  Vector3d mean_from = Vector3d::Zero();
  Vector3d mean_to = Vector3d::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) {
    mean_from += from[k] / static_cast<double>(from.size());
    mean_to += to[k] / static_cast<double>(to.size());
  }
  Matrix3d mixed = Matrix3d::Zero();
  for (std::size_t k = 0; k < from.size(); ++k)
    mixed += (to[k] - mean_to) * (from[k] - mean_from).transpose();
  Rigid3 motion;
  motion.rotation = nearest_rotation(mixed);
  motion.translation = mean_to - motion.rotation * mean_from;
  return motion;
}

/// What the natural spline with a pass's knots leaves that is fitted to its true drift.
double spline_leaves(const std::vector<double>& knots, const std::vector<PassPoint>& points) {
  const auto size = static_cast<Eigen::Index>(knots.size());
  Eigen::MatrixXd normal = 1e-9 * Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(size, 3);
  const auto shares = [&](const PassPoint& point) {
    return spline_shares(static_cast<int>(size), place_among(knots, point.time_s));
  };
  for (const PassPoint& point : points) {
    for (const SplineShare& a : shares(point)) {
      right.row(a.control) += a.weight * (point.truth - point.measured).transpose();
      for (const SplineShare& b : shares(point)) normal(a.control, b.control) += a.weight * b.weight;
    }
  }
  const Eigen::MatrixXd controls = inverse_of(normal) * right;
  double squares = 0.0;
  for (const PassPoint& point : points) {
    Vector3d left = point.measured - point.truth;
    for (const SplineShare& a : shares(point)) left += a.weight * controls.row(a.control).transpose();
    squares += left.squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(points.size()));
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Points of the passes and scanners of the stations as a result has them.
struct Compared {
  int passes = 0;
  int bent = 0;
  double passes_rms_m = 0.0;
  double spline_rms_m = 0.0;  ///< that the truth's own splines leave
  int stations = 0;           ///< joined to the passes, in whatever state
  int far = 0;                ///< of them: more than 10 cm off: joined wrongly
  double stations_median_m = 0.0;
  double stations_rms_m = 0.0;
  int knots_within = 0;  ///< numbers of corrections within two deviations, and all
  int knots_numbers = 0;
};

/// Of the corrections of a pass, about their means, how many numbers lie within two of their deviations.
void count_knots(const PassCorrection& correction, const std::vector<DriftSample>& drift,
                 Compared& compared) {
  Vector3d mean_found = Vector3d::Zero();
  Vector3d mean_true = Vector3d::Zero();
  const auto count = static_cast<double>(correction.knots.size());
  for (const PassKnot& knot : correction.knots) {
    mean_found += knot.moved_m / count;
    mean_true -= drift_at(drift, knot.time_s) / count;
  }
  for (const PassKnot& knot : correction.knots) {
    const Vector3d missed = (knot.moved_m - mean_found) - (-drift_at(drift, knot.time_s) - mean_true);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      ++compared.knots_numbers;
      compared.knots_within += std::abs(missed[axis]) < 2.0 * knot.moved_sigma_m[axis] ? 1 : 0;
    }
  }
}

/// That with the most passes, the lowest of them.
int component_of_passes(const ProjectResult& result) {
  std::map<int, int> passes;
  for (const ProjectScan& scan : result.scans) {
    if (scan.mobile && scan.component >= 0) ++passes[scan.component];
  }
  int best = 0;
  for (const auto& [component, count] : passes) {
    if (count > passes[best]) best = component;
  }
  return best;
}

Compared compare(const SimulatedProject& made, const ProjectResult& result) {
  Compared compared;
  const Vector3d& origin = made.truth.local_origin;
  std::vector<Vector3d> found;
  std::vector<Vector3d> truth;
  double leaves = 0.0;
  const int component = component_of_passes(result);
  for (const ProjectScan& scan : result.scans) {
    const auto pass = made.points.find(scan.file);
    if (pass == made.points.end() || scan.component != component || !scan.frame_from_scan) continue;
    ++compared.passes;
    const Rigid3 pose = to_local(*scan.frame_from_scan, origin, origin);
    std::vector<double> times;
    std::vector<Vector6d> values;
    if (scan.correction) {
      for (const PassKnot& knot : scan.correction->knots) {
        times.push_back(knot.time_s);
        Vector6d value;
        value << knot.turn_rad, knot.shift_m;
        values.push_back(value);
      }
      ++compared.bent;
      const double left = spline_leaves(times, pass->second);
      leaves += left * left * static_cast<double>(pass->second.size());
      const auto known = std::find_if(
          made.truth.scans.begin(), made.truth.scans.end(),
          [&](const SimulatedScan& one) { return scan.file.ends_with("/" + one.name + ".ply"); });
      count_knots(*scan.correction, known->drift, compared);
    }
    for (const PassPoint& point : pass->second) {
      Vector3d x = pose * point.measured;
      if (scan.correction)
        x = SplineMotion(times, values, scan.correction->pivot - origin).moved(x, point.time_s);
      found.push_back(x);
      truth.push_back(point.truth);
    }
  }
  if (found.empty()) return compared;
  const Rigid3 truth_from_found = fitted(found, truth);
  double squares = 0.0;
  for (std::size_t k = 0; k < found.size(); ++k)
    squares += (truth_from_found * found[k] - truth[k]).squaredNorm();
  compared.passes_rms_m = std::sqrt(squares / static_cast<double>(found.size()));
  compared.spline_rms_m = std::sqrt(leaves / static_cast<double>(found.size()));
  std::vector<double> missed;
  squares = 0.0;
  for (const ProjectScan& scan : result.scans) {
    if (scan.mobile || scan.component != component || !scan.frame_from_scan) continue;
    for (std::size_t k = 0; k < made.truth.scans.size(); ++k) {
      const SimulatedScan& known = made.truth.scans[k];
      if (!scan.file.ends_with("/" + known.name + ".ply")) continue;
      const Rigid3 pose = to_local(*scan.frame_from_scan, Vector3d::Zero(), origin);
      const double off =
          (truth_from_found * (pose * known.scanner) - known.local_from_scan * known.scanner).norm();
      if (off > 0.1) {
        ++compared.far;
        continue;
      }
      missed.push_back(off);
      squares += off * off;
    }
  }
  compared.stations = static_cast<int>(missed.size());
  compared.stations_median_m = median(missed);
  compared.stations_rms_m = std::sqrt(squares / std::max<double>(1.0, static_cast<double>(missed.size())));
  return compared;
}

void print(std::uint64_t seed, const char* how, const Compared& c) {
  fmt::print("{:4} {:6} {:6} {:4} {:12.2f} {:12.2f} {:8} {:4} {:10.2f} {:8.2f} {:11}\n", seed, how, c.passes,
             c.bent, 1e3 * c.passes_rms_m, 1e3 * c.spline_rms_m, c.stations, c.far, 1e3 * c.stations_median_m,
             1e3 * c.stations_rms_m,
             c.knots_numbers > 0 ? fmt::format("{:.1f} %", 100.0 * c.knots_within / c.knots_numbers) : "-");
}

void run(Settings settings) {
  settings.scene.drift = settings.drift == "walk" ? DriftKind::walk : DriftKind::waves;
  fmt::print("drift {} mm ({}); lengths in mm\n", 1e3 * settings.scene.drift_m, settings.drift);
  fmt::print("{:>4} {:6} {:>6} {:>4} {:>12} {:>12} {:>8} {:>4} {:>10} {:>8} {:>11}\n", "seed", "passes",
             "joined", "bent", "points rms", "own spline", "stations", "far", "median", "rms", "in 2 sigma");
  const std::uint64_t first = settings.scene.seed;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(settings.seeds); ++seed) {
    settings.scene.seed = seed;
    const fs::path folder = fs::path(settings.folder) / fmt::format("{}_{}", settings.scene.name, seed);
    const SimulatedProject made = simulate(settings, folder);
    for (const bool rigid : {true, false}) {
      ProjectOptions options;
      options.rigid_passes = rigid;
      print(seed, rigid ? "rigid" : "bent", compare(made, run_project(made.inputs, folder / "out", options)));
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  settings.scene.drift_m = 0.008;
  CLI::App app{"Passes that drift, rigid and bent, against the truth"};
  app.add_option("--building", settings.scene.name, "Which building");
  app.add_option("--seed", settings.scene.seed, "The first");
  app.add_option("--seeds", settings.seeds, "How many");
  app.add_option("--stations", settings.scene.stations, "0: the building's own number");
  app.add_option("--passes", settings.scene.passes, "Negative: the building's own number");
  app.add_option("--points-station", settings.scene.points_station, "Of each");
  app.add_option("--points-pass", settings.scene.points_pass, "Of each");
  app.add_option("--drift-m", settings.scene.drift_m, "One standard deviation per axis");
  app.add_option("--drift", settings.drift, "walk or waves")->check(CLI::IsMember({"walk", "waves"}));
  app.add_option("--folder", settings.folder, "Where scans and results are kept");
  CLI11_PARSE(app, argc, argv);
  run(settings);
  return 0;
}
