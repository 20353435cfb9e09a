// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/scanner_place.h"

#include <fmt/format.h>

#include "limen/base/named.h"

namespace limen {

const char* to_string(PlaceSource source) {
  static constexpr Named<PlaceSource> names[] = {
      {PlaceSource::unknown, "unknown"},     {PlaceSource::assumed, "assumed"},
      {PlaceSource::stated_by_file, "file"}, {PlaceSource::stated_by_user, "user"},
      {PlaceSource::estimated, "estimated"}, {PlaceSource::per_point, "per point"}};
  return name_of(names, source);
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
