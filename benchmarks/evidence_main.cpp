// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What two scans say of every pose that is found, of pairs whose truth is known. Rows (JSON lines, one a
// pair) are what scripts/fit_posterior reads.
//   bench_evidence --building flats --first-seed 1 --seeds 2 -o rows.jsonl
//   bench_evidence LIST --set hall -o rows.jsonl        scans at hand: a line each, NAME FILE and 12 numbers,
//                                                       the rows of the pose of the scan in the set's frame
//   bench_evidence LIST --foreign -o rows.jsonl         pairs of different places only: names PLACE/SCAN
#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include "known_scans.h"
#include "pair_set.h"
#include "prepared_frames.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/register/find_poses.h"
#include "limen/register/judge/as_built.h"
#include "limen/register/judge/given_pose.h"
#include "limen/register/judge/look_alike_odds.h"

namespace {

using namespace limen;               // NOLINT(google-build-using-namespace): a program, not a header
using namespace limen::calibration;  // NOLINT(google-build-using-namespace)

constexpr std::size_t kAskedPoses = 8;
constexpr std::size_t kAskedThings = 6;
constexpr double kPlacementM = 0.1;  // as a project asks about placements
constexpr double kElsewhereM = 1.0;

struct Settings {
  std::string list;
  std::string set;
  std::vector<std::string> sorts;
  std::string building;
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1;
  std::size_t points = 100000;
  bool as_drawn = false;
  bool foreign = false;
  bool placements = false;
  int every = 1;
  double near_m = 0.05;
  double near_deg = 0.5;
  double minutes = 60.0;
  std::string output;
};

const char* sort_name(PairSort sort) {
  switch (sort) {
    case PairSort::through_wall:
      return "through_wall";
    case PairSort::past_wall:
      return "past_wall";
    case PairSort::streets:
      return "streets";
    case PairSort::in_model:
      return "in_model";
    case PairSort::rooms:
      break;
  }
  return "rooms";
}

class Rows {
 public:
  explicit Rows(const Settings& settings) : s_(settings), start_(std::chrono::steady_clock::now()) {
    file_.open(s_.output, std::ios::app);
  }

