// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr double kTileSpacings = 6.0;  // edge of a tile in units of the plane's mean spacing
constexpr double kReach = 1.8;         // radius of a disc in units of the spacing
constexpr double kMostPixels = 6.0e6;
constexpr double kMostTiles = 1.0e6;
constexpr double kFinestPixel_m = 0.008;
constexpr double kWidestSpacing_m = 0.15;
constexpr double kPixel = 0.6;  // in units of the spacing where points are densest

}  // namespace

PlaneImage::PlaneImage(const std::vector<Vector3d>& points, const std::vector<std::uint32_t>& indices,
                       const PlaneFrame& frame, double area_m2)
    : frame_(frame) {
  for (const std::uint32_t i : indices) box_.add(frame_.to_plane(points[i]));
  if (indices.empty()) box_.add(Vector2d::Zero());
  const Vector2d size = box_.high - box_.low;
  const double covered_m2 = area_m2 > 0.0 ? area_m2 : size.prod();
  const double mean_m = std::clamp(std::sqrt(covered_m2 / std::max(1.0, static_cast<double>(indices.size()))),
                                   0.002, kWidestSpacing_m);
  sort_points(points, indices, mean_m);
  measure_spacing(mean_m);
  fill();
}

std::size_t PlaneImage::tile(const Vector2d& p) const {
  const Vector2d at = (p - box_.low) / tile_m_;
  const long column = std::clamp(static_cast<long>(at.x()), 0L, tile_columns_ - 1);
  const long row = std::clamp(static_cast<long>(at.y()), 0L, tile_rows_ - 1);
  return static_cast<std::size_t>(row * tile_columns_ + column);
}

void PlaneImage::sort_points(const std::vector<Vector3d>& points, const std::vector<std::uint32_t>& indices,
                             double spacing_m) {
  const Vector2d size = box_.high - box_.low;
  tile_m_ = std::max(
      {kTileSpacings * spacing_m, std::sqrt(size.prod() / kMostTiles), size.maxCoeff() / kMostTiles});
  tile_columns_ = static_cast<long>(size.x() / tile_m_) + 1;
  tile_rows_ = static_cast<long>(size.y() / tile_m_) + 1;
  std::vector<FlatPoint> flat;
  flat.reserve(indices.size());
  begins_.assign(static_cast<std::size_t>(tile_columns_ * tile_rows_) + 1, 0);
  for (const std::uint32_t i : indices) {
    flat.push_back({frame_.to_plane(points[i]), i});
    ++begins_[tile(flat.back().at) + 1];
  }
  for (std::size_t k = 1; k < begins_.size(); ++k) begins_[k] += begins_[k - 1];
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  flat_.resize(flat.size());
  for (const FlatPoint& point : flat) flat_[next[tile(point.at)]++] = point;
}

/// How much further apart the rows of a tile's points are than its points on average: at random the nearest
/// neighbour is half that average away, in rows far apart it is much nearer.
double PlaneImage::elongation(std::size_t tile) const {
  constexpr std::uint32_t kAsked = 12;
  constexpr double kMost = 2.0;
  const std::uint32_t begin = begins_[tile];
  const std::uint32_t end = begins_[tile + 1];
  if (end - begin < 6) return 1.0;
  const std::uint32_t step = 1 + (end - begin) / kAsked;
  double sum = 0.0;
  double asked = 0.0;
  for (std::uint32_t i = begin; i < end; i += step, asked += 1.0) {
    double least = tile_m_ * tile_m_;
    for (std::uint32_t j = begin; j < end; ++j)
      if (j != i) least = std::min(least, (flat_[i].at - flat_[j].at).squaredNorm());
    sum += std::sqrt(least);
  }
  const double mean = tile_m_ / std::sqrt(static_cast<double>(end - begin));
  return std::clamp(0.5 * mean * asked / std::max(sum, 1e-6), 1.0, kMost);
}

