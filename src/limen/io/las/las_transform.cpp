// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/las/las.h"
#include "limen/io/las/las_fields.h"
#include "limen/io/las/las_header.h"
#include "limen/io/las/las_records.h"
#include "limen/io/las/las_unit.h"
#include "limen/io/las/laz/laz_info.h"
#include "limen/io/las/laz/laz_pack.h"
#include "limen/io/las/laz/laz_writer.h"
#include "limen/io/table/moved_columns.h"

namespace limen {
namespace {

constexpr std::size_t kRecordsPerStep = 500000;  ///< records per step of work
constexpr std::size_t kRecordsPerPiece = 16384;

/// Three extra values of a record that are a place or a direction.
struct LasTriple {
  std::array<LasField, 3> values;
  MovedColumns columns;

  [[nodiscard]] bool is_real() const {
    const Scalar type = values[0].field.type;
    return (type == Scalar::float32 || type == Scalar::float64) &&
           std::all_of(values.begin(), values.end(),
                       [type](const LasField& value) { return value.field.type == type; });
  }
};

/// Those of the extra values that a motion changes.
std::vector<LasTriple> extra_triples(const LasHeader& header, const Rigid3& motion) {
  const bool turns = !motion.rotation.isIdentity(0.0);
  if (!turns && motion.translation.isZero(0.0)) return {};
  const std::vector<LasField> fields = las_layout(header).fields;
  const auto find = [&](std::string_view name, bool direction) -> std::optional<std::size_t> {
    const auto found = std::find_if(fields.begin(), fields.end(),
                                    [&](const LasField& value) { return value.field.name == name; });
    if (name.size() == 1 || found == fields.end() || (direction && !turns)) return {};
    return static_cast<std::size_t>(found - fields.begin());
  };
  std::vector<LasTriple> triples;
  for (const MovedColumns& moved : moved_columns(find))
    triples.push_back({{fields[moved.column[0]], fields[moved.column[1]], fields[moved.column[2]]}, moved});
  return triples;
}

template <typename Real>
void move_reals(const LasTriple& triple, const Rigid3& motion, char* record) {
  Vector3d x;
  for (std::size_t k = 0; k < 3; ++k) {
    Real stored{};
    std::memcpy(&stored, record + triple.values[k].at, sizeof stored);
    const Field& field = triple.values[k].field;
    x[static_cast<int>(k)] = field.offset + field.scale * static_cast<double>(stored);
  }
  x = triple.columns.moved(motion, x);
  for (std::size_t k = 0; k < 3; ++k) {
    const Field& field = triple.values[k].field;
    const auto stored = static_cast<Real>((x[static_cast<int>(k)] - field.offset) / field.scale);
    std::memcpy(record + triple.values[k].at, &stored, sizeof stored);
  }
}

void move_triple(const LasTriple& triple, const Rigid3& motion, char* record) {
  if (triple.values[0].field.type == Scalar::float64)
    move_reals<double>(triple, motion, record);
  else
    move_reals<float>(triple, motion, record);
}

/// What is moved, and how.
struct Motion {
  std::string_view bytes;
  const std::string& name;
  const LasHeader& header;
  const Rigid3& target_from_source;
  Monitor& monitor;
  std::vector<laz::ItemPlan> items;  ///< of points that are written packed; else none
  const LasSystem& system;           ///< of the target
  std::vector<LasTriple> triples = {};
};

using RecordSteps = std::array<std::int32_t, 3>;

RecordSteps place_of(const char* record) {
  RecordSteps place{};
  std::memcpy(place.data(), record, sizeof place);
  return place;
}
Vector3d old_point(const LasHeader& header, const RecordSteps& place) {
  return header.offset + header.scale.cwiseProduct(Vector3d(place[0], place[1], place[2]));
}

/// Extremes of integers; `outside`: some had no room.
struct Reach {
  RecordSteps low{INT32_MAX, INT32_MAX, INT32_MAX};
  RecordSteps high{INT32_MIN, INT32_MIN, INT32_MIN};
  std::uint64_t points = 0;
  bool outside = false;

  void add(const RecordSteps& place) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], place[k]);
      high[k] = std::max(high[k], place[k]);
    }
    ++points;
  }
  [[nodiscard]] Reach with(const Reach& other) const {
    Reach both = *this;
    for (std::size_t k = 0; k < 3; ++k) {
      both.low[k] = std::min(low[k], other.low[k]);
      both.high[k] = std::max(high[k], other.high[k]);
    }
    both.points += other.points;
    both.outside = outside || other.outside;
    return both;
  }
};

