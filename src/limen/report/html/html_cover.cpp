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
     "The place is found, but it is less sure than a registered one.",
     "{} places fit about equally well; which one is right is open.",
     "The best fit is not sure enough to be relied on.",
     "The place is found, but not every direction is held.", "Nothing was found that fits together.",
     "The probability that this is the right place is {}.",
     "{} is known to {} in its middle and to {} at its far end, {} m from there (95 %).",
     "This holds across the directions that are open.",
     "The points lie {} (root mean square) off the surfaces of the "
     "other side.",
     "Not held: {}.", "The scanner stood in {}.", "Project", "Operator", "Date"},
    {"fr", "R\u00e9sum\u00e9", "Les deux c\u00f4t\u00e9s ne s'assemblent que d'une seule fa\u00e7on.",
     "La position est trouv\u00e9e, mais elle est moins s\u00fbre qu'il n'est demand\u00e9.",
     "{} positions conviennent \u00e0 peu pr\u00e8s aussi bien ; laquelle est la bonne reste ind\u00e9cis.",
     "Le meilleur assemblage n'est pas assez s\u00fbr pour que l'on s'y fie.",
     "La position est trouv\u00e9e, mais toutes les directions ne sont pas tenues.",
     "Rien n'a \u00e9t\u00e9 trouv\u00e9 qui s'assemble.",
     "La probabilit\u00e9 que ce soit la bonne position est de {}.",
     "{} est connu \u00e0 {} pr\u00e8s en son milieu et \u00e0 {} pr\u00e8s \u00e0 son extr\u00e9mit\u00e9, "
     "\u00e0 {} m de l\u00e0 (95 %).",
     "Cela vaut en travers des directions ouvertes.",
     "Les points s'\u00e9cartent de {} (moyenne quadratique) des surfaces de l'autre c\u00f4t\u00e9.",
     "Non tenu : {}.", "Le scanner se trouvait dans {}.", "Projet", "Op\u00e9rateur", "Date"},
    {"de", "Zusammenfassung", "Beide Seiten passen nur auf eine Weise zusammen.",
     "Die Lage ist gefunden, aber weniger sicher, als verlangt wird.",
     "{} Lagen passen etwa gleich gut; welche die richtige ist, bleibt offen.",
     "Die beste Lage ist nicht sicher genug, um sich darauf zu verlassen.",
     "Die Lage ist gefunden, aber nicht jede Richtung ist gehalten.",
     "Es wurde nichts gefunden, was zusammenpasst.",
     "Die Wahrscheinlichkeit, dass dies die richtige Lage ist, betr\u00e4gt {}.",
     "{} ist in der Mitte auf {} und am fernen Ende, {} m davon, auf {} bekannt (95 %).",
     "Das gilt quer zu den offenen Richtungen.",
     "Die Punkte liegen {} (quadratisches Mittel) neben den Fl\u00e4chen der anderen Seite.",
     "Nicht gehalten: {}.", "Der Scanner stand in {}.", "Projekt", "Bearbeiter", "Datum"},
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

std::string cover_html(const RegistrationReport& report, const ReportCover& cover) {
  const Sentences& words = sentences_of(cover.language);
  std::string text;
  if (!cover.title.empty()) text += fmt::format("<p class=\"cover-title\">{}</p>\n", escaped(cover.title));
  const std::string facts = fact(words.project, cover.project) +
                            fact(words.operator_name, cover.operator_name) + fact(words.date, cover.date);
  if (!facts.empty()) text += fmt::format("<dl class=\"cover\" lang=\"{}\">{}</dl>\n", words.code, facts);
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
