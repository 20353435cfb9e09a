// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/advice.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/model/plausible_size.h"
#include "limen/register/judge/posterior.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

Vector3d inner_size(const InputSummary& side) {
  const Vector3d inner = side.inner_high - side.inner_low;
  return inner.isZero(0.0) ? Vector3d(side.high - side.low) : inner;
}

constexpr double kSureApart = 1.05;  // heights of storeys that differ by less are hardly a chance

/// Evidence for a cause; the largest is shown first.
struct WeighedCause {
  double weight = 0.0;
  LikelyCause cause;
};

/// How far two ratios of lengths lie apart, as a factor of 1 or more.
double apart(double a, double b) {
  return a > b ? a / b : b / a;
}

WeighedCause overlap_cause(const RegistrationReport& report) {
  const Hypothesis& best = report.result.best;
  WeighedCause stated{2.0, {"overlap", "", ""}};
  LikelyCause& cause = stated.cause;
  cause.remedy =
      "take scans that share walls of three directions (a floor, two walls), or a window that both see";
  if (report.source.kind == "segments") {
    cause.measured = "too few edges of one list lie on edges of the other";
    cause.remedy = "give lists that show the same edges of three directions";
  } else if (best.explained_share) {
    cause.measured = fmt::format("at best {:.0f} % of the walls that the scan saw are in the model",
                                 100.0 * *best.explained_share);
    cause.remedy = "check that the model is of this building and contains this storey";
  } else if (best.agreeing_m2 > 0.0) {
    cause.measured = overlap_words(best.agreeing_m2, best.contradicted_m2);
  } else {
    cause.measured = "no plane of one matches a plane of the other";
  }
  return stated;
}

WeighedCause units_cause(const RegistrationReport& report) {
  const Vector3d source = inner_size(report.source);
  const Vector3d target = inner_size(report.target);
  WeighedCause stated{0.5, {"units", "", ""}};
  stated.cause.measured = fmt::format("the source measures {}, the target {} (all but a few points)",
                                      size_words(source), size_words(target));
  stated.cause.remedy =
      "if the coordinates of a file are not in metres, give --source-units or --target-units";
  if (const auto guess = likely_unit(report.source, report.target)) {
    const char* const side = guess->source ? "source" : "target";
    const bool sure = guess->apart < kSureApart;
    stated.weight = sure ? 3.0 : 1.7;
    stated.cause.measured += fmt::format("; if the coordinates of the {} were in {}, both would be {} high",
                                         side, guess->unit, sure ? "equally" : "about equally");
    stated.cause.remedy = fmt::format("{}give --{}-units {}", sure ? "" : "if they are, ", side, guess->unit);
  }
  return stated;
}

std::optional<WeighedCause> place_cause(const InputSummary& side, const char* name) {
  if (side.kind != "scan" || side.mobile) return std::nullopt;
  WeighedCause stated{0.0, {"place of the scanner", "", ""}};
  stated.cause.remedy = fmt::format("if it is known, give --{}-origin x,y,z", name);
  const PlaceSource source = side.place.source;
  if (side.place.refuted) {
    const Vector3d& said = *side.place.refuted;
    stated.weight = 2.5;
    stated.cause.measured =
        fmt::format("the points of the {} contradict the scanner position {:.2f} {:.2f} {:.2f}", name,
                    said.x(), said.y(), said.z());
  } else if (source == PlaceSource::unknown) {
    stated.weight = 1.5;
    stated.cause.measured = fmt::format(
        "the scanner position of the {} is unknown and cannot be estimated from its points", name);
  } else if (source == PlaceSource::assumed && !side.place.confirmed) {
    stated.weight = 1.0;
    stated.cause.measured = fmt::format(
        "the scanner position of the {} is assumed to be 0,0,0, which its points do not confirm", name);
  } else {
    return std::nullopt;
  }
  return stated;
}

