// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_cover.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "limen/report/html/html_bytes.h"
#include "limen/report/summary/precision.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

/// The sentences of one language; {} are filled in.
struct Sentences {
  const char* code;
  const char* summary;
  const char* registered;
  const char* probable;
  const char* ambiguous;  ///< number of places
  const char* unsure;
  const char* open;
  const char* none;
  const char* probability;
  const char* precision;  ///< file, middle, distance, far end
  const char* across;
  const char* residuals;
  const char* not_held;
  const char* room;
  const char* project;
  const char* operator_name;
  const char* date;
};

constexpr std::array<Sentences, 3> kSentences = {{
    {"en", "Summary", "The two sides fit in one way only.",
     "A pose was found, but it is less certain than registered requires.",
     "{} places fit about equally well; it cannot be decided which one is right.",
     "The best fit is not certain enough to be relied on.",
     "A pose was found, but not every direction is determined.", "No reliable overlap was found.",
     "The probability that this is the right place is {}.",
     "Accuracy of {} (95 %): {} at the centre, {} at the far end, {} m from the centre.",
     "This holds only perpendicular to the undetermined directions.",
     "The points deviate by {} (root mean square) from the surfaces of the other side.",
     "Not determined: {}.", "The scanner stood in {}.", "Project", "Operator", "Date"},
    {"fr", "R\u00e9sum\u00e9", "Les deux c\u00f4t\u00e9s ne s'assemblent que d'une seule fa\u00e7on.",
     "Une position est trouv\u00e9e, mais elle est moins s\u00fbre qu'il n'est demand\u00e9.",
     "{} positions conviennent \u00e0 peu pr\u00e8s aussi bien ; on ne peut pas d\u00e9cider laquelle est la "
     "bonne.",
     "Le meilleur assemblage n'est pas assez s\u00fbr pour que l'on s'y fie.",
     "Une position est trouv\u00e9e, mais toutes les directions ne sont pas d\u00e9termin\u00e9es.",
     "Aucun recouvrement fiable n'a \u00e9t\u00e9 trouv\u00e9.",
     "La probabilit\u00e9 que ce soit la bonne position est de {}.",
     "Exactitude de {} (95 %) : {} au centre, {} \u00e0 l'extr\u00e9mit\u00e9, \u00e0 {} m du centre.",
     "Cela ne vaut que perpendiculairement aux directions non d\u00e9termin\u00e9es.",
     "Les points s'\u00e9cartent de {} (moyenne quadratique) des surfaces de l'autre c\u00f4t\u00e9.",
     "Non d\u00e9termin\u00e9 : {}.", "Le scanner se trouvait dans {}.", "Projet", "Op\u00e9rateur", "Date"},
    {"de", "Zusammenfassung", "Beide Seiten passen nur auf eine Weise zusammen.",
     "Eine Lage ist gefunden, aber weniger sicher, als verlangt wird.",
     "{} Lagen passen etwa gleich gut; welche die richtige ist, l\u00e4sst sich nicht entscheiden.",
     "Die beste Lage ist nicht sicher genug, um sich darauf zu verlassen.",
     "Eine Lage ist gefunden, aber nicht jede Richtung ist bestimmt.",
     "Es wurde keine verl\u00e4ssliche \u00dcberdeckung gefunden.",
     "Die Wahrscheinlichkeit, dass dies die richtige Lage ist, betr\u00e4gt {}.",
     "Genauigkeit von {} (95 %): {} in der Mitte und, {} m davon entfernt, {} am fernen Ende.",
     "Das gilt nur quer zu den nicht bestimmten Richtungen.",
     "Die Punkte weichen um {} (quadratisches Mittel) von den Fl\u00e4chen der anderen Seite ab.",
     "Nicht bestimmt: {}.", "Der Scanner stand in {}.", "Projekt", "Bearbeiter", "Datum"},
}};

const Sentences& sentences_of(Language language) {
  return kSentences[static_cast<std::size_t>(language)];
}

