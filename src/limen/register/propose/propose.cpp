// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/propose/propose.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "limen/base/parallel.h"
#include "limen/match/openings/enumerate_hybrid_poses.h"
#include "limen/match/planes/enumerate_model_poses.h"
#include "limen/match/segments/enumerate_segment_poses.h"

namespace limen {
namespace {

constexpr std::size_t kFirstLook = 800;  // samples asked per scan when thousands of poses are compared
constexpr std::size_t kMany = 2500;      // poses that get a first look
constexpr std::size_t kGlance = 150;     // samples asked of each scan when there are more
constexpr std::size_t kGlimpse = 40;     // and when there are tens of thousands
constexpr std::size_t kVeryMany = 8000;
// Between two scans as many samples tell which of the poses are worth asking more.
constexpr std::size_t kShortLook = 200;
constexpr std::size_t kSome = 768;
// One pose whose surface agrees by so much, m^2, is no coincidence, and others that reach so small a share of
// it will not become its rivals: what they say in the first digits is enough.
constexpr double kClearM2 = 20.0;
constexpr double kClearShare = 0.15;
// Of a model's poses, which come in the order of what their planes have in common, fewer get a closer look.
constexpr std::size_t kManyInModel = 600;
constexpr std::size_t kSomeInModel = 128;
// In a model a pose is not looked into further where its value is a smaller share of the best one's; the
// fewer samples were asked, the smaller.
constexpr double kGlanceShare = 0.3;
constexpr double kFirstShare = 0.35;
constexpr double kModelShare = 0.45;

/// The same for a scan in a model: the first looks ask the model only, for the scan says little about so much
/// more surface than it saw.
std::vector<PoseCandidate> select_in_model(const std::vector<PoseCandidate>& candidates,
                                           const ScanView& source, const ScanView& target, std::size_t most,
                                           bool openings) {
  std::vector<PoseCandidate> left = candidates;
  if (left.size() > kVeryMany) left = best_of(left, source, target, {kGlimpse, kVeryMany, 0.0, false, false});
  if (left.size() > kManyInModel)
    left = best_of(left, source, target, {kGlance, kManyInModel, 0.25, false, false, kGlanceShare});
  left = best_of(left, source, target, {kFirstLook, kSomeInModel, 1.0, openings, true, kFirstShare});
  return best_of(left, source, target,
                 {kSecondLook, most, kContradictionWeight, openings, true, kModelShare});
}

}  // namespace

std::vector<PoseCandidate> best_of(const std::vector<PoseCandidate>& candidates, const ScanView& source,
                                   const ScanView& target, const Look& look) {
  ScoreOptions coarse;
  coarse.samples = look.samples;
  coarse.openings = look.openings;
  coarse.ask_model = look.ask_model;
  const PoseScorer score_of(source, target, coarse);
  std::vector<double> values(candidates.size());
  parallel_for(candidates.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const PoseScore score = score_of(candidates[i].target_from_source);
      values[i] = score.evidence_m2 - look.contradiction_weight * score.contradicted_m2;
    }
  });
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  if (order.size() > look.most) order.resize(look.most);
  std::vector<PoseCandidate> best;
  for (const std::size_t i : order) {
    const double best_value = values[order.front()];
    const bool poor =
        look.min_share > 0 && best_value >= look.clear_m2 && values[i] < look.min_share * best_value;
    if (poor && best.size() >= look.least) break;
    best.push_back(candidates[i]);
  }
  return best;
}

std::vector<PoseCandidate> select_poses(const std::vector<PoseCandidate>& candidates, const ScanView& source,
                                        const ScanView& target, std::size_t most, bool openings) {
  const bool model = source.model || target.model;
  if (model) return select_in_model(candidates, source, target, most, openings);
  const auto look = [&](std::size_t samples, std::size_t kept, double contradiction_weight) {
    return Look{samples, kept, contradiction_weight, openings, true, kClearShare, 24, kClearM2};
  };
  std::vector<PoseCandidate> left = candidates;
  // A glance that leaves more than half of them costs more than it spares.
  if (left.size() > 2 * kMany) left = best_of(left, source, target, look(kGlance, kMany, 0.25));
  if (left.size() > kSome) left = best_of(left, source, target, look(kShortLook, kSome, 1.0));
  left = best_of(left, source, target, look(kFirstLook, 8 * most, 1.0));
  return best_of(left, source, target, look(kSecondLook, most, kContradictionWeight));
}

