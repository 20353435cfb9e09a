// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/base/text.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_copy.h"
#include "limen/io/e57/e57_crc.h"
#include "limen/io/e57/e57_description.h"
#include "limen/io/e57/e57_pages.h"

namespace limen {
namespace {

constexpr std::size_t kLargestPacket = 65536;
constexpr std::uint64_t kE57PageBytes = 1024;
/// Rows of a packet: so that every column fills whole words.
constexpr std::size_t kRowStep = 64;
/// Integers reach so far from the pose.
constexpr double kReachM = 1e6;
/// Coordinates that need a finer step than this are stored as doubles.
constexpr double kFinestStepM = 1e-7;
constexpr std::string_view kNotFinite = "cartesianInvalidState";

struct KnownField {
  const char* theirs;
  std::initializer_list<const char*> ours;
  bool integer;  ///< only where the plan has integers
};

const std::array<KnownField, 11>& known_columns() {
  static const std::array<KnownField, 11> kKnown{
      {{"intensity", {"intensity", "scalar_intensity"}, false},
       {"colorRed", {"red", "r", "diffuse_red"}, false},
       {"colorGreen", {"green", "g", "diffuse_green"}, false},
       {"colorBlue", {"blue", "b", "diffuse_blue"}, false},
       {"timeStamp", {"gps_time", "gpstime", "scalar_gps_time"}, false},
       {"rowIndex", {"row_index", "scan_index"}, true},
       {"columnIndex", {"column_index", "scan_line"}, true},
       {"returnIndex", {"return_index"}, true},
       {"nor:normalX", {"nx"}, false},
       {"nor:normalY", {"ny"}, false},
       {"nor:normalZ", {"nz"}, false}}};
  return kKnown;
}

/// The name of the column in the file; standard names are given once, to the first that asks.
std::string file_name_of(const ColumnPlan& plan, std::vector<std::string>& taken) {
  const std::string lower = lower_case(plan.name);
  for (const KnownField& known : known_columns()) {
    const bool fits = !known.integer || is_integer(plan.type);
    const auto same = [&](const char* name) { return lower == name; };
    if (!fits || std::none_of(known.ours.begin(), known.ours.end(), same)) continue;
    if (std::find(taken.begin(), taken.end(), known.theirs) != taken.end()) continue;
    taken.emplace_back(known.theirs);
    return known.theirs;
  }
  return "limen:" + e57_escaped_name(plan.name);
}

void set_storage(E57Column& column, Scalar type) {
  column.storage = E57Storage::integer;
  with_type(type, [&](auto kind) {
    using Value = decltype(kind);
    if constexpr (std::is_floating_point_v<Value>) {
      column.storage = sizeof(Value) == 4 ? E57Storage::float32 : E57Storage::float64;
    } else {
      constexpr int kUnused = 64 - 8 * static_cast<int>(sizeof(Value));
      column.minimum = std::is_signed_v<Value> ? std::numeric_limits<std::int64_t>::min() >> kUnused : 0;
      // The format knows no integers from 2^63 on.
      if (sizeof(Value) < 8) column.maximum = static_cast<std::int64_t>(std::numeric_limits<Value>::max());
    }
  });
  column.bits = column.storage == E57Storage::float32 ? 32 : e57_bits(column.minimum, column.maximum);
}

E57Column coordinate_column(const char* name, double resolution_m) {
  E57Column column;
  column.name = name;
  const double step = resolution_m / 8.0;
  if (!(step >= kFinestStepM)) return column;
  column.storage = E57Storage::integer;
  column.scale = step;
  column.maximum = static_cast<std::int64_t>(std::ceil(kReachM / step));
  column.minimum = -column.maximum;
  column.bits = e57_bits(column.minimum, column.maximum);
  return column;
}

template <typename Value>
std::int64_t load_as(const char* from) {
  Value value{};
  std::memcpy(&value, from, sizeof value);
  return static_cast<std::int64_t>(value);
}

/// An integer as it lies in memory. One from 2^63 on becomes negative, which lies outside its column's
/// bounds.
std::int64_t load_integer(const char* from, Scalar type) {
  return with_type(type, [&](auto kind) { return load_as<decltype(kind)>(from); });
}

/// A section of bytes that mean something to others.
std::string e57_blob(const std::string& bytes) {
  const std::uint64_t length = 16 + bytes.size();
  std::string section(8, '\0');
  for (unsigned k = 0; k < 8; ++k) section += static_cast<char>((length >> (8 * k)) & 255U);
  return section + bytes;
}

/// Appends the nearest integer; false where there is none or it lies outside the column's bounds.
bool append_rounded(E57Encoder& encoder, double value) {
  constexpr double kLargest = 9.2e18;
  return std::abs(value) < kLargest && encoder.append_integer(std::llround(value));
}

}  // namespace

/// One scan on its way into a file.
class E57Section {
 public:
  /// `name`: of the file, for messages.
  E57Section(E57PageWriter& file, std::string name, CloudPlan plan);
  void write(const RecordTable& rows);
  /// Ends the section; gives what the file's description needs.
  E57Description finish();