/// The box of all points in the target frame, by reading them: the header stated none that holds.
LasBox measured_box(const Motion& motion) {
  LasBox box;
  box.low.setConstant(std::numeric_limits<double>::infinity());
  box.high = -box.low;
  const auto records = open_las_records(motion.bytes, motion.name, motion.header);
  for (LasPiece piece = records->next(kRecordsPerStep); piece.count > 0;
       piece = records->next(kRecordsPerStep)) {
    motion.monitor.throw_if_cancelled();
    const char* data = piece.data;
    box = parallel_reduce(
        piece.count, kRecordsPerPiece, box,
        [&](std::size_t begin, std::size_t end) {
          LasBox part = box;
          for (std::size_t i = begin; i < end; ++i) {
            const RecordSteps place = place_of(data + i * motion.header.point_bytes);
            const Vector3d x = motion.target_from_source * old_point(motion.header, place);
            part.low = part.low.cwiseMin(x);
            part.high = part.high.cwiseMax(x);
          }
          return part;
        },
        [](const LasBox& a, const LasBox& b) {
          return LasBox{a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
        });
  }
  return box;
}

/// Moves the coordinates of records in place.
Reach move_records(const Motion& motion, const LasGrid& grid, std::vector<char>& records) {
  const std::size_t stride = motion.header.point_bytes;
  return parallel_reduce(
      records.size() / stride, kRecordsPerPiece, Reach{},
      [&](std::size_t begin, std::size_t end) {
        Reach reach;
        for (std::size_t i = begin; i < end; ++i) {
          char* record = &records[i * stride];
          RecordSteps place = place_of(record);
          if (!grid.unchanged) {
            const Vector3d x = motion.target_from_source * old_point(motion.header, place);
            const Vector3d steps = (x - grid.offset).cwiseQuotient(grid.scale);
            reach.outside = reach.outside || !(steps.cwiseAbs().maxCoeff() <= 2147483647.0);
            if (reach.outside) continue;
            for (std::size_t k = 0; k < 3; ++k)
              place[k] = static_cast<std::int32_t>(std::nearbyint(steps[static_cast<int>(k)]));
            std::memcpy(record, place.data(), sizeof place);
          }
          for (const LasTriple& triple : motion.triples) {
            if (triple.is_real()) move_triple(triple, motion.target_from_source, record);
          }
          reach.add(place);
        }
        return reach;
      },
      [](const Reach& sum, const Reach& part) { return sum.with(part); });
}

/// Records that describe how the points were packed; they are packed anew or no more.
bool describes_packing(const LasRecord& record) {
  return (record.user == kLasZipUser && record.number == kLasZipNumber) || record.user == "copc";
}

/// Records of the source's coordinate system, where the target has one of its own.
bool is_replaced(const Motion& motion, const LasRecord& record) {
  return !motion.system.wkt.empty() && record.user == "LASF_Projection";
}

constexpr int kTextFromMinor = 4;       // LAS 1.4 names systems by well-known text
constexpr std::uint16_t kTextBit = 16;  // of the global encoding: there is such a text
constexpr std::size_t kMostRecordBytes = 65535;

/// The record that names the target's system; empty where it has none, or this version of LAS cannot.
std::string system_record(const Motion& motion) {
  const LasSystem& system = motion.system;
  if (system.wkt.empty()) return {};
  if (motion.header.minor >= kTextFromMinor)
    return system.wkt.size() < kMostRecordBytes ? las_record("LASF_Projection", 2112, system.wkt + '\0')
                                                : std::string();
  return system.code.empty() ? std::string()
                             : las_record("LASF_Projection", 34735, las_key_directory(system.code));
}

/// A record as it is to be written; the scanner's position moves.
std::string written_record(const Motion& motion, const LasRecord& record) {
  std::string written(motion.bytes.substr(record.begin, record.end - record.begin));
  if (record.user != kLasCentreUser || record.number != kLasCentreNumber || record.body.size() < 24)
    return written;
  put_las_vector(written, written.size() - record.body.size(),
                 motion.target_from_source * las_vector(record.body, 0));
  return written;
}

/// Header and all that lies before the points.
std::string beginning(const Motion& motion, const LasGrid& grid) {
  const LasHeader& header = motion.header;
  std::string text(motion.bytes.substr(0, header.size));
  std::uint32_t taken_out = 0;
  std::uint32_t kept = 0;
  std::size_t end = header.size;
  for (const LasRecord& record : header.records) {
    if (record.extended) continue;
    end = record.end;
    if ((header.compressed && describes_packing(record)) || is_replaced(motion, record)) {
      ++taken_out;
    } else {
      ++kept;
      text += written_record(motion, record);
    }
  }
  const std::string named = system_record(motion);
  text += named;
  if (!named.empty()) ++kept;
  if (!motion.items.empty()) {
    text += las_record(kLasZipUser, kLasZipNumber, laz::laszip_record(motion.items, kLazChunkPoints));
  }
  text += motion.bytes.substr(end, header.points_begin - end);
  // A false count is kept, but not where it would hide the record that tells of the packing.
  const auto stated = las_number<std::uint32_t>(motion.bytes, las_at::kRecordCount);
  put_las_number(text, las_at::kRecordCount,
                 motion.items.empty() && named.empty() ? stated - taken_out
                 : motion.items.empty()                ? kept
                                                       : kept + 1);
  if (!named.empty() && header.minor >= kTextFromMinor)
    put_las_number(text, las_at::kGlobalEncoding,
                   static_cast<std::uint16_t>(header.global_encoding | kTextBit));
  put_las_number(text, las_at::kPointsBegin, static_cast<std::uint32_t>(text.size()));
  const unsigned packed = motion.items.empty() ? 0U : kPackedBit;
  text[las_at::kPointFormat] = static_cast<char>(static_cast<unsigned>(header.point_format) | packed);
  put_las_vector(text, las_at::kScale, grid.scale);
  put_las_vector(text, las_at::kOffset, grid.offset);
  return text;
}

/// What lies behind the points, and where in it waveforms and extended records begin.
struct Tail {
  std::string_view all;             ///< as it is
  std::optional<std::string> kept;  ///< extended records alone, where some were taken out
  std::optional<std::uint64_t> waveforms;
  std::optional<std::uint64_t> long_records;
  std::optional<std::uint32_t> long_record_count;  ///< where it changes

  [[nodiscard]] std::string_view bytes() const { return kept ? std::string_view(*kept) : all; }
};

std::uint64_t end_of_points(const Motion& motion) {
  const LasHeader& header = motion.header;
  if (!header.compressed) return header.points_begin + header.points * header.point_bytes;
  // The table of chunks ends somewhere: what follows is found by what the header points to.
  std::uint64_t end = motion.bytes.size();
  for (const std::uint64_t place : {header.waveforms, header.long_records}) {
    if (place > header.points_begin) end = std::min(end, place);
  }
  return end;
}

Tail tail_of(const Motion& motion) {
  const LasHeader& header = motion.header;
  const std::uint64_t begin = end_of_points(motion);
  Tail tail;
  tail.all = motion.bytes.substr(begin);
  const auto inside = [&](std::uint64_t place) {
    return place >= begin && place < motion.bytes.size() && place > 0;
  };
  std::string kept;
  std::uint32_t count = 0;
  bool taken_out = false;
  for (const LasRecord& record : header.records) {
    if (!record.extended) continue;
    const bool packing = (header.compressed && describes_packing(record)) || is_replaced(motion, record);
    taken_out = taken_out || packing;
    if (packing) continue;
    kept += written_record(motion, record);
    ++count;
  }
  if (inside(header.long_records)) tail.long_records = header.long_records - begin;
  if (inside(header.waveforms)) tail.waveforms = header.waveforms - begin;
  if (taken_out && !tail.waveforms) {
    tail.long_records = 0;
    tail.long_record_count = count;
    tail.kept = std::move(kept);
  }
  return tail;
}

/// Counts and places that are known in the end.
void patch_header(AtomicFile& file, const Motion& motion, const Tail& tail, std::uint64_t points_end) {
  const LasHeader& header = motion.header;
  if (header.minor >= 3 && tail.waveforms)
    overwrite_las_number(file, las_at::kWaveforms, points_end + *tail.waveforms);
  if (header.minor < 4) return;
  const bool none = tail.long_record_count == 0U;
  if (tail.long_records)
    overwrite_las_number(file, las_at::kLongRecords,
                         none ? std::uint64_t{0} : points_end + *tail.long_records);
  if (tail.long_record_count) overwrite_las_number(file, las_at::kLongRecordCount, *tail.long_record_count);
  if (!header.compressed || tail.long_records) return;
  overwrite_las_number(file, las_at::kLongRecords, std::uint64_t{0});
  overwrite_las_number(file, las_at::kLongRecordCount, std::uint32_t{0});
}

void patch_bounds(AtomicFile& file, const LasGrid& grid, const Reach& reach) {
  if (reach.points == 0) return;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<int>(k);
    const double a = grid.offset[axis] + grid.scale[axis] * reach.low[k];
    const double b = grid.offset[axis] + grid.scale[axis] * reach.high[k];
    overwrite_las_number(file, las_at::kBounds + 16 * k, std::max(a, b));
    overwrite_las_number(file, las_at::kBounds + 16 * k + 8, std::min(a, b));
  }
}