/// A tile at a border is half empty: the densest of a tile and those around it tells.
void PlaneImage::measure_spacing(double fallback_m) {
  std::vector<float> own(begins_.size() - 1);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const double count = begins_[k + 1] - begins_[k];
    own[k] = static_cast<float>(count < 2.0 ? kWidestSpacing_m : tile_m_ / std::sqrt(count) * elongation(k));
  }
  spacing_m_.resize(own.size());
  for (long row = 0; row < tile_rows_; ++row) {
    for (long column = 0; column < tile_columns_; ++column) {
      float least = static_cast<float>(std::max(kWidestSpacing_m, fallback_m));
      for (long r = std::max(0L, row - 1); r <= std::min(tile_rows_ - 1, row + 1); ++r)
        for (long c = std::max(0L, column - 1); c <= std::min(tile_columns_ - 1, column + 1); ++c)
          least = std::min(least, own[static_cast<std::size_t>(r * tile_columns_ + c)]);
      spacing_m_[static_cast<std::size_t>(row * tile_columns_ + column)] = least;
    }
  }
}

double PlaneImage::spacing_m(const Vector2d& p) const {
  return static_cast<double>(spacing_m_[tile(p)]);
}

double PlaneImage::reach_m(const Vector2d& p) const {
  return kReach * spacing_m(p) + 0.5 * pixel_m_;
}

/// A pixel is a little finer than the points are where they are densest.
double PlaneImage::finest_pixel_m() const {
  std::vector<float> sorted;
  for (std::size_t k = 0; k + 1 < begins_.size(); ++k)
    if (begins_[k + 1] > begins_[k]) sorted.push_back(spacing_m_[k]);
  if (sorted.empty()) return kFinestPixel_m;
  return std::max(kFinestPixel_m, kPixel * static_cast<double>(ranked(sorted, sorted.size() / 10)));
}

void PlaneImage::fill() {
  const double rim_m = kReach * kWidestSpacing_m;
  const Vector2d size = (box_.high - box_.low).array() + 2.0 * rim_m;
  pixel_m_ =
      std::max({finest_pixel_m(), std::sqrt(size.prod() / kMostPixels), size.maxCoeff() / kMostPixels});
  image_low_ = box_.low.array() - rim_m - 2.0 * pixel_m_;
  columns_ = static_cast<long>(size.x() / pixel_m_) + 5;
  rows_ = static_cast<long>(size.y() / pixel_m_) + 5;
  pixels_.assign(static_cast<std::size_t>(columns_ * rows_), 0);
  for (const FlatPoint& point : flat_) stamp(point.at, reach_m(point.at));
}

void PlaneImage::stamp(const Vector2d& p, double radius_m) {
  const Vector2d middle = (p - image_low_) / pixel_m_;
  const double radius = radius_m / pixel_m_;
  const long last = std::min(rows_ - 2, static_cast<long>(middle.y() + radius));
  for (long row = std::max(1L, static_cast<long>(middle.y() - radius)); row <= last; ++row) {
    const double off = static_cast<double>(row) + 0.5 - middle.y();
    const double half2 = radius * radius - off * off;
    if (half2 <= 0.0) continue;
    const double half = std::sqrt(half2);
    // The pixels whose middle is in the disc.
    const long from = std::max(1L, static_cast<long>(std::ceil(middle.x() - half - 0.5)));
    const long to = std::min(columns_ - 2, static_cast<long>(std::floor(middle.x() + half - 0.5)));
    if (to >= from)
      std::memset(&pixels_[static_cast<std::size_t>(row * columns_ + from)], 1,
                  static_cast<std::size_t>(to - from + 1));
  }
}

bool PlaneImage::filled(long column, long row) const {
  return column >= 0 && row >= 0 && column < columns_ && row < rows_ &&
         pixels_[static_cast<std::size_t>(row * columns_ + column)] != 0;
}

bool PlaneImage::covered(const Vector2d& p) const {
  const Vector2d at = (p - image_low_) / pixel_m_;
  return filled(static_cast<long>(std::floor(at.x())), static_cast<long>(std::floor(at.y())));
}

