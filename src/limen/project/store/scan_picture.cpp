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
  ByteWriter writer;
  writer.put(picture.local_origin);
  writer.put_count(picture.size());
  for (const Vector3d& x : picture.points) {
    for (Eigen::Index k = 0; k < 3; ++k) writer.put(static_cast<float>(x[k]));
  }
  writer.put_all(picture.colours);
  writer.put_all(picture.intensities);
  return writer.bytes();
}

Scan picture_from(std::string_view bytes, const std::string& where, std::size_t most) {
  constexpr std::size_t kPointBytes = 12;
  ByteReader reader(bytes, where);
  Scan picture;
  reader.get(picture.local_origin);
  picture.points.resize(reader.get_count(kPointBytes));
  for (Vector3d& x : picture.points) {
    for (Eigen::Index k = 0; k < 3; ++k) x[k] = static_cast<double>(reader.get<float>());
  }
  picture.colours = reader.get_all<std::uint8_t>();
  picture.intensities = reader.get_all<float>();
  reader.require(picture.colours.empty() || picture.colours.size() == 3 * picture.size());
  reader.require(picture.intensities.empty() || picture.intensities.size() == picture.size());
  const std::size_t count = std::min(most, picture.size());
  picture.points.resize(count);
  picture.points.shrink_to_fit();
  if (!picture.colours.empty()) picture.colours.resize(3 * count);
  if (!picture.intensities.empty()) picture.intensities.resize(count);
  return picture;
}

}  // namespace limen
