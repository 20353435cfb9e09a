// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_words.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kShareOfAxis = 0.1;  // an open direction with less than this along an axis leaves it alone

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
  const bool model = report.source.kind == "model" || report.target.kind == "model";
  return model ? "the scan and the model" : "the two scans";
}

/// "place" in a model, "way" between scans.
std::string places(const RegistrationReport& report, std::size_t count) {
  const bool model = report.source.kind == "model" || report.target.kind == "model";
  return fmt::format("{} {}", count, model ? "places" : "ways");
}

/// The largest standard deviation of the shifts or turns that are held; none where none is.
std::optional<double> worst_held(const RegistrationResult& result, bool rotation) {
  const Vector3d& sigma = rotation ? result.sigma.rotation_rad : result.sigma.translation_m;
  std::optional<double> worst;
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_open(result, rotation, axis)) worst = std::max(worst.value_or(0.0), sigma[axis]);
  }
  return worst;
}

/// Empty where no axis is held.
std::string expectation(const RegistrationResult& result) {
  const std::optional<double> shift = worst_held(result, false);
  const std::optional<double> turn = worst_held(result, true);
  std::string words;
  if (shift) words = (*shift < 0.00005 ? "less than 0.1 mm" : length_words(*shift)) + " in position";
  if (shift && turn) words += " and ";
  if (turn) words += angle_words(*turn) + " in direction";
  if (words.empty()) return {};
  return fmt::format("You can expect {} (one standard deviation of the worst axis{}).", words,
                     result.unobserved.empty() ? "" : " that is held");
}

VerdictWords registered_words(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  VerdictWords words{"Registered: " + both_sides(report) + " fit in one way only",
                     {expectation(result)},
                     square_metres(result.reason),
                     "✓"};
  if (!result.best.room.empty()) words.sentences.push_back("The scanner stood in " + result.best.room + ".");
  return words;
}

VerdictWords ambiguous_words(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  VerdictWords words{"", {}, "", "?"};
  if (result.rivals == 0) {
    words.headline = "Not decided: the best fit is not sure enough";
    words.sentences.push_back(capitalised(square_metres(result.reason)) + ".");
  } else {
    words.headline = fmt::format("Not decided: {} fit about equally well", places(report, result.rivals + 1));
    words.sentences.push_back(
        "Look through them below; a further scan, or a place known by other means, decides.");
    words.reason = square_metres(result.reason);
  }
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
  VerdictWords words{"Not fully held: the data leaves a direction open", {}, "", "↔"};
  for (const UnobservedFreedom& freedom : result.unobserved)
    words.sentences.push_back(capitalised(freedom.name) + " is not held by the data.");
  if (result.unobserved.size() > 1)
    words.headline =
        fmt::format("Not fully held: the data leaves {} directions open", result.unobserved.size());
  const std::string expected = expectation(result);
  if (!expected.empty()) words.sentences.push_back(expected);
  return words;
}

}  // namespace

bool is_open(const RegistrationResult& result, bool rotation, int axis) {
  for (const UnobservedFreedom& freedom : result.unobserved) {
    if (freedom.rotation == rotation && std::abs(freedom.direction[axis]) > kShareOfAxis) return true;
  }
  return false;
}

std::string file_name(const InputSummary& input) {
  return input.path.substr(input.path.find_last_of('/') + 1);
}

std::string length_words(double metres) {
  const double size = std::abs(metres);
  if (!std::isfinite(metres)) return "—";
  if (size < 0.00005) return "0.0 mm";
  if (size < 0.0995) return fmt::format("{:.{}f} mm", 1e3 * metres, size < 0.00995 ? 1 : 0);
  if (size < 0.995) return fmt::format("{:.1f} cm", 1e2 * metres);
  return fmt::format("{:.2f} m", metres);
}

std::string angle_words(double angle_rad) {
  if (!std::isfinite(angle_rad)) return "—";
  const double size = std::abs(degrees(angle_rad));
  return fmt::format("{:.{}f}°", degrees(angle_rad), size < 0.0995 ? 4 : size < 9.95 ? 2 : 1);
}

VerdictWords verdict_words(const RegistrationReport& report) {
  if (report.result.published) return published_words(report.result);
  switch (report.result.outcome) {
    case Outcome::registered:
      return registered_words(report);
    case Outcome::ambiguous:
      return ambiguous_words(report);
    case Outcome::under_constrained:
      return open_words(report);
    case Outcome::no_match:
      break;
  }
  return {"No match: " + both_sides(report) + " show nothing in common that fits together",
          {capitalised(square_metres(report.result.reason)) + ".",
           "Below they stand side by side, each upright as far as is known."},
          "",
          "✕"};
}

}  // namespace limen
