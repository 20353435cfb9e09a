// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_tables.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/version.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/summary/advice.h"
#include "limen/report/summary/precision.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

constexpr std::size_t kMostRows = 200;
constexpr double kOpenSigma = 0.5;  // metres or radians: of an alternative, what is known less well is open

std::string cell(const std::string& text, const char* tag = "td", const char* attributes = "") {
  return fmt::format("<{0}{1}>{2}</{0}>", tag, attributes, text);
}

/// A name of files or rooms, which is the same in every language.
std::string as_named(const std::string& name) {
  return "<span translate=\"no\">" + escaped(name) + "</span>";
}

std::string row(const std::string& head, const std::string& value) {
  return "<tr>" + cell(head, "th", " scope=\"row\"") + cell(value) + "</tr>\n";
}

/// A table with a head line; rows are ready HTML.
std::string table(const char* label, const std::vector<std::string>& heads, const std::string& rows,
                  const char* id) {
  std::string text = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{}\"><table "
      "id=\"{}\"><thead><tr>",
      label, id);
  for (const std::string& head : heads) text += cell(head, "th", " scope=\"col\"");
  return text + "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string facts(const std::string& rows, const char* id) {
  return fmt::format("<table class=\"facts\" id=\"{}\"><tbody>\n{}</tbody></table>\n", id, rows);
}

std::string area_words(double area_m2) {
  return fmt::format("{:.1f} m²", area_m2);
}

bool found(const RegistrationReport& report) {
  return report.result.outcome != Outcome::no_match;
}

std::string evidence_rows(const Hypothesis& pose) {
  std::string rows;
  if (pose.matched_segments > 0) {
    rows += row("Segments in common",
                fmt::format("{} with {:.1f} m", pose.matched_segments, pose.agreeing_length_m));
    return rows + row("Residual (root mean square)", length_words(pose.rms_m));
  }
  rows += row("Overlap: surface that agrees", area_words(pose.agreeing_m2));
  rows += row("Overlap: surface that contradicts", area_words(pose.contradicted_m2));
  rows += row("Residual (root mean square)", length_words(pose.rms_m));
  rows += row("Planes matched", fmt::format("{}", pose.matched_planes));
  rows += row("Openings matched", fmt::format("{}", pose.matched_openings));
  if (pose.explained_share)
    rows +=
        row("Walls of the scan found in the model", fmt::format("{:.0f} %", 100.0 * *pose.explained_share));
  return rows;
}

std::string size_of(const InputSummary& input) {
  if (input.kind == "scan") return fmt::format("{} points", input.points);
  return fmt::format("{} {}", input.elements, input.kind == "model" ? "elements" : "segments");
}

const Hypothesis& pose_of(const RegistrationResult& result, std::size_t pose) {
  return pose == 0 ? result.best : result.alternatives.at(pose - 1);
}

/// What is measured for the best pose alone.
std::string best_rows(const RegistrationResult& result) {
  std::string rows;
  if (const auto planes = plane_distance_rms(result.matches))
    rows += row("Residual between matched planes", length_words(*planes));
  for (const MeasuredThickness& wall : result.thickness) {
    if (wall.sigma_m > 0.1) continue;
    rows += row("Wall thickness", fmt::format("{:.3f} m ± {}", wall.value_m, length_words(wall.sigma_m)));
    break;
  }
  return rows;
}

std::string precision_row(const std::string& name, const PlacePrecision& place) {
  return "<tr>" + cell(name, "th", " scope=\"row\"") + cell(length_words(place.radius_m)) +
         cell(place.formal_radius_m ? length_words(*place.formal_radius_m) : "—") + "</tr>\n";
}

/// Formal and empirical separately.
std::string precision_table(const std::optional<PosePrecision>& precision) {
  if (!precision) return {};
  const std::string far = fmt::format("Far end, {:.0f} m from the centre", precision->far_distance_m);
  return table(
      "Accuracy of the pose", {"Place", "Accuracy (95 %)", "From the noise of the points alone"},
      precision_row("Centre of the source", precision->middle) + precision_row(far, precision->far_end),
      "precision");
}

std::string hash_of(const std::string& sha256) {
  if (sha256.empty()) return "—";
  return "<code class=\"hash\" translate=\"no\">" + sha256 + "</code>";
}

std::string input_row(const char* side, const InputSummary& input) {
  const Vector3d extent = input.high - input.low;
  std::string path = as_named(file_name(input));
  for (const std::string& with : input.with)
    path += "<br>with " + as_named(std::filesystem::path(with).filename().string());
  std::string kind = input.kind == "scan" ? (input.mobile ? "mobile scan" : "static scan") : input.kind;
  if (input.kind == "scan" && !input.centre_known) kind = "scan, scanner position unknown";
  return "<tr>" + cell(side, "th", " scope=\"row\"") + cell(path) + cell(kind) + cell(size_of(input)) +
         cell(fmt::format("{:.1f} × {:.1f} × {:.1f} m", extent.x(), extent.y(), extent.z())) +
         cell(hash_of(input.sha256)) + "</tr>\n";
}

}  // namespace

