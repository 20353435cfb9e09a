// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/polygon.h"

#include <algorithm>
#include <cmath>

namespace limen {

double signed_area(const Ring& ring) {
  if (ring.size() < 3) return 0.0;
  double twice = 0.0;
  Vector2d previous = ring.back() - ring.front();
  for (const Vector2d& p : ring) {
    const Vector2d current = p - ring.front();
    twice += previous.x() * current.y() - previous.y() * current.x();
    previous = current;
  }
  return 0.5 * twice;
}

double area(const Polygon& polygon) {
  double total = std::abs(signed_area(polygon.outer));
  for (const Ring& hole : polygon.holes) total -= std::abs(signed_area(hole));
  return total;
}

double area(const std::vector<Polygon>& polygons) {
  double total = 0.0;
  for (const Polygon& polygon : polygons) total += area(polygon);
  return total;
}

namespace {

/// Calls `take` with the x of every edge that crosses the line y.
template <typename Take>
void each_crossing(const Ring& ring, double y, const Take& take) {
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vector2d& a = ring[i];
    const Vector2d& b = ring[j];
    if ((a.y() > y) != (b.y() > y)) take((b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()) + a.x());
  }
}

}  // namespace

double outline_length(const Polygon& polygon) {
  const auto length = [](const Ring& ring) {
    double sum = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) sum += (ring[(i + 1) % ring.size()] - ring[i]).norm();
    return sum;
  };
  double sum = length(polygon.outer);
  for (const Ring& hole : polygon.holes) sum += length(hole);
  return sum;
}

bool contains(const Ring& ring, const Vector2d& p) {
  bool inside = false;
  each_crossing(ring, p.y(), [&](double x) { inside = inside != (p.x() < x); });
  return inside;
}

std::vector<double> crossings(const Polygon& polygon, double y) {
  std::vector<double> found;
  const auto take = [&](double x) { found.push_back(x); };
  each_crossing(polygon.outer, y, take);
  for (const Ring& hole : polygon.holes) each_crossing(hole, y, take);
  std::sort(found.begin(), found.end());
  return found;
}

bool contains(const Polygon& polygon, const Vector2d& p) {
  if (!contains(polygon.outer, p)) return false;
  for (const Ring& hole : polygon.holes) {
    if (contains(hole, p)) return false;
  }
  return true;
}

}  // namespace limen
