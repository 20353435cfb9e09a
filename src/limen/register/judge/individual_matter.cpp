// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/individual_matter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "limen/base/progress.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

// What is the building's. A wall, even a strip of it between two windows, is longer than furniture is high;
// a table or a bed that is taken for a wall is evidence lost, not evidence forged.
constexpr double kBuiltLengthM = 2.1;
constexpr double kBuiltArea_m2 = 3.0;
constexpr double kBeforeWallM = 0.25;  // frames, sills, radiators, skirtings: built with the wall
constexpr double kBehindWallM = 0.6;   // reveals, frames, panes
constexpr double kBesideWallM = 0.3;   // beyond the outline that was seen of it

// When a piece agrees.
constexpr double kMatterM = 0.08;       // cubes of clutter are 0.25 m, their means scatter by a third of it
constexpr double kFreeM = 0.15;         // rays passed this far beyond
constexpr double kNearFaceM = 0.06;     // a face that may be the same piece, moved
constexpr double kUprightCosine = 0.3;  // of a face's normal to the vertical

// Pieces nearer than this tell the same: the size of a chair, a box, a monitor. A moved table is few pieces.
constexpr double kCorrelationM = 0.25;
constexpr std::size_t kMostPieces = 1200;  // of each kind and scan, evenly chosen

constexpr int kDisplacements = 8;

/// One scan's large planes as boxes in the planes' own coordinates, one for each part.
class BuiltPlanes {
 public:
  explicit BuiltPlanes(const Features& features) : built_(features.planes.size(), false) {
    for (std::size_t i = 0; i < features.planes.size(); ++i) {
      const PlanarPolygon& plane = features.planes[i];
      const Box2 box = box_of(plane.parts);
      if (box.empty()) continue;
      const bool large = (box.high - box.low).maxCoeff() > kBuiltLengthM || plane.area_m2 > kBuiltArea_m2;
      if (!large) continue;
      built_[i] = true;
      for (const Polygon& part : plane.parts) parts_.push_back({plane.plane, plane.frame, box_of({part})});
    }
  }

  [[nodiscard]] bool is_built(std::int32_t plane) const { return built_[static_cast<std::size_t>(plane)]; }

  enum class Place { off, at, behind };
  /// Where `x` stands to the walls: at one, or behind one.
  [[nodiscard]] Place place(const Vector3d& x) const {
    Place found = Place::off;
    for (const Part& part : parts_) {
      const double distance = part.plane.signed_distance(x);
      if (distance > kBeforeWallM) continue;
      const Vector2d at = part.frame.to_plane(x);
      const Vector2d margin = Vector2d::Constant(kBesideWallM);
      if (!Box2{part.box.low - margin, part.box.high + margin}.contains(at)) continue;
      if (distance > -kBehindWallM) return Place::at;
      found = Place::behind;
    }
    return found;
  }

  /// Whether the way from `a` to `b` leads through a wall, or an opening of it.
  [[nodiscard]] bool between(const Vector3d& a, const Vector3d& b) const {
    return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
      const double from = part.plane.signed_distance(a);
      const double to = part.plane.signed_distance(b);
      if (from * to >= 0.0) return false;
      const Vector3d crossing = a + (b - a) * (from / (from - to));
      const Vector2d margin = Vector2d::Constant(kBesideWallM);
      return Box2{part.box.low - margin, part.box.high + margin}.contains(part.frame.to_plane(crossing));
    });
  }

 private:
  struct Part {
    Plane plane;
    PlaneFrame frame;
    Box2 box;
  };
  std::vector<bool> built_;
  std::vector<Part> parts_;
};

/// A piece of individual matter of one scan.
struct Piece {
  const SurfaceSample* sample = nullptr;
  bool behind = false;  ///< seen through an opening of this scan's walls
};

std::vector<Piece> pieces_of(const Features& features, const BuiltPlanes& built) {
  std::vector<Piece> pieces;
  for (const SurfaceSample& sample : features.samples) {
    if (sample.plane >= 0 && built.is_built(sample.plane)) continue;
    const BuiltPlanes::Place place = built.place(sample.mean);
    if (place != BuiltPlanes::Place::at) pieces.push_back({&sample, place == BuiltPlanes::Place::behind});
  }
  const std::size_t stride = 1 + pieces.size() / kMostPieces;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pieces.size(); i += stride) pieces[kept++] = pieces[i];
  pieces.resize(kept);
  return pieces;
}

/// An answer of one scan to a piece of the other, in the target's frame.
struct Told {
  Vector3d at = Vector3d::Zero();
  double weight = 0.0;
  bool agrees = false;
};

/// Effective number of independent observations (Kish's formula with the correlation of neighbours): the
/// square of the weights' sum over the sum of w_i w_j rho_ij, rho = exp(-d / length).
double effective_count(const std::vector<Told>& told) {
  double total = 0.0;
  double together = 0.0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    total += told[i].weight;
    together += told[i].weight * told[i].weight;
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = (told[i].at - told[j].at).norm();
      if (distance > 8.0 * kCorrelationM) continue;
      together += 2.0 * told[i].weight * told[j].weight * std::exp(-distance / kCorrelationM);
    }
  }
  return together > 0.0 ? total * total / together : 0.0;
}

