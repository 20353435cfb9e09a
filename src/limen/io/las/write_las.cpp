// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/las/las.h"
#include "limen/io/las/las_fields.h"
#include "limen/io/las/las_header.h"
#include "limen/io/las/las_slots.h"
#include "limen/io/las/laz/copc_writer.h"
#include "limen/io/las/laz/laz_info.h"
#include "limen/io/las/laz/laz_pack.h"
#include "limen/io/las/laz/laz_writer.h"
#include "limen/io/table/value_tops.h"

namespace limen {
namespace {

constexpr std::size_t kHeaderBytes14 = 375;
constexpr std::size_t kEncodedPerPiece = 16384;  ///< rows per piece of parallel work
constexpr std::size_t kEncodedStrip = 1024;      ///< values that stay in the cache
constexpr std::size_t kRowsPerBlock = 262144;    ///< rows that are encoded before they are written
constexpr double kFinestStep = 1e-5;
constexpr double kCoarsestStep = 1e-4;
constexpr double kSecondsOfWeek = 604800.0;
constexpr std::int32_t kBlank = INT32_MIN;  ///< stored for what is no number, until the row is left out

/// A value brought into a whole number of a range; what is no number becomes the lowest.
template <typename Value>
Value clamped(double value) {
  const auto least = static_cast<double>(std::numeric_limits<Value>::lowest());
  const auto most = static_cast<double>(std::numeric_limits<Value>::max());
  if (!(value > least)) return std::numeric_limits<Value>::lowest();
  return value >= most ? std::numeric_limits<Value>::max() : static_cast<Value>(value);
}

/// What the header tells of the points.
struct Summary {
  std::uint64_t points = 0;
  std::array<std::int32_t, 3> low{INT32_MAX, INT32_MAX, INT32_MAX};
  std::array<std::int32_t, 3> high{INT32_MIN, INT32_MIN, INT32_MIN};
  std::array<std::uint64_t, 16> returns{};
  double earliest = std::numeric_limits<double>::infinity();
  double latest = -std::numeric_limits<double>::infinity();
  bool outside = false;  ///< a coordinate that the steps cannot reach
  bool blank = false;    ///< a coordinate that is no number

  void add(const Summary& other) {
    points += other.points;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
    for (std::size_t k = 0; k < returns.size(); ++k) returns[k] += other.returns[k];
    earliest = std::min(earliest, other.earliest);
    latest = std::max(latest, other.latest);
    outside = outside || other.outside;
    blank = blank || other.blank;
  }
};

/// The values of one column that go into records.
struct ValueStrip {
  const double* values;
  std::size_t count;
  char* record;  ///< the first
  std::size_t stride;

  template <typename Make>
  void store(std::size_t at, const Make& make) const {
    char* to = record + at;
    for (std::size_t i = 0; i < count; ++i, to += stride) {
      const auto value = make(values[i]);
      std::memcpy(to, &value, sizeof value);
    }
  }
};

void store_bits(const ValueStrip& strip, const LasSlot& slot) {
  const unsigned most = (1U << slot.bits.count) - 1;
  for (std::size_t i = 0; i < strip.count; ++i) {
    char& byte = strip.record[i * strip.stride + slot.at];
    const unsigned value = std::min<unsigned>(clamped<std::uint8_t>(strip.values[i]), most);
    const unsigned kept = static_cast<unsigned char>(byte) & ~(most << slot.bits.shift);
    byte = static_cast<char>(kept | (value << slot.bits.shift));
  }
}

void store_extra(const ValueStrip& strip, const LasSlot& slot) {
  with_type(slot.type, [&](auto kind) {
    using Value = decltype(kind);
    if constexpr (std::is_floating_point_v<Value>)
      strip.store(slot.at, [](double value) { return static_cast<Value>(value); });
    else
      strip.store(slot.at, clamped<Value>);
  });
}

class LasWriter : public CloudWriter {
 public:
  LasWriter(const std::filesystem::path& path, const CloudPlan& plan)
      : name_(path.string()),
        plan_(plan),
        slots_(las_slots(plan, name_)),
        tree_(is_copc_ending(path)),
        items_(is_laz_ending(path) ? laz::items_of(slots_.point_format, slots_.point_bytes) : Items{}),
        file_(path) {
    const double step =
        plan.resolution_m > 0.0 ? plan.resolution_m : (plan.centre ? kFinestStep : kCoarsestStep);
    step_ = std::clamp(step, kFinestStep, kCoarsestStep);
    offset_ = round_offset(plan.near);
    if (!offset_.allFinite()) offset_.setZero();
    const std::string head = beginning();
    file_.write(head);
    if (tree_)
      packed_ = std::make_unique<CopcWriter>(file_, head.size(), items_,
                                             LasGrid{Vector3d::Constant(step_), offset_, false});
    else if (!items_.empty())
      packed_ = std::make_unique<LazWriter>(file_, head.size(), items_);
  }

