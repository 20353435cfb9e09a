// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Quality and speed of the segments of a scan against exact truth: scenes x seeds x stations, one line of CSV
// each, and a summary.
//   bench_segment_quality --scene room --seeds 5 --points 260000
//
// Words (docs/segments.md has the method). True edges: outlines of faces, and lines in which faces run
// through one another; coplanar faces that look one way are one. Seen: a ray reaches a face next to the edge,
// with echoes there, and the face meets another such face or is seen to end. Sharply seen: wide faces, and
// where one face alone shows the edge its echoes are 2 cm apart. Recall: share of the sharply seen length, of
// stretches of 0.5 m or more, with a segment within --near-m and --angle-deg. Precision: share of the
// segments' length that is so near to any true edge of a face with echoes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "segment_truth.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/extract/features/extract_features.h"
#include "limen/extract/segments/segments.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

struct Settings {
  std::vector<std::string> scenes = {"room", "museum"};
  int first_seed = 1;
  int seeds = 2;
  std::size_t points = 260000;
  std::size_t stations = 1;
  bool outdoor = false;
  bool no_centre = false;
  double near_m = 0.01;
  double angle_deg = 1.0;
  int threads = 0;
  int repeats = 1;
  bool list = false;
  EdgeTruthOptions truth;
  SegmentOptions segments;
};

/// Metres of line, and how much of it is right.
struct Share {
  double right = 0.0;
  double all = 0.0;
  [[nodiscard]] double percent() const { return all > 0.0 ? 100.0 * right / all : 100.0; }
  Share& operator+=(const Share& more) {
    right += more.right;
    all += more.all;
    return *this;
  }
};

struct Tally {
  std::map<bool, Share> recall;         ///< by crease, of sharp edges
  Share any_recall;                     ///< of all seen edges
  std::map<EdgeKind, Share> precision;  ///< by kind
  std::map<std::string, Share> by_element;
  std::vector<double> off_m;  ///< of right samples of segments from the true edge
  std::size_t segments = 0;
  double points = 0.0;
  double plane_seconds = 0.0;
  double seconds = 0.0;
  double processor_seconds = 0.0;  ///< of all threads, for the segments

