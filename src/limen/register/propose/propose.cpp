// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/propose/propose.h"

#include <algorithm>
#include <iterator>

#include "limen/match/openings/enumerate_hybrid_poses.h"
#include "limen/match/planes/enumerate_model_poses.h"
#include "limen/match/segments/enumerate_segment_poses.h"

namespace limen {
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
      all.push_back({pose.target_from_source, pose.support_m, pose.thickness_held ? 0 : 1});
    return all;
  }
  for (const HybridPose& pose : enumerate_hybrid_poses(source, target, hybrid))
    all.push_back({pose.target_from_source, pose.support_m2, pose.free_translations});
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

const char* to_string(Method method) {
  switch (method) {
    case Method::automatic:
      return "auto";
    case Method::polygons:
      return "polygons";
    case Method::openings:
      return "openings";
    case Method::hybrid:
      return "hybrid";
    case Method::segments:
      return "segments";
  }
  return "auto";
}

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