  void write(const RecordTable& rows) override {
    if (rows.fields.size() != plan_.columns.size())
      throw Error("rows without the columns of the plan", name_, "report this as a bug", Fault::internal);
    if (rows.rows == 0) return;
    if (spreads_.empty()) find_spreads(rows);
    for (std::size_t begin = 0; begin < rows.rows; begin += kRowsPerBlock)
      write_block(rows, {begin, std::min(rows.rows, begin + kRowsPerBlock)});
  }

  void finish() override {
    if (packed_) packed_->finish();
    patch_header();
    file_.commit();
  }

 private:
  /// Header and records before the points.
  [[nodiscard]] std::string beginning() const {
    std::string records;
    std::uint32_t count = 0;
    const auto add = [&](const std::string& user, std::uint16_t number, const std::string& body) {
      if (body.empty() || body.size() > 0xFFFF) return;
      records += las_record(user, number, body);
      ++count;
    };
    if (tree_) {
      records += copc_info_record();
      ++count;
    }
    // LAS 1.4 holds the coordinate system as well-known text; a code alone cannot be written there.
    const auto text = std::find_if(plan_.georeference.begin(), plan_.georeference.end(),
                                   [](const std::string& it) { return it.find('[') != std::string::npos; });
    if (text != plan_.georeference.end()) add("LASF_Projection", 2112, *text + '\0');
    add("LASF_Spec", 4, slots_.extra_bytes);
    if (plan_.centre) {
      std::string centre(24, '\0');
      put_las_vector(centre, 0, *plan_.centre);
      add(kLasCentreUser, kLasCentreNumber, centre);
    }
    const std::uint32_t chunks = tree_ ? laz::kVaryingChunks : kLazChunkPoints;
    if (!items_.empty()) add(kLasZipUser, kLasZipNumber, laz::laszip_record(items_, chunks));
    std::string header(kHeaderBytes14, '\0');
    header.replace(0, 4, "LASF");
    header[las_at::kMinorVersion - 1] = 1;
    header[las_at::kMinorVersion] = 4;
    header.replace(58, 5, "limen");
    put_las_number(header, las_at::kGlobalEncoding, kWktBit);
    put_las_number(header, las_at::kHeaderSize, static_cast<std::uint16_t>(kHeaderBytes14));
    put_las_number(header, las_at::kPointsBegin, static_cast<std::uint32_t>(kHeaderBytes14 + records.size()));
    put_las_number(header, las_at::kRecordCount, count);
    const auto format = static_cast<unsigned>(slots_.point_format) | (items_.empty() ? 0U : kPackedBit);
    header[las_at::kPointFormat] = static_cast<char>(format);
    put_las_number(header, las_at::kPointLength, static_cast<std::uint16_t>(slots_.point_bytes));
    put_las_vector(header, las_at::kScale, Vector3d::Constant(step_));
    put_las_vector(header, las_at::kOffset, offset_);
    return header + records;
  }

