// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/laid_scan.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "limen/base/parallel.h"
#include "limen/extract/cells/morton_order.h"

namespace limen {
namespace {

constexpr double kOrderM = 0.00125;
constexpr std::size_t kLaidPerPiece = 65536;

/// Points in one cube of the curve's order are sorted by their coordinates.
void settle_ties(CurvePlaces& sorted, const std::vector<Vector3d>& points) {
  const auto before = [&](const CurvePlace& a, const CurvePlace& b) {
    const Vector3d& p = points[a.index];
    const Vector3d& q = points[b.index];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::vector<std::size_t> starts;  // of pieces that part no cube
  for (std::size_t k = 0; k < sorted.size(); k += kLaidPerPiece) {
    std::size_t start = starts.empty() ? 0 : std::max(k, starts.back());
    while (start > 0 && start < sorted.size() && sorted[start].code == sorted[start - 1].code) ++start;
    starts.push_back(start);
  }
  starts.push_back(sorted.size());
  parallel_for(starts.size() - 1, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t begin = starts[first]; begin < starts[last];) {
      std::size_t end = begin + 1;
      while (end < sorted.size() && sorted[end].code == sorted[begin].code) ++end;
      if (end - begin > 1)
        std::stable_sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                         sorted.begin() + static_cast<std::ptrdiff_t>(end), before);
      begin = end;
    }
  });
}

/// values[i] for each i, made by `use` of the scan's value there.
template <typename Value, typename Use>
std::vector<Value> gathered(const std::vector<std::uint32_t>& indices, const Use& use) {
  std::vector<Value> values(indices.size());
  parallel_for(indices.size(), kLaidPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) values[k] = use(indices[k]);
  });
  return values;
}

/// Gives the memory of a list back.
template <typename List>
void drop(List& list) {
  List().swap(list);
}

/// Points brought into the order of the curve, and where they stood before.
std::vector<std::uint32_t> sort_along_curve(std::vector<Vector3d>& points) {
  CurvePlaces places = along_curve(points, kOrderM).places;
  settle_ties(places, points);
  std::vector<std::uint32_t> before(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) before[k] = places[k].index;
  drop(places);
  points = gathered<Vector3d>(before, [&](std::uint32_t i) { return points[i]; });
  return before;
}

/// `own`: the scan, where its memory may be given back; else null.
Scan lay(const Scan& scan, Scan* own, const ScanFrame& frame, const LayOptions& options) {
  const auto placed = [&](const Vector3d& x) { return Vector3d(frame.frame_from_scan * (x - frame.corner)); };
  Scan laid;
  laid.name = scan.name;
  laid.local_origin = scan.local_origin + frame.corner;
  laid.level = frame.upright;
  laid.centre_source = frame.place.source;
  const bool mobile = scan.mobile();
  const bool times = options.times && mobile && !scan.times_s.empty();
  std::optional<std::vector<std::uint32_t>> kept = kept_points(scan, frame, options.keep);
  if (own != nullptr) {
    drop(own->intensities);
    drop(own->colours);
    if (!times) drop(own->times_s);
    if (!options.lines) own->topology = {};
  }
  laid.points.resize(kept ? kept->size() : scan.size());
  parallel_for(laid.points.size(), kLaidPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) laid.points[k] = placed(scan.points[kept ? (*kept)[k] : k]);
  });
  if (own != nullptr) drop(own->points);
  std::vector<std::uint32_t> indices = sort_along_curve(laid.points);
  if (kept) {
    for (std::uint32_t& i : indices) i = (*kept)[i];
    drop(*kept);
  }
  if (mobile) {
    laid.centres = gathered<Vector3d>(indices, [&](std::uint32_t i) { return placed(scan.centres[i]); });
    if (own != nullptr) drop(own->centres);
    if (times) laid.times_s = gathered<double>(indices, [&](std::uint32_t i) { return scan.times_s[i]; });
  } else if (frame.place.source != PlaceSource::unknown) {
    laid.centres = {placed(frame.place.centre)};
  }
  if (options.lines && scan.topology.known()) {
    laid.topology.line =
        gathered<std::int32_t>(indices, [&](std::uint32_t i) { return scan.topology.line[i]; });
    laid.topology.index =
        gathered<std::int32_t>(indices, [&](std::uint32_t i) { return scan.topology.index[i]; });
  }
  return laid;
}

}  // namespace

Scan laid_in(const Scan& scan, const ScanFrame& frame, const LayOptions& options) {
  return lay(scan, nullptr, frame, options);
}

Scan laid_in(Scan&& scan, const ScanFrame& frame, const LayOptions& options) {
  Scan own = std::move(scan);
  return lay(own, &own, frame, options);
}

}  // namespace limen
