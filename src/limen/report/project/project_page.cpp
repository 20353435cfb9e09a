// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/version.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/report_page.h"
#include "limen/report/project/page_parts.h"
#include "limen/report/project/project_axes.h"
#include "limen/report/project/question_pictures.h"
#include "limen/report/project/station_accuracy.h"
#include "limen/report/summary/precision.h"

namespace limen {
namespace {

std::string state_cell(const char* state) {
  return fmt::format("<td class=\"state {0}\">{0}</td>", state);
}

/// What a button says.
std::string caption_of(const Decision& answer, bool several) {
  switch (answer.kind) {
    case DecisionKind::accept:
      return several ? "Yes, at the best pose" : "Yes";
    case DecisionKind::choose:
      return fmt::format("Yes, at pose {}", answer.pose);
    case DecisionKind::reject:
      return "No";
    default:
      break;
  }
  return "Don't know";
}

std::string questions(const ProjectResult& result, const std::vector<std::string>& drawn) {
  if (result.questions.empty()) return {};
  std::string text = "<h2>Open questions</h2>\n";
  std::size_t number = 0;
  for (const ProjectQuestion& question : result.questions) {
    text += fmt::format("<div class=\"card ask keep\"><p>{}</p>\n", escaped(question.text));
    for (const std::vector<Decision>& answers : asked_of(question)) {
      text += fmt::format("<p>{}</p>\n{}", escaped(asked_words(answers)),
                          number < drawn.size() ? drawn[number] : "");
      ++number;
      const bool several = std::any_of(answers.begin(), answers.end(), [](const Decision& answer) {
        return answer.kind == DecisionKind::choose;
      });
      for (const Decision& answer : answers)
        text += fmt::format("<button type=\"button\" class=\"answer\" data-line=\"{}\">{}</button> ",
                            escaped(decide_line("DIR", answer)), caption_of(answer, several));
    }
    text += "</div>\n";
  }
  return text +
         "<p class=\"soft\" id=\"paste\" hidden><span>Paste this line into a terminal, then run the project "
         "again (finished work is kept):</span> <code translate=\"no\"></code></p>\n";
}

/// A card with a table; `head`: the cells of its first row, those of numbers begin with '#'.
std::string table(const std::string& title, const std::string& id, const std::vector<std::string>& head,
                  const std::string& rows, const std::string& note = {}) {
  return fmt::format("<section class=\"card wide keep\"{}><h2>{}</h2>\n{}{}</section>\n",
                     id.empty() ? "" : fmt::format(" id=\"{}\"", id), title,
                     note.empty() ? "" : fmt::format("<p class=\"soft\">{}</p>\n", note),
                     scrolled_table(title, head, rows));
}

std::string decisions_table(const ProjectResult& result) {
  if (result.decisions.empty()) return {};
  std::string text;
  for (const ProjectDecision& stated : result.decisions) {
    const char* colour = stated.state == DecisionState::kept           ? "verified"
                         : stated.state == DecisionState::contradicted ? "rejected"
                                                                       : "weak";
    text += fmt::format("<tr><td translate=\"no\">{}</td><td class=\"state {}\">{}</td><td>{}</td></tr>\n",
                        escaped(words_of(stated.decision)), colour, to_string(stated.state),
                        escaped(stated.reason));
  }
  return table("Your decisions", "", {"decision", "state", "why"}, text);
}

std::string pass_cell(const std::optional<bool>& within) {
  if (!within) return "<td></td>";
  return *within ? "<td class=\"state verified\">pass</td>" : "<td class=\"state rejected\">fail</td>";
}

/// Deviations along the axes and of the heading, and what holds with 95 %.
std::string accuracy_cells(const std::optional<StationAccuracy>& it, bool tolerance) {
  const std::string last = tolerance ? "<td></td>" : "";
  if (!it) return "<td></td><td></td><td></td><td></td><td></td><td></td>" + last;
  if (it->held_fixed) return "<td colspan=\"6\">held fixed</td>" + last;
  std::string text;
  for (const double sigma : it->sigma_m) text += fmt::format("<td class=\"n\">{:.1f}</td>", 1e3 * sigma);
  text += fmt::format("<td class=\"n\">{:.3f}</td><td class=\"n\">{:.1f}</td><td>{}</td>",
                      degrees(it->heading_sigma_rad), 1e3 * it->radius_m,
                      it->loa > 0 ? fmt::format("LOA{}", it->loa) : "");
  return tolerance ? text + pass_cell(it->within_tolerance) : text;
}

std::string scans_table(const ProjectResult& result) {
  std::string text;
  for (const std::size_t k : worst_scans_first(result)) {
    const ProjectScan& scan = result.scans[k];
    text += fmt::format(
        "<tr id=\"scan{0}\"><td class=\"n\">{0}</td><td class=\"path\" translate=\"no\">{1}{2}</td>", k,
        escaped(shown_name(scan)), scan.model ? " <span class=\"soft\">model</span>" : "");
    text += state_cell(scan.readable ? to_string(scan.state) : "unreadable");
    text +=
        fmt::format("<td class=\"n\">{}</td>", scan.component >= 0 ? fmt::format("{}", scan.component) : "");
    text += accuracy_cells(accuracy_of(result, k), result.tolerance_m.has_value());
    text += fmt::format("<td>{}</td></tr>\n", escaped(scan.reason));
  }
  std::vector<std::string> head = {"#no.", "file", "state",         "#group",    "#sigma x, mm",
                                   "#y",   "#z",   "#heading, deg", "#95 %, mm", "class"};
  if (result.tolerance_m) head.emplace_back(fmt::format("{:g} mm", 1e3 * *result.tolerance_m));
  head.emplace_back("why");
  return table(
      "Scans", "scans", head, text,
      "The worst first. 95 %: radius that holds the position with this probability; class: the Level of "
      "Accuracy of the USIBD "
      "by that radius. registered: certain within the limit; probable: less certain; ambiguous: another "
      "place fits as "
      "well; under_constrained: a direction is undetermined; floating: not connected to the main group.");
}

/// What no loop checks leaves no residual.
std::string residual_cells(const ProjectResult& result, const ProjectLink& link) {
  std::string text = is_checked(link)
                         ? fmt::format("<td class=\"n\">{:.1f}</td><td class=\"n\">{:.3f}</td>",
                                       1e3 * link.solved.loop_error_m, degrees(link.solved.loop_error_rad))
                         : "<td colspan=\"2\">unchecked</td>";
  if (result.tolerance_m) text += pass_cell(within_tolerance(result, link));
  return text;
}

/// How much of the smaller scan agrees, and how far the planes that do lie from one another.
std::string overlap_cells(const ProjectResult& result, std::size_t link) {
  const std::optional<double> overlap = overlap_of(result, link);
  std::string text =
      fmt::format("<td class=\"n\">{}</td>", overlap ? fmt::format("{:.0f}", 100.0 * *overlap) : "");
  for (const std::vector<PlaneMatch>* planes : {&result.links[link].matches, &result.links[link].adjusted}) {
    const std::optional<double> rms = plane_distance_rms(*planes);
    text += fmt::format("<td class=\"n\">{}</td>", rms ? fmt::format("{:.1f}", 1e3 * *rms) : "");
  }
  return text;
}

std::string links_table(const ProjectResult& result) {
  if (result.links.empty()) return {};
  std::string text;
  for (const std::size_t k : worst_links_first(result)) {
    const ProjectLink& link = result.links[k];
    text += fmt::format(
        "<tr data-of-link=\"{0}\"><td class=\"n\"><button type=\"button\" class=\"link\" data-link=\"{0}\" "
        "aria-label=\"Show link {0} alone\">{0}</button></td><td class=\"pair\"><a href=\"#scan{1}\">{1}</a> "
        "and <a "
        "href=\"#scan{2}\">{2}</a></td>",
        k, link.source, link.target);
    text += state_cell(to_string(link.solved.state));
    text += fmt::format(
        "<td>{}</td><td class=\"n\">{:.1f}</td>{}{}<td class=\"n\">{:.1f} of 6</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td></tr>\n",
        link.given ? "given" : to_string(link.pair), link.agreeing_m2, overlap_cells(result, k),
        residual_cells(result, link), link.solved.redundancy, loops_through(result, k),
        link.alternatives.size());
  }
  std::vector<std::string> head = {"#no.",
                                   "scans",
                                   "state",
                                   "result of the pair alone",
                                   "#agreeing, m²",
                                   "#overlap, %",
                                   "#planes alone, mm RMS",
                                   "#adjusted",
                                   "#residual, mm",
                                   "#deg"};
  if (result.tolerance_m) head.emplace_back(fmt::format("{:g} mm", 1e3 * *result.tolerance_m));
  head.insert(head.end(), {"#redundancy", "#loops", "#other poses"});
  return table(
      "Links", "links", head, text,
      "Click a number to see that link alone, before and after, with the surfaces that agree. "
      "overlap: share of the planes of the smaller scan, by area, that agree with planes of the "
      "other; planes alone: RMS of the distances between them by this link, adjusted: after the "
      "adjustment of the whole. First what is in doubt, then unchecked links, then verified ones, the "
      "largest residual first. "
      "verified: checked by a loop; bridge: single unchecked link; ambiguous: another pose fits as "
      "well; rejected: contradicted, or probably two look-alike places; weak: too little overlap, "
      "or a direction undetermined; in_place: measured from where the other links place both scans.");
}

std::string loops_table(const ProjectResult& result) {
  if (result.loops.empty()) return {};
  std::string text;
  for (const GraphLoop& loop : result.loops) {
    text += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.3f}</td><td class=\"n\">"
        "{:.1f}</td></tr>\n",
        fmt::join(loop.links, ", "), loop.closes ? "yes" : "no", 1e3 * loop.error_m, degrees(loop.error_rad),
        loop.chi_square);
  }
  return table("Loops", "", {"links", "closes", "#misclosure, mm", "#deg", "#chi-squared (6 d.o.f.)"}, text);
}