  /// What a unit of a colour or of an intensity in fractions is worth in 65535ths: by the largest values that
  /// the plan states, else by those of the first rows.
  void find_spreads(const RecordTable& rows) {
    spreads_.assign(plan_.columns.size(), 1.0);
    double largest = 0.0;
    bool integer = true;
    for (const LasSlot& slot : slots_.slots) {
      const ColumnPlan& column = plan_.columns[slot.column];
      const bool fraction = slot.at == 12 && slot.store == LasStore::word && !is_integer(column.type);
      if (slot.store != LasStore::colour && !fraction) continue;
      const double most = column.largest ? *column.largest : largest_value(rows, rows.fields[slot.column]);
      if (fraction) {
        spreads_[slot.column] = most > 0.0 && most <= 1.0 ? 65535.0 : 1.0;
      } else {
        largest = std::max(largest, most);
        integer = integer && is_integer(column.type);
      }
    }
    for (const LasSlot& slot : slots_.slots) {
      if (slot.store == LasStore::colour && plan_.columns[slot.column].type != Scalar::uint16)
        spreads_[slot.column] = 65535.0 / colour_top(largest, integer);
    }
  }

  void write_block(const RecordTable& rows, RowRange range) {
    records_.assign((range.end - range.begin) * slots_.point_bytes, '\0');
    Summary summary = parallel_reduce(
        range.end - range.begin, kEncodedPerPiece, Summary{},
        [&](std::size_t begin, std::size_t end) {
          Summary piece;
          for (std::size_t at = begin; at < end; at += kEncodedStrip) {
            const std::size_t stop = std::min(end, at + kEncodedStrip);
            encode(rows, {range.begin + at, range.begin + stop}, &records_[at * slots_.point_bytes], piece);
          }
          return piece;
        },
        [](Summary sum, const Summary& piece) {
          sum.add(piece);
          return sum;
        });
    if (summary.blank) leave_out_blanks(summary);
    if (summary.outside) {
      throw Error(fmt::format("a point lies more than {:.0f} km from {:.0f} {:.0f} {:.0f}, which "
                              "steps of {} m cannot reach",
                              step_ * 2147483.648, offset_.x(), offset_.y(), offset_.z(), step_),
                  name_, "write PLY, or leave out stray points");
    }
    summary_.add(summary);
    const std::string_view bytes(records_.data(), records_.size());
    packed_ ? packed_->write(bytes) : file_.write(bytes);
  }

  /// Takes out the records with a coordinate that was no number.
  void leave_out_blanks(Summary& summary) {
    const std::size_t bytes = slots_.point_bytes;
    std::size_t kept = 0;
    for (std::size_t at = 0; at < records_.size(); at += bytes) {
      std::array<std::int32_t, 3> place{};
      std::memcpy(place.data(), &records_[at], sizeof place);
      if (std::find(place.begin(), place.end(), kBlank) != place.end()) {
        --summary.points;
        --summary.returns[static_cast<unsigned char>(records_[at + 14]) & 15U];
        continue;
      }
      if (kept != at) std::memcpy(&records_[kept], &records_[at], bytes);
      kept += bytes;
    }
    records_.resize(kept);
  }

  void encode(const RecordTable& rows, RowRange range, char* records, Summary& summary) const {
    std::array<double, kEncodedStrip> values;  // NOLINT: filled below
    const ValueStrip strip{values.data(), range.end - range.begin, records, slots_.point_bytes};
    for (std::size_t i = 0; i < strip.count; ++i) records[i * strip.stride + 14] = 0x11;  // one return of one
    for (const LasSlot& slot : slots_.slots) {
      const Field& field = rows.fields[slot.column];
      if (slot.store == LasStore::extra && !rows.swapped && field.plain() && field.type == slot.type) {
        copy_column(field, range, records + slot.at);
        continue;
      }
      load_numbers(rows, field, range, values.data());
      store(strip, slot, summary);
    }
    summary.points += strip.count;
    for (std::size_t i = 0; i < strip.count; ++i)
      ++summary.returns[static_cast<unsigned char>(records[i * strip.stride + 14]) & 15U];
  }

  /// Numbers that are stored as they are, 64-bit integers too.
  void copy_column(const Field& field, RowRange range, char* to) const {
    const std::size_t bytes = size_of(field.type);
    const char* from = field.data + range.begin * field.stride;
    for (std::size_t i = range.begin; i < range.end; ++i, from += field.stride, to += slots_.point_bytes)
      std::memcpy(to, from, bytes);
  }

