// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_words.h"

#include <cctype>

#include <fmt/format.h>

#include "limen/report/summary/advice.h"
#include "limen/report/summary/precision.h"

namespace limen {
namespace {

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// "m2" of messages as "m²".
std::string square_metres(std::string text) {
  for (std::size_t at = text.find(" m2"); at != std::string::npos; at = text.find(" m2", at + 1))
    text.replace(at, 3, " m²");
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
    words += " (root mean square)";
    if (precision && precision->middle.formal_radius_m && precision->far_end.formal_radius_m)
      words += fmt::format("; from the noise of the points alone the accuracy would be {} and {}",
                           length_words(*precision->middle.formal_radius_m),
                           length_words(*precision->far_end.formal_radius_m));
    sentences.push_back(words + ".");
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

}  // namespace limen
