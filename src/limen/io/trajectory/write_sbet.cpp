// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/trajectory/write_sbet.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/files/mapped_file.h"

namespace limen {
namespace {

constexpr std::size_t kTime = 0;
constexpr std::size_t kLatitude = 1;
constexpr std::size_t kLongitude = 2;
constexpr std::size_t kHeight = 3;
constexpr std::size_t kSpeed = 4;
constexpr std::size_t kRoll = 7;
constexpr std::size_t kPitch = 8;
constexpr std::size_t kHeading = 9;
constexpr std::size_t kWander = 10;

/// East, north, up from forward, right, down.
Matrix3d grid_from_body(double roll, double pitch, double heading) {
  Matrix3d enu_from_ned;
  enu_from_ned << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  return enu_from_ned * rotation_exp({0.0, 0.0, heading}) * rotation_exp({0.0, pitch, 0.0}) *
         rotation_exp({roll, 0.0, 0.0});
}

/// Roll, pitch and heading of such a turn.
Vector3d attitude_of(const Matrix3d& grid_from_body) {
  Matrix3d ned_from_enu;
  ned_from_enu << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  const Matrix3d turn = ned_from_enu * grid_from_body;
  return {std::atan2(turn(2, 1), turn(2, 2)), -std::asin(std::clamp(turn(2, 0), -1.0, 1.0)),
          std::atan2(turn(1, 0), turn(0, 0))};
}

}  // namespace

std::vector<SbetRecord> read_sbet_records(const std::filesystem::path& path) {
  const MappedFile file(path);
  constexpr std::size_t kBytes = sizeof(SbetRecord);
  if (file.bytes().size() % kBytes != 0)
    throw Error(fmt::format("{} bytes are not a whole number of SBET records", file.bytes().size()),
                path.string(), "give the SBET");
  std::vector<SbetRecord> records(file.bytes().size() / kBytes);
  for (std::size_t i = 0; i < records.size(); ++i)
    std::memcpy(records[i].data(), file.bytes().data() + i * kBytes, kBytes);
  return records;
}

std::string sbet_bytes(const std::vector<SbetRecord>& records) {
  std::string bytes(records.size() * sizeof(SbetRecord), '\0');
  for (std::size_t i = 0; i < records.size(); ++i)
    std::memcpy(bytes.data() + i * sizeof(SbetRecord), records[i].data(), sizeof(SbetRecord));
  return bytes;
}

std::vector<SbetRecord> moved_records(const std::vector<SbetRecord>& records, const MapProjection& source,
                                      const MapProjection& target, const SbetMotion& motion) {
  std::vector<SbetRecord> moved = records;
  for (SbetRecord& it : moved) {
    const double latitude = it[kLatitude];
    const double longitude = it[kLongitude];
    Vector3d x = motion.frame_from_map * source.to_map(latitude, longitude, it[kHeight]);
    Matrix3d turn = motion.frame_from_map.rotation;
    if (motion.bend != nullptr) {
      const Rigid3 bent = motion.bend->at(it[kTime]);
      x = bent * x;
      turn = bent.rotation * turn;
    }
    const Vector3d place = target.from_map(x);
    // Headings on the map are those from true north less the heading of the map's own north.
    const double heading =
        it[kHeading] - it[kWander] - source.convergence_rad(latitude, longitude, it[kHeight]);
    const Vector3d attitude = attitude_of(turn * grid_from_body(it[kRoll], it[kPitch], heading));
    it[kLatitude] = place.x();
    it[kLongitude] = place.y();
    it[kHeight] = place.z();
    it[kRoll] = attitude.x();
    it[kPitch] = attitude.y();
    it[kHeading] = attitude.z() + target.convergence_rad(place.x(), place.y(), place.z()) + it[kWander];
  }
  return moved;
}

std::vector<SbetRecord> records_of_places(const std::vector<TimedPlace>& places, const MapProjection& map) {
  std::vector<SbetRecord> records;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const TimedPlace& before = places[k == 0 ? 0 : k - 1];
    const TimedPlace& after = places[std::min(k + 1, places.size() - 1)];
    const Vector3d place = map.from_map(places[k].x);
    const double seconds = after.time_s - before.time_s;
    const Vector3d speed = seconds > 0.0 ? Vector3d((after.x - before.x) / seconds) : Vector3d::Zero();
    SbetRecord record{};
    record[kTime] = places[k].time_s;
    record[kLatitude] = place.x();
    record[kLongitude] = place.y();
    record[kHeight] = place.z();
    const double convergence = map.convergence_rad(place.x(), place.y(), place.z());
    const double heading = std::atan2(speed.x(), speed.y()) + convergence;
    const double along = speed.head<2>().norm();
    record[kSpeed] = along * std::cos(heading);  // north
    record[kSpeed + 1] = along * std::sin(heading);
    record[kSpeed + 2] = -speed.z();
    record[kHeading] = heading;
    records.push_back(record);
  }
  return records;
}

}  // namespace limen
