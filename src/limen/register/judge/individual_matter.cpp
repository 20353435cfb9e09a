// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/individual_matter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "limen/base/progress.h"
#include "limen/geometry/joined_points.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/register/judge/built_planes.h"
#include "limen/register/judge/common_surfaces.h"
#include "limen/register/judge/met_faces.h"

namespace limen {
namespace {

// When a piece agrees.
constexpr double kMatterM = 0.08;      // pieces are 0.1 m, means of round ones lie off all surface
constexpr double kFreeM = 0.15;        // rays passed this far beyond
constexpr double kSlopedCosine = 0.7;  // of a face that tells shifts along the floor, to the vertical
constexpr double kSameNormal = 0.94;   // cosine: normals of small pieces are known to some degrees
constexpr double kBesideM = 0.15;      // along the face, between the middles of two pieces of it
constexpr double kUnevenM = 0.001;     // roughness, and the pose, at least: more where walls show more

// Pieces nearer than this tell the same: the size of a chair, a box, a monitor. A moved table is few pieces.
constexpr double kCorrelationM = 0.25;
constexpr std::size_t kMostPieces = 1200;  // of each kind and scan, evenly chosen

constexpr int kDisplacements = 8;

/// A piece of individual matter of one scan.
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
                    const std::vector<Vector3d>& places, IndividualMatter& individual) {
  DisjointSets sets = joined_points(places, kThingLengthM);
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> number(places.size(), kNone);
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::size_t& thing = number[sets.find(i)];
    if (thing == kNone) {
      thing = individual.things.size();
      individual.things.emplace_back();
    }
    if (i < stated.size()) {
      individual.things[thing].count += shares[i];
      if (stated[i].agrees) individual.things[thing].agreeing += shares[i];
    } else {
      individual.faces[i - stated.size()].thing = thing;
    }
  }
  double agreeing = 0.0;
  for (const ThingSeen& thing : individual.things) {
    individual.matter.count += thing.count;
    agreeing += thing.agreeing;
  }
  if (individual.matter.count > 0.0) individual.matter.share = agreeing / individual.matter.count;
}

/// One scan with what is the building's and what is not.
struct Side {
  ScanView view;
  BuiltPlanes built;
  std::vector<Piece> pieces;

  explicit Side(const ScanView& scan) : view(scan), built(scan), pieces(pieces_of(scan, built)) {}
};

