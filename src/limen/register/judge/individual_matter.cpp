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
#include "limen/register/judge/stairs.h"

namespace limen {
namespace {

// What is the building's: its large planes, and what is near them.
constexpr double kBeforeWallM = 0.25;   // frames, sills, radiators, skirtings: built with the wall
constexpr double kBehindWallM = 0.6;    // reveals, frames, panes
constexpr double kBesideWallM = 0.3;    // beyond the outline that was seen of it
constexpr double kBelowCeilingM = 0.5;  // lintels, beams, what shows of a wall above furniture
constexpr double kSameWallM = 0.04;     // strips of a wall that furniture cuts in pieces lie in one plane ...
constexpr double kSameWallCosine = 0.9994;  // ... to 2 degrees
constexpr double kLevelCosine = 0.95;
constexpr double kAtStripM = 0.1;  // before and beside a strip

// When a piece agrees.
constexpr double kMatterM = 0.08;        // pieces are 0.1 m, means of round ones lie off all surface
constexpr double kFreeM = 0.15;          // rays passed this far beyond
constexpr double kUprightCosine = 0.3;   // of a face's normal to the vertical
constexpr double kSlopedCosine = 0.7;    // of a face that tells shifts along the floor, to the vertical
constexpr double kSameNormal = 0.94;     // cosine: normals of small pieces are known to some degrees
constexpr double kBesideM = 0.15;        // along the face, between the middles of two pieces of it
constexpr double kUnevenM = 0.001;       // roughness, and the pose, at least
constexpr double kOneFaceM = 0.04;       // pieces that lie so in one plane ...
constexpr double kOneFaceCosine = 0.97;  // ... facing the same way ...
constexpr double kNextPieceM = 0.35;     // ... are of one face, piece by piece
constexpr double kThingLengthM = 0.4;    // faces nearer than this tell the same ...
constexpr double kFrontLengthM = 1.5;    // ... and those of one plane nearer than this
constexpr double kFrontCosine = 0.99;    // a front is parallel to its wall to 8 degrees ...
constexpr double kDeepestM = 0.7;        // ... and no further from it than cupboards are deep

// Pieces nearer than this tell the same: the size of a chair, a box, a monitor. A moved table is few pieces.
constexpr double kCorrelationM = 0.25;
constexpr std::size_t kMostPieces = 1200;  // of each kind and scan, evenly chosen

constexpr int kDisplacements = 8;

/// One scan's large planes as boxes in the planes' own coordinates, one for each part.
class BuiltPlanes {
 public:
  explicit BuiltPlanes(const ScanView& view) : built_(view.features->planes.size(), false) {
    const std::vector<PlanarPolygon>& planes = view.features->planes;
    if (view.details != nullptr) flights_ = find_flights(*view.details);
    for (std::size_t i = 0; i < planes.size(); ++i)
      if (of_building(planes[i])) add(i, planes[i], false);
    const std::vector<Part> large = parts_;
    for (std::size_t i = 0; i < planes.size(); ++i)
      if (!built_[i] && (reaches_ceiling(planes[i], large) || continues_wall(planes[i], large)))
        add(i, planes[i], true);
  }

  [[nodiscard]] bool is_built(std::int32_t plane) const { return built_[static_cast<std::size_t>(plane)]; }

  [[nodiscard]] const std::vector<bool>& flags() const { return built_; }

  enum class Place { off, at_wall, behind };
  /// Where `x` stands to the walls: at one (or at the ceiling, or on stairs), or behind one.
  [[nodiscard]] Place place(const Vector3d& x) const {
    Place found = Place::off;
    if (std::any_of(flights_.begin(), flights_.end(), [&](const Flight& f) { return f.contains(x); }))
      return Place::at_wall;
    for (const Part& part : parts_) {
      if (is_below(x, part)) return Place::at_wall;
      const double distance = part.plane.signed_distance(x);
      if (distance > (part.strip ? kAtStripM : kBeforeWallM)) continue;
      if (part.strip && distance < -kBehindWallM) continue;
      const Vector2d at = part.frame.to_plane(x);
      const Vector2d margin = Vector2d::Constant(part.strip ? kAtStripM : kBesideWallM);
      if (!Box2{part.box.low - margin, part.box.high + margin}.contains(at)) continue;
      if (distance > -kBehindWallM) return Place::at_wall;
      found = Place::behind;
    }
    return found;
  }

  /// Whether a face at `x` may be the front of something that stands with its back to a wall.
  [[nodiscard]] bool is_front(const Vector3d& x, const Vector3d& normal) const {
    return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
      if (std::abs(part.plane.normal.z()) > kUprightCosine) return false;
      if (part.plane.normal.dot(normal) < kFrontCosine) return false;
      const double distance = part.plane.signed_distance(x);
      if (distance < 0.0 || distance > kDeepestM) return false;
      const Vector2d margin = Vector2d::Constant(kBesideWallM);
      return Box2{part.box.low - margin, part.box.high + margin}.contains(part.frame.to_plane(x));
    });
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
    bool strip = false;
  };

