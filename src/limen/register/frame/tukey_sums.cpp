// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/tukey_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "limen/base/wide.h"

namespace limen {
namespace {

constexpr std::size_t kLanes = 4;
constexpr std::size_t kSums = 10;
constexpr std::size_t kBlock = 256;

struct Columns {
  const double* x;
  const double* y;
  const double* z;
};

struct Slab {
  double nx, ny, nz, offset;
  double inverse_width = 1.0;
};

LIMEN_WIDE void fill_distances(const Columns& at, std::size_t count, const Slab& slab, double* distance) {
  for (std::size_t i = 0; i < count; ++i)
    distance[i] = std::abs(slab.nx * at.x[i] + slab.ny * at.y[i] + slab.nz * at.z[i] - slab.offset);
}

/// Where the slab's plane is nearer than what is known, it is what is known.
LIMEN_WIDE void keep_nearer(const Columns& at, std::size_t count, const Slab& slab, double number,
                            double* nearest, double* label) {
  for (std::size_t i = 0; i < count; ++i) {
    const double off = std::abs(slab.nx * at.x[i] + slab.ny * at.y[i] + slab.nz * at.z[i] - slab.offset);
    const bool nearer = off < nearest[i];
    label[i] = nearer ? number : label[i];
    nearest[i] = nearer ? off : nearest[i];
  }
}

/// Several numbers in one, as GCC and Clang know them.
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

/// Of whole groups of lanes. Each lane sums its own, so that the result is the same however many the
/// processor takes at once.
LIMEN_WIDE void add_lanes(const Columns& at, std::size_t count, const Slab& slab,
                          std::array<Lanes, kSums>& sums) {
  std::array<Lanes, kSums> all = sums;
  for (std::size_t i = 0; i < count; i += kLanes) {
    Lanes x;
    Lanes y;
    Lanes z;
    std::memcpy(&x, at.x + i, sizeof x);
    std::memcpy(&y, at.y + i, sizeof y);
    std::memcpy(&z, at.z + i, sizeof z);
    const Lanes off = (slab.nx * x + slab.ny * y + slab.nz * z - slab.offset) * slab.inverse_width;
    const Lanes left = 1.0 - off * off;
    const Lanes root = left > 0.0 ? left : Lanes{};
    const Lanes weight = root * root;
    const Lanes wx = weight * x;
    const Lanes wy = weight * y;
    const Lanes wz = weight * z;
    all[0] += weight;
    all[1] += wx;
    all[2] += wy;
    all[3] += wz;
    all[4] += wx * x;
    all[5] += wx * y;
    all[6] += wx * z;
    all[7] += wy * y;
    all[8] += wy * z;
    all[9] += wz * z;
  }
  sums = all;
}

Slab slab_of(const Plane& plane, double width_m) {
  return {plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.offset, 1.0 / width_m};
}

}  // namespace

PointColumns near_plane(const PointColumns& points, const Plane& plane, double within_m) {
  const Slab slab = slab_of(plane, within_m);
  PointColumns near;
  std::array<double, kBlock> distance{};
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - begin);
    fill_distances({&points.x[begin], &points.y[begin], &points.z[begin]}, count, slab, distance.data());
    for (std::size_t k = 0; k < count; ++k) {
      if (distance[k] <= within_m) near.add(points.x[begin + k], points.y[begin + k], points.z[begin + k]);
    }
  }
  return near;
}

void label_nearest(const std::vector<Vector3d>& points, std::size_t begin, std::size_t end,
                   const std::vector<Plane>& planes, double within_m, std::vector<std::int32_t>& labels) {
  std::array<double, kBlock> x;
  std::array<double, kBlock> y;
  std::array<double, kBlock> z;
  std::array<double, kBlock> nearest;
  std::array<double, kBlock> label;
  for (std::size_t first = begin; first < end; first += kBlock) {
    const std::size_t count = std::min(kBlock, end - first);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = points[first + i].x();
      y[i] = points[first + i].y();
      z[i] = points[first + i].z();
    }
    nearest.fill(within_m);
    label.fill(-1.0);
    for (std::size_t k = 0; k < planes.size(); ++k)
      keep_nearer({x.data(), y.data(), z.data()}, count, slab_of(planes[k], 1.0), static_cast<double>(k),
                  nearest.data(), label.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (label[i] >= 0.0) labels[first + i] = static_cast<std::int32_t>(label[i]);
    }
  }
}

std::array<double, 10> tukey_sums(const PointColumns& points, const Plane& plane, double width_m) {
  const Slab slab = slab_of(plane, width_m);
  std::array<Lanes, kSums> lanes{};
  const std::size_t whole = points.size() / kLanes * kLanes;
  add_lanes({points.x.data(), points.y.data(), points.z.data()}, whole, slab, lanes);
  if (whole < points.size()) {
    // The last few, filled up with points too far to count.
    std::array<double, kLanes> x{};
    std::array<double, kLanes> y{};
    std::array<double, kLanes> z{};
    for (std::size_t k = 0; k < kLanes; ++k) {
      const bool real = whole + k < points.size();
      const Vector3d far = plane.normal * (plane.offset + 4.0 * width_m);
      x[k] = real ? points.x[whole + k] : far.x();
      y[k] = real ? points.y[whole + k] : far.y();
      z[k] = real ? points.z[whole + k] : far.z();
    }
    add_lanes({x.data(), y.data(), z.data()}, kLanes, slab, lanes);
  }
  std::array<double, kSums> sums{};
  for (std::size_t s = 0; s < kSums; ++s) {
    for (std::size_t k = 0; k < kLanes; ++k) sums[s] += lanes[s][k];
  }
  return sums;
}

}  // namespace limen
