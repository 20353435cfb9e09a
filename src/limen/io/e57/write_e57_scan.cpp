// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "limen/files/png.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_description.h"

namespace limen {
namespace {

constexpr double kPointsPerPixel = 4.0;

/// The intensities round the scanner, black to white; pixels without a point are like those beside them.
class PanoramaPainter {
 public:
  explicit PanoramaPainter(const Scan& scan)
      : height_(static_cast<std::size_t>(
            std::clamp(std::sqrt(static_cast<double>(scan.size()) / kPointsPerPixel / 2.0), 16.0, 1024.0))),
        sums_(2 * height_ * height_, 0.0),
        counts_(sums_.size(), 0.0) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const std::size_t at = pixel_of(scan.points[i] - scan.centre(i));
      sums_[at] += scan.intensities[i];
      counts_[at] += 1.0;
    }
  }

  E57Panorama painted() {
    while (fill()) {
    }
    double most = 0.0;
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      if (counts_[k] > 0.0) most = std::max(most, sums_[k] / counts_[k]);
    }
    std::vector<std::uint8_t> grey;
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const double share = counts_[k] > 0.0 && most > 0.0 ? sums_[k] / counts_[k] / most : 0.0;
      grey.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0))));
    }
    return {png_of_grey(grey, 2 * height_), 2 * height_, height_};
  }

 private:
  [[nodiscard]] std::size_t pixel_of(const Vector3d& way) const {
    const double right = 0.5 - 0.5 * std::atan2(way.y(), way.x()) / std::numbers::pi;
    const double down = 0.5 - std::atan2(way.z(), std::hypot(way.x(), way.y())) / std::numbers::pi;
    const auto cell = [](double share, std::size_t count) {
      return std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count)));
    };
    return 2 * height_ * cell(down, height_) + cell(right, 2 * height_);
  }

  /// Gives empty pixels the sum of their neighbours; false where none was given anything.
  bool fill() {
    const std::size_t width = 2 * height_;
    const std::vector<double> sums = sums_;
    const std::vector<double> counts = counts_;
    bool any = false;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      if (counts[k] > 0.0) continue;
      const std::size_t row = k / width * width;
      for (const std::size_t beside :
           {row + (k + 1) % width, row + (k + width - 1) % width, k >= width ? k - width : k,
            k + width < counts.size() ? k + width : k}) {
        sums_[k] += sums[beside];
        counts_[k] += counts[beside];
      }
      any = any || counts_[k] > 0.0;
    }
    return any;
  }

  std::size_t height_;
  std::vector<double> sums_;
  std::vector<double> counts_;
};

}  // namespace

void write_e57(const std::filesystem::path& path, const Scan& scan) {
  scan.check();
  CloudPlan plan;
  plan.name = scan.name;
  plan.columns = {{"x"}, {"y"}, {"z"}};
  plan.most_points = scan.size();
  plan.centre = scan.local_origin + scan.centre(0);
  const bool grey = !scan.intensities.empty();
  if (grey) plan.columns.push_back({"intensity", Scalar::float32});
  auto numbers = std::make_shared<std::vector<double>>();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d x = scan.local_origin + scan.points[i];
    numbers->insert(numbers->end(), {x.x(), x.y(), x.z()});
    if (grey) numbers->push_back(scan.intensities[i]);
  }
  std::vector<std::string> names;
  for (const ColumnPlan& column : plan.columns) names.push_back(column.name);
  E57StationsWriter file(path);
  file.begin_station(plan);
  file.write(table_of_numbers(std::move(numbers), names));
  if (grey) file.add(PanoramaPainter(scan).painted());
  file.finish();
}

}  // namespace limen