std::string millimetres(const Vector3d& metres) {
  return fmt::format("<td class=\"n\">{:.1f}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.1f}</td>",
                     1e3 * metres.x(), 1e3 * metres.y(), 1e3 * metres.z());
}

std::string point_row(const ProjectPoint& point) {
  const char* colour = point.state == PointState::used         ? "verified"
                       : point.state == PointState::left_out   ? "rejected"
                       : point.state == PointState::not_placed ? "weak"
                                                               : "bridge";
  std::string seers;
  for (const ProjectSight& sight : point.sights)
    seers += fmt::format("{0}<a href=\"#scan{1}\">{1}</a>", seers.empty() ? "" : ", ", sight.scan);
  std::string row =
      fmt::format("<tr><td translate=\"no\">{}</td><td>{}</td><td class=\"state {}\">{}</td><td>{}</td>",
                  escaped(point.name), to_string(point.role), colour, to_string(point.state), seers);
  if (point.found) {
    const double largest = point.test.w.cwiseAbs().maxCoeff();
    const double detectable = point.test.detectable.maxCoeff();
    row += millimetres(point.test.residual) + millimetres(point.test.sigma);
    row += fmt::format("<td class=\"n\">{:.1f}</td><td class=\"n\">{}</td>", largest,
                       point.state == PointState::used && std::isfinite(detectable)
                           ? fmt::format("{:.0f}", 1e3 * detectable)
                           : "");
  } else {
    row += "<td></td><td></td><td></td><td></td><td></td><td></td><td></td><td></td>";
  }
  return row + fmt::format("<td>{}</td></tr>\n", escaped(point.reason));
}