std::string key_table(const RegistrationReport& report, std::size_t pose) {
  const RegistrationResult& result = report.result;
  std::string rows =
      row("Source", as_named(file_name(report.source)) + ", <span>" + size_of(report.source) + "</span>");
  rows += row("Target", as_named(file_name(report.target)) + ", <span>" + size_of(report.target) + "</span>");
  if (!found(report)) return facts(rows, "key");
  const Hypothesis& shown = pose_of(result, pose);
  if (shown.probability && !result.published)
    rows += row("Probability", probability_words(*shown.probability));
  if (!shown.room.empty()) rows += row("Room", as_named(shown.room));
  rows += evidence_rows(shown);
  if (pose == 0) rows += best_rows(result);
  if (!result.alternatives.empty())
    rows += row("Other poses tested", fmt::format("{}", result.alternatives.size()));
  return facts(rows, "key");
}

std::string sigma_table(const RegistrationReport& report, std::size_t pose) {
  if (!found(report)) return {};
  const RegistrationResult& result = report.result;
  const Hypothesis& shown = pose_of(result, pose);
  const PoseMotion motion = motion_of(report, shown);
  const Vector3d turn = motion.turn_rad * motion.axis;
  const Vector3d shift_sigma = shift_sigma_of(report, shown);
  const auto deviation = [&](bool rotation, int axis, double sigma, const std::string& words) {
    const bool open = pose == 0 ? is_open(result, rotation, axis) : sigma > kOpenSigma;
    if (open) return std::string("◇ not determined by the data");
    return result.published ? std::string("not given by the method") : "± " + words;
  };
  std::string rows;
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    rows += "<tr>" + cell(fmt::format("Shift along {}", kAxes[axis]), "th", " scope=\"row\"") +
            cell(fmt::format("{:.4f} m", motion.shift_m[axis] + 0.0)) +
            cell(deviation(false, axis, shift_sigma[axis], length_words(shift_sigma[axis]))) + "</tr>\n";
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = shown.sigma.rotation_rad[axis];
    rows += "<tr>" + cell(fmt::format("Turn about {}", kAxes[axis]), "th", " scope=\"row\"") +
            cell(fmt::format("{:.4f}°", degrees(turn[axis]) + 0.0)) +
            cell(deviation(true, axis, sigma, angle_words(sigma))) + "</tr>\n";
  }
  return table("Uncertainty of the pose", {"Degree of freedom", "Value", "Standard deviation"}, rows,
               "sigma") +
         precision_table(precision_of(report, shown));
}

std::string causes_table(const RegistrationReport& report) {
  std::string rows;
  for (const LikelyCause& cause : likely_causes(report))
    rows += "<tr>" + cell(escaped(cause.name), "th", " scope=\"row\"") + cell(escaped(cause.measured)) +
            cell(escaped(cause.remedy)) + "</tr>\n";
  if (rows.empty()) return {};
  return table("Likely causes, the likeliest first", {"Cause", "Measured", "What to do"}, rows, "causes");
}

std::string alternatives_table(const RegistrationReport& report) {
  if (!found(report) || report.result.alternatives.empty()) return {};
  const RegistrationResult& result = report.result;
  const bool segments = result.best.matched_segments > 0;
  const std::size_t count = std::min(result.alternatives.size() + 1, kMostRows);
  bool rooms = false;
  bool probable = false;
  for (std::size_t k = 0; k < count; ++k) {
    rooms = rooms || !pose_of(result, k).room.empty();
    probable = probable || (pose_of(result, k).probability && !result.published);
  }
  std::string rows;
  for (std::size_t k = 0; k < count; ++k) {
    const Hypothesis& pose = pose_of(result, k);
    const std::string name = k == 0 ? "Best" : fmt::format("Alternative {}{}", k, pose.tie ? " =" : "");
    rows += fmt::format("<tr data-pose=\"{}\">", k) +
            cell(fmt::format("<button type=\"button\" class=\"link\" data-pose=\"{}\">{}</button>", k, name),
                 "th", " scope=\"row\"");
    if (probable) rows += cell(pose.probability ? probability_words(*pose.probability) : "—");
    if (segments) {
      rows += cell(fmt::format("{}", pose.matched_segments)) +
              cell(fmt::format("{:.1f} m", pose.agreeing_length_m));
    } else {
      rows += cell(area_words(pose.agreeing_m2)) + cell(area_words(pose.contradicted_m2));
    }
    // Poses that were never judged to the end have none.
    rows += cell(pose.rms_m > 0 ? length_words(pose.rms_m) : "—");
    if (rooms) rows += cell(as_named(pose.room));
    rows += "</tr>\n";
  }
  std::vector<std::string> heads = {"Pose"};
  if (probable) heads.emplace_back("Probability");
  heads.emplace_back(segments ? "Segments" : "Agrees");
  heads.emplace_back(segments ? "Length" : "Contradicted");
  heads.emplace_back("Residual");
  if (rooms) heads.emplace_back("Room");
  return table("Poses", heads, rows, "alternatives");
}

