// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "limen/io/las/las.h"
#include "limen/io/las/las_fields.h"
#include "limen/io/las/las_records.h"
#include "limen/io/las/las_unit.h"

namespace limen {
namespace {

class LasStream : public PointStream {
 public:
  LasStream(std::unique_ptr<LasRecords> records, const LasLayout& layout, std::size_t stride)
      : records_(std::move(records)), layout_(layout), stride_(stride) {}

  std::optional<RecordTable> next(std::size_t most_rows) override {
    const LasPiece piece = records_->next(std::max<std::size_t>(most_rows, 1));
    if (piece.count == 0) return std::nullopt;
    return las_table(layout_, piece.data, piece.count, stride_);
  }

 private:
  std::unique_ptr<LasRecords> records_;
  LasLayout layout_;
  std::size_t stride_;
};

/// What the first points show: one sentence is all a user needs.
struct LasBeginning {
  bool withheld = false;  ///< some are marked so
  bool timed = false;     ///< some have a time: formats 6 to 10 have room for one in any case

  LasBeginning(const LasHeader& header, LasRecords& records) {
    constexpr std::size_t kLooked = 4096;
    const unsigned mask = las_is_long_format(header.point_format) ? 0x04U : 0x80U;
    const std::size_t time_at = las_gps_time_at(header.point_format);
    const LasPiece piece = records.next(kLooked);
    for (std::size_t i = 0; i < std::min(piece.count, kLooked); ++i) {
      const auto* const point = piece.data + i * header.point_bytes;
      withheld = withheld || (static_cast<unsigned char>(point[15]) & mask) != 0;
      double time_s = 0.0;
      if (time_at != 0) std::memcpy(&time_s, point + time_at, sizeof time_s);
      timed = timed || time_s != 0.0;
    }
  }
};

const char* stated_time(const LasHeader& header) {
  return (header.global_encoding & 1U) != 0
             ? "GPS times are adjusted standard times: seconds since 6 January 1980, less 1e9"
             : "GPS times are seconds of the GPS week, as the file says";
}

std::optional<Vector3d> stated_centre(const LasHeader& header) {
  const LasRecord* record = header.find(kLasCentreUser, kLasCentreNumber);
  if (record == nullptr || record->body.size() < 24) return {};
  const Vector3d centre = las_vector(record->body, 0);
  return centre.allFinite() ? std::optional(centre) : std::nullopt;
}

class LasFile : public PointFile {
 public:
  LasFile(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), header_(parse_las_header(bytes, name)), layout_(las_layout(header_)) {
    CloudFacts facts;
    facts.table.name = name;
    facts.points = header_.points;
    facts.table.centre = stated_centre(header_);
    facts.table.metres_per_unit = las_metres_per_unit(header_);
    for (const LasField& value : layout_.fields) facts.fields.push_back(value.field.name);
    facts.notes = header_.notes;
    facts.notes.insert(facts.notes.end(), layout_.notes.begin(), layout_.notes.end());
    // A damaged beginning is an error here, before anybody makes room for the points.
    const LasBeginning beginning(header_, *open_las_records(bytes_, name_, header_));
    if (beginning.timed) facts.notes.emplace_back(stated_time(header_));
    if (beginning.withheld) facts.notes.emplace_back("points that the file marks as withheld are kept");
    clouds_.push_back(std::move(facts));
  }

  [[nodiscard]] std::string format() const override { return las_format_name(header_); }
  [[nodiscard]] const std::vector<CloudFacts>& clouds() const override { return clouds_; }
  [[nodiscard]] std::unique_ptr<PointStream> read(std::size_t /*index*/) const override {
    return std::make_unique<LasStream>(open_las_records(bytes_, name_, header_), layout_,
                                       header_.point_bytes);
  }

 private:
  std::string_view bytes_;
  std::string name_;
  LasHeader header_;
  LasLayout layout_;
  std::vector<CloudFacts> clouds_;
};

}  // namespace

std::unique_ptr<PointFile> open_las(std::string_view bytes, const std::string& name) {
  return std::make_unique<LasFile>(bytes, name);
}

}  // namespace limen