/// Asks `judge` about the pieces of `scan`; what it does not know is left out.
void ask_matter(const Side& scan, const Side& judge, const Rigid3& judge_from_scan,
                const Rigid3& target_from_scan, std::vector<Stated>& stated) {
  if (!judge.view.knows_free) return;  // what it does not contradict it does not confirm either
  for (const Piece& piece : scan.pieces) {
    SightQuery query;
    query.at = judge_from_scan * piece.detail->mean;
    query.surface_m = kMatterM;
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

/// The flat pieces of one scan, found by place.
class DetailGrid {
 public:
  explicit DetailGrid(const std::vector<SurfaceDetail>& details) : details_(details) {
    for (std::uint32_t i = 0; i < details.size(); ++i) cells_.emplace_back(cell_of(details[i].mean), i);
    std::sort(cells_.begin(), cells_.end());
  }

  /// Of the pieces beside the place that face the same way the nearest; null: none.
  [[nodiscard]] const SurfaceDetail* nearest(const Vector3d& at, const Vector3d& normal) const {
    const SurfaceDetail* found = nullptr;
    double least = kNearFaceM;
    const Cell middle = cell_of(at);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const Cell cell{middle[0] + dx, middle[1] + dy, middle[2] + dz};
          auto it = std::lower_bound(cells_.begin(), cells_.end(), std::pair{cell, std::uint32_t{0}});
          for (; it != cells_.end() && it->first == cell; ++it) {
            const SurfaceDetail& other = details_[it->second];
            if (other.normal.dot(normal) < kSameNormal) continue;
            const Vector3d apart = at - other.mean;
            const double across = apart.dot(other.normal);
            const double along = (apart - across * other.normal).norm();
            if (along > kBesideM || std::abs(across) >= least) continue;
            least = std::abs(across);
            found = &other;
          }
        }
    return found;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static Cell cell_of(const Vector3d& x) {
    constexpr double kCellM = 0.17;  // no smaller than the reach: sqrt(kBesideM^2 + kNearFaceM^2)
    return {static_cast<std::int64_t>(std::floor(x.x() / kCellM)),
            static_cast<std::int64_t>(std::floor(x.y() / kCellM)),
            static_cast<std::int64_t>(std::floor(x.z() / kCellM))};
  }

  const std::vector<SurfaceDetail>& details_;
  std::vector<std::pair<Cell, std::uint32_t>> cells_;
};

/// Upright flat pieces of `scan` that `judge` has nearby as well: of what is in the room, not of the
/// building, and not what both see through openings only.
std::vector<MetFace> met_faces(const Side& scan, const Side& judge, const Rigid3& judge_from_scan,
                               const Rigid3& target_from_judge) {
  std::vector<MetFace> faces;
  if (scan.view.details == nullptr || judge.view.details == nullptr) return faces;
  const DetailGrid grid(*judge.view.details);
  for (const Piece& piece : scan.pieces) {
    const SurfaceDetail& detail = *piece.detail;
    if (!detail.flat()) continue;
    const Vector3d normal = judge_from_scan.rotation * detail.normal;
    if (std::abs(normal.z()) > kSlopedCosine) continue;
    const Vector3d at = judge_from_scan * detail.mean;
    const SurfaceDetail* met = grid.nearest(at, normal);
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

std::vector<Stated> stated_of_matter(const Side& source, const Side& target,
                                     const Rigid3& target_from_source) {
  std::vector<Stated> stated;
  ask_matter(source, target, target_from_source, target_from_source, stated);
  ask_matter(target, source, inverse(target_from_source), Rigid3{}, stated);
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
    const std::vector<Stated> stated = stated_of_matter(source, target, displaced);
    if (stated.empty()) continue;
    share += agreeing_share(stated);
    ++counted;
  }
  return counted > 0 ? share / counted : 0.0;
}

}  // namespace

struct MatterAsker::Sides {
  Side source;
  Side target;
  CommonSurfaceAsker surfaces;

  Sides(const ScanView& first, const ScanView& second)
      : source(first), target(second), surfaces(first, source.built, second, target.built) {}
};

MatterAsker::MatterAsker(const ScanView& source, const ScanView& target)
    : sides_(new Sides(source, target)) {}

MatterAsker::~MatterAsker() = default;

IndividualMatter MatterAsker::operator()(const Rigid3& target_from_source) const {
  CancelScope::check();
  const Side& source = sides_->source;
  const Side& target = sides_->target;
  IndividualMatter individual;
  if (source.view.space == nullptr || target.view.space == nullptr) return individual;
  const std::vector<Stated> stated = stated_of_matter(source, target, target_from_source);
  const std::vector<double> shares = shares_of(stated, 8.0 * kThingLengthM);
  individual.chance = chance_of(source, target, target_from_source);
  individual.apart = wall_between(source, target, target_from_source) ||
                     wall_between(target, source, inverse(target_from_source));
  const CommonSurfaces surfaces = sides_->surfaces(target_from_source);
  individual.built = built_evidence(surfaces.all);
  std::vector<Vector3d> places;
  for (const Stated& one : stated) places.push_back(one.at);
  individual.faces = face_offsets(source, target, target_from_source, surfaces.scatter_m, places);
  group_by_thing(stated, shares, places, individual);
  return individual;
}

BuiltEvidence MatterAsker::built(const Rigid3& target_from_source) const {
  CancelScope::check();
  if (sides_->source.view.space == nullptr || sides_->target.view.space == nullptr) return {};
  return built_evidence(sides_->surfaces(target_from_source).all);
}

IndividualMatter individual_matter(const ScanView& source, const ScanView& target,
                                   const Rigid3& target_from_source) {
  return MatterAsker(source, target)(target_from_source);
}

}  // namespace limen
