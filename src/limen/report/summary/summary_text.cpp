// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/summary_text.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/report/summary/advice.h"
#include "limen/report/summary/precision.h"
#include "limen/report/summary/words.h"

namespace limen {

AnswerPlaces answer_places(const RegistrationResult& result) {
  constexpr double kShare = 0.95;
  const std::size_t count = result.alternatives.size();
  AnswerPlaces places;
  places.alternatives.resize(count);
  std::iota(places.alternatives.begin(), places.alternatives.end(), std::size_t{0});
  if (!result.others || !result.best.probability) return places;
  const auto probability = [&](std::size_t k) {
    return k < count ? result.alternatives[k].probability.value_or(0.0) : result.others->look_alike;
  };
  std::vector<std::size_t> order(count + 1);  // the last is the place that no pose is listed of
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probability(a) > probability(b); });
  places.alternatives.clear();
  double reached = *result.best.probability;
  for (const std::size_t k : order) {
    if (reached >= kShare * (1.0 - result.others->nothing_shared) || probability(k) <= 0.0) break;
    reached += probability(k);
    if (k == count)
      places.look_alike = true;
    else
      places.alternatives.push_back(k);
  }
  std::sort(places.alternatives.begin(), places.alternatives.end());
  return places;
}

namespace {

constexpr std::size_t kShown = 12;  // alternatives on the console

std::string line(const char* name, const std::string& value) {
  return fmt::format("{:<12}{}\n", name, value);
}

std::string motion_lines(const RegistrationReport& report) {
  const PoseMotion motion = motion_of(report, report.result.best);
  const Vector3d& shift = motion.shift_m;
  std::string text = line("shift", fmt::format("{:.4f} {:.4f} {:.4f} m, of the centre of {} ({})",
                                               shift.x() + 0.0, shift.y() + 0.0, shift.z() + 0.0,
                                               file_name(report.source), length_words(shift.norm())));
  return text + line("turn", fmt::format("{:.4f} deg about {}, through that centre", degrees(motion.turn_rad),
                                         axis_words(motion.axis)));
}

/// What the stated accuracy counts besides the noise of the points.
std::string rest_words(const RegistrationReport& report) {
  std::string text = report.result.moved.empty() || in_model(report)
                         ? "how far planes disagree"
                         : "how far planes disagree or were moved";
  if (report.source.mobile || report.target.mobile) text += ", and how far trajectories drift";
  for (const InputSummary* side : {&report.source, &report.target}) {
    if (may_have_moved(report, *side))
      text += fmt::format(", and that the scanner of {} may have moved", file_name(*side));
  }
  return text;
}

std::string precision_lines(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  std::string text;
  if (const auto precision = precision_of(report, result.best)) {
    text += line("accuracy",
                 fmt::format("{} at the centre, {} at the far end {:.0f} m away (95 %{})",
                             length_words(precision->middle.radius_m),
                             length_words(precision->far_end.radius_m), precision->far_distance_m,
                             precision->across_open ? ", perpendicular to the undetermined direction" : ""));
    if (precision->middle.formal_radius_m)
      text += line("", fmt::format("{} and {} from the noise of the points alone; the rest is {}",
                                   length_words(*precision->middle.formal_radius_m),
                                   length_words(precision->far_end.formal_radius_m.value_or(0.0)),
                                   rest_words(report)));
  }
  for (const UnobservedFreedom& freedom : result.unobserved) text += line("not fixed", freedom.name);
  if (result.best.rms_m > 0) {
    std::string residuals = length_words(result.best.rms_m) + " of the " +
                            (result.best.matched_segments > 0 ? "edges" : "points");
    if (const auto planes = plane_distance_rms(result.matches))
      residuals += fmt::format(", {} between matched planes", length_words(*planes));
    text += line("residuals", residuals + " (root mean square)");
  }
  return text;
}

std::string start_line(const RegistrationResult& result) {
  if (!result.start) return {};
  const std::string off =
      fmt::format("{:.3g} m and {:.2f} deg from where it was expected, {:.1f} sigma", result.start->shift_m,
                  degrees(result.start->turn_rad), result.start->sigmas);
  return line("start", result.start->refuted() ? "refuted by the data: " + off : off);
}

std::string pose_lines(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  std::string text;
  if (result.best.probability && !result.published)
    text += line("probability", probability_words(*result.best.probability));
  text += motion_lines(report) + precision_lines(report) + start_line(result);
  for (const MeasuredThickness& wall : result.thickness) {
    if (wall.sigma_m > 0.1) continue;
    text += line("wall", fmt::format("{:.3f} m thick, sigma {:.1f} mm, from {} opening{}", wall.value_m,
                                     1e3 * wall.sigma_m, wall.openings, wall.openings == 1 ? "" : "s"));
  }
  if (!result.best.room.empty()) text += line("room", result.best.room);
  return text;
}

std::string alternative_line(std::size_t number, const Hypothesis& pose) {
  std::string text = fmt::format("{:>5} {} ", number, pose.tie ? '=' : ' ');
  text += fmt::format("{:>18}  ", pose.probability ? probability_words(*pose.probability) : "");
  if (pose.matched_segments > 0) {
    text += fmt::format("{:>4} segments, {:.1f} m", pose.matched_segments, pose.agreeing_length_m);
  } else {
    text += fmt::format("{:>7.1f} m2 agree, {:>5.1f} m2 contradict", pose.agreeing_m2, pose.contradicted_m2);
  }
  return text + (pose.room.empty() ? "" : "  " + pose.room) + "\n";
}

/// The places of an answer that is not decided.
std::string place_lines(const RegistrationResult& result) {
  const AnswerPlaces places = answer_places(result);
  std::string text = line(
      "places", "together 95 % of the probability, chance left out; = cannot be distinguished from number 0");
  text += alternative_line(0, result.best);
  const std::size_t shown = std::min(places.alternatives.size(), kShown);
  for (std::size_t k = 0; k < shown; ++k)
    text += alternative_line(places.alternatives[k] + 1, result.alternatives[places.alternatives[k]]);
  if (places.look_alike)
    text +=
        fmt::format("{:>7} {:>18}  a look-alike place\n", "", probability_words(result.others->look_alike));
  if (shown < result.alternatives.size())
    text += fmt::format("      and {} more in result.json\n", result.alternatives.size() - shown);
  return text;
}

/// A table where there is something to choose, else their number.
std::string alternative_lines(const RegistrationResult& result) {
  const std::size_t count = result.alternatives.size();
  if (result.outcome == Outcome::ambiguous && result.others) return place_lines(result);
  if (count == 0 || result.published) return {};
  const std::string others = count == 1 ? "1 other pose" : fmt::format("{} other poses", count);
  if (result.rivals == 0)
    return line("others", fmt::format("{} tested, {} nearly as well", others,
                                      count == 1 ? "it does not fit" : "none fits"));
  std::string text = line("others", others + "; = cannot be distinguished from the best (number 0)");
  text += alternative_line(0, result.best);
  std::size_t shown = 0;
  for (std::size_t k = 0; k < count && shown < kShown; ++k) {
    if (!result.alternatives[k].tie && shown >= result.rivals) continue;
    text += alternative_line(k + 1, result.alternatives[k]);
    ++shown;
  }
  if (shown < count) text += fmt::format("      and {} more in result.json\n", count - shown);
  return text;
}

std::string cause_lines(const RegistrationReport& report) {
  std::string text;
  std::size_t number = 0;
  for (const LikelyCause& cause : likely_causes(report)) {
    text += fmt::format("{}{:>3} {}: {}; {}\n", number == 0 ? "likely causes, the likeliest first\n" : "",
                        number + 1, cause.name, cause.measured, cause.remedy);
    ++number;
  }
  return text;
}

std::string next_lines(const RegistrationReport& report, const std::string& folder) {
  std::string text;
  for (const std::string& step : next_steps(report, folder)) text += line(text.empty() ? "next" : "", step);
  if (report.result.outcome != Outcome::no_match && on_large_coordinates(report))
    text += line("",
                 "in CloudCompare apply transform.txt to the global coordinates (Apply Transformation, "
                 "\"apply to global\"), because they are large");
  if (report.result.outcome != Outcome::no_match && has_offset(report))
    text += line(
        "", "in a program that ignores the offset in the comment of a file, use transform_raw.txt instead");
  return text;
}

}  // namespace

std::string summary_text(const RegistrationReport& report, const std::string& folder) {
  const RegistrationResult& result = report.result;
  std::string text = fmt::format("{}: {}\n", to_string(result.outcome), result.reason);
  text += result.outcome == Outcome::no_match ? cause_lines(report)
                                              : pose_lines(report) + alternative_lines(result);
  text += next_lines(report, folder);
  double seconds = 0.0;
  for (const StageTime& stage : result.stages) seconds += stage.seconds;
  return text + fmt::format("in {:.2f} s; written to {}\n", seconds, folder);
}

}  // namespace limen
