// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/seen_clutter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "limen/base/progress.h"
#include "limen/geometry/cell_key.h"
#include "limen/geometry/cell_lists.h"
#include "limen/geometry/joined_points.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/register/judge/built_planes.h"
#include "limen/register/judge/common_surfaces.h"
#include "limen/register/judge/met_faces.h"

namespace limen {
namespace {

// When a piece agrees.
constexpr double kSurfaceM = 0.08;     // pieces are 0.1 m, means of round ones lie off all surface
constexpr double kFreeM = 0.15;        // rays passed this far beyond
constexpr double kSlopedCosine = 0.7;  // of a face that tells shifts along the floor, to the vertical
constexpr double kSameNormal = 0.94;   // cosine: normals of small pieces are known to some degrees
constexpr double kBesideM = 0.15;      // along the face, between the middles of two pieces of it
constexpr double kUnevenM = 0.001;     // roughness, and the pose, at least: more where walls show more

// Pieces nearer than this tell the same: the size of a chair, a box, a monitor. A moved table is few pieces.
constexpr double kCorrelationM = 0.25;
constexpr std::size_t kMostPieces = 1200;  // of each kind and scan, evenly chosen

constexpr int kDisplacements = 8;

/// A piece of clutter of one scan.
struct Piece {
  const SurfaceDetail* detail = nullptr;
  bool behind = false;  ///< seen through an opening of this scan's walls
};

std::vector<Piece> pieces_of(const ScanView& view, const BuiltPlanes& built) {
  std::vector<Piece> pieces;
  if (view.details == nullptr) return pieces;
  for (const SurfaceDetail& detail : *view.details) {
    const BuiltPlanes::Place place = built.place(detail.mean);
    if (place != BuiltPlanes::Place::at_wall)
      pieces.push_back({&detail, place == BuiltPlanes::Place::behind});
  }
  const std::size_t stride = 1 + pieces.size() / kMostPieces;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pieces.size(); i += stride) pieces[kept++] = pieces[i];
  pieces.resize(kept);
  return pieces;
}

/// An answer of one scan to a piece of the other, in the target's frame.
struct Stated {
  Vector3d at = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();  ///< of a flat piece; else zero
  double weight = 0.0;
  bool agrees = false;
};

/// A leaf, a cupboard's front, a table top is one thing: it is there or not.
double correlation(const Stated& a, const Stated& b) {
  const Vector3d apart = a.at - b.at;
  return std::exp(-apart.norm() / (in_one_face(apart, a.normal, b.normal) ? kFrontLengthM : kCorrelationM));
}

double agreeing_share(const std::vector<Stated>& stated) {
  double total = 0.0;
  double agreeing = 0.0;
  for (const Stated& one : stated) {
    total += one.weight;
    if (one.agrees) agreeing += one.weight;
  }
  return total > 0.0 ? agreeing / total : 0.0;
}

/// What is nearer than `kThingLengthM`, one by one, is of one thing. `shares`: of each answer, of an
/// observation. `places`: of the answers, then of the faces.
void group_by_thing(const std::vector<Stated>& stated, const std::vector<double>& shares,
                    const std::vector<Vector3d>& places, SeenClutter& clutter) {
  DisjointSets sets = joined_points(places, kThingLengthM);
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> number(places.size(), kNone);
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::size_t& thing = number[sets.find(i)];
    if (thing == kNone) {
      thing = clutter.things.size();
      clutter.things.emplace_back();
    }
    if (i < stated.size()) {
      clutter.things[thing].count += shares[i];
      if (stated[i].agrees) clutter.things[thing].agreeing += shares[i];
    } else {
      clutter.faces[i - stated.size()].thing = thing;
    }
  }
  double agreeing = 0.0;
  for (const ThingSeen& thing : clutter.things) {
    clutter.pieces.count += thing.count;
    agreeing += thing.agreeing;
  }
  if (clutter.pieces.count > 0.0) clutter.pieces.share = agreeing / clutter.pieces.count;
}

/// The pieces of one scan, found by place.
class DetailGrid {
 public:
  explicit DetailGrid(const std::vector<SurfaceDetail>* details) : details_(details) {
    if (details == nullptr) return;
    std::vector<std::vector<std::int64_t>> cells;
    for (const SurfaceDetail& detail : *details) cells.push_back({cell_key(cell_of(detail.mean, kCellM))});
    cells_ = CellLists(std::move(cells));
  }

