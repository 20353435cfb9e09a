// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/las_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/las/las_fields.h"
#include "limen/io/las/las_unit.h"

// Source: ASPRS LAS Specification 1.4 R15; earlier versions are beginnings of the same layout.

namespace limen {
namespace {

constexpr std::size_t kLongRecordHead = 60;
constexpr std::array<std::size_t, 5> kHeaderBytesOf{227, 227, 227, 235, 375};

/// A file in memory and its name.
struct HeaderSource {
  std::string_view bytes;
  const std::string& name;

  [[noreturn]] void fail(const std::string& what, const char* remedy) const {
    throw Error(what, name, remedy);
  }
  [[noreturn]] void damaged(const std::string& what) const {
    fail(what, "get the whole file, or export it again");
  }
};

std::string text_at(std::string_view bytes, std::size_t at, std::size_t length) {
  const std::string_view field = bytes.substr(at, length);
  return std::string(field.substr(0, field.find('\0')));
}

/// The record that begins at `at`; nothing where it does not fit into `room` bytes.
std::optional<LasRecord> record_at(std::string_view bytes, std::size_t at, std::uint64_t room,
                                   bool extended) {
  const std::size_t head = extended ? kLongRecordHead : kLasRecordHead;
  if (room < head) return {};
  const std::uint64_t length = extended ? las_number<std::uint64_t>(bytes, at + 20)
                                        : std::uint64_t{las_number<std::uint16_t>(bytes, at + 20)};
  if (length > room - head) return {};
  LasRecord record;
  record.user = text_at(bytes, at + 2, 16);
  record.number = las_number<std::uint16_t>(bytes, at + 18);
  record.body = bytes.substr(at + head, length);
  record.begin = at;
  record.end = at + head + length;
  record.extended = extended;
  return record;
}

/// What lies between header and points. Records that do not fit are noted, not fatal: the points are sound.
void parse_records(const HeaderSource& source, std::uint32_t promised, LasHeader& header) {
  std::size_t at = header.size;
  for (std::uint32_t k = 0; k < promised; ++k) {
    std::optional<LasRecord> record = record_at(source.bytes, at, header.points_begin - at, false);
    if (!record) {
      header.notes.push_back(
          fmt::format("the header promises {} variable length records, but only {} fit before the points; "
                      "the rest is skipped",
                      promised, k));
      return;
    }
    at = record->end;
    header.records.push_back(std::move(*record));
  }
}

void parse_long_records(const HeaderSource& source, LasHeader& header) {
  const auto promised = las_number<std::uint32_t>(source.bytes, las_at::kLongRecordCount);
  if (promised == 0) {
    header.long_records = 0;
    return;
  }
  std::uint64_t at = header.long_records;
  for (std::uint32_t k = 0; k < promised; ++k) {
    const std::uint64_t size = source.bytes.size();
    const std::uint64_t room = at < header.points_begin || at > size ? 0 : size - at;
    std::optional<LasRecord> record = record_at(source.bytes, at, room, true);
    if (!record) {
      header.notes.push_back(
          fmt::format("the header promises {} extended records after the points, but only {} are present; "
                      "the rest is skipped",
                      promised, k));
      if (k == 0) header.long_records = 0;
      return;
    }
    at = record->end;
    header.records.push_back(std::move(*record));
  }
}

void check_version(const HeaderSource& source, LasHeader& header) {
  if (!looks_like_las(source.bytes))
    source.damaged("this is not a LAS file, in spite of its name: it does not begin with LASF");
  if (source.bytes.size() < kHeaderBytesOf[0])
    source.damaged(fmt::format("the file ends within its header, after {} bytes", source.bytes.size()));
  const int major = static_cast<unsigned char>(source.bytes[las_at::kMinorVersion - 1]);
  header.minor = static_cast<unsigned char>(source.bytes[las_at::kMinorVersion]);
  if (major != 1 || header.minor > 4) {
    source.fail(fmt::format("LAS version {}.{} is not known", major, header.minor),
                "export it as LAS 1.0 to 1.4");
  }
  const std::size_t least = kHeaderBytesOf[static_cast<std::size_t>(header.minor)];
  header.size = las_number<std::uint16_t>(source.bytes, las_at::kHeaderSize);
  if (header.size < least) {
    source.damaged(
        fmt::format("a header of {} bytes is impossible: LAS 1.{} has {}", header.size, header.minor, least));
  }
  header.points_begin = las_number<std::uint32_t>(source.bytes, las_at::kPointsBegin);
  if (header.points_begin < header.size || header.points_begin > source.bytes.size()) {
    source.damaged(
        fmt::format("the points should begin at byte {}, but the header has {} bytes and the file {}",
                    header.points_begin, header.size, source.bytes.size()));
  }
}

void parse_point_format(const HeaderSource& source, LasHeader& header) {
  const unsigned format = static_cast<unsigned char>(source.bytes[las_at::kPointFormat]);
  header.compressed = (format & 0x80U) != 0;
  header.point_format = static_cast<int>(format & 0x3FU);
  if (header.point_format > 10 || (format & 0x40U) != 0) {
    source.fail(fmt::format("point format {} is not known", format & 0x7FU),
                "export it with a point format from 0 to 10");
  }
  header.point_bytes = las_number<std::uint16_t>(source.bytes, las_at::kPointLength);
  const std::size_t least = las_point_bytes(header.point_format);
  if (header.point_bytes < least) {
    source.damaged(fmt::format("points of {} bytes are impossible: point format {} has {}",
                               header.point_bytes, header.point_format, least));
  }
}

void parse_count(const HeaderSource& source, LasHeader& header) {
  header.points = las_number<std::uint32_t>(source.bytes, las_at::kLegacyCount);
  if (header.minor < 4) return;
  const auto count = las_number<std::uint64_t>(source.bytes, las_at::kCount);
  if (count != 0 && header.points != 0 && count != header.points) {
    header.notes.push_back(
        fmt::format("two counts of points disagree, {} and {}: the first is used", count, header.points));
  }
  if (count != 0) header.points = count;
}

void parse_grid(const HeaderSource& source, LasHeader& header) {
  header.scale = las_vector(source.bytes, las_at::kScale);
  header.offset = las_vector(source.bytes, las_at::kOffset);
  header.high = las_vector(source.bytes, las_at::kBounds, 16);
  header.low = las_vector(source.bytes, las_at::kBounds + 8, 16);
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(header.scale[k]) || header.scale[k] == 0.0 || !std::isfinite(header.offset[k])) {
      source.damaged(
          fmt::format("a scale of {} with an offset of {} is impossible", header.scale[k], header.offset[k]));
    }
  }
}

}  // namespace

