// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_cover.h"

#include <fmt/format.h>

#include "limen/report/html/html_bytes.h"
#include "limen/report/summary/precision.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

std::string verdict_of(const RegistrationResult& result) {
  switch (result.outcome) {
    case Outcome::registered:
      return "The two sides fit in one way only.";
    case Outcome::probable:
      return "A pose was found, but it is less certain than registered requires.";
    case Outcome::ambiguous:
      return result.rivals > 0
                 ? fmt::format("{} places fit about equally well; it cannot be decided which one is right.",
                               result.rivals + 1)
                 : "The best fit is not certain enough to be relied on.";
    case Outcome::under_constrained:
      return "A pose was found, but not every direction is determined.";
    case Outcome::no_match:
      break;
  }
  return "No reliable overlap was found.";
}

std::string precision_sentence(const RegistrationReport& report, const PosePrecision& precision) {
  const bool by_target = report.source.kind == "model" && report.target.kind != "model";
  return fmt::format("Accuracy of {} (95 %): {} at the centre, {} at the far end, {:.0f} m from the centre.",
                     file_name(by_target ? report.target : report.source),
                     length_words(precision.middle.radius_m), length_words(precision.far_end.radius_m),
                     precision.far_distance_m);
}

std::string fact(const char* name, const std::string& value) {
  return value.empty()
             ? ""
             : fmt::format("<div><dt>{}</dt><dd translate=\"no\">{}</dd></div>", name, escaped(value));
}

}  // namespace

std::vector<std::string> cover_summary(const RegistrationReport& report, Language language) {
  const RegistrationResult& result = report.result;
  std::vector<std::string> text;
  const auto add = [&](const std::string& sentence) { text.push_back(in_language(sentence, language)); };
  add(verdict_of(result));
  if (result.outcome == Outcome::no_match || result.published) return text;
  const Hypothesis& best = result.best;
  if (best.probability)
    add(fmt::format("The probability that this is the right place is {}.",
                    probability_words(*best.probability)));
  if (const auto precision = precision_of(report, best)) {
    add(precision_sentence(report, *precision));
    if (precision->across_open) add("This holds only perpendicular to the undetermined directions.");
  }
  if (best.rms_m > 0)
    add(fmt::format("The points deviate by {} (root mean square) from the surfaces of the other side.",
                    length_words(best.rms_m)));
  for (const UnobservedFreedom& freedom : result.unobserved)
    add(fmt::format("Not determined: {}.", freedom.name));
  if (!best.room.empty()) add(fmt::format("The scanner stood in {}.", best.room));
  return text;
}

std::string cover_facts(const ReportCover& cover) {
  std::string text;
  if (!cover.logo.empty())
    text += fmt::format("<img class=\"logo\" alt=\"\" src=\"{}\">\n", escaped(cover.logo));
  if (!cover.title.empty())
    text += fmt::format("<p class=\"cover-title\" translate=\"no\">{}</p>\n", escaped(cover.title));
  const std::string facts =
      fact("Project", cover.project) + fact("Operator", cover.operator_name) + fact("Date", cover.date);
  if (!facts.empty())
    text += fmt::format("<dl class=\"cover\" lang=\"{}\">{}</dl>\n", code_of(cover.language), facts);
  return text;
}

std::string signature_html(const ReportCover& cover) {
  if (cover.operator_name.empty()) return {};
  return fmt::format(
      "<dl class=\"signature\">{}<div><dt>Date</dt><dd translate=\"no\">{}</dd></div>"
      "<div><dt>Signature</dt><dd></dd></div></dl>\n",
      fact("Operator", cover.operator_name), escaped(cover.date));
}

std::string cover_html(const RegistrationReport& report, const ReportCover& cover) {
  const std::string text = page_in_language(cover_facts(cover), cover.language);
  if (cover.language == Language::english) return text;
  std::string sentences;
  for (const std::string& sentence : cover_summary(report, cover.language))
    sentences += (sentences.empty() ? "" : " ") + escaped(sentence);
  return text +
         fmt::format(
             "<section class=\"summary\" lang=\"{0}\" aria-label=\"{1}\"><p><b>{1}.</b> {2}</p></section>\n",
             code_of(cover.language), in_language("Summary", cover.language), sentences);
}

}  // namespace limen
