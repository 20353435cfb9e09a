// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_page.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/version.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/table_page.h"
#include "limen/report/project/pass_charts.h"
#include "limen/report/project/project_plan.h"

namespace limen {
namespace {

std::string state_cell(const char* state) {
  return fmt::format("<td class=\"state {0}\">{0}</td>", state);
}

std::string scan_name(const ProjectScan& scan) {
  return scan.index > 0 ? fmt::format("{} #{}", scan.file, scan.index) : scan.file;
}

/// The command that takes an answer, for a shell.
std::string line_of(const Decision& answer) {
  std::string line = fmt::format("limen project decide DIR {}", to_string(answer.kind));
  for (const std::string& scan : answer.scans) {
    std::string quoted;
    for (const char c : scan) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += " '" + quoted + "'";
  }
  if (answer.kind == DecisionKind::choose) line += fmt::format(" {}", answer.pose);
  return line;
}

std::string questions(const ProjectResult& result) {
  if (result.questions.empty()) return {};
  std::string text = "<h2>Open questions</h2>\n";
  for (const ProjectQuestion& question : result.questions) {
    text += fmt::format("<div class=\"card\"><p>{}</p>", escaped(question.text));
    for (const Decision& answer : question.answers)
      text += fmt::format("<button type=\"button\" class=\"answer\" data-line=\"{}\">{}</button> ",
                          escaped(line_of(answer)), escaped(words_of(answer)));
    text += "</div>\n";
  }
  return text +
         R"(<p class="soft" id="paste" hidden>Paste this line into a terminal, then run the project again
(what is done is kept): <code></code></p>
<script>
document.addEventListener('click', (event) => {
  let line = event.target.dataset && event.target.dataset.line;
  if (!line) return;
  // The folder is that of this page.
  if (location.protocol === 'file:') {
    const folder = decodeURIComponent(location.pathname).replace(/\/[^/]*$/, '') || '/';
    line = line.replace(' DIR ', () => " '" + folder.replaceAll("'", "'\\''") + "' ");
  }
  const paste = document.getElementById('paste');
  paste.hidden = false;
  paste.querySelector('code').textContent = line;
  if (navigator.clipboard) navigator.clipboard.writeText(line).catch(() => {});
});
</script>
)";
}

std::string decisions_table(const ProjectResult& result) {
  if (result.decisions.empty()) return {};
  std::string text =
      "<h2>Your decisions</h2>\n<div "
      "class=\"scroll\" tabindex=\"0\"><table><tr><th>decision</th><th>state</th><th>why</th></tr>\n";
  for (const ProjectDecision& told : result.decisions) {
    const char* colour = told.state == DecisionState::kept           ? "verified"
                         : told.state == DecisionState::contradicted ? "rejected"
                                                                     : "weak";
    text +=
        fmt::format("<tr><td>{}</td><td class=\"state {}\">{}</td><td>{}</td></tr>\n",
                    escaped(words_of(told.decision)), colour, to_string(told.state), escaped(told.reason));
  }
  return text + "</table></div>\n";
}

std::string scans_table(const ProjectResult& result) {
  std::string text =
      "<h2>Scans</h2>\n<div "
      "class=\"scroll\" tabindex=\"0\"><table><tr><th>no.</th><th>file</th><th>state</th><th>component</th>"
      "<th>sigma, mm</th><th>sigma, deg</th><th>why</th></tr>\n";
  for (std::size_t k = 0; k < result.scans.size(); ++k) {
    const ProjectScan& scan = result.scans[k];
    text += fmt::format("<tr id=\"scan{0}\"><td class=\"n\">{0}</td><td class=\"path\">{1}{2}</td>", k,
                        escaped(scan_name(scan)), scan.model ? " <span class=\"soft\">model</span>" : "");
    text += state_cell(scan.readable ? to_string(scan.state) : "unreadable");
    text +=
        fmt::format("<td class=\"n\">{}</td>", scan.component >= 0 ? fmt::format("{}", scan.component) : "");
    if (scan.frame_from_scan) {
      text +=
          fmt::format("<td class=\"n\">{:.1f}</td><td class=\"n\">{:.3f}</td>",
                      1e3 * scan.sigma.translation_m.maxCoeff(), degrees(scan.sigma.rotation_rad.maxCoeff()));
    } else {
      text += "<td></td><td></td>";
    }
    text += fmt::format("<td>{}</td></tr>\n", escaped(scan.reason));
  }
  return text + "</table></div>\n";
}

std::string links_table(const ProjectResult& result) {
  if (result.links.empty()) return {};
  std::string text =
      "<h2>Links</h2>\n<div class=\"scroll\" "
      "tabindex=\"0\"><table><tr><th>no.</th><th>scans</th><th>state</th><th>the pair "
      "alone</th>"
      "<th>agreeing, m&sup2;</th><th>misses by, mm</th><th>deg</th><th>redundancy</th><th>other "
      "poses</th></tr>\n";
  for (std::size_t k = 0; k < result.links.size(); ++k) {
    const ProjectLink& link = result.links[k];
    text += fmt::format(
        "<tr><td class=\"n\">{0}</td><td><a href=\"#scan{1}\">{1}</a> and <a href=\"#scan{2}\">{2}</a></td>",
        k, link.source, link.target);
    text += state_cell(to_string(link.solved.state));
    text += fmt::format(
        "<td>{}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.3f}</td>"
        "<td class=\"n\">{:.1f} of 6</td><td class=\"n\">{}</td></tr>\n",
        link.given ? "given" : to_string(link.pair), link.agreeing_m2, 1e3 * link.solved.loop_error_m,
        degrees(link.solved.loop_error_rad), link.solved.redundancy, link.alternatives.size());
  }
  return text + "</table></div>\n";
}

std::string loops_table(const ProjectResult& result) {
  if (result.loops.empty()) return {};
  std::string text =
      "<h2>Loops</h2>\n<div class=\"scroll\" "
      "tabindex=\"0\"><table><tr><th>links</th><th>closes</th><th>misses by, "
      "mm</th><th>deg</th>"
      "<th>chi squared of 6</th></tr>\n";
  for (const GraphLoop& loop : result.loops) {
    std::string links;
    for (const int link : loop.links) links += fmt::format("{}{}", links.empty() ? "" : ", ", link);
    text += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.3f}</td><td class=\"n\">"
        "{:.1f}</td></tr>\n",
        links, loop.closes ? "yes" : "no", 1e3 * loop.error_m, degrees(loop.error_rad), loop.chi_square);
  }
  return text + "</table></div>\n";
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
      fmt::format("<tr><td>{}</td><td>{}</td><td class=\"state {}\">{}</td><td>{}</td>", escaped(point.name),
                  to_string(point.role), colour, to_string(point.state), seers);
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
  return fmt::format(
      "<h2>Control and check points</h2>\n<p class=\"soft\">{}. Given less found, with one standard "
      "deviation; w: "
      "the largest of the three tests; found with 80&nbsp;%: the smallest blunder along any axis that would "
      "be "
      "found.</p>\n<div class=\"scroll\" "
      "tabindex=\"0\"><table><tr><th>point</th><th>role</th><th>state</th><th>seen by</th>"
      "<th>x, mm</th><th>y</th><th>z</th><th>sigma x, mm</th><th>y</th><th>z</th><th>w</th>"
      "<th>found with 80&nbsp;%, mm</th><th>why</th></tr>\n{}</table></div>\n",
      escaped(result.control_words), rows);
}

