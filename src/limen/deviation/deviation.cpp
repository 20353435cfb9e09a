// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/deviation/coverage.h"
#include "limen/deviation/element_shift.h"
#include "limen/deviation/model_faces.h"
#include "limen/deviation/point_faces.h"
#include "limen/deviation/unmodelled.h"

namespace limen {
namespace {

constexpr double kMissingShare = 0.01;   // of an element's surface, that rays passed: less says little of it
constexpr double kContestedShare = 0.3;  // of a face's points that might be on another face
constexpr double kOwnShare = 0.3;        // of the gap to it: matter nearer than this is the face's own
constexpr double kNearLimit = 0.7;       // of the largest distance: what lies there may be anything
constexpr double kPeakShare = 0.65;      // of a face's points that stand together, else it is two things
constexpr double kMostNoise = 1.8;       // of a typical face's: one that scatters more is no plane
constexpr std::size_t kFacePoints = 30;  // fewer do not tell where a face stands

/// Matter that may let light pass: that rays went through says nothing.
bool may_be_pane(BimKind kind) {
  return kind == BimKind::window || kind == BimKind::plate;
}

/// The signed distances of each face, by face.
std::vector<std::vector<float>> distances_by_face(const PointFaces& laid, std::size_t faces) {
  std::vector<std::vector<float>> distances(faces);
  for (std::size_t i = 0; i < laid.face.size(); ++i) {
    if (laid.face[i] >= 0) distances[static_cast<std::size_t>(laid.face[i])].push_back(laid.distance_m[i]);
  }
  return distances;
}

/// The typical gap from each face to another that its points might be on; infinite where few might.
std::vector<double> gaps_by_face(const PointFaces& laid, std::size_t faces) {
  std::vector<std::vector<float>> gaps(faces);
  std::vector<std::size_t> asked(faces, 0);
  for (std::size_t k = 0; k < laid.gap_m.size(); ++k) {
    const std::size_t i = k * PointFaces::kGapStride;
    if (i >= laid.face.size() || laid.face[i] < 0) continue;
    const auto face = static_cast<std::size_t>(laid.face[i]);
    ++asked[face];
    if (!std::isnan(laid.gap_m[k])) gaps[face].push_back(laid.gap_m[k]);
  }
  std::vector<double> typical(faces, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < faces; ++k) {
    if (static_cast<double>(gaps[k].size()) <= kContestedShare * static_cast<double>(asked[k])) continue;
    const auto middle = gaps[k].begin() + static_cast<std::ptrdiff_t>(gaps[k].size() / 2);
    std::nth_element(gaps[k].begin(), middle, gaps[k].end());
    typical[k] = static_cast<double>(*middle);
  }
  return typical;
}

float nth(std::vector<float>& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

/// Figures of all distances of an element.
void describe(std::vector<float>& distances, ElementDeviation& it) {
  it.points = distances.size();
  if (distances.empty()) return;
  double sum = 0.0;
  double squares = 0.0;
  for (const float d : distances) sum += static_cast<double>(d);
  it.mean_m = sum / static_cast<double>(distances.size());
  for (const float d : distances) squares += std::pow(static_cast<double>(d) - it.mean_m, 2);
  it.sigma_m = std::sqrt(squares / static_cast<double>(distances.size()));
  it.median_m = static_cast<double>(nth(distances, 0.5));
  for (float& d : distances) d = std::abs(d);
  it.p95_m = static_cast<double>(nth(distances, 0.95));
  it.loa = loa_class(it.p95_m);
}

Presence presence_of(const ElementDeviation& it, BimKind kind, const DeviationOptions& options) {
  const double reached = it.covered_m2 + it.passed_m2;
  const bool seen =
      it.points >= static_cast<std::size_t>(options.min_points) && it.covered_m2 >= options.min_judged_m2;
  if (seen && (it.covered_share >= options.min_found_share || may_be_pane(kind))) return Presence::found;
  if (reached < options.min_judged_m2 || may_be_pane(kind)) return Presence::not_judged;
  const double least = std::max(options.min_missing_m2, kMissingShare * it.area_m2);
  const bool missing = it.covered_share < options.min_found_share && it.passed_m2 >= least;
  return missing ? Presence::not_found : Presence::not_judged;
}

/// What the faces of one element gather.
struct Gathered {
  std::vector<float> distances;
  std::vector<FaceOffset> offsets;
};

/// The scatter of the points of a typical face: most points' faces scatter less.
double typical_sigma_m(const std::vector<Gathered>& gathered) {
  std::vector<std::pair<double, std::size_t>> sigmas;
  std::size_t total = 0;
  for (const Gathered& g : gathered) {
    for (const FaceOffset& face : g.offsets) {
      sigmas.emplace_back(face.sigma_m, face.points);
      total += face.points;
    }
  }
  std::sort(sigmas.begin(), sigmas.end());
  std::size_t passed = 0;
  for (const auto& [sigma, points] : sigmas) {
    passed += points;
    if (2 * passed >= total) return sigma;
  }
  return 0.0;
}

/// What points and rays say of every face.
struct FaceEvidence {
  std::vector<std::vector<float>> distances_m;
  std::vector<double> gap_m;  ///< to another face that its points might be on
  const std::vector<FaceCoverage>& coverage;
};

class Measuring {
 public:
  Measuring(const BimModel& model, const DeviationOptions& options, Monitor& monitor)
      : model_(model), options_(options), monitor_(monitor), faces_(faces_of(model)) {}

  [[nodiscard]] Deviation run(const ScanInModel& scan) {
    const FaceIndex index(faces_.faces, options_.max_distance_m);
    monitor_.begin_stage("distances");
    PointFaces laid = lay_on_faces(scan, index, options_, monitor_);
    monitor_.begin_stage("coverage");
    const std::vector<FaceCoverage> coverage = face_coverage(scan, laid, index, options_);
    monitor_.throw_if_cancelled();
    monitor_.begin_stage("elements");
    Deviation result;
    result.oriented = scan.centre_known();
    measure_elements(laid, coverage, result);
    find_unmodelled(scan, laid, result);
    name_points(std::move(laid), result);
    return result;
  }

 private:
  void measure_elements(const PointFaces& laid, const std::vector<FaceCoverage>& coverage,
                        Deviation& result) const {
    const FaceEvidence evidence{distances_by_face(laid, faces_.faces.size()),
                                gaps_by_face(laid, faces_.faces.size()), coverage};
    std::vector<std::vector<std::size_t>> faces_of_element(model_.elements.size());
    for (std::size_t k = 0; k < faces_.elements.size(); ++k)
      faces_of_element[static_cast<std::size_t>(faces_.elements[k])].push_back(k);
    result.elements.resize(model_.elements.size());
    for (const BimFace& face : model_.faces)
      result.elements[static_cast<std::size_t>(face.element)].area_m2 += face.area_m2;
    std::vector<Gathered> gathered(model_.elements.size());
    parallel_for(model_.elements.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        ElementDeviation& it = result.elements[e];
        it.element = static_cast<std::int32_t>(e);
        gathered[e] = gather(faces_of_element[e], evidence, it);
        describe(gathered[e].distances, it);
        it.presence = presence_of(it, model_.elements[e].kind, options_);
      }
    });
    find_shifts(gathered, result);
  }