/// Writes the whole file; nothing where a point had no room in the grid.
std::optional<std::uint64_t> write_moved(const Motion& motion, const LasGrid& grid,
                                         const std::filesystem::path& output) {
  AtomicFile file(output);
  const std::string text = beginning(motion, grid);
  file.write(text);
  std::optional<LazWriter> packed;
  if (!motion.items.empty()) packed.emplace(file, text.size(), motion.items);
  Reach reach;
  const auto records = open_las_records(motion.bytes, motion.name, motion.header);
  std::vector<char> moved;
  for (LasPiece piece = records->next(kRecordsPerStep); piece.count > 0;
       piece = records->next(kRecordsPerStep)) {
    motion.monitor.throw_if_cancelled();
    moved.assign(piece.data, piece.data + piece.count * motion.header.point_bytes);
    reach = reach.with(move_records(motion, grid, moved));
    if (reach.outside) return {};
    const std::string_view written(moved.data(), moved.size());
    packed ? packed->write(written) : file.write(written);
    motion.monitor.advance(static_cast<double>(reach.points), static_cast<double>(motion.header.points));
  }
  const std::uint64_t points_end =
      packed ? packed->finish() : text.size() + reach.points * motion.header.point_bytes;
  const Tail tail = tail_of(motion);
  file.write(tail.bytes());
  patch_header(file, motion, tail, points_end);
  patch_bounds(file, grid, reach);
  file.commit();
  return reach.points;
}