std::string notes(const ProjectResult& result) {
  if (result.notes.empty()) return {};
  std::string text = "<h2>Notes</h2>\n<ul>\n";
  for (const std::string& note : result.notes) text += fmt::format("<li>{}</li>\n", escaped(note));
  return text + "</ul>\n";
}

std::string frame_words(const ProjectResult& result) {
  if (result.frame_kind == "control")
    return fmt::format("The frame is that of the control points in {}.", escaped(result.control_file));
  if (result.frame_scan < 0) return "Nothing was joined.";
  const ProjectScan& scan = result.scans[static_cast<std::size_t>(result.frame_scan)];
  return fmt::format("The frame is that of {}.", escaped(scan_name(scan)));
}

}  // namespace

std::string project_page(const ProjectResult& result) {
  std::string text =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>limen: project</title>\n<style>";
  text += table_page_style();
  text += fmt::format(
      "</style></head>\n<body data-outcome=\"{0}\"><main>\n<h1>{0}: {1}</h1>\n<p class=\"soft\">{2} {3} "
      "pairs "
      "were tried. limen {4}.</p>\n",
      to_string(result.outcome), escaped(result.reason), frame_words(result), result.pairs_tried, kVersion);
  text += questions(result) + decisions_table(result);
  const std::string plan = project_plan(result);
  if (!plan.empty())
    text += "<h2>Plan</h2>\n" + plan +
            "<p class=\"soft\">Lines: verified links are full, bridges dashed, ambiguous and rejected ones "
            "dotted. Ellipses are "
            "one sigma, enlarged 100 times. Triangles: control and check points.</p>\n";
  text += pass_charts(result);
  text +=
      scans_table(result) + points_table(result) + links_table(result) + loops_table(result) + notes(result);
  return text + "</main></body></html>\n";
}

}  // namespace limen