  void add(std::size_t i, const PlanarPolygon& plane, bool strip) {
    built_[i] = true;
    for (const Polygon& part : plane.parts)
      parts_.push_back({plane.plane, plane.frame, box_of({part}), strip});
  }

  /// Whether `x` is right below a ceiling.
  static bool is_below(const Vector3d& x, const Part& part) {
    if (part.plane.normal.z() > -kLevelCosine) return false;
    const double below = part.plane.signed_distance(x);
    if (below <= 0.0 || below > kBelowCeilingM) return false;
    const Vector2d margin = Vector2d::Constant(kBesideWallM);
    return Box2{part.box.low - margin, part.box.high + margin}.contains(part.frame.to_plane(x));
  }

  static bool reaches_ceiling(const PlanarPolygon& plane, const std::vector<Part>& large) {
    if (std::abs(plane.plane.normal.z()) > kUprightCosine) return false;
    for (const Polygon& part : plane.parts) {
      for (const Vector2d& corner : part.outer) {
        const Vector3d x = plane.frame.to_space(corner);
        if (std::any_of(large.begin(), large.end(), [&](const Part& one) { return is_below(x, one); }))
          return true;
      }
    }
    return false;
  }

  static bool continues_wall(const PlanarPolygon& plane, const std::vector<Part>& large) {
    const Box2 box = box_of(plane.parts);
    if (box.empty()) return false;
    const Vector3d middle = plane.frame.to_space(0.5 * (box.low + box.high));
    return std::any_of(large.begin(), large.end(), [&](const Part& wall) {
      return std::abs(wall.plane.normal.z()) < kUprightCosine &&
             wall.plane.normal.dot(plane.plane.normal) > kSameWallCosine &&
             std::abs(wall.plane.signed_distance(middle)) < kSameWallM;
    });
  }

  std::vector<bool> built_;
  std::vector<Part> parts_;
  std::vector<Flight> flights_;
};

double square(double x) {
  return x * x;
}

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
struct Told {
  Vector3d at = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();  ///< of a flat piece; else zero
  double weight = 0.0;
  bool agrees = false;
};

/// A face of one scan that the other has as well, in the target's frame.
struct MetFace {
  Vector3d at = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  double offset_m = 0.0;
  double sigma_m = 0.0;
  double weight = 1.0;  ///< pieces
};

/// Faces near one another may be of one thing, or were pushed together; those in one plane are of one
/// cupboard or board even where something hides what lies between.
double correlation(const MetFace& a, const MetFace& b) {
  const Vector3d apart = a.at - b.at;
  const bool one_plane = a.normal.dot(b.normal) > kOneFaceCosine && std::abs(apart.dot(a.normal)) < kOneFaceM;
  return std::exp(-apart.norm() / (one_plane ? kFrontLengthM : kThingLengthM));
}

/// A leaf, a cupboard's front, a table top is one thing: it is there or not.
double correlation(const Told& a, const Told& b) {
  const Vector3d apart = a.at - b.at;
  const bool one_plane = a.normal.dot(b.normal) > kOneFaceCosine && std::abs(apart.dot(a.normal)) < kOneFaceM;
  return std::exp(-apart.norm() / (one_plane ? kFrontLengthM : kCorrelationM));
}

