// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether stated probabilities hold, and what becomes of pairs that look alike and are not: look-alike
// places, rooms that have nothing in common, other buildings of the same kind; against the simulator's exact
// truth.
//   bench_calibration --purpose judging --minutes 20 -o rows.csv      again: goes on where it stopped
//   bench_calibration --purpose fitting --only twin --pairs 100 -o rows.csv
//   bench_calibration --report rows.csv --svg reliability.svg         the tables of rows made before
// A pose is the true one within 5 cm at the scanner and half a degree.
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <type_traits>

#include "calibration_kinds.h"
#include "calibration_rows.h"
#include "pair_set.h"
#include <CLI/CLI.hpp>

#include "limen/base/angles.h"
#include "limen/io/ply/ply.h"
#include "limen/register/prepare/prepared_pair.h"
#include "limen/register/register.h"

namespace {

using namespace limen;               // NOLINT(google-build-using-namespace): a program, not a header
using namespace limen::calibration;  // NOLINT(google-build-using-namespace)

struct Settings {
  std::string purpose = "judging";
  std::vector<std::string> buildings;
  std::vector<std::string> only;  ///< kinds of pairs
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1000;
  std::size_t points = 100000;
  int pairs = 0;
  double minutes = 10.0;
  bool plain = false;
  bool as_built = false;
  std::string output;
  std::string wrong;
  bool lost = false;
  std::string report;
  std::string svg;
};

/// What a hypothesis states of itself; nothing where the library states no probabilities.
template <typename Statement>
std::optional<double> probability_of(const Statement& hypothesis) {
  if constexpr (requires { hypothesis.probability; }) {
    if constexpr (std::is_convertible_v<decltype(hypothesis.probability), double>)
      return hypothesis.probability;
    else
      return hypothesis.probability;
  } else {
    return std::nullopt;
  }
}

struct Miss {
  double rotation_deg = 0.0;
  double translation_m = 0.0;
  [[nodiscard]] bool near() const { return rotation_deg <= 0.5 && translation_m <= 0.05; }
};

Miss miss_of(const Rigid3& pose, const Rigid3& truth, const Vector3d& scanner) {
  const Rigid3 error = inverse(truth) * pose;
  return {degrees(rotation_angle(error.rotation)), (error * scanner - scanner).norm()};
}

/// Scans of one set, each made ready when a pair first asks for it.
class Ready {
 public:
  explicit Ready(PairSet set) : set_(std::move(set)), prepared_(set_.scans.size()) {}

  [[nodiscard]] const PairSet& set() const { return set_; }
  PreparedScan take(std::size_t i) {
    if (!prepared_[i]) prepared_[i] = prepare_scan(set_.scans[i].scan, prepare_options({}));
    PreparedScan taken = std::move(*prepared_[i]);
    prepared_[i].reset();
    return taken;
  }
  void put_back(std::size_t i, PreparedScan&& scan) { prepared_[i] = std::move(scan); }

 private:
  PairSet set_;
  std::vector<std::optional<PreparedScan>> prepared_;
};

/// Registers two scans; `truth`: nothing where there is none (another building).
void measure(Row& row, const PreparedPair& pair, const std::optional<Rigid3>& truth,
             const Vector3d& scanner) {
  const auto start = std::chrono::steady_clock::now();
  const RegistrationResult result = register_prepared(pair);
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  row.outcome = to_string(result.outcome);
  row.agreeing_m2 = result.best.agreeing_m2;
  row.contradicted_m2 = result.best.contradicted_m2;
  const auto consider = [&](const Hypothesis& hypothesis) {
    const Miss miss = truth ? miss_of(hypothesis.target_from_source, *truth, scanner) : Miss{180.0, 1e3};
    if (const auto p = probability_of(hypothesis)) row.statements.push_back({*p, miss.near()});
    return miss;
  };
  // Without a match there is no best pose to speak of; what was considered may still be listed.
  const Miss best = consider(result.best);
  row.rotation_deg = best.rotation_deg;
  row.translation_m = best.translation_m;
  row.near = best.near();
  row.listed = row.near;
  for (const Hypothesis& other : result.alternatives) row.listed = consider(other).near() || row.listed;
}

class Calibration {
 public:
  explicit Calibration(const Settings& settings) : s_(settings), start_(std::chrono::steady_clock::now()) {
    if (s_.output.empty()) return;
    for (const Row& row : rows_of(s_.output)) {
      rows_.push_back(row);
      done_.insert(key_of(row));
    }
    const bool fresh = rows_.empty();
    file_.open(s_.output, std::ios::app);
    if (fresh) file_ << header() << "\n" << std::flush;
  }