/// Walks along the pixels' edges with the filled side to the left, from the lower edge of a filled pixel over
/// an empty one. `seen` marks such edges. Where two filled pixels touch at a corner they stay apart.
Ring PlaneImage::trace(long column, long row, std::vector<char>& seen) const {
  // Heading 0: +x, 1: +y, 2: -x, 3: -y; (x, y): the lattice point the edge begins at.
  constexpr std::array<long, 4> kX = {1, 0, -1, 0};
  constexpr std::array<long, 4> kY = {0, 1, 0, -1};
  // The pixels ahead, to the left and to the right of a lattice point, by heading.
  constexpr std::array<long, 4> kLeftX = {0, -1, -1, 0};
  constexpr std::array<long, 4> kLeftY = {0, 0, -1, -1};
  constexpr std::array<long, 4> kRightX = {0, 0, -1, -1};
  constexpr std::array<long, 4> kRightY = {-1, 0, 0, -1};
  Ring ring;
  long x = column;
  long y = row;
  std::size_t heading = 0;
  do {
    if (heading == 0) seen[static_cast<std::size_t>(y * columns_ + x)] = 1;
    ring.push_back(image_low_ +
                   pixel_m_ * Vector2d(static_cast<double>(x) + 0.5 * static_cast<double>(kX[heading]),
                                       static_cast<double>(y) + 0.5 * static_cast<double>(kY[heading])));
    x += kX[heading];
    y += kY[heading];
    if (!filled(x + kLeftX[heading], y + kLeftY[heading])) {
      heading = (heading + 1) % 4;
    } else if (filled(x + kRightX[heading], y + kRightY[heading])) {
      heading = (heading + 3) % 4;
    }
  } while (x != column || y != row || heading != 0);
  return ring;
}

std::vector<Ring> PlaneImage::contours() const {
  std::vector<Ring> rings;
  std::vector<char> seen(pixels_.size(), 0);
  for (long row = 1; row < rows_; ++row) {
    for (long column = 1; column < columns_; ++column) {
      const auto at = static_cast<std::size_t>(row * columns_ + column);
      if (pixels_[at] == 0 || pixels_[at - static_cast<std::size_t>(columns_)] != 0 || seen[at] != 0)
        continue;
      rings.push_back(trace(column, row, seen));
    }
  }
  return rings;
}

std::vector<FlatPoint> PlaneImage::points_in(const Strip& strip) const {
  const double middle_t = 0.5 * (strip.begin_m + strip.end_m);
  const double middle_h = 0.5 * (strip.low_m + strip.high_m);
  const double half_t = 0.5 * (strip.end_m - strip.begin_m);
  const double half_h = 0.5 * (strip.high_m - strip.low_m);
  const Vector2d middle = strip.at(middle_t, middle_h);
  const Vector2d inward = strip.inward();
  // Tiles are walked along the strip's steeper axis, a few across.
  const bool upright = std::abs(strip.along.y()) > std::abs(strip.along.x());
  const Eigen::Index main = upright ? 1 : 0;
  const Eigen::Index side = 1 - main;
  const double reach_main = half_t * std::abs(strip.along[main]) + half_h * std::abs(inward[main]);
  const double slope = strip.along[side] / strip.along[main];
  const double reach_side = half_h / std::abs(strip.along[main]) + tile_m_ * std::abs(slope);
  const auto index = [&](double value, Eigen::Index axis) {
    return static_cast<long>(std::floor((value - box_.low[axis]) / tile_m_));
  };
  const long mains = upright ? tile_rows_ : tile_columns_;
  const long sides = upright ? tile_columns_ : tile_rows_;
  std::vector<FlatPoint> found;
  for (long m = std::max(0L, index(middle[main] - reach_main, main));
       m <= std::min(mains - 1, index(middle[main] + reach_main, main)); ++m) {
    const double along = box_.low[main] + (static_cast<double>(m) + 0.5) * tile_m_ - middle[main];
    const double centre = middle[side] + slope * along;
    for (long s = std::max(0L, index(centre - reach_side, side));
         s <= std::min(sides - 1, index(centre + reach_side, side)); ++s) {
      const auto k = static_cast<std::size_t>(upright ? m * tile_columns_ + s : s * tile_columns_ + m);
      for (std::uint32_t i = begins_[k]; i < begins_[k + 1]; ++i) {
        const Vector2d off = flat_[i].at - middle;
        if (std::abs(off.dot(strip.along)) <= half_t && std::abs(off.dot(inward)) <= half_h)
          found.push_back(flat_[i]);
      }
    }
  }
  return found;
}

}  // namespace limen
