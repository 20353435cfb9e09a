// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/model_walls.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "limen/base/progress.h"

namespace limen {
namespace {

constexpr double kWallTilt = 0.5;         // |normal . up| of a wall is less
constexpr double kMissesDrawingM = 0.05;  // by how much what is built may miss its drawing and count
constexpr double kCeilingTilt = 0.3;      // a ceiling, a sloping one too, looks down more than this
constexpr double kColumnM = 0.25;         // walls are looked at in columns this wide
constexpr double kBesideCeilingM = 0.5;   // beside the top of a column, and above it, a ceiling is sought ...
constexpr double kNearCeilingM = 0.25;
constexpr double kWallBelowCeilingM = 0.15;  // ... which may seem a little lower than the wall's top
constexpr double kMostWallPieces = 1500.0;
// Of the planes that do not reach a ceiling one in five is a wall: gables, parapets, walls with something
// before their upper part.
constexpr double kLowPlaneShare = 0.2;
constexpr double kUprightAgain = 0.98;  // cosine: the model's vertical is an axis of the scan's frame
constexpr double kWallLimit_m2 = 5.0;   // of one plane, however large, about this much says something new ...
constexpr double kObservation_m2 = 1.25;  // ... and this much of it is one observation

double observations(double area_m2) {
  return kWallLimit_m2 / kObservation_m2 * (1.0 - std::exp(-area_m2 / kWallLimit_m2));
}

/// +x, -x, +y, -y, +z, -z.
Vector3d way_up(std::size_t way) {
  const double sign = way % 2 == 0 ? 1.0 : -1.0;
  return sign * Vector3d::Unit(static_cast<Eigen::Index>(way / 2));
}

}  // namespace

bool ModelWalls::Rectangle::is_crossed(const Vector3d& from, const Vector3d& to) const {
  constexpr double kRim = 0.02;  // of the opening's size
  const double before = normal.dot(from - corner);
  const double behind = normal.dot(to - corner);
  if (before * behind >= 0) return false;
  const Vector3d at = from + before / (before - behind) * (to - from) - corner;
  const double u = across.dot(at);
  const double v = up.dot(at);
  return u > -kRim && u < 1.0 + kRim && v > -kRim && v < 1.0 + kRim;
}

ModelWalls::ModelWalls(const ScanView& scan, const ScanView& model) : scan_(scan), model_(model) {
  for (const Opening& opening : model.features->openings) {
    const Vector3d across = opening.corners[1] - opening.corners[0];
    const Vector3d up = opening.corners[3] - opening.corners[0];
    const Vector3d normal = across.cross(up);
    if (!(normal.norm() > 0)) continue;
    openings_.push_back(
        {opening.corners[0], normal.normalized(), across / across.squaredNorm(), up / up.squaredNorm()});
  }
  for (std::size_t way = 0; way < kWaysUp; ++way) reaching_[way] = reaching_ceiling(way_up(way));
  choose_pieces();
}

ModelWalls::Reaching ModelWalls::reaching_ceiling(const Vector3d& up) const {
  const Features& features = *scan_.features;
  std::vector<Vector3d> ceiling;
  std::vector<std::map<int, Vector3d>> tops(features.planes.size());
  for (const SurfaceSample& sample : features.samples) {
    if (sample.plane < 0) continue;
    const double facing = sample.normal.dot(up);
    if (facing < -kCeilingTilt) ceiling.push_back(sample.mean);
    if (std::abs(facing) > kWallTilt) continue;
    const Vector3d along = up.cross(sample.normal).normalized();
    const int column = static_cast<int>(std::floor(along.dot(sample.mean) / kColumnM));
    const auto [it, first] = tops[static_cast<std::size_t>(sample.plane)].insert({column, sample.mean});
    if (!first && up.dot(sample.mean - it->second) > 0) it->second = sample.mean;
  }
  const auto has_ceiling = [&](const std::pair<const int, Vector3d>& top) {
    return std::any_of(ceiling.begin(), ceiling.end(), [&](const Vector3d& at) {
      const Vector3d apart = at - top.second;
      const double above = up.dot(apart);
      return above > -kWallBelowCeilingM && above < kNearCeilingM &&
             apart.squaredNorm() - above * above < kBesideCeilingM * kBesideCeilingM;
    });
  };
  Reaching reaching;
  for (const auto& columns : tops) {
    const auto high = std::count_if(columns.begin(), columns.end(), has_ceiling);
    reaching.push_back(columns.empty() ? 0.0
                                       : static_cast<double>(high) / static_cast<double>(columns.size()));
  }
  return reaching;
}

const ModelWalls::Reaching* ModelWalls::reaching_under(const Matrix3d& rotation) const {
  for (std::size_t way = 0; way < kWaysUp; ++way) {
    if (rotation.row(2).dot(way_up(way)) <= kUprightAgain) continue;
    const Reaching& reaching = reaching_[way];
    // Of a pass along the street every upright plane may be a wall.
    const bool indoors =
        std::any_of(reaching.begin(), reaching.end(), [](double share) { return share > 0.0; });
    return scan_.mobile && !indoors ? nullptr : &reaching;
  }
  return nullptr;
}

void ModelWalls::choose_pieces() {
  const Features& features = *scan_.features;
  const auto stride =
      static_cast<std::size_t>(1.0 + static_cast<double>(features.samples.size()) / kMostWallPieces);
  for (std::size_t i = 0; i < features.samples.size(); i += stride) {
    const SurfaceSample& sample = features.samples[i];
    if (sample.plane < 0) continue;
    const auto plane = static_cast<std::size_t>(sample.plane);
    pieces_.push_back({sample.mean, sample.normal,
                       static_cast<double>(stride) * static_cast<double>(sample.area_m2),
                       features.planes[plane].oriented, features.planes[plane].interior, plane});
  }
}

std::vector<Vector3d> ModelWalls::stations_under(const Rigid3& model_from_scan) const {
  std::vector<Vector3d> stations;
  if (scan_.stations == nullptr) return stations;
  for (const Vector3d& station : *scan_.stations) stations.push_back(model_from_scan * station);
  return stations;
}

bool ModelWalls::is_asked(const Piece& piece, const Vector3d& at,
                          const std::vector<Vector3d>& stations) const {
  // From where nobody knows: what was seen through openings as the scan itself tells it.
  if (stations.empty()) return !piece.interior && (!scan_.mobile || model_.reach.contains(at));
  const auto nearest = std::min_element(stations.begin(), stations.end(), [&](const auto& a, const auto& b) {
    return (a - at).squaredNorm() < (b - at).squaredNorm();
  });
  return std::none_of(openings_.begin(), openings_.end(),
                      [&](const Rectangle& opening) { return opening.is_crossed(*nearest, at); });
}

WallBalance ModelWalls::under(const Rigid3& model_from_scan) const {
  CancelScope::check();
  struct Sums {
    double asked_m2 = 0.0;
    double explained_m2 = 0.0;
  };
  std::vector<Sums> planes(scan_.features->planes.size());
  const std::vector<Vector3d> stations = stations_under(model_from_scan);
  for (const Piece& piece : pieces_) {
    SightQuery query;
    query.normal = model_from_scan.rotation * piece.normal;
    if (std::abs(query.normal.z()) > kWallTilt) continue;
    query.at = model_from_scan * piece.at;
    if (!is_asked(piece, query.at, stations)) continue;
    query.oriented = piece.oriented;
    query.surface_m = kMissesDrawingM;
    Sums& sums = planes[piece.plane];
    sums.asked_m2 += piece.area_m2;
    if (model_.space->look(query).kind == SightKind::surface) sums.explained_m2 += piece.area_m2;
  }
  const Reaching* reaching = reaching_under(model_from_scan.rotation);
  WallBalance balance;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    if (!(planes[p].asked_m2 > 0)) continue;
    const double wall = reaching != nullptr ? kLowPlaneShare + (1.0 - kLowPlaneShare) * (*reaching)[p] : 1.0;
    const double asked = wall * observations(planes[p].asked_m2);
    balance.asked += asked;
    balance.explained += asked * planes[p].explained_m2 / planes[p].asked_m2;
  }
  return balance;
}

}  // namespace limen
