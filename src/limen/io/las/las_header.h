// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/base/atomic_file.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// A number of a LAS file (little-endian) at `at`, which must lie in `bytes`.
template <typename Value>
Value las_number(std::string_view bytes, std::size_t at) {
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Three of them, `step` bytes from one to the next.
inline Vector3d las_vector(std::string_view bytes, std::size_t at, std::size_t step = 8) {
  return {las_number<double>(bytes, at), las_number<double>(bytes, at + step),
          las_number<double>(bytes, at + 2 * step)};
}
/// Writes a number over the bytes at `at`, which must be there.
template <typename Value>
void put_las_number(std::string& bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}
inline void put_las_vector(std::string& bytes, std::size_t at, const Vector3d& values) {
  for (int k = 0; k < 3; ++k) put_las_number(bytes, at + 8 * static_cast<std::size_t>(k), values[k]);
}

/// Writes a number over bytes that were written to the file before.
template <typename Value>
void overwrite_las_number(AtomicFile& file, std::uint64_t at, Value value) {
  std::string bytes(sizeof value, '\0');
  put_las_number(bytes, 0, value);
  file.overwrite(at, bytes);
}

/// Places of the LAS header that are read and patched, bytes from the beginning.
namespace las_at {
inline constexpr std::size_t kGlobalEncoding = 6;
inline constexpr std::size_t kMinorVersion = 25;
inline constexpr std::size_t kHeaderSize = 94;
inline constexpr std::size_t kPointsBegin = 96;
inline constexpr std::size_t kRecordCount = 100;
inline constexpr std::size_t kPointFormat = 104;
inline constexpr std::size_t kPointLength = 105;
inline constexpr std::size_t kLegacyCount = 107;
inline constexpr std::size_t kScale = 131;
inline constexpr std::size_t kOffset = 155;
inline constexpr std::size_t kBounds = 179;     ///< max x, min x, max y, min y, max z, min z
inline constexpr std::size_t kWaveforms = 227;  ///< from 1.3
inline constexpr std::size_t kLongRecords = 235;
inline constexpr std::size_t kLongRecordCount = 243;
inline constexpr std::size_t kCount = 247;
inline constexpr std::size_t kReturns = 255;
}  // namespace las_at

/// Bytes of a variable length record before its body.
inline constexpr std::size_t kLasRecordHead = 54;
/// Name of the record that holds the scanner position of a static scan, written by limen: three float64,
/// metres.
inline constexpr const char* kLasCentreUser = "limen";
inline constexpr std::uint16_t kLasCentreNumber = 1;

/// A variable length record as it lies in a file; the body has at most 65535 bytes.
std::string las_record(std::string_view user, std::uint16_t number, std::string_view body);

/// A variable length record, the long kind too.
struct LasRecord {
  std::string user;          ///< "LASF_Projection"
  std::uint16_t number = 0;  ///< record id
  std::string_view body;
  std::size_t begin = 0;  ///< of its own head in the file, bytes
  std::size_t end = 0;    ///< of its body
  bool extended = false;  ///< behind the points
};

/// The header of a LAS or LAZ file, checked against the length of the file.
struct LasHeader {
  int minor = 0;  ///< version 1.minor
  std::uint16_t global_encoding = 0;
  std::size_t size = 0;
  std::size_t points_begin = 0;
  int point_format = 0;     ///< 0 to 10
  bool compressed = false;  ///< LAZ
  std::size_t point_bytes = 0;
  std::uint64_t points = 0;
  Vector3d scale = Vector3d::Ones();
  Vector3d offset = Vector3d::Zero();
  Vector3d low = Vector3d::Zero();  ///< as the file says; never trusted
  Vector3d high = Vector3d::Zero();
  std::uint64_t waveforms = 0;     ///< where the waveform packets begin, or 0
  std::uint64_t long_records = 0;  ///< where the extended records begin, or 0
  std::vector<LasRecord> records;  ///< in the order of the file
  std::vector<std::string> notes;  ///< what was odd and is passed over

  /// The first record of that name; nullptr where there is none.
  [[nodiscard]] const LasRecord* find(std::string_view user, std::uint16_t number) const;
};

/// True where the bytes begin like a LAS or LAZ file.
bool looks_like_las(std::string_view bytes);

/// Reads the header and the variable length records. Throws Error where something in it cannot be, or where
/// the points of an uncompressed file do not fit into it.
LasHeader parse_las_header(std::string_view bytes, const std::string& name);

/// "LAZ 1.4, point format 6".
std::string las_format_name(const LasHeader& header);

/// Texts of the coordinate system (OGC WKT) that the file carries, as they are; where it has none, but the
/// keys of GeoTIFF with a number of a projected system: "EPSG:2154".
std::vector<std::string> las_coordinate_systems(const LasHeader& header);

/// An axis-aligned box.
struct LasBox {
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
};

/// The steps in which coordinates are stored: coordinate = offset + scale * integer.
struct LasGrid {
  Vector3d scale = Vector3d::Ones();
  Vector3d offset = Vector3d::Zero();
  bool unchanged = false;  ///< the integers stay, only the offset moves
};

/// The box round the eight corners of a moved box.
LasBox moved_box(const LasBox& box, const Rigid3& target_from_source);

/// The box that the header tells, where it can be one.
std::optional<LasBox> stated_box(const LasHeader& header);

/// A round number near a place: what stored coordinates are counted from.
Vector3d round_offset(const Vector3d& near);

/// A grid for points in `box`, target frame: steps as fine as the finest old ones and 0.1 mm, where the box
/// allows, else the next power of ten that it allows; the offset is a round number near its middle. A pose
/// without rotation keeps the old steps and shifts the offset.
LasGrid moved_grid(const LasHeader& header, const Rigid3& target_from_source, const LasBox& box);

}  // namespace limen