std::string points_table(const ProjectResult& result) {
  std::string rows;
  for (const ProjectPoint& point : result.points) {
    if (point.given) rows += point_row(point);
  }
  if (rows.empty()) return {};
  return table("Control and check points", "",
               {"point", "role", "state", "seen by", "#x, mm", "#y", "#z", "#sigma x, mm", "#y", "#z", "#w",
                "#detectable with 80 %, mm", "why"},
               rows,
               escaped(result.control_words) +
                   ". x, y, z: given minus measured, with one standard deviation; w: the largest of the "
                   "three normalised residuals; detectable with 80 %: the smallest gross error along "
                   "any axis that would be detected.");
}

/// What is noted of many files alike is shown once.
std::string notes(const ProjectResult& result) {
  if (result.notes.empty()) return {};
  constexpr std::size_t kMany = 4;
  std::set<std::string> files;
  for (const ProjectScan& scan : result.scans) files.insert(scan.file);
  const auto words = [&](const std::string& note) {
    const std::size_t end = note.find(": ");
    return end != std::string::npos && files.count(note.substr(0, end)) > 0 ? note.substr(end + 2) : note;
  };
  std::map<std::string, std::size_t> count;
  for (const std::string& note : result.notes) ++count[words(note)];
  std::string text = "<section class=\"card wide keep\"><h2>Notes</h2>\n<ul>\n";
  for (const std::string& note : result.notes) {
    std::size_t& alike = count[words(note)];
    if (alike < kMany) {
      text += alike > 0 ? fmt::format("<li>{}</li>\n", escaped(note)) : "";
      continue;
    }
    text += fmt::format("<li>{} files: {}</li>\n", alike, escaped(words(note)));
    alike = 0;
  }
  return text + "</ul></section>\n";
}

std::string frame_words(const ProjectResult& result) {
  if (result.frame_kind == "control")
    return fmt::format("The frame is that of the control points in {}.", escaped(result.control_file));
  if (result.frame_scan < 0) return "No scan was registered to another.";
  const ProjectScan& scan = result.scans[static_cast<std::size_t>(result.frame_scan)];
  return fmt::format("The frame is that of {}.", escaped(shown_name(scan)));
}