std::optional<WeighedCause> axes_cause(const RegistrationReport& report) {
  for (const auto& [name, value] : report.options) {
    const std::string* text = std::get_if<std::string>(&value);
    if (name != "gravity" || text == nullptr || *text != "up") continue;
    return WeighedCause{1.8,
                        {"axes", "--gravity up states that both z axes point up",
                         "leave --gravity out: limen then finds the vertical itself"}};
  }
  return std::nullopt;
}

WeighedCause pair_cause(const RegistrationReport& report) {
  if (in_model(report))
    return {1.2,
            {"another pair", "a single scan was compared with the model",
             "register it with its neighbours first and give them with --source-with, or use limen project "
             "with --model"}};
  return {
      1.2,
      {"another pair", "only these two scans were given",
       "give scans that lie between them with --source-with and --target-with, or all with limen project"}};
}

std::string in_folder(const std::string& folder, const char* name) {
  return folder.empty() ? std::string("DIR/") + name
                        : shell_word((std::filesystem::path(folder) / name).string());
}

/// The command that moves the source's cloud; what to do instead where the units differ, for it moves and
/// does not scale.
std::string transform_command(const RegistrationReport& report, const std::string& folder, bool choice) {
  const bool source_moves = report.source.kind == "scan";
  const InputSummary& moved = source_moves ? report.source : report.target;
  if (report.source.metres_per_unit != report.target.metres_per_unit)
    return fmt::format("apply {}, which includes the scale, in another program",
                       in_folder(folder, "transform.txt"));
  if (moved.path.empty()) return fmt::format("apply {}", in_folder(folder, "transform.txt"));
  return fmt::format("limen transform {}{}{} {} moved.ply", in_folder(folder, "result.json"),
                     choice ? " --alternative N" : "", source_moves ? "" : " --invert",
                     shell_word(moved.path));
}

bool has_report(const RegistrationReport& report) {
  return report.result.picture != nullptr;
}

double most_moved_mm(const std::vector<PlaneMatch>& moved) {
  double most_m = 0.0;
  for (const PlaneMatch& plane : moved) most_m = std::max(most_m, std::abs(plane.distance_m));
  return 1e3 * most_m;
}

/// Planes of a model that were probably built elsewhere, where there are any.
std::string moved_words(const std::vector<PlaneMatch>& moved) {
  if (moved.empty()) return {};
  const bool one = moved.size() == 1;
  return fmt::format("{} plane{} of the model {} up to {:.0f} mm from where {} built; ", moved.size(),
                     one ? "" : "s", one ? "is" : "are", most_moved_mm(moved), one ? "it was" : "they were");
}

/// Of two scans what lies beside its counterpart, where there is any.
void add_step_of_moved(const RegistrationReport& report, std::vector<std::string>& steps) {
  const std::vector<PlaneMatch>& moved = report.result.moved;
  if (moved.empty() || in_model(report)) return;
  steps.push_back(fmt::format(
      "find out what was moved or rebuilt between the scans: {} up to {:.0f} mm beside {}; the stated "
      "accuracy allows for either side having moved",
      moved.size() == 1 ? "1 plane lies" : fmt::format("{} planes lie", moved.size()), most_moved_mm(moved),
      moved.size() == 1 ? "its counterpart" : "their counterparts"));
}

std::vector<std::string> steps_registered(const RegistrationReport& report, const std::string& folder) {
  std::vector<std::string> steps;
  if (has_report(report))
    steps.push_back(
        fmt::format("look at {}: 3-D view, residuals, sections", in_folder(folder, "report.html")));
  if (report.source.kind == "segments") return steps;
  steps.push_back(fmt::format("move the cloud: {}", transform_command(report, folder, false)));
  if (in_model(report)) {
    const bool source_is_model = report.source.kind == "model";
    const InputSummary& scan = source_is_model ? report.target : report.source;
    const InputSummary& model = source_is_model ? report.source : report.target;
    steps.push_back(
        fmt::format("{}measure deviations from the model: limen deviation {} {} --result {}{} -o deviation",
                    moved_words(report.result.moved), shell_word(scan.path), shell_word(model.path),
                    in_folder(folder, "result.json"), source_is_model ? " --inverse" : ""));
  }
  add_step_of_moved(report, steps);
  for (const auto& [side, name] :
       {std::pair(&report.source, "source"), std::pair(&report.target, "target")}) {
    if (!may_have_moved(report, *side)) continue;
    steps.push_back(
        fmt::format("if the scanner of {} stood in one place, state its position, and the accuracy will be "
                    "better: --{}-origin x,y,z",
                    file_name(*side), name));
  }
  return steps;
}