/// Each piece's share of an observation, w_i / sum_j w_j rho_ij: neighbours that tell the same make one
/// together, however many they are, and what stands alone is one of its own. Farther apart than `reach_m`
/// none are correlated.
template <typename Item>
std::vector<double> shares_of(const std::vector<Item>& items, double reach_m) {
  std::vector<double> together(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    together[i] += items[i].weight;
    for (std::size_t j = 0; j < i; ++j) {
      if ((items[j].at - items[i].at).squaredNorm() > reach_m * reach_m) continue;
      const double rho = correlation(items[i], items[j]);
      together[i] += items[j].weight * rho;
      together[j] += items[i].weight * rho;
    }
  }
  for (std::size_t i = 0; i < items.size(); ++i)
    together[i] = together[i] > 0.0 ? items[i].weight / together[i] : 0.0;
  return together;
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

/// `shares`: each answer's, of an observation.
Observations observations(const std::vector<Told>& told, const std::vector<double>& shares) {
  Observations seen;
  double agreeing = 0.0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    seen.count += shares[i];
    if (told[i].agrees) agreeing += shares[i];
  }
  seen.share = seen.count > 0.0 ? agreeing / seen.count : 0.0;
  return seen;
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
                const Rigid3& target_from_scan, std::vector<Told>& told) {
  if (!judge.view.knows_free) return;  // what it does not contradict it does not confirm either
  for (const Piece& piece : scan.pieces) {
    SightQuery query;
    query.at = judge_from_scan * piece.detail->mean;
    const BuiltPlanes::Place place = judge.built.place(query.at);
    if (place == BuiltPlanes::Place::at_wall) continue;
    query.surface_m = kMatterM;
    query.free_m = kFreeM;
    const Sight sight = judge.view.space->look(query);
    const bool surface = sight.kind == SightKind::surface;
    if (!surface && sight.kind != SightKind::free) continue;
    // Beyond an opening of both stands what both rooms' neighbours have alike: corridors, façades.
    if (surface && piece.behind && place == BuiltPlanes::Place::behind) continue;
    if (surface && sight.plane >= 0 && judge.built.is_built(sight.plane)) continue;
    const SurfaceDetail& detail = *piece.detail;
    const Vector3d normal =
        detail.flat() ? Vector3d(target_from_scan.rotation * detail.normal) : Vector3d::Zero();
    told.push_back({target_from_scan * detail.mean, normal, static_cast<double>(detail.area_m2), surface});
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

/// Upright flat pieces of `scan` that `judge` has nearby as well: of what stands in the room, not of the
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

/// Whether a piece goes on where those of a face, given by their numbers, end. What lies in one plane above
/// one another is of one leaf or cupboard, of which something hides the middle.
bool continues(const MetFace& piece, const std::vector<MetFace>& pieces,
               const std::vector<std::size_t>& face) {
  const MetFace& first = pieces[face.front()];
  if (piece.normal.dot(first.normal) < kOneFaceCosine) return false;
  if (std::abs(first.normal.dot(piece.at - first.at)) > kOneFaceM) return false;
  return std::any_of(face.rbegin(), face.rend(), [&](std::size_t k) {
    return (pieces[k].at - piece.at).head<2>().squaredNorm() < kNextPieceM * kNextPieceM;
  });
}

/// What the pieces of one face say together.
MetFace mean_of(const std::vector<MetFace>& pieces, const std::vector<std::size_t>& face) {
  constexpr double kLeastSigmaM = 1e-4;
  MetFace mean;
  double weights = 0.0;
  for (const std::size_t k : face) {
    const double weight = 1.0 / (square(pieces[k].sigma_m) + square(kLeastSigmaM));
    mean.offset_m += weight * pieces[k].offset_m;
    mean.at += pieces[k].at;
    mean.normal += pieces[k].normal;
    weights += weight;
  }
  const auto count = static_cast<double>(face.size());
  mean.offset_m /= weights;
  mean.at /= count;
  mean.normal.normalize();
  mean.weight = count;
  double scatter = 0.0;
  for (const std::size_t k : face) scatter += square(pieces[k].offset_m - mean.offset_m);
  mean.sigma_m = std::sqrt(1.0 / weights + scatter / square(count));
  return mean;
}

/// The pieces of one face were put where they are together: they make one observation, a better one the more
/// they are.
std::vector<MetFace> joined(const std::vector<MetFace>& pieces) {
  std::vector<std::vector<std::size_t>> faces;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto found = std::find_if(faces.begin(), faces.end(),
                                    [&](const auto& face) { return continues(pieces[k], pieces, face); });
    if (found != faces.end())
      found->push_back(k);
    else
      faces.push_back({k});
  }
  std::vector<MetFace> means;
  means.reserve(faces.size());
  for (const std::vector<std::size_t>& face : faces) means.push_back(mean_of(pieces, face));
  return means;
}

/// What stands in a room is its own to the millimetre: offsets between pieces that both scans have.
FaceOffsets face_offsets(const Side& source, const Side& target, const Rigid3& target_from_source) {
  const Rigid3 source_from_target = inverse(target_from_source);
  // Nearness is mutual, about: the sparser scan asks.
  const bool source_asks = source.view.details != nullptr && target.view.details != nullptr &&
                           source.view.details->size() <= target.view.details->size();
  const std::vector<MetFace> faces =
      joined(source_asks ? met_faces(source, target, target_from_source, Rigid3{})
                         : met_faces(target, source, source_from_target, target_from_source));
  FaceOffsets offsets;
  const double drift = std::hypot(source.view.features->drift_m, target.view.features->drift_m);
  for (const MetFace& face : faces) {
    offsets.offsets_m.push_back(face.offset_m);
    offsets.sigmas_m.push_back(std::hypot(kUnevenM, face.sigma_m, drift));
    offsets.fronts.push_back(
        target.built.is_front(face.at, face.normal) ||
        source.built.is_front(source_from_target * face.at, source_from_target.rotation * face.normal));
  }
  offsets.shares = shares_of(faces, 8.0 * kThingLengthM);
  return offsets;
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

}  // namespace

IndividualMatter individual_matter(const ScanView& source_view, const ScanView& target_view,
                                   const Rigid3& target_from_source) {
  CancelScope::check();
  IndividualMatter individual;
  individual.source_built.assign(source_view.features->planes.size(), true);
  individual.target_built.assign(target_view.features->planes.size(), true);
  if (source_view.space == nullptr || target_view.space == nullptr) return individual;
  const Side source(source_view);
  const Side target(target_view);
  const std::vector<Told> told = told_of_matter(source, target, target_from_source);
  const std::vector<double> shares = shares_of(told, 8.0 * kThingLengthM);
  individual.matter = observations(told, shares);
  individual.chance = chance_of(source, target, target_from_source);
  individual.apart = wall_between(source, target, target_from_source) ||
                     wall_between(target, source, inverse(target_from_source));
  individual.faces = face_offsets(source, target, target_from_source);
  individual.source_built = source.built.flags();
  individual.target_built = target.built.flags();
  return individual;
}

}  // namespace limen