  [[nodiscard]] Share all_recall() const {
    Share sum;
    for (const auto& [crease, share] : recall) sum += share;
    return sum;
  }
  [[nodiscard]] Share all_precision() const {
    Share sum;
    for (const auto& [kind, share] : precision) sum += share;
    return sum;
  }
  Tally& operator+=(const Tally& more) {
    for (const auto& [key, share] : more.recall) recall[key] += share;
    any_recall += more.any_recall;
    for (const auto& [key, share] : more.precision) precision[key] += share;
    for (const auto& [key, share] : more.by_element) by_element[key] += share;
    off_m.insert(off_m.end(), more.off_m.begin(), more.off_m.end());
    segments += more.segments;
    points += more.points;
    plane_seconds += more.plane_seconds;
    seconds += more.seconds;
    processor_seconds += more.processor_seconds;
    return *this;
  }
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Distance of a place to a segment; a little beyond its ends still counts as beside it.
double distance_to(const Segment& segment, const Vector3d& x, double slack) {
  const Vector3d along = segment.direction();
  const double t = along.dot(x - segment.a);
  if (t < -slack || t > segment.length() + slack) return 1e300;
  return (x - segment.a - t * along).norm();
}

/// Of a missed sample: the share of the echoes next to it that belong to a plane like the true one, and to
/// any.
std::pair<double, double> labelled(const SeenSample& sample, const ExtractedFeatures& extracted) {
  double like = 0.0;
  double any = 0.0;
  for (const std::uint32_t i : sample.echoes) {
    const std::int32_t label = extracted.labels[i];
    if (label < 0) continue;
    any += 1.0;
    const Plane& plane = extracted.features.planes[static_cast<std::size_t>(label)].plane;
    if (std::abs(plane.normal.dot(sample.face.normal)) > std::cos(radians(3.0)) &&
        std::abs(plane.signed_distance(sample.at)) < 0.01)
      like += 1.0;
  }
  const double count = static_cast<double>(sample.echoes.size());
  return {like / count, any / count};
}

void list_missed(const SeenSample& sample, const ExtractedFeatures& extracted,
                 const std::vector<DetectedEdge>& found) {
  static Vector3d last_at = Vector3d::Zero();
  static Vector3d last_along = Vector3d::Zero();
  if (sample.along == last_along && (sample.at - last_at).norm() < 0.3) return;
  last_at = sample.at;
  last_along = sample.along;
  const auto [like, any] = labelled(sample, extracted);
  double best = 1e300;
  double best_deg = 0.0;
  for (const DetectedEdge& edge : found) {
    const double turn =
        degrees(std::acos(std::min(1.0, std::abs(edge.segment.direction().dot(sample.along)))));
    const double off = distance_to(edge.segment, sample.at, 0.02);
    if (turn > 8.0 || off >= best) continue;
    best = off;
    best_deg = turn;
  }
  fmt::print(
      "# missed {} {} at ({:.2f} {:.2f} {:.2f}) along ({:.2f} {:.2f} {:.2f}): {} echoes, {:.0f} % on its "
      "plane, {:.0f} % on any; nearest {:.1f} mm {:.2f} deg\n",
      sample.crease ? "crease" : "border", sample.element, sample.at.x(), sample.at.y(), sample.at.z(),
      sample.along.x(), sample.along.y(), sample.along.z(), sample.echoes.size(), 100.0 * like, 100.0 * any,
      best < 1.0 ? 1e3 * best : -1.0, best_deg);
}

void measure_recall(const std::vector<DetectedEdge>& found, const EdgeTruth& truth,
                    const ExtractedFeatures& extracted, const Settings& settings, Tally& tally) {
  const double cosine = std::cos(radians(settings.angle_deg));
  for (const SeenSample& sample : truth.seen) {
    const bool right = std::any_of(found.begin(), found.end(), [&](const DetectedEdge& edge) {
      return std::abs(edge.segment.direction().dot(sample.along)) >= cosine &&
             distance_to(edge.segment, sample.at, settings.near_m) <= settings.near_m;
    });
    const double step = settings.truth.step_m;
    const Share share{right ? step : 0.0, step};
    tally.any_recall += share;
    if (!right && settings.list && sample.sharp) list_missed(sample, extracted, found);
    if (!sample.sharp) continue;
    tally.recall[sample.crease] += share;
    tally.by_element[(sample.crease ? "crease " : "border ") + sample.element] += share;
  }
}

void measure_precision(const std::vector<DetectedEdge>& found, const EdgeTruth& truth,
                       const Settings& settings, Tally& tally) {
  constexpr double kStep_m = 0.01;
  const double cosine = std::cos(radians(settings.angle_deg));
  for (const DetectedEdge& edge : found) {
    const Vector3d along = edge.segment.direction();
    std::vector<Segment> near;
    for (const Segment& segment : truth.edges) {
      if (segment.length() < 1e-6 || std::abs(segment.direction().dot(along)) < cosine) continue;
      const Vector3d off = edge.segment.a - segment.a;
      const Vector3d direction = segment.direction();
      if ((off - off.dot(direction) * direction).norm() < settings.near_m + edge.segment.length() * 0.02)
        near.push_back(segment);
    }
    Share share;
    for (double t = 0.5 * kStep_m; t < edge.segment.length(); t += kStep_m) {
      double least = 1e300;
      for (const Segment& segment : near)
        least = std::min(least, distance_to(segment, edge.segment.a + t * along, settings.near_m));
      share += {least <= settings.near_m ? kStep_m : 0.0, kStep_m};
      if (least <= settings.near_m) tally.off_m.push_back(least);
    }
    tally.precision[edge.kind] += share;
    if (settings.list && share.percent() < 50.0) {
      double best = 1e300;
      double best_deg = 0.0;
      const Vector3d middle = 0.5 * (edge.segment.a + edge.segment.b);
      for (const Segment& segment : truth.edges) {
        if (std::abs(segment.direction().dot(along)) < std::cos(radians(10.0))) continue;
        const double off = distance_to(segment, middle, 0.05);
        if (off >= best) continue;
        best = off;
        best_deg = degrees(std::acos(std::min(1.0, std::abs(segment.direction().dot(along)))));
      }
      fmt::print(
          "# wrong {} {:.2f} m sigma {:.1f} mm at ({:.2f} {:.2f} {:.2f}) along ({:.2f} {:.2f} {:.2f}) planes "
          "{} {}: {:.1f} mm {:.2f} deg off\n",
          edge.kind == EdgeKind::crease ? "crease" : "border", edge.segment.length(), 1e3 * edge.sigma_m,
          middle.x(), middle.y(), middle.z(), along.x(), along.y(), along.z(), edge.planes[0], edge.planes[1],
          best < 1.0 ? 1e3 * best : -1.0, best_deg);
    }
  }
}

Tally run_scan(const SimulatedCase& simulated, std::size_t s, const World& world, const Settings& settings) {
  const Scan& scan = simulated.scans[s];
  using Clock = std::chrono::steady_clock;
  Tally tally;
  const auto start = Clock::now();
  const ExtractedFeatures extracted = extract_features(scan);
  tally.plane_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  Scan blind;
  if (settings.no_centre) {
    blind = scan;
    blind.centres.clear();
  }
  std::vector<DetectedEdge> found;
  for (int k = 0; k < settings.repeats; ++k) {
    const auto begin = Clock::now();
    const std::clock_t ticks = std::clock();
    found = find_edges(settings.no_centre ? blind : scan, extracted, settings.segments);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    const double processor = static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC;
    tally.seconds = k == 0 ? seconds : std::min(tally.seconds, seconds);
    tally.processor_seconds = k == 0 ? processor : std::min(tally.processor_seconds, processor);
  }
  const EdgeTruth truth = EdgeTruthFinder(simulated, s, world, settings.truth).run();
  measure_recall(found, truth, extracted, settings, tally);
  measure_precision(found, truth, settings, tally);
  tally.segments = found.size();
  tally.points = static_cast<double>(scan.size());
  return tally;
}

void print_row(const std::string& scene, int seed, const std::string& scan, const Tally& t) {
  const Share recall = t.all_recall();
  const Share precision = t.all_precision();
  fmt::print(
      "{},{},{},{:.0f},{:.1f},{:.1f},{:.1f},{:.1f},{},{:.1f},{:.1f},{:.1f},{:.1f},{:.2f},{:.3f},{:.3f}\n",
      scene, seed, scan, t.points, recall.all, recall.percent(),
      t.recall.count(true) != 0 ? t.recall.at(true).percent() : 100.0,
      t.recall.count(false) != 0 ? t.recall.at(false).percent() : 100.0, t.segments, precision.all,
      precision.percent(),
      t.precision.count(EdgeKind::crease) != 0 ? t.precision.at(EdgeKind::crease).percent() : 100.0,
      t.precision.count(EdgeKind::border) != 0 ? t.precision.at(EdgeKind::border).percent() : 100.0,
      1e3 * quantile(t.off_m, 0.5), t.plane_seconds, t.seconds);
  std::fflush(stdout);
}

void summarise(const std::string& name, const Tally& t) {
  const Share recall = t.all_recall();
  const Share precision = t.all_precision();
  fmt::print(
      "# {}: {:.1f} % of {:.0f} m of sharply seen edges found ({:.1f} % of {:.0f} m of all seen), {:.1f} % "
      "of {:.0f} m of segments on an edge; right "
      "ones "
      "off {:.1f} mm (median), {:.1f} mm (95 %); segments {:.2f} M points/s ({:.2f} per processor second), "
      "with planes {:.2f}\n",
      name, recall.percent(), recall.all, t.any_recall.percent(), t.any_recall.all, precision.percent(),
      precision.all, 1e3 * quantile(t.off_m, 0.5), 1e3 * quantile(t.off_m, 0.95), 1e-6 * t.points / t.seconds,
      1e-6 * t.points / t.processor_seconds, 1e-6 * t.points / (t.seconds + t.plane_seconds));
}

Tally run(const std::string& scene, int seed, const Settings& settings) {
  SceneOptions options;
  options.name = scene;
  options.seed = static_cast<std::uint64_t>(seed);
  if (settings.outdoor) {
    options.points_outdoor = settings.points;
    options.points_indoor = 2000;
    options.stations = 1;
  } else {
    options.points_indoor = settings.points;
    options.stations = settings.stations;
  }
  const SimulatedCase simulated = simulate(options);
  const Recipe recipe = make_recipe(options);
  Tally sum;
  for (std::size_t s = 0; s < simulated.scans.size(); ++s) {
    if (simulated.scans[s].mobile() != settings.outdoor) continue;
    const Tally tally = run_scan(simulated, s, recipe.world, settings);
    print_row(scene, seed, simulated.scans[s].name, tally);
    sum += tally;
  }
  return sum;
}

void add_options(CLI::App& app, Settings& settings) {
  app.add_option("--scene", settings.scenes, "built-in scenes");
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of buildings");
  app.add_option("--points", settings.points, "points of each scan");
  app.add_option("--stations", settings.stations, "stations of each building");
  app.add_flag("--outdoor", settings.outdoor, "the mobile scan instead of the stations");
  app.add_flag("--no-centre", settings.no_centre, "the scanner's position is not given");
  app.add_option("--near-m", settings.near_m, "a segment is on an edge within this");
  app.add_option("--angle-deg", settings.angle_deg, "and this");
  app.add_option("--min-echoes", settings.truth.min_echoes, "next to an edge that must be found");
  app.add_option("--min-border-echoes", settings.truth.min_border_echoes, "the same of a border");
  app.add_option("--min-face-echoes", settings.truth.min_face_echoes,
                 "of a face of an edge that must be found");
  app.add_option("--threads", settings.threads, "0: the machine's");
  app.add_option("--repeats", settings.repeats, "runs of each detection; the fastest counts");
  app.add_flag("--list", settings.list, "name what was missed and what was wrong");
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Quality of limen's segments against the simulator's exact truth");
  add_options(app, settings);
  CLI11_PARSE(app, argc, argv);
  set_thread_count(settings.threads);
  fmt::print(
      "scene,seed,scan,points,seen_m,recall,recall_creases,recall_borders,segments,segments_m,precision,"
      "precision_creases,precision_borders,off_mm,plane_seconds,seconds\n");
  Tally all;
  for (const std::string& scene : settings.scenes) {
    Tally sum;
    for (int seed = settings.first_seed; seed < settings.first_seed + settings.seeds; ++seed)
      sum += run(scene, seed, settings);
    summarise(scene, sum);
    all += sum;
  }
  summarise("all", all);
  if (settings.list)
    for (const auto& [element, share] : all.by_element)
      fmt::print("#   {:50} {:7.2f} m {:5.1f} %\n", element, share.all, share.percent());
  return 0;
}