  void list(const std::vector<Known>& scans) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
      for (std::size_t j = i + 1; j < scans.size(); ++j) {
        const bool foreign = place_of(scans[i].name) != place_of(scans[j].name);
        if (foreign != s_.foreign || count_++ % s_.every != 0) continue;
        if (s_.placements) {
          place(scans, i, j, j);
          place(scans, i, j, (i + j) % scans.size());
          continue;
        }
        PreparedPair pair{scans[i].scan, scans[j].scan};
        set_from_source_ = scans[i].set_from_scan;
        set_from_target_ = scans[j].set_from_scan;
        run(s_.set, scans[i].name, scans[j].name, foreign ? "foreign" : "known", pair,
            foreign ? std::nullopt : std::optional(inverse(scans[j].set_from_scan) * scans[i].set_from_scan));
      }
    }
  }

  void building(std::uint64_t seed) {
    const PairSet here = set_of(seed);
    const PairSet there = set_of(seed + 500000);
    const std::vector<PreparedScan> scans = prepared(here, here.scans.size());
    const std::vector<PreparedScan> foreign = prepared(there, std::min<std::size_t>(2, there.scans.size()));
    for (std::size_t i = 0; i < scans.size(); ++i) {
      for (std::size_t j = i + 1; j < scans.size(); ++j) {
        if (here.kind_of(i, j) == PairKind::unclear) continue;
        const std::string kind =
            std::string(to_string(here.kind_of(i, j))) + (here.furnished_alike(i, j) ? "_alike" : "");
        PreparedPair pair{scans[i], scans[j]};
        run(name_of(seed), here.scans[i].truth.name, here.scans[j].truth.name, kind, pair,
            here.target_from_source(i, j));
      }
      for (std::size_t j = 0; j < foreign.size() && i < 4; ++j) {
        PreparedPair pair{scans[i], foreign[j]};
        run(name_of(seed), here.scans[i].truth.name, "other_" + there.scans[j].truth.name, "other_building",
            pair, std::nullopt);
      }
    }
  }

 private:
  /// What the scans say of scan j where scan `as` lies.
  void place(const std::vector<Known>& scans, std::size_t i, std::size_t j, std::size_t as) {
    const double apart_m = (scans[j].set_from_scan.translation - scans[as].set_from_scan.translation).norm();
    if (as != j && apart_m < kElsewhereM) return;
    const PoseScore score = score_given_pose(scans[i].scan, scans[j].scan,
                                             inverse(scans[as].set_from_scan) * scans[i].set_from_scan,
                                             Method::automatic, kPlacementM);
    file_ << fmt::format(R"({{"set": "{}", "placed": "{}", "agreeing": {:.3f}, "contradicted": {:.3f}}})",
                         s_.set, as == j ? "right" : "wrong", score.agreeing_m2, score.contradicted_m2)
          << "\n";
  }
  static std::string things(const SeenClutter& seen) {
    std::string faces;
    for (const FaceMiss& face : seen.faces)
      faces += fmt::format("{}[{:.2f}, {:.3f}, {:.2f}, {}]", faces.empty() ? "" : ", ", 1e3 * face.offset_m,
                           face.share, 1e3 * face.sigma_m, face.thing);
    std::string things;
    for (const ThingSeen& thing : seen.things)
      things += fmt::format("{}[{:.2f}, {:.2f}]", things.empty() ? "" : ", ", thing.count, thing.agreeing);
    return fmt::format(R"("chance": {:.3f}, "things": [{}], "faces_mm": [{}])", seen.chance, things, faces);
  }
  static std::string built(const BuiltEvidence& seen) {
    return fmt::format(R"(, "built": {:.3f})", built_nats(seen, {bends_beforehand(0.0)}));
  }
  /// How a pose moves the scan from inside, in the frame of the set, the one from outside being where it is.
  /// `moved_source`: by it, in the source's prepared frame.
  [[nodiscard]] std::string moved(const PreparedPair& pair, const Rigid3& moved_source) const {
    const Rigid3 set_from_prepared = set_from_source_ * Rigid3{pair.source.upright_from_scan.transpose(),
                                                               pair.source.extracted.features.local_origin};
    Rigid3 moved = set_from_prepared * moved_source * inverse(set_from_prepared);
    if (pair.source.surroundings == Surroundings::outside) moved = inverse(moved);
    std::string text;
    for (int r = 0; r < 3; ++r)
      text += fmt::format("{}{:.17g}, {:.17g}, {:.17g}, {:.17g}", r == 0 ? "" : ", ", moved.rotation(r, 0),
                          moved.rotation(r, 1), moved.rotation(r, 2), moved.translation[r]);
    return fmt::format(R"(, "moved": [{}])", text);
  }
  /// Which scan of a pair through windows is the one from inside, and where it is.
  [[nodiscard]] std::string inside(const PreparedPair& pair) const {
    const bool source = pair.source.surroundings != Surroundings::outside;
    const Vector3d at = (source ? set_from_source_ : set_from_target_).translation;
    return fmt::format(R"("inside": "{}", "at": [{:.3f}, {:.3f}, {:.3f}], )", source ? "source" : "target",
                       at.x(), at.y(), at.z());
  }
  static std::string place_of(const std::string& name) { return name.substr(0, name.find('/')); }
  [[nodiscard]] std::string name_of(std::uint64_t seed) const {
    return fmt::format("{}{}_{}", s_.building, s_.as_drawn ? "_drawn" : "", seed);
  }
  [[nodiscard]] bool over() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count() > 60.0 * s_.minutes;
  }
  [[nodiscard]] PairSet set_of(std::uint64_t seed) const {
    PairSetOptions options;
    options.name = s_.building;
    options.seed = seed;
    options.points = s_.points;
    options.as_built = !s_.as_drawn;
    return simulate_pair_set(options);
  }
  static std::vector<PreparedScan> prepared(const PairSet& set, std::size_t count) {
    std::vector<PreparedScan> scans;
    for (std::size_t i = 0; i < count; ++i)
      scans.push_back(prepare_scan(set.scans[i].scan, prepare_options({})));
    return scans;
  }

  void run(const std::string& set, const std::string& from, const std::string& to, const std::string& kind,
           const PreparedPair& pair, const std::optional<Rigid3>& truth) {
    if (over()) return;
    const auto start = std::chrono::steady_clock::now();
    const WorkedPair worked = worked_pair(pair);
    const char* sort = sort_name(sort_of(worked));
    if (!s_.sorts.empty() && std::find(s_.sorts.begin(), s_.sorts.end(), sort) == s_.sorts.end()) return;
    std::vector<StageTime> stages;
    StageClock clock(stages, silent_monitor());
    const RegisterOptions options;
    std::vector<FoundPose> poses = find_poses(worked, options, clock);
    if (poses.size() > kAskedPoses) poses.resize(kAskedPoses);
    const ScanView source = worked.source.view();
    const ScanView target = worked.target.view();
    std::optional<Rigid3> right;
    if (truth) right = in_prepared_frames(*truth, pair);
    const ClutterComparer asker(source, target);
    std::string text;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Rigid3 pose =
          worked.turned ? inverse(poses[k].refined.target_from_source) : poses[k].refined.target_from_source;
      const PoseScore& score = poses[k].score;
      text +=
          fmt::format(R"({}{{"right": {:d}, "evidence": {:.3f}, "agreeing": {:.3f}, "contradicted": {:.3f}, )"
                      R"("opening": {:.3f}, "held": {:d})",
                      k == 0 ? "" : ", ", right && is_near(pose, *right, pair, s_.near_m, s_.near_deg),
                      score.evidence_m2, score.agreeing_m2, score.contradicted_m2, score.opening_m2,
                      unobserved_freedoms(poses[k].refined, 0.03).empty());
      if (right && is_through_windows(sort_of(worked))) text += moved(pair, inverse(*right) * pose);
      if (k < kAskedThings && is_through_windows(sort_of(worked)))
        text += built(asker.built(poses[k].refined.target_from_source));
      if (k < kAskedThings && sort_of(worked) == PairSort::rooms) {
        const SeenClutter seen = asker(poses[k].refined.target_from_source);
        text += built(seen.built);
        text += fmt::format(R"(, "built_one": [{:.2f}], "apart": {:d}, {})",
                            fmt::join(logs_of_bends(seen.built, 0.0), ", "), seen.behind_wall, things(seen));
      }
      text += "}";
    }
    std::string contrasts;
    const ScoreOptions fine = fine_score(source, target, Method::automatic);
    for (std::size_t a = 0; a < poses.size(); ++a) {
      const PoseContrasts contrast(source, target, poses[a].refined.target_from_source, fine);
      for (std::size_t b = a + 1; b < poses.size(); ++b) {
        const PoseContrast c = contrast(poses[b].refined.target_from_source);
        contrasts +=
            fmt::format("{}[{}, {}, {:.3f}, {:.3f}, {:.3f}, {:.3f}]", contrasts.empty() ? "" : ", ", a, b,
                        c.for_first_m2, c.for_second_m2, c.against_first_m2, c.against_second_m2);
      }
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    file_
        << fmt::format(
               R"({{"set": "{}", "source": "{}", "target": "{}", "kind": "{}", "sort": "{}", {}"noise_mm": {:.1f}, )"
               R"("seconds": {:.2f}, "poses": [{}], "contrasts": [{}]}})",
               set, from, to, kind, sort, right && is_through_windows(sort_of(worked)) ? inside(pair) : "",
               1e3 * std::max(source.features->noise_m, target.features->noise_m), spent.count(), text,
               contrasts)
        << "\n"
        << std::flush;
  }

  const Settings& s_;
  std::chrono::steady_clock::time_point start_;
  std::ofstream file_;
  int count_ = 0;
  Rigid3 set_from_source_;  ///< of a list
  Rigid3 set_from_target_;
};

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("What two scans say of every pose that is found, of pairs whose truth is known");
  app.add_option("list", settings.list, "scans with their poses");
  app.add_option("--set", settings.set, "name of the rows' set");
  app.add_option("--sorts", settings.sorts, "only pairs of these sorts, for example through_wall")
      ->delimiter(',');
  app.add_option("--building", settings.building, "simulated buildings of this kind instead");
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of seeds");
  app.add_option("--points", settings.points, "points of a station, about");
  app.add_flag("--as-drawn", settings.as_drawn, "walls exactly where they were drawn");
  app.add_flag("--foreign", settings.foreign, "only pairs of different places");
  app.add_flag("--placements", settings.placements, "right and wrong placements of a list's scans instead");
  app.add_option("--every", settings.every, "only every so many pairs of a list");
  app.add_option("--near-m", settings.near_m, "a pose nearer than this is the true one ...");
  app.add_option("--near-deg", settings.near_deg, "... and its rotation nearer than this");
  app.add_option("--minutes", settings.minutes, "stop after so long");
  app.add_option("-o,--output", settings.output, "rows are added to this file")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    Rows rows(settings);
    if (!settings.list.empty()) rows.list(scans_of_list(settings.list));
    for (std::uint64_t seed = settings.first_seed;
         !settings.building.empty() && seed < settings.first_seed + settings.seeds; ++seed)
      rows.building(seed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_evidence: {}\n", error.what());
    return 1;
  }
  return 0;
}