/// With the decimal sign of the language, and words that numbers may have.
std::string in_language(std::string text, Language language) {
  if (language == Language::english) return text;
  const auto replace = [&text](const std::string& english, const std::string& other) {
    const std::size_t at = text.find(english);
    if (at != std::string::npos) text.replace(at, english.size(), other);
  };
  const bool german = language == Language::german;
  replace("more than", german ? "mehr als" : "plus de");
  replace("less than", german ? "weniger als" : "moins de");
  std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

template <typename... Parts>
std::string filled(const char* pattern, const Parts&... parts) {
  return fmt::format(fmt::runtime(pattern), parts...);
}

std::string verdict_of(const RegistrationResult& result, const Sentences& words) {
  switch (result.outcome) {
    case Outcome::registered:
      return words.registered;
    case Outcome::probable:
      return words.probable;
    case Outcome::ambiguous:
      return result.rivals > 0 ? filled(words.ambiguous, result.rivals + 1) : words.unsure;
    case Outcome::under_constrained:
      return words.open;
    case Outcome::no_match:
      break;
  }
  return words.none;
}

/// German names the distance before the radius.
std::string precision_sentence(const RegistrationReport& report, const PosePrecision& precision,
                               Language language) {
  const Sentences& words = sentences_of(language);
  const bool by_target = report.source.kind == "model" && report.target.kind != "model";
  const std::string name = file_name(by_target ? report.target : report.source);
  const std::string middle = in_language(length_words(precision.middle.radius_m), language);
  const std::string far = in_language(length_words(precision.far_end.radius_m), language);
  const std::string distance = fmt::format("{:.0f}", precision.far_distance_m);
  return language == Language::german ? filled(words.precision, name, middle, distance, far)
                                      : filled(words.precision, name, middle, far, distance);
}

std::string fact(const char* name, const std::string& value) {
  return value.empty() ? "" : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, escaped(value));
}

}  // namespace

std::vector<std::string> cover_summary(const RegistrationReport& report, Language language) {
  const RegistrationResult& result = report.result;
  const Sentences& words = sentences_of(language);
  std::vector<std::string> text = {verdict_of(result, words)};
  if (result.outcome == Outcome::no_match || result.published) return text;
  const Hypothesis& best = result.best;
  if (best.probability)
    text.push_back(filled(words.probability, in_language(probability_words(*best.probability), language)));
  if (const auto precision = precision_of(report, best)) {
    text.push_back(precision_sentence(report, *precision, language));
    if (precision->across_open) text.emplace_back(words.across);
  }
  if (best.rms_m > 0)
    text.push_back(filled(words.residuals, in_language(length_words(best.rms_m), language)));
  for (const UnobservedFreedom& freedom : result.unobserved)
    text.push_back(filled(words.not_held, freedom.name));
  if (!best.room.empty()) text.push_back(filled(words.room, best.room));
  return text;
}

std::string cover_facts(const ReportCover& cover) {
  const Sentences& words = sentences_of(cover.language);
  std::string text;
  if (!cover.logo.empty())
    text += fmt::format("<img class=\"logo\" alt=\"\" src=\"{}\">\n", escaped(cover.logo));
  if (!cover.title.empty()) text += fmt::format("<p class=\"cover-title\">{}</p>\n", escaped(cover.title));
  const std::string facts = fact(words.project, cover.project) +
                            fact(words.operator_name, cover.operator_name) + fact(words.date, cover.date);
  if (!facts.empty()) text += fmt::format("<dl class=\"cover\" lang=\"{}\">{}</dl>\n", words.code, facts);
  return text;
}

std::string signature_html(const ReportCover& cover) {
  if (cover.operator_name.empty()) return {};
  const Sentences& words = sentences_of(cover.language);
  return fmt::format(
      "<dl class=\"signature\"><div><dt>{}</dt><dd>{}</dd></div><div><dt>{}</dt><dd>{}</dd></div>"
      "<div><dt>Signature</dt><dd></dd></div></dl>\n",
      words.operator_name, escaped(cover.operator_name), words.date, escaped(cover.date));
}

std::string cover_html(const RegistrationReport& report, const ReportCover& cover) {
  const Sentences& words = sentences_of(cover.language);
  const std::string text = cover_facts(cover);
  if (cover.language == Language::english) return text;
  std::string sentences;
  for (const std::string& sentence : cover_summary(report, cover.language))
    sentences += (sentences.empty() ? "" : " ") + escaped(sentence);
  return text +
         fmt::format(
             "<section class=\"summary\" lang=\"{0}\" aria-label=\"{1}\"><p><b>{1}.</b> {2}</p></section>\n",
             words.code, words.summary, sentences);
}

}  // namespace limen