double chance_of(const RegistrationResult& result) {
  const OtherExplanations others = result.others.value_or(OtherExplanations{});
  return others.nothing_shared + others.unlisted_pose;
}

double elsewhere_of(const RegistrationResult& result) {
  const double look_alike = result.others ? result.others->look_alike : 0.0;
  return 1.0 - result.best.probability.value_or(1.0) - look_alike - chance_of(result);
}

/// What excludes a look-alike place, where nothing else is as likely besides the best pose.
std::optional<std::string> step_of_look_alike(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  const double look_alike = result.others ? result.others->look_alike : 0.0;
  if (look_alike < std::max(chance_of(result), elsewhere_of(result))) return std::nullopt;
  const bool said = std::any_of(report.options.begin(), report.options.end(),
                                [](const auto& option) { return option.first == "repeats"; });
  return said ? "to be more certain, ask somebody who knows the building: are these the same room, or two "
                "look-alike rooms?"
              : "to be more certain, add --repeats none, if no room, flat or storey of the building looks "
                "like another";
}

std::vector<std::string> steps_probable(const RegistrationReport& report, const std::string& folder) {
  std::vector<std::string> steps = {surer(report)};
  for (std::string& step : steps_registered(report, folder)) steps.push_back(std::move(step));
  return steps;
}

std::vector<std::string> steps_ambiguous(const RegistrationReport& report, const std::string& folder) {
  std::vector<std::string> steps;
  const bool ties = report.result.rivals > 0;
  if (has_report(report))
    steps.push_back(fmt::format("look at {} in {}", ties ? "the poses one by one" : "the pose",
                                in_folder(folder, "report.html")));
  if (report.source.kind == "segments") return steps;
  if (ties)
    steps.push_back(fmt::format("if you know which pose is right, choose it by its number: {}",
                                transform_command(report, folder, true)));
  if (report.result.others && report.result.others->look_alike > 0.0) {
    if (std::optional<std::string> step = step_of_look_alike(report)) steps.push_back(*std::move(step));
  }
  steps.push_back(in_model(report)
                      ? "add a scan of a place that is unique in the model: --source-with SCAN POSE"
                      : "add a scan that shows where the places differ: --source-with SCAN POSE, or limen "
                        "project with all scans");
  return steps;
}

std::vector<std::string> steps_open(const RegistrationReport& report, const std::string& folder) {
  std::vector<std::string> steps;
  if (has_report(report))
    steps.push_back(
        fmt::format("see in {} which direction is undetermined", in_folder(folder, "report.html")));
  std::string what =
      "add a scan that shows a wall, a floor or a window perpendicular to the undetermined direction: "
      "--source-with SCAN POSE, or limen project with all scans";
  for (const UnobservedFreedom& freedom : report.result.unobserved) {
    if (freedom.rotation)
      what = "add a scan that shows surfaces of other directions: --source-with SCAN POSE";
  }
  steps.push_back(what);
  if (report.source.mobile != report.target.mobile && report.result.thickness.empty() &&
      !report.result.openings.empty())
    steps.push_back("if the thickness of the outer wall is known, give --wall-thickness-m");
  add_step_of_moved(report, steps);
  return steps;
}

