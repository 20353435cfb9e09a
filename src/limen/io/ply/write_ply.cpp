// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/io/ply/ply.h"

namespace limen {
namespace {

static_assert(std::endian::native == std::endian::little, "write_ply copies numbers as they are in memory");

constexpr std::size_t kPiece = 16384;

std::string header_of(const Scan& scan) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment limen\n";
  if (!scan.mobile()) {
    const Vector3d centre =
        scan.centre_known() ? Vector3d(scan.local_origin + scan.centres[0]) : Vector3d::Zero();
    text += scan.centre_known()
                ? fmt::format("comment scanner_position {} {} {}\n", centre.x(), centre.y(), centre.z())
                : "comment scanner_position unknown\n";
  }
  text += fmt::format("element vertex {}\n", scan.size());
  for (const char* name : {"x", "y", "z"}) text += fmt::format("property double {}\n", name);
  if (scan.mobile()) {
    for (const char* name : {"x", "y", "z"}) text += fmt::format("property double {}_origin\n", name);
  }
  if (!scan.times_s.empty()) text += "property double GPS_time\n";
  if (scan.topology.known()) text += "property int scan_line\nproperty int scan_index\n";
  if (!scan.intensities.empty()) text += "property float intensity\n";
  if (!scan.colours.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  return text + "end_header\n";
}

std::size_t record_bytes(const Scan& scan) {
  return 3 * sizeof(double) + (scan.mobile() ? 3 * sizeof(double) : 0) +
         (scan.times_s.empty() ? 0 : sizeof(double)) +
         (scan.topology.known() ? 2 * sizeof(std::int32_t) : 0) +
         (scan.intensities.empty() ? 0 : sizeof(float)) + (scan.colours.empty() ? 0 : 3);
}

template <typename Value>
char* put(char* at, const Value& value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

char* put(char* at, const Vector3d& x) {
  for (int k = 0; k < 3; ++k) at = put(at, x[k]);
  return at;
}

char* put_record(char* at, const Scan& scan, std::size_t i) {
  at = put(at, Vector3d(scan.local_origin + scan.points[i]));
  if (scan.mobile()) at = put(at, Vector3d(scan.local_origin + scan.centres[i]));
  if (!scan.times_s.empty()) at = put(at, scan.times_s[i]);
  if (scan.topology.known()) {
    at = put(at, scan.topology.line[i]);
    at = put(at, scan.topology.index[i]);
  }
  if (!scan.intensities.empty()) at = put(at, scan.intensities[i]);
  if (!scan.colours.empty()) {
    for (std::size_t k = 0; k < 3; ++k) at = put(at, scan.colours[3 * i + k]);
  }
  return at;
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Scan& scan) {
  scan.check();
  AtomicFile file(path);
  file.write(header_of(scan));
  const std::size_t stride = record_bytes(scan);
  std::string piece;
  for (std::size_t begin = 0; begin < scan.size(); begin += kPiece) {
    const std::size_t end = std::min(scan.size(), begin + kPiece);
    piece.resize((end - begin) * stride);
    char* at = piece.data();
    for (std::size_t i = begin; i < end; ++i) at = put_record(at, scan, i);
    file.write(piece);
  }
  file.commit();
}

}  // namespace limen