 private:
  void plan_encoders();
  void check_table(const RecordTable& rows) const;
  void encode_points(const RecordTable& rows);
  void encode_column(const RecordTable& rows, std::size_t k);
  [[noreturn]] void refuse(std::size_t k, std::size_t row, double value) const;
  void put_packet(std::size_t rows);
  [[nodiscard]] E57Description description() const;
  [[nodiscard]] double shift_of(const std::string& lower_name) const;

  std::string name_;
  CloudPlan plan_;
  Vector3d shift_;
  E57PageWriter& file_;
  std::uint64_t page_;     ///< of the section's head
  std::uint64_t logical_;  ///< where it begins
  std::uint64_t physical_;
  std::vector<E57Encoder> encoders_;  ///< one per column of the plan, then the state of the points
  std::array<E57Range, 3> bounds_;    ///< of the points that are numbers, about the shift
  std::size_t packet_rows_ = 0;
  std::uint64_t rows_ = 0;
  std::size_t waiting_rows_ = 0;  ///< encoded, not yet in a packet
  std::uint64_t digest_ = 0;      ///< of all that was written: makes the names (GUIDs) of file and scan
};

E57Section::E57Section(E57PageWriter& file, std::string name, CloudPlan plan)
    : name_(std::move(name)),
      plan_(std::move(plan)),
      shift_(plan_.centre.value_or(plan_.near)),
      file_(file),
      page_(file.keep_page()),
      logical_(file.logical()),
      physical_(file.physical()) {
  const bool sound = plan_.columns.size() >= 3 && lower_case(plan_.columns[0].name) == "x" &&
                     lower_case(plan_.columns[1].name) == "y" && lower_case(plan_.columns[2].name) == "z";
  if (!sound) throw Error("the first columns are not x, y and z", name_, "", Fault::internal);
  plan_encoders();
  std::size_t bits = 0;
  for (const E57Encoder& encoder : encoders_) bits += encoder.column().bits;
  const std::size_t room = kLargestPacket - 8 - 2 * std::min<std::size_t>(encoders_.size(), 16384);
  packet_rows_ = room / (kRowStep / 8 * bits) * kRowStep;
  if (packet_rows_ == 0) {
    throw Error(fmt::format("{} values per point are too many for an E57 file", plan_.columns.size()), name_,
                "write the points as PLY");
  }
  file_.append(std::string(kE57SectionHeaderBytes, '\0'));
}

void E57Section::plan_encoders() {
  static constexpr std::array<const char*, 3> kCoordinates{"cartesianX", "cartesianY", "cartesianZ"};
  std::vector<std::string> taken;
  for (std::size_t k = 0; k < plan_.columns.size(); ++k) {
    if (k < 3) {
      encoders_.emplace_back(coordinate_column(kCoordinates[k], plan_.resolution_m));
      continue;
    }
    E57Column column;
    column.name = file_name_of(plan_.columns[k], taken);
    const bool moved = shift_of(lower_case(plan_.columns[k].name)) != 0.0;
    set_storage(column, moved ? Scalar::float64 : plan_.columns[k].type);
    encoders_.emplace_back(std::move(column));
  }
  E57Column state;
  state.name = kNotFinite;
  state.storage = E57Storage::integer;
  state.minimum = 0;
  state.maximum = 2;
  state.bits = 2;
  encoders_.emplace_back(std::move(state));
}

/// What is taken off a column of the plan: coordinates of scanner positions are stored about the pose too.
double E57Section::shift_of(const std::string& lower_name) const {
  constexpr std::array<std::string_view, 3> kCentre{"x_origin", "y_origin", "z_origin"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (lower_name == kCentre[k]) return shift_[static_cast<int>(k)];
  }
  return 0.0;
}

void E57Section::check_table(const RecordTable& rows) const {
  bool same = rows.fields.size() == plan_.columns.size();
  for (std::size_t k = 0; same && k < rows.fields.size(); ++k)
    same = rows.fields[k].name == lower_case(plan_.columns[k].name);
  if (!same) throw Error("the columns are not those of the plan", name_, "", Fault::internal);
}

void E57Section::refuse(std::size_t k, std::size_t row, double value) const {
  throw Error(
      fmt::format("{} of point {} is {}, which does not fit ({} to {})", plan_.columns[k].name,
                  rows_ + row + 1, value, encoders_[k].column().minimum, encoders_[k].column().maximum),
      name_, "write the points as PLY, or correct the values");
}

void E57Section::encode_points(const RecordTable& rows) {
  std::vector<Vector3d> points(rows.rows);
  for (std::size_t k = 0; k < 3; ++k) {
    load_numbers(rows, rows.fields[k], {0, rows.rows}, points.empty() ? nullptr : points[0].data() + k, 3);
  }
  E57Encoder& state = encoders_.back();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool valid = points[i].allFinite();
    const Vector3d x = valid ? Vector3d(points[i] - shift_) : Vector3d::Zero();
    (void)state.append_integer(valid ? 0 : 2);
    for (std::size_t k = 0; k < 3; ++k) {
      const double coordinate = x[static_cast<int>(k)];
      if (valid) bounds_[k].add(coordinate);
      E57Encoder& encoder = encoders_[k];
      if (encoder.column().storage != E57Storage::integer) {
        encoder.append(coordinate);
      } else if (!append_rounded(encoder, coordinate / encoder.column().scale)) {
        throw Error(
            fmt::format("point {} lies more than {:.0f} km from the others", rows_ + i + 1, kReachM / 1e3),
            name_, "check the source's coordinates");
      }
    }
  }
}