std::string planes_table(const RegistrationReport& report) {
  std::vector<PlaneMatch> matches = report.result.matches;
  if (matches.empty()) return {};
  std::stable_sort(matches.begin(), matches.end(),
                   [](const PlaneMatch& a, const PlaneMatch& b) { return a.overlap_m2 > b.overlap_m2; });
  std::string rows;
  for (std::size_t k = 0; k < matches.size() && k < kMostRows; ++k) {
    const PlaneMatch& match = matches[k];
    rows +=
        fmt::format("<tr data-source-plane=\"{}\" data-target-plane=\"{}\">", match.source, match.target) +
        cell(fmt::format("{} – {}", match.source, match.target), "th", " scope=\"row\"") +
        cell(length_words(match.distance_m)) + cell(angle_words(match.angle_rad)) +
        cell(area_words(match.overlap_m2)) + "</tr>\n";
  }
  return table("Planes that agree", {"Planes, source – target", "Distance", "Angle", "Overlap"}, rows,
               "planes");
}

std::string openings_table(const RegistrationReport& report) {
  if (report.result.openings.empty()) return {};
  std::string rows;
  for (std::size_t k = 0; k < report.result.openings.size() && k < kMostRows; ++k) {
    const MatchedOpenings& match = report.result.openings[k];
    rows += "<tr>" + cell(fmt::format("{} – {}", match.source, match.target), "th", " scope=\"row\"") +
            cell(length_words(match.shift_across_m)) + cell(length_words(match.shift_up_m)) + "</tr>\n";
  }
  return table("Openings that agree", {"Openings, source – target", "Offset, across", "Offset, upwards"},
               rows, "openings");
}

std::string thickness_table(const RegistrationReport& report) {
  std::string rows;
  for (const MeasuredThickness& wall : report.result.thickness) {
    const bool known = wall.sigma_m <= 0.1;
    rows += "<tr>" +
            cell(fmt::format("{} – {}", wall.source_plane, wall.target_plane), "th", " scope=\"row\"") +
            cell(known ? fmt::format("{:.3f} m", wall.value_m) : "◇ not determined by the data") +
            cell(known ? "± " + length_words(wall.sigma_m) : "") + cell(fmt::format("{}", wall.openings)) +
            "</tr>\n";
  }
  if (rows.empty()) return {};
  return table("Walls between the scans",
               {"Wall, source – target plane", "Thickness", "One standard deviation", "Openings"}, rows,
               "thickness");
}

std::string inputs_table(const RegistrationReport& report) {
  return table("Inputs", {"Side", "File", "Kind", "Content", "Extent", "SHA-256"},
               input_row("Source", report.source) + input_row("Target", report.target), "inputs");
}

std::string stages_table(const RegistrationReport& report) {
  std::vector<StageTime> stages;
  double total = 0.0;
  for (const StageTime& stage : report.result.stages) {
    const auto known = std::find_if(stages.begin(), stages.end(),
                                    [&stage](const StageTime& one) { return one.name == stage.name; });
    if (known == stages.end()) {
      stages.push_back(stage);
    } else {
      known->seconds += stage.seconds;
    }
    total += stage.seconds;
  }
  if (stages.empty()) return {};
  std::string rows;
  for (const StageTime& stage : stages) {
    const double share = total > 0 ? 100.0 * stage.seconds / total : 0.0;
    rows += "<tr>" + cell(escaped(stage.name), "th", " scope=\"row\"") +
            cell(fmt::format("{:.2f} s", stage.seconds)) +
            cell(fmt::format("<span class=\"bar\" style=\"width:{:.1f}%\"></span>", share), "td",
                 " class=\"bars\" aria-hidden=\"true\"") +
            "</tr>\n";
  }
  rows += "<tr>" + cell("All", "th", " scope=\"row\"") + cell(fmt::format("{:.2f} s", total)) + cell("") +
          "</tr>\n";
  return table("Time", {"Stage", "Time", "Share"}, rows, "stages");
}

std::string options_table(const RegistrationReport& report) {
  const auto option = [](const std::string& name, const std::string& value) {
    return "<tr>" + cell(as_named(name), "th", " scope=\"row\"") + cell(as_named(value)) + "</tr>\n";
  };
  std::string rows = option("limen", kVersion) + option("seed", fmt::format("{}", report.seed));
  for (const auto& [name, value] : report.options) {
    const std::string text = std::visit(
        [](const auto& plain) {
          if constexpr (std::is_same_v<std::decay_t<decltype(plain)>, std::string>) {
            return plain;
          } else {
            return fmt::format("{}", plain);
          }
        },
        value);
    rows += option(name, text);
  }
  return facts(rows, "options");
}

}  // namespace limen