const LasRecord* LasHeader::find(std::string_view user, std::uint16_t number) const {
  for (const LasRecord& record : records) {
    if (record.user == user && record.number == number) return &record;
  }
  return nullptr;
}

std::string las_record(std::string_view user, std::uint16_t number, std::string_view body) {
  std::string record(kLasRecordHead, '\0');
  std::copy(user.begin(), user.end(), record.begin() + 2);
  put_las_number(record, 18, number);
  put_las_number(record, 20, static_cast<std::uint16_t>(body.size()));
  return record.append(body);
}

bool looks_like_las(std::string_view bytes) {
  return bytes.substr(0, 4) == "LASF";
}

LasHeader parse_las_header(std::string_view bytes, const std::string& name) {
  const HeaderSource source{bytes, name};
  LasHeader header;
  check_version(source, header);
  header.global_encoding = las_number<std::uint16_t>(bytes, las_at::kGlobalEncoding);
  parse_point_format(source, header);
  parse_count(source, header);
  parse_grid(source, header);
  parse_records(source, las_number<std::uint32_t>(bytes, las_at::kRecordCount), header);
  if (header.minor >= 3) header.waveforms = las_number<std::uint64_t>(bytes, las_at::kWaveforms);
  if (header.minor >= 4) {
    header.long_records = las_number<std::uint64_t>(bytes, las_at::kLongRecords);
    parse_long_records(source, header);
  }
  const std::uint64_t room = (bytes.size() - header.points_begin) / header.point_bytes;
  if (!header.compressed && header.points > room) {
    throw Error(fmt::format("the header promises {} points, the file has room for {}", header.points, room),
                name, "get the whole file, or correct the count");
  }
  return header;
}

std::string las_format_name(const LasHeader& header) {
  return fmt::format("{} 1.{}{}, point format {}", header.compressed ? "LAZ" : "LAS", header.minor,
                     header.find("copc", 1) != nullptr ? " (COPC)" : "", header.point_format);
}

std::vector<std::string> las_coordinate_systems(const LasHeader& header) {
  std::vector<std::string> texts;
  for (const LasRecord& record : header.records) {
    if (record.user != "LASF_Projection" || record.number != 2112) continue;
    std::string text(record.body.substr(0, record.body.find('\0')));
    if (!text.empty()) texts.push_back(std::move(text));
  }
  if (texts.empty()) {
    if (const std::string code = las_projected_code(header); !code.empty()) texts.push_back(code);
  }
  return texts;
}

namespace {

constexpr double kStep = 1e-4;
constexpr double kRoundOffset = 100.0;
/// Integers are kept below this, so that a box that is given a little too small does no harm.
constexpr double kMostSteps = 2.1e9;

}  // namespace

LasBox moved_box(const LasBox& box, const Rigid3& target_from_source) {
  LasBox moved;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vector3d x{(corner & 1U) != 0 ? box.high.x() : box.low.x(),
                     (corner & 2U) != 0 ? box.high.y() : box.low.y(),
                     (corner & 4U) != 0 ? box.high.z() : box.low.z()};
    const Vector3d y = target_from_source * x;
    moved.low = corner == 0 ? y : Vector3d(moved.low.cwiseMin(y));
    moved.high = corner == 0 ? y : Vector3d(moved.high.cwiseMax(y));
  }
  return moved;
}

std::optional<LasBox> stated_box(const LasHeader& header) {
  const bool sound =
      header.low.allFinite() && header.high.allFinite() && (header.low.array() <= header.high.array()).all();
  if (!sound) return {};
  return LasBox{header.low, header.high};
}

Vector3d round_offset(const Vector3d& near) {
  return (near / kRoundOffset).array().round() * kRoundOffset;
}

LasGrid moved_grid(const LasHeader& header, const Rigid3& target_from_source, const LasBox& box) {
  LasGrid grid;
  if (target_from_source.rotation.isIdentity(0.0)) {
    grid.scale = header.scale;
    grid.offset = header.offset + target_from_source.translation;
    grid.unchanged = true;
    return grid;
  }
  double step = std::min(kStep, header.scale.cwiseAbs().minCoeff());
  const Vector3d middle = 0.5 * (box.low + box.high);
  grid.offset = round_offset(middle);
  const double reach =
      std::max((box.high - grid.offset).cwiseAbs().maxCoeff(), (box.low - grid.offset).cwiseAbs().maxCoeff());
  while (reach > kMostSteps * step && std::isfinite(reach)) step *= 10.0;
  grid.scale.setConstant(step);
  return grid;
}

}  // namespace limen