std::vector<std::string> steps_none(const RegistrationReport& report, const std::string& folder) {
  std::vector<std::string> steps;
  if (has_report(report))
    steps.push_back(fmt::format("look at both side by side in {}", in_folder(folder, "report.html")));
  const std::vector<LikelyCause> causes = likely_causes(report);
  if (!causes.empty()) steps.push_back(causes.front().remedy);
  if (report.source.kind == "scan") steps.push_back("check how limen reads the files: limen info FILE");
  return steps;
}

}  // namespace

std::optional<UnitGuess> likely_unit(const InputSummary& source, const InputSummary& target) {
  if (source.kind == "segments") return std::nullopt;
  Vector3d from = inner_size(source);
  Vector3d to = inner_size(target);
  std::sort(from.data(), from.data() + 3);
  std::sort(to.data(), to.data() + 3);
  if (!(from[0] > 0) || !(to[0] > 0)) return std::nullopt;
  const bool source_larger = from[0] > to[0];
  const double thickness = apart(from[0], to[0]);  // of storeys, mostly: they hardly differ
  const double length = source_larger ? from[2] / to[2] : to[2] / from[2];
  const InputSummary& larger = source_larger ? source : target;
  // A model's unit is in its file; and who gave a unit is not asked for another.
  if (larger.kind == "model" || larger.metres_per_unit != 1.0) return std::nullopt;
  // A building may well be three times as high and as long as a room of another, both in metres.
  if (is_size_of_building(inner_size(larger))) return std::nullopt;
  struct Unit {
    const char* name;
    double per_metre;
    double slack;  // factor by which storeys may differ
  };
  for (const Unit& unit : {Unit{"mm", 1000.0, 2.0}, Unit{"cm", 100.0, 1.6}, Unit{"in", 39.3701, 1.2},
                           Unit{"ft", 3.28084, 1.15}}) {
    if (apart(thickness, unit.per_metre) > unit.slack || apart(length, unit.per_metre) > 2.5) continue;
    if (!is_size_of_building(inner_size(larger) / unit.per_metre)) continue;
    return UnitGuess{source_larger, unit.name, apart(thickness, unit.per_metre)};
  }
  return std::nullopt;
}

std::string surer(const RegistrationReport& report) {
  if (std::optional<std::string> step = step_of_look_alike(report)) return *std::move(step);
  const double chance = chance_of(report.result);
  const char* const with =
      in_model(report) || report.source.kind == "scan" ? ": --source-with SCAN POSE" : "";
  return chance > elsewhere_of(report.result)
             ? fmt::format("to be more certain, add a scan that shows more of the overlap{}", with)
             : fmt::format(
                   "to be more certain, add a scan that sees both sides{}, or use limen project with all "
                   "scans",
                   with);
}

std::vector<LikelyCause> likely_causes(const RegistrationReport& report) {
  if (report.result.outcome != Outcome::no_match) return {};
  std::vector<WeighedCause> causes = {overlap_cause(report), pair_cause(report)};
  if (report.source.kind != "segments") causes.push_back(units_cause(report));
  for (auto cause :
       {place_cause(report.source, "source"), place_cause(report.target, "target"), axes_cause(report)}) {
    if (cause) causes.push_back(std::move(*cause));
  }
  std::stable_sort(causes.begin(), causes.end(),
                   [](const WeighedCause& a, const WeighedCause& b) { return a.weight > b.weight; });
  std::vector<LikelyCause> list;
  for (WeighedCause& cause : causes) list.push_back(std::move(cause.cause));
  return list;
}

std::vector<std::string> next_steps(const RegistrationReport& report, const std::string& folder) {
  if (report.result.published) {
    return {"compare it with the verdict of limen's own method: leave --as-published out"};
  }
  switch (report.result.outcome) {
    case Outcome::registered:
      return steps_registered(report, folder);
    case Outcome::probable:
      return steps_probable(report, folder);
    case Outcome::ambiguous:
      return steps_ambiguous(report, folder);
    case Outcome::under_constrained:
      return steps_open(report, folder);
    case Outcome::no_match:
      break;
  }
  return steps_none(report, folder);
}

}  // namespace limen