  std::vector<Row> run() {
    for (std::uint64_t seed = s_.first_seed; seed < s_.first_seed + s_.seeds && !over(); ++seed)
      for (const Kind& kind : kinds_for(s_.purpose))
        if (wanted(s_.buildings, kind.building) && !over()) run_set(kind, seed);
    return rows_;
  }

 private:
  static bool wanted(const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  }
  static std::string key_of(const Row& row) {
    return fmt::format("{}/{}/{}/{}", row.building, row.seed, row.source, row.target);
  }
  [[nodiscard]] bool over() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count() > 60.0 * s_.minutes || (s_.pairs > 0 && made_ >= s_.pairs);
  }

  Ready ready(const Kind& kind, std::uint64_t seed) const {
    PairSetOptions options;
    options.name = kind.building;
    options.seed = seed;
    options.points = s_.points;
    options.styles = !s_.plain;
    options.as_built = s_.as_built;
    return Ready(simulate_pair_set(options));
  }

  void run_set(const Kind& kind, std::uint64_t seed) {
    Ready here = ready(kind, seed);
    const PairSet& set = here.set();
    for (std::size_t i = 0; i < set.scans.size(); ++i) {
      for (std::size_t j = i + 1; j < set.scans.size() && !over(); ++j) {
        Row row = row_for(kind, seed);
        row.kind = to_string(set.kind_of(i, j));
        row.mirrored = set.mirrored(i, j);
        row.furnished_alike = set.furnished_alike(i, j);
        row.same_storey = set.same_storey(i, j);
        row.source = set.scans[i].truth.name;
        row.target = set.scans[j].truth.name;
        run_pair(row, here, i, here, j, set.target_from_source(i, j));
      }
    }
    if (!wanted(s_.only, "other_building") || over()) return;
    // Another building of the same kind: nothing is common but the kind.
    Ready there = ready(kind, seed + 500000);
    for (std::size_t i = 0; i < std::min<std::size_t>(4, set.scans.size()); ++i) {
      for (std::size_t j = 0; j < std::min<std::size_t>(3, there.set().scans.size()) && !over(); ++j) {
        Row row = row_for(kind, seed);
        row.kind = "other_building";
        row.source = set.scans[i].truth.name;
        row.target = "other_" + there.set().scans[j].truth.name;
        run_pair(row, here, i, there, j, std::nullopt);
      }
    }
  }

  static Row row_for(const Kind& kind, std::uint64_t seed) {
    Row row;
    row.building = kind.building;
    row.purpose = to_string(kind.purpose);
    row.seed = seed;
    return row;
  }

  void run_pair(Row& row, Ready& from, std::size_t i, Ready& to, std::size_t j,
                const std::optional<Rigid3>& truth) {
    if (row.kind == "unclear" || !wanted(s_.only, row.kind) || done_.count(key_of(row)) > 0) return;
    PreparedPair pair{from.take(i), to.take(j)};
    measure(row, pair, truth, from.set().scans[i].truth.scanner);
    from.put_back(i, std::move(pair.source));
    to.put_back(j, std::move(pair.target));
    ++made_;
    if (file_.is_open()) file_ << text_of(row) << "\n" << std::flush;
    if (row.wrong()) fmt::print("WRONG {}\n", text_of(row));
    if (row.wrong() || stated_wrongly(row) || (s_.lost && is_lost(row))) {
      keep(row, from, i);
      keep(row, to, j);
    }
    rows_.push_back(row);
  }

  /// Whether a wrong pose is reported as nearly sure, whatever the outcome.
  static bool stated_wrongly(const Row& row) {
    constexpr double kSurely = 0.99;
    return !row.statements.empty() && row.statements.front().probability > kSurely &&
           !row.statements.front().right;
  }

