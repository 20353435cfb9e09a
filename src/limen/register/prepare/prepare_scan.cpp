// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/prepare_scan.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/extract/cells/morton_order.h"
#include "limen/match/planes/polygon_distance.h"
#include "limen/sight/panorama.h"
#include "limen/sight/voxel_map.h"

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

namespace {

constexpr double kFramed = 0.1;  // shares of the work, about, by which progress is reported
constexpr double kExtracted = 0.75;
constexpr double kSpaceKnown = 0.85;
constexpr double kFlatNoise = 1.6;    // noise, and what its estimate is off
constexpr double kFlattestM = 0.005;  // largest scatter of a piece that is flat but for the noise
constexpr double kRoundestM = 0.015;
constexpr double kReachM = 0.3;  // beyond the samples

/// Up to which scatter a piece is flat but for the noise.
double flat_scatter(double noise_m) {
  return std::clamp(kFlatNoise * noise_m, kFlattestM, kRoundestM);
}

/// What rays of the scan passed and met.
std::shared_ptr<const SpaceView> space_of(const Scan& laid, const ExtractedFeatures& extracted) {
  if (laid.centres.size() == 1)
    return std::make_shared<Panorama>(laid, extracted.labels, extracted.features, laid.centre(0));
  return std::make_shared<VoxelMap>(laid, extracted.features);
}

/// The view of space, the openings, and the segments of a scan in its frame. Neither of the first two needs
/// the other: what one does alone is done beside the other.
void look_around(const Scan& laid, const PrepareOptions& options, PreparedScan& prepared, Monitor& monitor) {
  Features& features = prepared.extracted.features;
  if (laid.centres.size() == 1) prepared.stations = laid.centres;
  if (!options.planes_only) {
    std::vector<Opening> openings;
    run_both(
        [&] {
          if (prepared.upright && laid.centre_known())
            openings = find_openings(laid, prepared.extracted, Vector3d::UnitZ(), options.openings, monitor);
        },
        [&] {
          prepared.space = space_of(laid, prepared.extracted);
          if (!laid.mobile())
            prepared.details = find_surface_details(laid, prepared.extracted.labels, features.planes,
                                                    flat_scatter(features.noise_m));
        });
    features.openings = std::move(openings);
  }
  monitor.advance(kSpaceKnown, 1.0);
  if (options.segments) features.segments = find_segments(laid, prepared.extracted, options.edges, monitor);
  prepared.settle_reach();
}

bool needs_lines(PlaneDetector detector) {
  return detector == PlaneDetector::scan_lines || detector == PlaneDetector::published;
}

ScannerPlace in_world(ScannerPlace place, const Vector3d& local_origin) {
  if (place.source != PlaceSource::unknown && place.source != PlaceSource::per_point)
    place.centre += local_origin;
  if (place.refuted) *place.refuted += local_origin;
  return place;
}

/// Whether the relief of façades is found; poses are sought with few and large planes.
bool wants_relief(const PrepareOptions& options) {
  return options.extract.detect.relief && (options.planes_only || options.segments);
}

/// Segments are found along the borders between neighbouring points, and lines are made of all their points;
/// relief shows in a row of points here and there, once what a trajectory drifts with time is taken out.
LayOptions laying_for(const PrepareOptions& options) {
  const bool lines = options.segments || needs_lines(options.extract.detect.detector);
  const bool relief = wants_relief(options);
  LayOptions laying{lines ? kKeepAll : options.keep, lines, options.track || relief};
  if (relief) laying.keep.most_per_m2_of_way = 0.0;
  return laying;
}

PreparedScan prepare_laid(const Scan& laid, const ScanFrame& frame, const PrepareOptions& options,
                          Monitor& monitor) {
  const CancelScope scope(monitor);
  PreparedScan prepared;
  prepared.upright = frame.upright;
  prepared.surely_upright = frame.surely_upright;
  prepared.upright_from_scan = frame.frame_from_scan;
  prepared.place = in_world(frame.place, laid.local_origin - frame.corner);
  prepared.mobile = laid.mobile();
  prepared.surroundings = surroundings_of(laid);
  ExtractOptions extract = options.extract;
  extract.detect.relief = wants_relief(options);
  extract.interior.enabled = extract.interior.enabled && (prepared.upright || prepared.mobile);
  {
    StagePart extracting(monitor, kFramed, kExtracted);
    prepared.extracted = extract_features(laid, extract, extracting);
  }
  Features& features = prepared.extracted.features;
  features.drift_m = std::hypot(features.drift_m, frame.rounding_m);
  if (options.track && laid.mobile() && !options.planes_only)
    prepared.track = find_pass_track(laid, prepared.extracted);
  look_around(laid, options, prepared, monitor);
  return prepared;
}

}  // namespace

void PreparedScan::settle_reach() {
  reach.setEmpty();
  for (const SurfaceSample& sample : extracted.features.samples) reach.extend(sample.mean);
  reach.min().array() -= kReachM;
  reach.max().array() += kReachM;
  if (model) runs = SampleRuns(extracted.features.samples);
}

PreparedScan prepare_in_frame(const Scan& scan, const ScanFrame& frame, const PrepareOptions& options,
                              Monitor& monitor) {
  return prepare_laid(laid_in(scan, frame, laying_for(options)), frame, options, monitor);
}

PreparedScan prepare_in_frame(Scan&& scan, const ScanFrame& frame, const PrepareOptions& options,
                              Monitor& monitor) {
  return prepare_laid(laid_in(std::move(scan), frame, laying_for(options)), frame, options, monitor);
}

PreparedScan prepare_scan(const Scan& scan, const PrepareOptions& options, Monitor& monitor) {
  return prepare_in_frame(scan, find_scan_frame(scan, options.gravity, monitor), options, monitor);
}

PreparedScan prepare_scan(Scan&& scan, const PrepareOptions& options, Monitor& monitor) {
  const ScanFrame frame = find_scan_frame(scan, options.gravity, monitor);
  return prepare_in_frame(std::move(scan), frame, options, monitor);
}

Features in_own_frame(PreparedScan&& prepared) {
  const Rigid3 back{prepared.upright_from_scan.transpose(), Vector3d::Zero()};
  Features features = std::move(prepared.extracted.features);
  features.samples.clear();
  if (back.rotation.isIdentity()) return features;
  for (PlanarPolygon& polygon : features.planes) polygon = transformed(back, polygon);
  for (Opening& opening : features.openings) {
    for (Vector3d& corner : opening.corners) corner = back * corner;
    for (Vector3d& corner : opening.outline) corner = back * corner;
  }
  for (Segment& segment : features.segments) segment = {back * segment.a, back * segment.b};
  return features;
}

}  // namespace limen
