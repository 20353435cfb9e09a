// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/words.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kShareOfAxis = 0.1;  // an open direction with less than this along an axis leaves it alone
constexpr double kUpright = 0.996;    // the vertical, to five degrees

}  // namespace

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

std::string probability_words(double probability) {
  if (!std::isfinite(probability)) return "—";
  if (probability > 0.9999) return "more than 99.99 %";
  if (probability < 0.0001) return "less than 0.01 %";
  // Cut, not rounded: 99.97 % is not 100.0 %.
  const bool fine = probability >= 0.99;
  if (probability < 0.01) return fmt::format("{:.2f} %", 100.0 * probability);
  const double scale = fine ? 1e4 : 1e3;
  return fmt::format("{:.{}f} %", std::floor(scale * probability + 1e-9) / scale * 100.0, fine ? 2 : 1);
}

std::string axis_words(const Vector3d& axis) {
  if (std::abs(axis.z()) > kUpright) return "the vertical";
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", axis.x() + 0.0, axis.y() + 0.0, axis.z() + 0.0);
}

std::string square_metres(std::string text) {
  for (std::size_t at = text.find(" m2"); at != std::string::npos; at = text.find(" m2", at + 1))
    text.replace(at, 3, " m²");
  return text;
}

std::string size_words(const Vector3d& size_m) {
  return fmt::format("{:.1f} x {:.1f} x {:.1f} m", size_m.x(), size_m.y(), size_m.z());
}

std::string file_name(const InputSummary& input) {
  return std::filesystem::path(input.path).filename().string();
}

bool is_open(const RegistrationResult& result, bool rotation, int axis) {
  for (const UnobservedFreedom& freedom : result.unobserved) {
    if (freedom.rotation == rotation && std::abs(freedom.direction[axis]) > kShareOfAxis) return true;
  }
  return false;
}

bool in_model(const RegistrationReport& report) {
  return report.source.kind == "model" || report.target.kind == "model";
}

bool may_have_moved(const RegistrationReport& report, const InputSummary& side) {
  return side.kind == "scan" && side.place.source == PlaceSource::unknown && !side.mobile &&
         report.result.best.matched_segments == 0;
}

}  // namespace limen