  void store(const ValueStrip& strip, const LasSlot& slot, Summary& summary) const {
    const double spread = spreads_[slot.column];
    switch (slot.store) {
      case LasStore::coordinate:
        return store_coordinate(strip, slot, summary);
      case LasStore::bits:
        return store_bits(strip, slot);
      case LasStore::byte:
        return strip.store(slot.at, clamped<std::uint8_t>);
      case LasStore::word:
      case LasStore::colour:
        return strip.store(slot.at, [&](double v) { return clamped<std::uint16_t>(spread * v + 0.5); });
      case LasStore::angle:
        return strip.store(slot.at,
                           [](double v) { return clamped<std::int16_t>(std::nearbyint(v / kLasAngleStep)); });
      case LasStore::time:
        for (std::size_t i = 0; i < strip.count; ++i) {
          summary.earliest = std::min(summary.earliest, strip.values[i]);
          summary.latest = std::max(summary.latest, strip.values[i]);
        }
        // Of points whose time nobody knows LAS says 0.
        return strip.store(slot.at, [](double value) { return std::isnan(value) ? 0.0 : value; });
      case LasStore::extra:
        return store_extra(strip, slot);
    }
  }

  void store_coordinate(const ValueStrip& strip, const LasSlot& slot, Summary& summary) const {
    const double offset = offset_[slot.axis];
    const double steps_per_m =
        std::nearbyint(1.0 / step_) * step_ == 1.0 ? std::nearbyint(1.0 / step_) : 1.0 / step_;
    const auto axis = static_cast<std::size_t>(slot.axis);
    std::int32_t low = summary.low[axis];
    std::int32_t high = summary.high[axis];
    bool inside = true;
    strip.store(slot.at, [&](double value) {
      const double steps = std::nearbyint((value - offset) * steps_per_m);
      const bool here = std::abs(steps) <= 2147483647.0;
      if (!here) {
        const bool number = std::isfinite(value);
        inside = inside && !number;
        summary.blank = summary.blank || !number;
        return kBlank;
      }
      const auto stored = static_cast<std::int32_t>(steps);
      low = std::min(low, stored);
      high = std::max(high, stored);
      return stored;
    });
    summary.low[axis] = low;
    summary.high[axis] = high;
    summary.outside = summary.outside || !inside;
  }

  void patch_header() {
    overwrite_las_number(file_, las_at::kCount, summary_.points);
    for (std::size_t k = 1; k < summary_.returns.size(); ++k)
      overwrite_las_number(file_, las_at::kReturns + 8 * (k - 1), summary_.returns[k]);
    for (std::size_t k = 0; k < 3 && summary_.points > 0; ++k) {
      const double offset = offset_[static_cast<int>(k)];
      overwrite_las_number(file_, las_at::kBounds + 16 * k, offset + step_ * summary_.high[k]);
      overwrite_las_number(file_, las_at::kBounds + 16 * k + 8, offset + step_ * summary_.low[k]);
    }
    // Seconds of a week cannot be negative or more than a week has: such times are of the other kind.
    const bool of_week = summary_.earliest >= 0.0 && summary_.latest <= kSecondsOfWeek;
    const bool timed = summary_.earliest <= summary_.latest;
    if (timed && !of_week)
      overwrite_las_number(file_, las_at::kGlobalEncoding, static_cast<std::uint16_t>(kWktBit | 1U));
  }

  using Items = std::vector<laz::ItemPlan>;
  static constexpr std::uint16_t kWktBit = 16;

  std::string name_;
  CloudPlan plan_;
  LasSlots slots_;
  bool tree_;    ///< a COPC
  Items items_;  ///< of packed points; else none
  AtomicFile file_;
  std::unique_ptr<PointPacker> packed_;
  double step_ = kCoarsestStep;
  Vector3d offset_ = Vector3d::Zero();
  std::vector<double> spreads_;  ///< per column; empty before the first rows
  std::vector<char> records_;
  Summary summary_;
};

}  // namespace

std::unique_ptr<CloudWriter> make_las_writer(const std::filesystem::path& path, const CloudPlan& plan) {
  return std::make_unique<LasWriter>(path, plan);
}

}  // namespace limen