std::vector<std::string> notes_of(const Motion& motion, const LasGrid& grid) {
  std::vector<std::string> notes = motion.header.notes;
  const LasHeader& header = motion.header;
  const bool placed = std::any_of(header.records.begin(), header.records.end(),
                                  [](const LasRecord& record) { return record.user == "LASF_Projection"; });
  const double angle = rotation_angle(motion.target_from_source.rotation);
  const Vector3d middle = 0.5 * (header.low + header.high);
  const double shift = (motion.target_from_source * middle - middle).norm();
  constexpr double kSmallAngle = 0.02;  // radians
  constexpr double kSmallShiftM = 10.0;
  if (!motion.system.wkt.empty()) {
    if (system_record(motion).empty())
      notes.push_back(
          fmt::format("LAS 1.{} states a coordinate system by its EPSG number, and this one has none: it is "
                      "not written to the file",
                      header.minor));
  } else if (placed && !(angle < kSmallAngle && shift < kSmallShiftM)) {
    notes.emplace_back(
        "the records of the coordinate system are kept as they were: they name the source's system, "
        "the coordinates are now the target's");
  }
  for (const LasTriple& triple : motion.triples) {
    if (!triple.is_real())
      notes.push_back(fmt::format("{} and its like are whole numbers: they are kept as they were",
                                  triple.values[0].field.name));
  }
  if (las_wave_packet_at(header.point_format) != 0 && !grid.unchanged)
    notes.emplace_back("directions of wave packets are kept as they were, not turned");
  if (header.find("copc", 1) != nullptr)
    notes.emplace_back("the index of the cloud optimised file (COPC) is left out");
  const double old_step = header.scale.cwiseAbs().minCoeff();
  if (grid.scale.cwiseAbs().minCoeff() > old_step) {
    notes.push_back(fmt::format(
        "coordinates are stored in steps of {} instead of {}: the points extend too far for finer steps",
        grid.scale.x(), old_step));
  }
  return notes;
}

}  // namespace

TransformedCloud transform_las(std::string_view bytes, const std::string& name,
                               const Rigid3& target_from_source, const std::filesystem::path& output,
                               Monitor& monitor, const LasSystem& system) {
  const LasHeader header = parse_las_header(bytes, name);
  Motion motion{bytes,   name, header, target_from_source,
                monitor, {},   system, extra_triples(header, target_from_source)};
  if (is_laz_ending(output)) motion.items = laz::items_of(header.point_format, header.point_bytes);
  const std::optional<LasBox> stated = stated_box(header);
  LasGrid grid = moved_grid(header, target_from_source,
                            stated ? moved_box(*stated, target_from_source) : measured_box(motion));
  const bool coarser = grid.scale.maxCoeff() > header.scale.cwiseAbs().minCoeff() && !grid.unchanged;
  if (stated && coarser)
    grid = moved_grid(header, target_from_source, measured_box(motion));  // is it so large?
  std::optional<std::uint64_t> points = write_moved(motion, grid, output);
  if (!points) {  // the header's box was wrong
    grid = moved_grid(header, target_from_source, measured_box(motion));
    points = write_moved(motion, grid, output);
  }
  if (!points)
    throw Error("the moved coordinates are not finite or too large to be stored", name, "check the pose");
  TransformedCloud result;
  result.points = static_cast<std::size_t>(*points);
  result.format = las_format_name(header);
  result.notes = notes_of(motion, grid);
  return result;
}

}  // namespace limen