  void find_shifts(std::vector<Gathered>& gathered, Deviation& result) const {
    const double noise_m = typical_sigma_m(gathered);
    std::vector<FaceOffset> all;
    for (std::size_t e = 0; e < gathered.size(); ++e) {
      for (FaceOffset& face : gathered[e].offsets)
        face.contested = face.contested || face.sigma_m > kMostNoise * noise_m;
      result.elements[e].shift = shift_of(gathered[e].offsets, options_);
      all.insert(all.end(), gathered[e].offsets.begin(), gathered[e].offsets.end());
    }
    result.common = shift_of(all, options_);
  }

  [[nodiscard]] Gathered gather(const std::vector<std::size_t>& faces, const FaceEvidence& evidence,
                                ElementDeviation& it) const {
    Gathered all;
    for (const std::size_t k : faces) {
      const std::vector<float>& distances = evidence.distances_m[k];
      it.covered_m2 += evidence.coverage[k].covered_m2;
      if (faces_.panes[k] == 0) it.passed_m2 += evidence.coverage[k].passed_m2;
      all.distances.insert(all.distances.end(), distances.begin(), distances.end());
      if (distances.size() < kFacePoints) continue;
      FaceOffset offset = face_offset(faces_.faces[k].plane.normal, distances, options_.max_distance_m);
      const double off = std::abs(offset.offset_m);
      const bool split =
          static_cast<double>(offset.points) < kPeakShare * static_cast<double>(distances.size());
      offset.contested =
          split || off > kOwnShare * evidence.gap_m[k] || off > kNearLimit * options_.max_distance_m;
      all.offsets.push_back(offset);
    }
    const double reached = it.covered_m2 + it.passed_m2;
    it.covered_share = reached > 0.0 ? it.covered_m2 / reached : 0.0;
    return all;
  }