std::string heading(ProjectOutcome outcome) {
  switch (outcome) {
    case ProjectOutcome::registered:
      return "Registered: all scans are in one frame";
    case ProjectOutcome::partial:
      return "Partial: some scans are registered in one frame";
    case ProjectOutcome::no_match:
      break;
  }
  return "No match: no scan was registered to another";
}

const char* symbol(ProjectOutcome outcome) {
  switch (outcome) {
    case ProjectOutcome::registered:
      return "&#10003;";
    case ProjectOutcome::partial:
      return "?";
    case ProjectOutcome::no_match:
      break;
  }
  return "&#8800;";
}

/// How well the stations are known, and which is known least.
std::string accuracy_words(const ProjectResult& result) {
  std::vector<std::pair<double, std::size_t>> radii;
  std::size_t within = 0;
  for (std::size_t k = 0; k < result.scans.size(); ++k) {
    const std::optional<StationAccuracy> it = accuracy_of(result, k);
    if (!it || it->held_fixed || result.scans[k].component != 0 || !is_placed(result.scans[k].state))
      continue;
    radii.emplace_back(it->radius_m, k);
    within += it->within_tolerance.value_or(false) ? 1 : 0;
  }
  if (radii.empty()) return {};
  std::sort(radii.begin(), radii.end());
  std::string text = fmt::format(
      "<p>Accuracy of the placed scans (95 %): {:.1f} mm in the median, {:.1f} mm at worst (<a "
      "href=\"#scan{}\" translate=\"no\">{}</a>).</p>\n",
      1e3 * radii[radii.size() / 2].first, 1e3 * radii.back().first, radii.back().second,
      escaped(shown_name(result.scans[radii.back().second])));
  if (result.tolerance_m)
    text += fmt::format("<p>Tolerance {:g} mm (95 %): {} of {} placed scans pass.</p>\n",
                        1e3 * *result.tolerance_m, within, radii.size());
  return text;
}

/// What other programs give of a registration as a whole.
std::string bundle_words(const ProjectResult& result) {
  const std::optional<BundleError> bundle = bundle_error(result);
  if (!bundle) return {};
  const ProjectLink& worst = result.links[bundle->worst];
  return fmt::format(
      "<p>Bundle error: {:.1f} mm (RMS of {} pairs of planes after the adjustment); the worst link is {} "
      "(scans {} and {}): {:.1f} mm.</p>\n",
      1e3 * bundle->rms_m, bundle->planes, bundle->worst, worst.source, worst.target,
      1e3 * bundle->worst_rms_m);
}

/// What came of it, how well it is known, and whose frame it is.
std::string lead(const ProjectResult& result) {
  return fmt::format(
      "<p><span>{}</span>.</p>\n{}<p class=\"reason\">{} <span>{} pairs were tried.</span></p>",
      escaped(result.reason), accuracy_words(result) + bundle_words(result), frame_words(result),
      result.pairs_tried);
}

}  // namespace

std::string project_page(const ProjectResult& result, std::vector<ProjectPicture> pictures, bool on_map,
                         const ReportCover& cover) {
  const std::string drawings = project_plan(result, on_map);
  std::string plans;
  if (!drawings.empty())
    plans = "<div class=\"plans\">" + drawings +
            "</div>\n<p class=\"soft\">Lines: links; solid: verified by a loop; dashed: single unchecked "
            "link (bridge); dotted: ambiguous or rejected. Ellipses: one standard deviation, enlarged 100 "
            "times. Triangles: control and check points.</p>\n";
  plans += pass_charts(result);
  const PageParts parts = {
      {"title", escaped(cover.title.empty() ? in_language("limen: project", cover.language) : cover.title)},
      {"cover", cover_facts(cover)},
      {"signature", signature_html(cover)},
      {"style", std::string(report_style()) + std::string(view_style()) + std::string(project_style())},
      {"version", kVersion},
      {"outcome", to_string(result.outcome)},
      {"symbol", symbol(result.outcome)},
      {"heading", heading(result.outcome)},
      {"lead", lead(result)},
      {"questions", questions(result, question_pictures(result, pictures)) + decisions_table(result)},
      {"plans", plans},
      {"tables", scans_table(result) + points_table(result) + links_table(result) + loops_table(result) +
                     notes(result)},
      {"scene", project_scene(result, std::move(pictures), cover.language) + texts_element(cover.language)},
      {"script", std::string(project_script())}};
  return page_in_language(filled_in(project_pattern(), parts), cover.language);
}

}  // namespace limen
