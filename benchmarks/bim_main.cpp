// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Scans simulated in building models, found in these models again: how often, how well, how fast.
//   bench_bim MODEL... [--at-least 60] [--method auto] [--points N] [--first-seed N] [--only TEXT]
//             [--furnished] [--foreign]
#include <chrono>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bim_cases.h"
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/geometry/linear.h"
#include "limen/report/summary/precision.h"

namespace limen {
namespace {

using bim_cases::CasePlan;
using bim_cases::Judgement;

struct Options {
  std::vector<std::string> models;
  bim_cases::Selection selection;
  std::string method = "auto";
  std::string only;
  bool foreign = false;
};

/// Counts of a group of cases.
struct Tally {
  int cases = 0;
  int registered = 0;
  int right = 0;
  int ambiguous_right = 0;
  int wrong = 0;
  int undecided_listed = 0;  ///< where the model does not repeat the room, but the truth is listed
  int other = 0;
  std::vector<double> shifts_m;
  std::vector<double> turns_deg;
  std::vector<double> sigmas;  ///< errors of registered poses, in their own sigmas
  std::vector<double> seconds;
  int held = 0;  ///< of registered poses, those whose station is within the stated radius (95 %)

  void add(const Judgement& judgement) {
    ++cases;
    if (judgement.right()) ++right;
    if (judgement.wrong()) ++wrong;
    if (judgement.outcome == Outcome::registered) ++registered;
    if (judgement.right() && judgement.outcome == Outcome::ambiguous) ++ambiguous_right;
    if (!judgement.right() && !judgement.wrong()) ++(judgement.listed ? undecided_listed : other);
    if (judgement.outcome == Outcome::registered && judgement.near) {
      shifts_m.push_back(judgement.translation_m);
      turns_deg.push_back(judgement.rotation_deg);
    }
  }
};

double middle_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print(const std::string& name, const Tally& tally) {
  const auto held =
      std::count_if(tally.sigmas.begin(), tally.sigmas.end(), [](double s) { return s <= 2.0; });
  fmt::print(
      "{:<28} {:>3} cases: {:>3} right ({} registered, {} rightly ambiguous), {} wrong, {} undecided with "
      "the truth listed, {} not found; median {:.2f} mm {:.4f} deg, {:.0f} % of freedoms within 2 sigma, "
      "{} of the stated radii hold, {:.2f} s\n",
      name, tally.cases, tally.right, tally.registered - tally.wrong, tally.ambiguous_right, tally.wrong,
      tally.undecided_listed, tally.other, 1e3 * middle_of(tally.shifts_m), middle_of(tally.turns_deg),
      tally.sigmas.empty() ? 0.0
                           : 100.0 * static_cast<double>(held) / static_cast<double>(tally.sigmas.size()),
      tally.held, middle_of(tally.seconds));
}

/// The six errors of a pose in its own sigmas, about the point it is known best at.
std::vector<double> errors_in_sigmas(const RegistrationResult& result, const Rigid3& truth) {
  const Rigid3& pose = result.best.target_from_source;
  const Vector3d turn = rotation_log(truth.rotation * pose.rotation.transpose());
  const Vector3d at = inverse(pose) * result.sigma.centre;
  const Vector3d shift = truth * at - result.sigma.centre;
  std::vector<double> errors;
  for (Eigen::Index k = 0; k < 3; ++k) {
    errors.push_back(std::abs(turn[k]) / std::max(1e-12, result.sigma.rotation_rad[k]));
    errors.push_back(std::abs(shift[k]) / std::max(1e-12, result.sigma.translation_m[k]));
  }
  return errors;
}

/// Whether the first station's place is within the stated radius.
bool is_held(const RegistrationResult& result, const Rigid3& truth) {
  const Vector3d& at = result.best.target_from_source.translation;
  Eigen::Matrix<double, 3, 6> moves;
  moves << -skew(at - result.sigma.centre), Matrix3d::Identity();
  return (truth.translation - at).norm() <= radius_95(moves * result.sigma.covariance * moves.transpose());
}

RegisterOptions register_options(const Options& options) {
  RegisterOptions registering;
  registering.method = value_called(kMethods, options.method).value();
  return registering;
}

/// Scans of each model are sought in all other models, where nothing is right but to find nothing.
void run_foreign(const Options& options) {
  const RegisterOptions registering = register_options(options);
  std::vector<BimModel> models;
  for (const std::string& name : options.models) models.push_back(bim_cases::read_model(name));
  std::map<std::string, int> outcomes;
  for (const CasePlan& plan : bim_cases::plan_cases(models.size(), options.selection)) {
    if (!options.only.empty() && plan.label().find(options.only) == std::string::npos) continue;
    const SimulatedCase made = bim_cases::make_case(models[plan.model], plan, options.selection);
    for (std::size_t other = 0; other < models.size(); ++other) {
      if (other == plan.model) continue;
      RegisterInput target;
      target.model = models[other];
      const RegistrationResult result = register_inputs(bim_cases::input_of(made), target, registering);
      ++outcomes[to_string(result.outcome)];
      fmt::print("{:<24} in {:<24} {:<46} {:<12} explained {:.2f} value {:.1f} {}\n", models[plan.model].name,
                 models[other].name, plan.label(), to_string(result.outcome),
                 result.best.explained_share.value_or(1.0), result.best.score, result.reason);
      std::fflush(stdout);
    }
  }
  for (const auto& [outcome, count] : outcomes) fmt::print("{}: {}\n", outcome, count);
}

void run(const Options& options) {
  const RegisterOptions registering = register_options(options);
  std::map<std::string, Tally> tallies;
  Tally all;
  std::optional<std::size_t> loaded;
  RegisterInput target;
  for (const CasePlan& plan : bim_cases::plan_cases(options.models.size(), options.selection)) {
    if (!options.only.empty() && plan.label().find(options.only) == std::string::npos) continue;
    if (loaded != plan.model) target.model = bim_cases::read_model(options.models[plan.model]);
    loaded = plan.model;
    const SimulatedCase made = bim_cases::make_case(*target.model, plan, options.selection);
    const auto start = std::chrono::steady_clock::now();
    const RegistrationResult result = register_inputs(bim_cases::input_of(made), target, registering);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const Judgement judgement = bim_cases::judge(result, made.truth);
    const std::string& name = target.model->name;
    for (Tally* tally : {&tallies[name],
                         &tallies[plan.furnished  ? "~ furnished"
                                  : plan.as_built ? "~ as built"
                                                  : "~ as planned"],
                         &tallies[plan.any_rotation ? "~ any rotation" : "~ level"],
                         &tallies[plan.stations == 1 ? "~ one station" : "~ three stations"], &all}) {
      tally->add(judgement);
      tally->seconds.push_back(seconds.count());
      if (judgement.outcome != Outcome::registered) continue;
      for (const double error : errors_in_sigmas(result, world_from_scan(made.truth, 0)))
        tally->sigmas.push_back(error);
      if (is_held(result, world_from_scan(made.truth, 0))) ++tally->held;
    }
    fmt::print("{:<24} {:<46} {:<6} {:<12} {:6.1f} mm {:7.4f} deg  {:.2f} s  explained {:.2f} {}{} [{}] {}\n",
               name, plan.label(), judgement.right() ? "right" : (judgement.wrong() ? "WRONG" : "-"),
               to_string(result.outcome), 1e3 * judgement.translation_m, judgement.rotation_deg,
               seconds.count(), result.best.explained_share.value_or(1.0),
               judgement.repeated ? "repeated " : "", judgement.listed ? "listed" : "not listed",
               result.alternatives.size(), result.reason);
    std::fflush(stdout);
  }
  for (const auto& [name, tally] : tallies) print(name, tally);
  print("all", all);
}

}  // namespace
}  // namespace limen

int main(int argc, char** argv) {
  limen::Options options;
  CLI::App app("Scans simulated in building models, found in them again");
  app.add_option("MODEL", options.models, "Model files, or office")->required();
  app.add_option("--at-least", options.selection.at_least, "Cases in all");
  app.add_option("--first-seed", options.selection.first_seed, "Seed of the first case");
  app.add_option("--points", options.selection.points, "Of each station");
  app.add_option("--method", options.method, "auto, polygons or segments");
  app.add_option("--only", options.only, "Only cases whose label holds this");
  app.add_flag("--furnished", options.selection.furnished,
               "Rooms as built, up to 70 % of their walls hidden by furniture");
  app.add_flag("--as-built", options.selection.as_built, "Only cases as built");
  app.add_flag("--foreign", options.foreign, "Seek the scans of each model in all others");
  CLI11_PARSE(app, argc, argv);
  try {
    options.foreign ? limen::run_foreign(options) : limen::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