  /// Of the pieces beside the place that face the same way the nearest; null: none.
  [[nodiscard]] const SurfaceDetail* nearest(const Vector3d& at, const Vector3d& normal) const {
    const SurfaceDetail* found = nullptr;
    double least = kNearFaceM;
    const Vector3d middle = cell_of(at, kCellM);
    for (int k = 0; k < 27; ++k) {
      for (const std::int32_t i : cells_.at(cell_key(middle + way_to_cell(k)))) {
        const SurfaceDetail& other = (*details_)[static_cast<std::size_t>(i)];
        if (other.normal.dot(normal) < kSameNormal) continue;
        const Vector3d between = at - other.mean;
        const double across = between.dot(other.normal);
        const double along = (between - across * other.normal).norm();
        if (along > kBesideM || std::abs(across) >= least) continue;
        least = std::abs(across);
        found = &other;
      }
    }
    return found;
  }

 private:
  static constexpr double kCellM = 0.17;  // no smaller than the reach: sqrt(kBesideM^2 + kNearFaceM^2)

  const std::vector<SurfaceDetail>* details_;
  CellLists cells_;
};

/// One scan with what is the building's and what is not.
struct Side {
  ScanView view;
  BuiltPlanes built;
  std::vector<Piece> pieces;
  DetailGrid details;

  explicit Side(const ScanView& scan)
      : view(scan), built(scan), pieces(pieces_of(scan, built)), details(scan.details) {}
};

/// Asks `judge` about the pieces of `scan`; what it does not know is left out.
void compare_pieces(const Side& scan, const Side& judge, const Rigid3& judge_from_scan,
                    const Rigid3& target_from_scan, std::vector<Stated>& stated) {
  if (!judge.view.knows_free) return;  // what it does not contradict it does not confirm either
  for (const Piece& piece : scan.pieces) {
    SightQuery query;
    query.at = judge_from_scan * piece.detail->mean;
    query.surface_m = kSurfaceM;
    query.free_m = kFreeM;
    const Sight sight = judge.view.space->look(query);
    const bool surface = sight.kind == SightKind::surface;
    if (!surface && sight.kind != SightKind::free) continue;
    const BuiltPlanes::Place place = judge.built.place(query.at);
    if (place == BuiltPlanes::Place::at_wall) continue;
    // Beyond an opening of both is what both rooms' neighbours have alike: corridors, façades.
    if (surface && piece.behind && place == BuiltPlanes::Place::behind) continue;
    if (surface && sight.plane >= 0 && judge.built.is_built(sight.plane)) continue;
    const SurfaceDetail& detail = *piece.detail;
    const Vector3d normal =
        detail.flat() ? Vector3d(target_from_scan.rotation * detail.normal) : Vector3d::Zero();
    stated.push_back({target_from_scan * detail.mean, normal, static_cast<double>(detail.area_m2), surface});
  }
}

/// Upright flat pieces of `scan` that `judge` has nearby as well: of what is in the room, not of the
/// building, and not what both see through openings only.
std::vector<MetFace> met_faces(const Side& scan, const Side& judge, const Rigid3& judge_from_scan,
                               const Rigid3& target_from_judge) {
  std::vector<MetFace> faces;
  for (const Piece& piece : scan.pieces) {
    const SurfaceDetail& detail = *piece.detail;
    if (!detail.flat()) continue;
    const Vector3d normal = judge_from_scan.rotation * detail.normal;
    if (std::abs(normal.z()) > kSlopedCosine) continue;
    const Vector3d at = judge_from_scan * detail.mean;
    const SurfaceDetail* met = judge.details.nearest(at, normal);
    if (met == nullptr) continue;
    const BuiltPlanes::Place there = judge.built.place(at);
    if (there == BuiltPlanes::Place::at_wall) continue;
    if (there == BuiltPlanes::Place::behind && piece.behind) continue;
    const Vector3d across = (normal + met->normal).normalized();
    // Things are put elsewhere along the floor: of a slope that is more than what is seen across it.
    const double lean = 1.0 / across.head<2>().norm();
    faces.push_back(
        {target_from_judge * at, target_from_judge.rotation * across, lean * across.dot(at - met->mean),
         lean * std::hypot(static_cast<double>(detail.sigma_m), static_cast<double>(met->sigma_m))});
  }
  return faces;
}

