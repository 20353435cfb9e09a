// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_report.h"

#include <cctype>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/version.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_data.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/html_tables.h"
#include "limen/report/html/report_page.h"
#include "limen/report/html/section_svg.h"
#include "limen/report/summary/advice.h"
#include "limen/report/summary/precision.h"

namespace limen {
namespace {

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// "the two scans", "the scan and the model", "the two lists of segments"
std::string both_sides(const RegistrationReport& report) {
  if (report.source.kind == "segments") return "the two lists of segments";
  return in_model(report) ? "the scan and the model" : "the two scans";
}

/// "place" in a model, "way" between scans.
std::string places(const RegistrationReport& report, std::size_t count) {
  return fmt::format("{} {}", count, in_model(report) ? "places" : "ways");
}

/// How well the best pose is known, and by what; nothing of what is open.
std::vector<std::string> expectation(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  std::vector<std::string> sentences;
  const auto precision = precision_of(report, result.best);
  if (precision) {
    const InputSummary& side =
        report.source.kind == "model" && report.target.kind != "model" ? report.target : report.source;
    sentences.push_back(
        fmt::format("Accuracy of {} (95 %): {} at the centre, {} at the far end, {:.0f} m from the centre{}.",
                    file_name(side), length_words(precision->middle.radius_m),
                    length_words(precision->far_end.radius_m), precision->far_distance_m,
                    precision->across_open ? ", perpendicular to the undetermined direction" : ""));
  }
  if (result.best.rms_m > 0) {
    std::string words = fmt::format("Residuals: {} of the {}", length_words(result.best.rms_m),
                                    result.best.matched_segments > 0 ? "edges" : "points");
    if (const auto planes = plane_distance_rms(result.matches))
      words += fmt::format(", {} between matched planes", length_words(*planes));
    sentences.push_back(words + " (root mean square).");
    if (precision && precision->middle.formal_radius_m && precision->far_end.formal_radius_m)
      sentences.push_back(fmt::format("From the noise of the points alone the accuracy would be {} and {}.",
                                      length_words(*precision->middle.formal_radius_m),
                                      length_words(*precision->far_end.formal_radius_m)));
  }
  return sentences;
}

void append(VerdictWords& words, const std::vector<std::string>& sentences) {
  words.sentences.insert(words.sentences.end(), sentences.begin(), sentences.end());
}

/// What the data leaves open, beside a verdict that is about something else.
void append_open(VerdictWords& words, const RegistrationResult& result) {
  for (const UnobservedFreedom& freedom : result.unobserved)
    words.sentences.push_back(capitalised(freedom.name) + " is not determined by the data.");
}

VerdictWords registered_words(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  VerdictWords words{"", {}, square_metres(result.reason), "✓"};
  words.headline = fmt::format("Registered: {} fit in one way only", both_sides(report));
  if (result.best.probability)
    words.sentences.push_back(fmt::format("This is the right place with a probability of {}.",
                                          probability_words(*result.best.probability)));
  append(words, expectation(report));
  if (!result.best.room.empty())
    words.sentences.push_back(fmt::format("The scanner stood in {}.", result.best.room));
  return words;
}

VerdictWords probable_words(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  VerdictWords words{
      "Probable: a pose was found, but it is less certain than registered requires", {}, "", "✓?"};
  words.sentences.push_back(capitalised(square_metres(result.reason)) + ".");
  words.sentences.push_back(capitalised(surer(report)) + ".");
  append(words, expectation(report));
  if (!result.best.room.empty())
    words.sentences.push_back(fmt::format("The scanner stood in {}.", result.best.room));
  return words;
}

VerdictWords ambiguous_words(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  VerdictWords words{"", {}, "", "?"};
  if (result.rivals == 0) {
    words.headline = "Not decided: the best fit is not certain enough";
    words.sentences.push_back(capitalised(square_metres(result.reason)) + ".");
  } else {
    words.headline = fmt::format("Not decided: {} fit about equally well", places(report, result.rivals + 1));
    words.sentences.push_back(
        "Compare them below; a further scan, or a position known by other means, can decide.");
    words.reason = square_metres(result.reason);
  }
  append_open(words, result);
  return words;
}

VerdictWords published_words(const RegistrationResult& result) {
  VerdictWords words{
      fmt::format("The pose of the published method {}, without a verdict", result.published->method),
      {},
      square_metres(result.reason),
      "?"};
  for (const UnobservedFreedom& freedom : result.unobserved)
    words.sentences.push_back(capitalised(freedom.name) + " is assumed by the method.");
  return words;
}

VerdictWords open_words(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  VerdictWords words{"Under-constrained: the data leave one direction undetermined", {}, "", "↔"};
  append_open(words, result);
  if (result.unobserved.size() > 1)
    words.headline =
        fmt::format("Under-constrained: the data leave {} directions undetermined", result.unobserved.size());
  append(words, expectation(report));
  return words;
}

}  // namespace

VerdictWords verdict_words(const RegistrationReport& report) {
  if (report.result.published) return published_words(report.result);
  switch (report.result.outcome) {
    case Outcome::registered:
      return registered_words(report);
    case Outcome::probable:
      return probable_words(report);
    case Outcome::ambiguous:
      return ambiguous_words(report);
    case Outcome::under_constrained:
      return open_words(report);
    case Outcome::no_match:
      break;
  }
  return {"No match: " + both_sides(report) + " have no reliable overlap",
          {capitalised(square_metres(report.result.reason)) + ".",
           "They are shown side by side below, each upright as far as is known."},
          "",
          "✕"};
}

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

/// What to do next, but for looking at this page. A command is set off from what it does.
std::string steps(const RegistrationReport& report) {
  std::string items;
  for (const std::string& step : next_steps(report)) {
    if (step.find("report.html") != std::string::npos) continue;
    const std::size_t end = step.find(": limen ");
    const std::string command = end == std::string::npos ? ""
                                                         : fmt::format(" <code translate=\"no\">{}</code>",
                                                                       escaped(step.substr(end + 2)));
    items += "<li>" + escaped(step.substr(0, command.empty() ? end : end + 1)) + command + "</li>\n";
  }
  if (items.empty()) return items;
  const bool folder = items.find("DIR/") != std::string::npos;
  return "<ul>" + items + "</ul>\n" + (folder ? "<p class=\"note\">DIR: the folder of this page.</p>\n" : "");
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
                 "<pre id=\"matrix\" translate=\"no\" tabindex=\"0\" aria-label=\"4 by 4 matrix, metres\">" +
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
  const PageParts parts = {
      {"title", escaped(cover.title.empty() ? in_language(words.headline, cover.language) : cover.title)},
      {"outcome", to_string(report.result.outcome)},
      {"symbol", words.symbol},
      {"headline", escaped(words.headline)},
      {"cover", cover_facts(cover)},
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
      {"scene", scene_elements(report, scene, view, cover.language) + texts_element(cover.language)}};
  pages.page = filled_in(report_pattern(), parts);
  for (std::string* text : {&pages.page, &pages.top, &pages.front, &pages.side})
    *text = page_in_language(*text, cover.language);
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