  /// Whether the two show one place and the right pose is not even among the alternatives.
  static bool is_lost(const Row& row) {
    const bool shared = row.kind != "twin" && row.kind != "other_room" && row.kind != "other_building";
    return shared && !row.near && !row.listed;
  }

  void keep(const Row& row, const Ready& set, std::size_t scan) const {
    if (s_.wrong.empty()) return;
    std::filesystem::create_directories(s_.wrong);
    const PairSetScan& kept = set.set().scans[scan];
    const std::string name = fmt::format("{}_{}_{}.ply", row.building, set.set().seed, kept.truth.name);
    write_ply(std::filesystem::path(s_.wrong) / name, kept.scan);
    // Where it stood in truth, in the frame of all scans of the building: four rows of four.
    std::ofstream pose(std::filesystem::path(s_.wrong) / (name + ".pose"));
    const Rigid3& at = kept.truth.local_from_scan;
    for (int r = 0; r < 3; ++r)
      pose << fmt::format("{} {} {} {}\n", at.rotation(r, 0), at.rotation(r, 1), at.rotation(r, 2),
                          at.translation[r]);
    pose << "0 0 0 1\n";
  }

  const Settings& s_;
  std::chrono::steady_clock::time_point start_;
  std::ofstream file_;
  std::vector<Row> rows_;
  std::set<std::string> done_;
  int made_ = 0;
};

void print_tables(const std::vector<Row>& rows, const std::string& svg) {
  std::map<std::string, Count> kinds;
  std::map<std::string, Count> look_alikes;
  std::map<std::string, Count> buildings;
  Reliability reliability;
  double seconds = 0.0;
  for (const Row& row : rows) {
    kinds[row.kind].add(row);
    buildings[fmt::format("{} ({})", row.building, row.purpose)].add(row);
    if (row.kind == "twin")
      look_alikes[fmt::format("{}{}{}{}", row.building, row.mirrored ? ", mirrored" : "",
                              row.same_storey ? "" : ", other floor",
                              row.furnished_alike ? ", furnished alike" : "")]
          .add(row);
    for (const Statement& statement : row.statements) reliability.add(statement);
    seconds += row.seconds;
  }
  print_counts("kind of pair", kinds);
  print_counts("look-alike rooms", look_alikes);
  print_counts("building", buildings);
  if (reliability.count > 0)
    reliability.print();
  else
    fmt::print("\nno probabilities were stated\n");
  fmt::print("{} pairs, {:.2f} s each\n", rows.size(),
             rows.empty() ? 0.0 : seconds / static_cast<double>(rows.size()));
  if (!svg.empty()) std::ofstream(svg) << reliability.svg();
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Calibration of limen's verdicts against the simulator's exact truth");
  app.add_option("--purpose", settings.purpose, "fitting, choosing, judging or all kinds of buildings")
      ->check(CLI::IsMember({"fitting", "choosing", "judging", "all"}));
  app.add_option("--building", settings.buildings, "only these kinds of buildings");
  app.add_option(
      "--only", settings.only,
      "only these kinds of pairs: same_room, other_day, next_room, twin, other_room, other_building");
  app.add_option("--first-seed", settings.first_seed, "first seed");
  app.add_option("--seeds", settings.seeds, "number of seeds");
  app.add_option("--points", settings.points, "points of a station, about");
  app.add_option("--pairs", settings.pairs, "stop after so many; 0: no bound");
  app.add_option("--minutes", settings.minutes, "stop after so long");
  app.add_flag("--plain", settings.plain, "no random styles");
  app.add_flag("--as-built", settings.as_built, "walls deviate from the drawing as real ones do");
  app.add_option("-o,--output", settings.output,
                 "rows are added to this file; what it has is not done again");
  app.add_option("--wrong", settings.wrong,
                 "the scans of pairs whose wrong pose is stated as sure are written to this folder");
  app.add_flag("--lost", settings.lost, "so are those of pairs of one place whose pose was not found");
  app.add_option("--report", settings.report, "only the tables of such a file");
  app.add_option("--svg", settings.svg, "a picture of the reliability table");
  CLI11_PARSE(app, argc, argv);
  try {
    print_tables(settings.report.empty() ? Calibration(settings).run() : rows_of(settings.report),
                 settings.svg);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_calibration: {}\n", error.what());
    return 1;
  }
  return 0;
}