/// What is in a room is its own to the millimetre: offsets between pieces that both scans have.
/// `scatter_m`: of a piece of wall, by how the two scans differ on walls that both saw. The places of the
/// faces are added to `places`.
std::vector<FaceMiss> face_offsets(const Side& source, const Side& target, const Rigid3& target_from_source,
                                   double scatter_m, std::vector<Vector3d>& places) {
  // Nearness is mutual, about: the sparser scan asks.
  const bool source_asks = source.view.details != nullptr && target.view.details != nullptr &&
                           source.view.details->size() <= target.view.details->size();
  const std::vector<MetFace> faces =
      joined(source_asks ? met_faces(source, target, target_from_source, Rigid3{})
                         : met_faces(target, source, inverse(target_from_source), target_from_source));
  const std::vector<double> shares = shares_of(faces, 8.0 * kThingLengthM);
  const double drift = std::hypot(source.view.features->drift_m, target.view.features->drift_m);
  std::vector<FaceMiss> offsets;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const MetFace& face = faces[k];
    const double uneven_m = std::max(kUnevenM, scatter_m);
    offsets.push_back({face.offset_m, shares[k], std::hypot(uneven_m, face.sigma_m, drift), 0});
    places.push_back(face.at);
  }
  return offsets;
}

std::vector<Stated> compared_pieces(const Side& source, const Side& target,
                                    const Rigid3& target_from_source) {
  std::vector<Stated> stated;
  compare_pieces(source, target, target_from_source, target_from_source, stated);
  compare_pieces(target, source, inverse(target_from_source), Rigid3{}, stated);
  return stated;
}

/// Whether a wall of `judge` is between the two stations.
bool wall_between(const Side& scan, const Side& judge, const Rigid3& judge_from_scan) {
  if (!scan.view.station || !judge.view.station) return false;
  return judge.built.between(judge_from_scan * *scan.view.station, *judge.view.station);
}

/// How often things meet things when one room's are shifted about in the other, at their heights.
double chance_of(const Side& source, const Side& target, const Rigid3& target_from_source) {
  double share = 0.0;
  int counted = 0;
  for (int k = 0; k < kDisplacements; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kDisplacements;
    const double length = k % 2 == 0 ? 0.7 : 1.2;
    Rigid3 displaced = target_from_source;
    displaced.translation += length * Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const std::vector<Stated> stated = compared_pieces(source, target, displaced);
    if (stated.empty()) continue;
    share += agreeing_share(stated);
    ++counted;
  }
  return counted > 0 ? share / counted : 0.0;
}

}  // namespace

struct ClutterComparer::Sides {
  Side source;
  Side target;
  CommonSurfaceFinder surfaces;

  Sides(const ScanView& first, const ScanView& second)
      : source(first), target(second), surfaces(first, source.built, second, target.built) {}
};

ClutterComparer::ClutterComparer(const ScanView& source, const ScanView& target)
    : sides_(new Sides(source, target)) {}

ClutterComparer::~ClutterComparer() = default;

SeenClutter ClutterComparer::operator()(const Rigid3& target_from_source) const {
  CancelScope::check();
  const Side& source = sides_->source;
  const Side& target = sides_->target;
  SeenClutter clutter;
  if (source.view.space == nullptr || target.view.space == nullptr) return clutter;
  const std::vector<Stated> stated = compared_pieces(source, target, target_from_source);
  const std::vector<double> shares = shares_of(stated, 8.0 * kThingLengthM);
  clutter.chance = chance_of(source, target, target_from_source);
  clutter.behind_wall = wall_between(source, target, target_from_source) ||
                        wall_between(target, source, inverse(target_from_source));
  const CommonSurfaces surfaces = sides_->surfaces(target_from_source);
  clutter.built = built_evidence(surfaces.all);
  std::vector<Vector3d> places;
  for (const Stated& one : stated) places.push_back(one.at);
  clutter.faces = face_offsets(source, target, target_from_source, surfaces.scatter_m, places);
  group_by_thing(stated, shares, places, clutter);
  return clutter;
}

BuiltEvidence ClutterComparer::built(const Rigid3& target_from_source) const {
  CancelScope::check();
  if (sides_->source.view.space == nullptr || sides_->target.view.space == nullptr) return {};
  return built_evidence(sides_->surfaces(target_from_source).all);
}

SeenClutter seen_clutter(const ScanView& source, const ScanView& target, const Rigid3& target_from_source) {
  return ClutterComparer(source, target)(target_from_source);
}

}  // namespace limen