  void find_unmodelled(const ScanInModel& scan, const PointFaces& laid, Deviation& result) const {
    std::vector<Vector3d> loose;
    for (std::size_t i = 0; i < laid.far.size(); ++i) {
      if (laid.far[i] != 0) loose.push_back(scan.points[i]);
    }
    result.far = loose.size();
    Vector3d low = Vector3d::Constant(1e300);
    Vector3d high = Vector3d::Constant(-1e300);
    for (const FlatFace& face : faces_.faces) {
      for (const Vector2d& p : face.outline.outer) {
        low = low.cwiseMin(face.frame.to_space(p));
        high = high.cwiseMax(face.frame.to_space(p));
      }
    }
    result.unmodelled = pieces_of(loose, options_.cluster_m, options_.min_cluster_points, low, high);
  }

  void name_points(PointFaces laid, Deviation& result) const {
    result.distance_m = std::move(laid.distance_m);
    result.element = std::move(laid.face);
    for (std::int32_t& face : result.element) {
      if (face < 0) continue;
      face = faces_.elements[static_cast<std::size_t>(face)];
      ++result.matched;
    }
  }

  const BimModel& model_;
  const DeviationOptions& options_;
  Monitor& monitor_;
  ModelFaces faces_;
};

}  // namespace

void DeviationOptions::check() const {
  if (!(max_distance_m > 0.0 && max_distance_m <= 1.0))
    throw_bad_option("max_distance_m", max_distance_m, "within (0, 1]");
  if (!(max_angle_deg > 0.0 && max_angle_deg < 90.0))
    throw_bad_option("max_angle_deg", max_angle_deg, "within (0, 90)");
  if (!(tile_m > 0.0)) throw_bad_option("tile_m", tile_m, "more than 0");
  if (rays < 1) throw_bad_option("rays", static_cast<double>(rays), "1 or more");
  if (!(min_judged_m2 > 0.0)) throw_bad_option("min_judged_m2", min_judged_m2, "more than 0");
  if (!(min_missing_m2 > 0.0)) throw_bad_option("min_missing_m2", min_missing_m2, "more than 0");
  if (!(min_found_share > 0.0 && min_found_share < 1.0))
    throw_bad_option("min_found_share", min_found_share, "within (0, 1)");
  if (!(min_held_share > 0.0 && min_held_share < 0.3))
    throw_bad_option("min_held_share", min_held_share, "within (0, 0.3)");
  if (!(max_shift_sigma_m > 0.0)) throw_bad_option("max_shift_sigma_m", max_shift_sigma_m, "more than 0");
  if (!(cluster_m > 0.0)) throw_bad_option("cluster_m", cluster_m, "more than 0");
}

const char* to_string(Presence presence) {
  switch (presence) {
    case Presence::found:
      return "found";
    case Presence::not_found:
      return "not_found";
    case Presence::not_judged:
      return "not_judged";
  }
  return "not_judged";
}

int loa_class(double deviation_m) {
  constexpr struct {
    int loa;
    double most_m;
  } kClasses[] = {{50, 0.001}, {40, 0.005}, {30, 0.015}, {20, 0.050}, {10, 0.150}};
  for (const auto& it : kClasses) {
    if (deviation_m <= it.most_m) return it.loa;
  }
  return 0;
}

Deviation measure_deviation(const Scan& scan, const BimModel& model, const Rigid3& model_from_scan,
                            const DeviationOptions& options, Monitor& monitor) {
  options.check();
  scan.check();
  model.check();
  if (scan.points.empty()) throw Error("holds no points", scan.name, "give a scan with points");
  if (model.faces.empty()) throw Error("holds no faces", model.name, "give a model with elements");
  return Measuring(model, options, monitor).run(ScanInModel(scan, model_from_scan));
}

}  // namespace limen