double agreeing_share(const std::vector<Told>& told) {
  double total = 0.0;
  double agreeing = 0.0;
  for (const Told& one : told) {
    total += one.weight;
    if (one.agrees) agreeing += one.weight;
  }
  return total > 0.0 ? agreeing / total : 0.0;
}

Observations observations(const std::vector<Told>& told) {
  return {effective_count(told), agreeing_share(told)};
}

/// One scan with what is the building's and what is not.
struct Side {
  ScanView view;
  BuiltPlanes built;
  std::vector<Piece> pieces;

  explicit Side(const ScanView& scan)
      : view(scan), built(*scan.features), pieces(pieces_of(*scan.features, built)) {}
};

/// Asks `judge` about the pieces of `scan`; what it does not know is left out.
void ask_matter(const Side& scan, const Side& judge, const Rigid3& judge_from_scan,
                const Rigid3& target_from_scan, std::vector<Told>& told) {
  if (!judge.view.knows_free) return;  // what it does not contradict it does not confirm either
  for (const Piece& piece : scan.pieces) {
    SightQuery query;
    query.at = judge_from_scan * piece.sample->mean;
    const BuiltPlanes::Place place = judge.built.place(query.at);
    if (place == BuiltPlanes::Place::at) continue;
    query.surface_m = kMatterM;
    query.free_m = kFreeM;
    const Sight sight = judge.view.space->look(query);
    const bool surface = sight.kind == SightKind::surface;
    if (!surface && sight.kind != SightKind::free) continue;
    // Beyond an opening of both stands what both rooms' neighbours have alike: corridors, façades.
    if (surface && piece.behind && place == BuiltPlanes::Place::behind) continue;
    if (surface && sight.plane >= 0 && judge.built.is_built(sight.plane)) continue;
    told.push_back(
        {target_from_scan * piece.sample->mean, static_cast<double>(piece.sample->area_m2), surface});
  }
}

/// Upright faces of furniture that the other scan has nearby.
void ask_faces(const Side& scan, const Side& judge, const Rigid3& judge_from_scan,
               const Rigid3& target_from_scan, double fine_m, std::vector<Told>& told) {
  for (const Piece& piece : scan.pieces) {
    const SurfaceSample& sample = *piece.sample;
    if (sample.plane < 0) continue;
    const Vector3d normal = judge_from_scan.rotation * sample.normal;
    if (std::abs(normal.z()) > kUprightCosine) continue;
    SightQuery query;
    query.at = judge_from_scan * sample.mean;
    if (judge.built.place(query.at) == BuiltPlanes::Place::at) continue;
    query.normal = normal;
    query.oriented = scan.view.features->planes[static_cast<std::size_t>(sample.plane)].oriented;
    query.surface_m = kNearFaceM;
    const Sight sight = judge.view.space->look(query);
    if (sight.kind != SightKind::surface || sight.plane < 0 || judge.built.is_built(sight.plane)) continue;
    told.push_back({target_from_scan * sample.mean, static_cast<double>(sample.area_m2),
                    std::abs(sight.distance_m) <= fine_m});
  }
}

std::vector<Told> told_of_matter(const Side& source, const Side& target, const Rigid3& target_from_source) {
  std::vector<Told> told;
  ask_matter(source, target, target_from_source, target_from_source, told);
  ask_matter(target, source, inverse(target_from_source), Rigid3{}, told);
  return told;
}

/// Whether a wall of `judge` stands between the two stations.
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
    const std::vector<Told> told = told_of_matter(source, target, displaced);
    if (told.empty()) continue;
    share += agreeing_share(told);
    ++counted;
  }
  return counted > 0 ? share / counted : 0.0;
}

/// How far two measurements of one face may be apart: noise of both planes and what walls are uneven.
double fine_m(const ScanView& source, const ScanView& target) {
  const double noise = std::hypot(source.features->noise_m, target.features->noise_m);
  const double drift = std::hypot(source.features->drift_m, target.features->drift_m);
  return std::clamp(3.0 * std::hypot(noise, drift), 0.008, 0.025);
}

}  // namespace

IndividualMatter individual_matter(const ScanView& source_view, const ScanView& target_view,
                                   const Rigid3& target_from_source) {
  CancelScope::check();
  IndividualMatter individual;
  if (source_view.space == nullptr || target_view.space == nullptr) return individual;
  const Side source(source_view);
  const Side target(target_view);
  individual.matter = observations(told_of_matter(source, target, target_from_source));
  individual.chance = chance_of(source, target, target_from_source);
  individual.apart = wall_between(source, target, target_from_source) ||
                     wall_between(target, source, inverse(target_from_source));
  const double fine = fine_m(source_view, target_view);
  std::vector<Told> faces;
  ask_faces(source, target, target_from_source, target_from_source, fine, faces);
  ask_faces(target, source, inverse(target_from_source), Rigid3{}, fine, faces);
  individual.faces = observations(faces);
  return individual;
}

}  // namespace limen
