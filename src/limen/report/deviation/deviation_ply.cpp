// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/report/deviation/deviation_report.h"

namespace limen {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are in memory");

constexpr std::size_t kRecordBytes = 3 * sizeof(double) + 3 + sizeof(float) + sizeof(std::int32_t);
constexpr std::size_t kPiece = 16384;  // records written at once
constexpr Colour kOnNoFace{128, 128, 128};

std::string header(std::size_t points, double limit_m) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment limen deviation\n";
  text += fmt::format("comment full colour at {} m\nelement vertex {}\n", limit_m, points);
  for (const char* name : {"x", "y", "z"}) text += fmt::format("property double {}\n", name);
  for (const char* name : {"red", "green", "blue"}) text += fmt::format("property uchar {}\n", name);
  return text + "property float deviation_m\nproperty int element\nend_header\n";
}

template <typename Value>
char* put(char* at, const Value& value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

unsigned char mixed(double from, double to, double share) {
  return static_cast<unsigned char>(std::lround(from + share * (to - from)));
}

}  // namespace

Colour deviation_colour(double deviation_m, double limit_m) {
  constexpr double kMiddle = 240.0;
  const double share = std::min(1.0, std::abs(deviation_m) / limit_m);
  if (deviation_m < 0.0)
    return {mixed(kMiddle, 0.0, share), mixed(kMiddle, 80.0, share), mixed(kMiddle, 200.0, share)};
  return {mixed(kMiddle, 220.0, share), mixed(kMiddle, 90.0, share), mixed(kMiddle, 0.0, share)};
}

void write_deviation_points(const std::filesystem::path& path, std::size_t count,
                            const std::function<DeviationPoint(std::size_t)>& point, double colour_limit_m) {
  if (!(colour_limit_m > 0.0)) throw_bad_option("colour_limit_m", colour_limit_m, "more than 0");
  AtomicFile file(path);
  file.write(header(count, colour_limit_m));
  std::string bytes;
  for (std::size_t begin = 0; begin < count; begin += kPiece) {
    const std::size_t end = std::min(count, begin + kPiece);
    bytes.resize((end - begin) * kRecordBytes);
    char* at = bytes.data();
    for (std::size_t i = begin; i < end; ++i) {
      const DeviationPoint it = point(i);
      for (Eigen::Index k = 0; k < 3; ++k) at = put(at, it.x[k]);
      const Colour colour = std::isnan(it.deviation_m)
                                ? kOnNoFace
                                : deviation_colour(static_cast<double>(it.deviation_m), colour_limit_m);
      at = put(put(put(at, colour.red), colour.green), colour.blue);
      at = put(put(at, it.deviation_m), it.element);
    }
    file.write(bytes);
  }
  file.commit();
}

void write_deviation_ply(const std::filesystem::path& path, const Scan& scan, const DeviationReport& report,
                         double colour_limit_m) {
  const Deviation& deviation = report.deviation;
  const auto point = [&](std::size_t i) -> DeviationPoint {
    return {report.model_from_scan * (scan.local_origin + scan.points[i]), deviation.distance_m[i],
            deviation.element[i]};
  };
  write_deviation_points(path, scan.size(), point, colour_limit_m);
}

void write_deviation(const std::filesystem::path& folder, const DeviationReport& report,
                     const BimModel& model, const Scan& scan, double colour_limit_m) {
  const Sheet table = deviation_sheet(report, model);
  // The numbers first: the cloud is a thousand times larger. An earlier run's must not stand beside them.
  std::filesystem::remove(folder / "deviation.ply");
  write_files({{folder / "deviation.csv", csv_of(table)},
               {folder / "deviation.xlsx", workbook_of({table})},
               {folder / "deviation.json", deviation_json(report, model)}});
  write_deviation_ply(folder / "deviation.ply", scan, report, colour_limit_m);
}

}  // namespace limen