namespace {

constexpr double kSlideStepM = 0.4;
constexpr int kFewAnchors = 2;

/// The planes seen through openings alone, or all others.
Features part_of(const Features& features, bool seen_through) {
  Features part;
  std::copy_if(features.planes.begin(), features.planes.end(), std::back_inserter(part.planes),
               [seen_through](const PlanarPolygon& plane) { return plane.interior == seen_through; });
  return part;
}

void append(std::vector<PoseCandidate>& all, const std::vector<PoseCandidate>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// The features that poses are proposed from where a scan looks through openings: what the one sees through
/// them against what is around the other, for the large surfaces of either side would crowd out the few
/// that both share (2021, 3.1; 5 for what a room sees of the street).
struct ThroughPair {
  Features source;
  Features target;
};

std::vector<ThroughPair> through_pairs(const Features& source, const Features& target) {
  const Features source_through = part_of(source, true);
  const Features target_through = part_of(target, true);
  std::vector<ThroughPair> pairs;
  if (!target_through.planes.empty()) pairs.push_back({part_of(source, false), target_through});
  if (!source_through.planes.empty()) pairs.push_back({source_through, part_of(target, false)});
  return pairs;
}

/// Poses that lay openings on openings; the shift across the wall from planes that both scans saw, or
/// assumed.
std::vector<PoseCandidate> opening_candidates(const Features& source, const Features& target,
                                              const ProposalOptions& options) {
  HybridPoseOptions hybrid;
  hybrid.openings.gravity_known = options.planes.gravity_known;
  if (options.wall_thickness_m > 0) hybrid.wall_thickness_m = options.wall_thickness_m;
  std::vector<PoseCandidate> all;
  if (options.method == Method::openings) {
    for (const OpeningPose& pose : enumerate_opening_poses(source, target, hybrid.openings))
      all.push_back({pose.target_from_source, pose.support_m});
    return all;
  }
  for (const HybridPose& pose : enumerate_hybrid_poses(source, target, hybrid))
    all.push_back({pose.target_from_source, pose.support_m2});
  return all;
}

/// Poses of a scan anywhere in a model.
std::vector<PoseCandidate> model_candidates(const Features& source, const Features& target,
                                            const ProposalOptions& options) {
  ModelPoseOptions in_model;
  in_model.gravity_known = options.planes.gravity_known;
  in_model.gravity_tolerance_deg = options.planes.gravity_tolerance_deg;
  if (!options.thorough) in_model.anchors = kFewAnchors;
  if (options.model == ModelSide::target) return enumerate_model_poses(source, target, in_model);
  std::vector<PoseCandidate> poses = enumerate_model_poses(target, source, in_model);
  for (PoseCandidate& pose : poses) pose.target_from_source = inverse(pose.target_from_source);
  return poses;
}

}  // namespace

std::vector<PoseCandidate> propose_poses(const Features& source, const Features& target,
                                         const ProposalOptions& options) {
  std::vector<PoseCandidate> all;
  if (options.method == Method::segments) {
    SegmentPoseOptions lines;
    lines.gravity_known = options.planes.gravity_known;
    lines.gravity_tolerance_deg = options.planes.gravity_tolerance_deg;
    return enumerate_segment_poses(source.segments, target.segments, lines);
  }
  const bool planes = options.method == Method::automatic || options.method == Method::polygons;
  if (planes && options.model != ModelSide::none) {
    all = model_candidates(source, target, options);
    if (!all.empty()) return all;
  }
  if (planes) {
    append(all, enumerate_poses(source, target, options.planes));
    PoseEnumerationOptions fewer = options.planes;
    fewer.max_poses = std::max(1, options.planes.max_poses / 2);
    for (const ThroughPair& pair : through_pairs(source, target))
      append(all, enumerate_poses(pair.source, pair.target, fewer));
  }
  if (options.method != Method::polygons && options.planes.gravity_known)
    append(all, opening_candidates(source, target, options));
  return all;
}

std::vector<PoseCandidate> propose_sliding_poses(const Features& source, const Features& target,
                                                 const ProposalOptions& options) {
  const std::vector<ThroughPair> pairs = through_pairs(source, target);
  if (pairs.empty()) return enumerate_sliding_poses(source, target, kSlideStepM, options.planes);
  std::vector<PoseCandidate> all;
  for (const ThroughPair& pair : pairs)
    append(all, enumerate_sliding_poses(pair.source, pair.target, kSlideStepM, options.planes));
  return all;
}

}  // namespace limen
