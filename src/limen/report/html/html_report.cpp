// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_report.h"

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/version.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_data.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/html_tables.h"
#include "limen/report/html/html_words.h"
#include "limen/report/html/report_page.h"
#include "limen/report/html/section_svg.h"
#include "limen/report/summary/advice.h"

namespace limen {
namespace {

/// A heading with what follows, or nothing where nothing follows. `kept`: on the printed sheet too.
std::string section(const char* heading, const std::string& content, const char* remark = "",
                    bool kept = false) {
  if (content.empty()) return {};
  const std::string note = *remark == '\0' ? "" : fmt::format("<p class=\"note\">{}</p>\n", remark);
  return fmt::format("<section class=\"card{}\"><h2>{}</h2>\n{}{}</section>\n", kept ? " keep" : "", heading,
                     content, note);
}

std::string sentences(const VerdictWords& words) {
  std::string text;
  for (const std::string& sentence : words.sentences) text += "<p>" + escaped(sentence) + "</p>\n";
  if (!words.reason.empty()) text += "<p class=\"reason\">" + escaped(words.reason) + ".</p>\n";
  return text;
}

/// What to do next, but for looking at this page.
std::string steps(const RegistrationReport& report) {
  std::string items;
  for (const std::string& step : next_steps(report)) {
    if (step.find("report.html") == std::string::npos) items += "<li>" + escaped(step) + "</li>\n";
  }
  return items.empty() ? items : "<ul>" + items + "</ul>\n";
}

std::string agreement(const RegistrationReport& report) {
  std::string text = section("Planes that agree", planes_table(report),
                             "Under the best pose. Distance along the target plane's normal at the middle of "
                             "the overlap.");
  text += section("Openings that agree", openings_table(report), "Under the best pose.");
  return text + section("Walls between the scans", thickness_table(report));
}

/// Replaced where another pose is shown.
std::string boxed(const char* id, const std::string& content) {
  return content.empty() ? content : fmt::format("<div id=\"{}\">{}</div>\n", id, content);
}

std::string tables(const RegistrationReport& report) {
  std::string text = section("Likely causes, the likeliest first", causes_table(report), "", true);
  text += section(
      "Uncertainty of the pose", boxed("sigma-of-pose", sigma_table(report)),
      "Shift of the source's centre and turn about it, along the target's axes, for the pose that is shown.",
      true);
  text += section("Key numbers", boxed("key-of-pose", key_table(report)), "", true);
  text += section("What to do next", steps(report));
  text += section("Poses", alternatives_table(report),
                  "The best first; each is a different place, not a refinement of the best. =: it cannot be "
                  "distinguished from the best.");
  if (report.result.outcome != Outcome::no_match) text += agreement(report);  // of the best pose
  text += section("Inputs", inputs_table(report));
  text += section("Time", stages_table(report));
  return text + section("How it was run", options_table(report));
}

std::string matrix_card(const RegistrationReport& report) {
  if (report.result.outcome == Outcome::no_match) return {};
  return section("Transform, source to target",
                 "<pre id=\"matrix\" tabindex=\"0\" aria-label=\"4 by 4 matrix, metres\">" +
                     matrix_text(file_matrix(report, report.result.best.target_from_source)) +
                     "</pre>\n<button type=\"button\" id=\"copy\">Copy</button> "
                     "<span id=\"copied\" role=\"status\"></span>\n"
                     "<p class=\"note\" id=\"matrix-pose\">The best pose, as in transform.txt.</p>\n",
                 report.source.metres_per_unit == 1.0 && report.target.metres_per_unit == 1.0
                     ? "Four rows of four, metres."
                     : "Four rows of four, between the numbers of the files in their own units.");
}

}  // namespace

ReportPages report_pages(const RegistrationReport& report, const ReportScene& scene,
                         const ReportCover& cover) {
  const SceneView view = make_view(scene, report.result);
  ReportPages pages;
  pages.top = section_svg(scene, view, SectionSide::top);
  pages.front = section_svg(scene, view, SectionSide::front);
  pages.side = section_svg(scene, view, SectionSide::side);
  const VerdictWords words = verdict_words(report);
  const PageParts parts = {{"title", escaped(cover.title.empty() ? words.headline : cover.title)},
                           {"outcome", to_string(report.result.outcome)},
                           {"symbol", words.symbol},
                           {"headline", escaped(words.headline)},
                           {"cover", cover_html(report, cover)},
                           {"sentences", sentences(words)},
                           {"source", escaped(file_name(report.source))},
                           {"target", escaped(file_name(report.target))},
                           {"tables", tables(report) + matrix_card(report)},
                           {"top", pages.top},
                           {"front", pages.front},
                           {"side", pages.side},
                           {"version", kVersion},
                           {"style", std::string(report_style())},
                           {"script", std::string(report_script())},
                           {"scene", scene_elements(report, scene, view)}};
  pages.page = filled_in(report_pattern(), parts);
  return pages;
}

void write_report(const std::filesystem::path& folder, const RegistrationReport& report,
                  const ReportScene& scene, const ReportCover& cover) {
  const ReportPages pages = report_pages(report, scene, cover);
  write_files({{folder / "section_top.svg", pages.top},
               {folder / "section_front.svg", pages.front},
               {folder / "section_side.svg", pages.side},
               {folder / "report.html", pages.page}});
}

void remove_report(const std::filesystem::path& folder) {
  for (const char* name :
       {"report.html", "report.pdf", "section_top.svg", "section_front.svg", "section_side.svg"})
    std::filesystem::remove(folder / name);
}

}  // namespace limen