void E57Section::encode_column(const RecordTable& rows, std::size_t k) {
  const Field& field = rows.fields[k];
  E57Encoder& encoder = encoders_[k];
  if (encoder.column().storage == E57Storage::integer && field.plain() && is_integer(field.type) &&
      !rows.swapped) {
    for (std::size_t i = 0; i < rows.rows; ++i) {
      const std::int64_t value = load_integer(field.data + i * field.stride, field.type);
      if (!encoder.append_integer(value)) refuse(k, i, static_cast<double>(value));
    }
    return;
  }
  constexpr std::size_t kStrip = 4096;
  std::array<double, kStrip> strip{};
  const double shift = shift_of(field.name);
  for (std::size_t begin = 0; begin < rows.rows; begin += kStrip) {
    const std::size_t end = std::min(rows.rows, begin + kStrip);
    load_numbers(rows, field, {begin, end}, strip.data());
    for (std::size_t i = begin; i < end; ++i) {
      const double value = strip[i - begin] - shift;
      if (encoder.column().storage != E57Storage::integer) {
        encoder.append(value);
      } else if (!append_rounded(encoder, value)) {
        refuse(k, i, value);
      }
    }
  }
}

void E57Section::write(const RecordTable& rows) {
  check_table(rows);
  // The points are one task, each further column is another.
  parallel_for(rows.fields.size() - 2, 1, [&](std::size_t task, std::size_t) {
    if (task == 0) {
      encode_points(rows);
    } else {
      encode_column(rows, task + 2);
    }
  });
  rows_ += rows.rows;
  waiting_rows_ += rows.rows;
  while (waiting_rows_ >= packet_rows_) put_packet(packet_rows_);
  for (E57Encoder& encoder : encoders_) encoder.forget_taken();
}

