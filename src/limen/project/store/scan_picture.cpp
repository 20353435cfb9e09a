// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/scan_picture.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "limen/base/random.h"
#include "limen/geometry/spread_evenly.h"
#include "limen/project/store/byte_stream.h"

namespace limen {

Scan picture_of(const Scan& scan, std::size_t most) {
  // Far more points than are wanted: every n-th first, for the grid's sake.
  constexpr std::size_t kTimesWanted = 4;
  const std::size_t stride =
      std::max<std::size_t>(1, scan.size() / (kTimesWanted * std::max<std::size_t>(most, 1)));
  std::vector<Vector3d> some;
  some.reserve(scan.size() / stride + 1);
  for (std::size_t i = 0; i < scan.size(); i += stride) some.push_back(scan.points[i]);
  std::vector<std::uint32_t> kept = spread_evenly(some, most);
  std::sort(kept.begin(), kept.end(), [](std::uint32_t a, std::uint32_t b) { return mix64(a) < mix64(b); });
  Scan picture;
  picture.local_origin = scan.local_origin;
  for (const std::uint32_t k : kept) {
    const std::size_t i = k * stride;
    picture.points.push_back(scan.points[i]);
    for (std::size_t c = 0; !scan.colours.empty() && c < 3; ++c)
      picture.colours.push_back(scan.colours[3 * i + c]);
    if (!scan.intensities.empty()) picture.intensities.push_back(scan.intensities[i]);
  }
  return picture;
}

std::string picture_bytes(const Scan& picture) {
  std::vector<float> places;
  for (const Vector3d& x : picture.points) {
    for (Eigen::Index k = 0; k < 3; ++k) places.push_back(static_cast<float>(x[k]));
  }
  return bytes_of_all(picture.local_origin, places, picture.colours, picture.intensities);
}

Scan picture_from(std::string_view bytes, const std::string& where, std::size_t most) {
  ByteReader reader(bytes, where);
  Scan picture;
  std::vector<float> places;
  reader(picture.local_origin, places, picture.colours, picture.intensities);
  const std::size_t kept = places.size() / 3;
  reader.require(places.size() == 3 * kept);
  reader.require(picture.colours.empty() || picture.colours.size() == 3 * kept);
  reader.require(picture.intensities.empty() || picture.intensities.size() == kept);
  const std::size_t count = std::min(most, kept);
  for (std::size_t i = 0; i < count; ++i)
    picture.points.emplace_back(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
  if (!picture.colours.empty()) picture.colours.resize(3 * count);
  if (!picture.intensities.empty()) picture.intensities.resize(count);
  return picture;
}

}  // namespace limen
