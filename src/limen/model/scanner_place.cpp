// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/scanner_place.h"

#include <fmt/format.h>

namespace limen {

const char* to_string(PlaceSource source) {
  switch (source) {
    case PlaceSource::unknown:
      return "unknown";
    case PlaceSource::assumed:
      return "assumed";
    case PlaceSource::stated_by_file:
      return "file";
    case PlaceSource::stated_by_user:
      return "user";
    case PlaceSource::estimated:
      return "estimated";
    case PlaceSource::per_point:
      return "per point";
  }
  return "";
}

std::string words_of_refuted(const ScannerPlace& place) {
  if (!place.refuted) return {};
  const auto words = [](const Vector3d& at) {
    return fmt::format("{:.3f} {:.3f} {:.3f}", at.x(), at.y(), at.z());
  };
  const std::string said = words(*place.refuted);
  if (place.source == PlaceSource::stated_by_user)
    return fmt::format("the points do not fit the given scanner position {}; it is used nevertheless", said);
  return fmt::format("the points contradict the scanner position {}; {}", said,
                     place.source == PlaceSource::unknown
                         ? "it is taken as unknown"
                         : "the position estimated from the points is used: " + words(place.centre));
}

}  // namespace limen