void E57Section::put_packet(std::size_t rows) {
  std::vector<std::string_view> streams;
  std::size_t length = 6 + 2 * encoders_.size();
  for (E57Encoder& encoder : encoders_) {
    streams.push_back(encoder.take((rows * encoder.column().bits + 7) / 8));
    length += streams.back().size();
  }
  const std::size_t padded = (length + 3) / 4 * 4;
  std::string packet{1, 0};
  const auto append_16 = [&](std::size_t value) {
    packet += static_cast<char>(value & 255U);
    packet += static_cast<char>(value >> 8U);
  };
  append_16(padded - 1);
  append_16(streams.size());
  for (const std::string_view stream : streams) append_16(stream.size());
  for (const std::string_view stream : streams) packet.append(stream);
  packet.resize(padded, '\0');
  digest_ = mix64(digest_ ^ crc32c(packet));
  file_.append(packet);
  waiting_rows_ -= rows;
}

E57Description E57Section::description() const {
  E57Description about;
  about.name = plan_.name;
  about.georeference = plan_.georeference;
  about.shift = shift_;
  about.centre_known = plan_.centre.has_value();
  about.bounds = bounds_;
  about.points = rows_;
  about.section = physical_;
  about.digest = mix64(digest_ ^ rows_);
  for (const E57Encoder& encoder : encoders_) {
    about.columns.push_back(encoder.column());
    about.ranges.push_back(encoder.range());
  }
  return about;
}

E57Description E57Section::finish() {
  for (E57Encoder& encoder : encoders_) encoder.finish();
  if (waiting_rows_ > 0) put_packet(waiting_rows_);
  const std::string section =
      e57_section_header(file_.logical() - logical_, physical_ + kE57SectionHeaderBytes);
  file_.replace(page_, physical_ % kE57PageBytes, section);
  return description();
}

E57StationsWriter::E57StationsWriter(const std::filesystem::path& path)
    : name_(path.string()), file_(std::make_unique<E57PageWriter>(path)) {}
E57StationsWriter::~E57StationsWriter() = default;

void E57StationsWriter::begin_station(const CloudPlan& plan) {
  end_station();
  // The head of a section is known at its end: it must not lie in two pages.
  if (!stations_.empty()) file_->fill_page();
  station_ = std::make_unique<E57Section>(*file_, name_, plan);
}

void E57StationsWriter::write(const RecordTable& rows) {
  if (!station_) throw Error("rows came before the first station", name_, "", Fault::internal);
  station_->write(rows);
}

void E57StationsWriter::add(E57Panorama panorama) {
  panorama_ = std::make_unique<E57Panorama>(std::move(panorama));
}

void E57StationsWriter::end_station() {
  if (!station_) return;
  const E57Description about = station_->finish();
  stations_.push_back(e57_entry(about));
  station_.reset();
  if (!panorama_) return;
  const std::uint64_t section = file_->physical();
  file_->append(e57_blob(panorama_->png));
  file_->fill_word();
  stations_.back().images = e57_panorama_xml(about, *panorama_, section);
  panorama_.reset();
}

void E57StationsWriter::copy(const E57Original& from, std::size_t scan, const Rigid3& target_from_source,
                             const std::string& wkt, Monitor& monitor) {
  end_station();
  stations_.push_back(from.copy(scan, target_from_source, *file_, monitor));
  if (!wkt.empty()) stations_.back().georeference = {wkt};
}

void E57StationsWriter::finish() {
  end_station();
  E57Head head;
  head.xml_offset = file_->physical();
  const std::string xml = e57_description_xml(stations_);
  head.xml_bytes = xml.size();
  file_->append(xml);
  file_->finish(head);
}

namespace {

class E57Writer : public CloudWriter {
 public:
  E57Writer(const std::filesystem::path& path, const CloudPlan& plan) : file_(path) {
    file_.begin_station(plan);
  }
  void write(const RecordTable& rows) override { file_.write(rows); }
  void finish() override { file_.finish(); }

 private:
  E57StationsWriter file_;
};

}  // namespace

std::unique_ptr<CloudWriter> make_e57_writer(const std::filesystem::path& path, const CloudPlan& plan) {
  return std::make_unique<E57Writer>(path, plan);
}

}  // namespace limen
