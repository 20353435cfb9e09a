// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/enumerate_segment_poses.h"

#include <algorithm>
#include <cmath>

#include "limen/base/parallel.h"
#include "limen/match/planes/direction_clusters.h"
#include "limen/match/segments/parallel_rotations.h"
#include "limen/match/segments/segment_lookup.h"
#include "limen/match/segments/segment_votes.h"
#include "limen/match/solvers/rigid_from_lines.h"

namespace limen {
namespace {

constexpr double kParallelDeg = 5.0;       // segments that differ by less are parallel
constexpr double kSegmentReachM = 0.15;    // d of (8): pieces farther apart do not match
constexpr std::size_t kMostSources = 400;  // longest segments of the smaller set that vote
constexpr std::size_t kMostSegmentPoses = 2000;
constexpr double kSamePoseDeg = 2.0;  // poses nearer than both bounds are one
constexpr double kSameSegmentShiftM = 0.15;
constexpr std::size_t kMostTargets = 12000;  // longest segments of the larger set that are voted for
constexpr double kMinDirectionShare = 0.02;  // of the length: fewer segments make no direction
constexpr int kDirections = 6;               // heaviest of each set
constexpr double kMinAlignedShare = 0.5;     // of the best rotation's: turns that align less are not tried
constexpr std::size_t kPieces = 700;         // about; of the smaller set, to measure a pose
constexpr double kFinestPieceM = 0.2;
constexpr std::size_t kCoarseStride = 4;  // pieces left out in the first look
constexpr std::size_t kSecondLook = 4;    // of so many shifts one is looked at with all pieces
constexpr std::size_t kLeastSecondLook = 60;
constexpr int kSegmentFitRounds = 2;

/// Directions of a set, heaviest first.
std::vector<AxisDirection> directions_of(const std::vector<Segment>& segments) {
  DirectionClusterOptions options;
  options.max_angle_rad = radians(kParallelDeg);
  options.max_clusters = 0;
  const DirectionClusters found = cluster_directions(segments, std::nullopt, options);
  std::vector<AxisDirection> directions;
  double total = 0.0;
  for (const DirectionCluster& cluster : found.clusters) {
    directions.push_back({cluster.direction, cluster.weight});
    total += cluster.weight;
  }
  std::stable_sort(directions.begin(), directions.end(),
                   [](const AxisDirection& a, const AxisDirection& b) { return a.weight > b.weight; });
  std::erase_if(directions,
                [total](const AxisDirection& d) { return d.weight < kMinDirectionShare * total; });
  if (directions.size() > kDirections) directions.resize(kDirections);
  return directions;
}

/// Weight of (8) for a piece: its length where it lies on the other set, nothing beyond the reach.
double gain(const SegmentSample& piece, const SegmentHit& hit) {
  if (hit.segment < 0) return 0.0;
  const double share = hit.distance_m / kSegmentReachM;
  return piece.length_m * (1.0 - share * share);
}

/// The enumeration with the smaller set as source.
class SegmentEnumerator {
 public:
  SegmentEnumerator(const std::vector<Segment>& source, const std::vector<Segment>& target,
                    const SegmentPoseOptions& options)
      : options_(options),
        source_(source, kMostSources),
        target_(target, kMostTargets),
        source_axes_(directions_of(source)),
        target_axes_(directions_of(target)),
        target_segments_(target),
        lookup_(target, kSegmentReachM, radians(2.0 * kParallelDeg)) {
    const double step = std::max(kFinestPieceM, source_.total_length_m() / static_cast<double>(kPieces));
    std::vector<Segment> used;
    for (std::size_t i = 0; i < source_.size(); ++i) {
      const Vector3d half = 0.5 * source_.lengths_m[i] * source_.directions[i];
      used.push_back({source_.middles[i] - half, source_.middles[i] + half});
      middle_ += source_.middles[i] / static_cast<double>(source_.size());
    }
    pieces_ = sample_segments(used, step);
  }

  [[nodiscard]] std::vector<PoseCandidate> run() const {
    const std::vector<Matrix3d> rotations = all_rotations();
    std::vector<std::vector<PoseCandidate>> found(rotations.size());
    parallel_for(rotations.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = poses_of(rotations[i]);
    });
    std::vector<PoseCandidate> all;
    for (const std::vector<PoseCandidate>& poses : found) all.insert(all.end(), poses.begin(), poses.end());
    return distinct(all);
  }

 private:
  /// IV-B: every association of directions, without turns that align much less than the best one.
  [[nodiscard]] std::vector<Matrix3d> all_rotations() const {
    RotationOptions rotation_options;
    rotation_options.gravity_known = options_.gravity_known;
    rotation_options.gravity_tolerance_deg = options_.gravity_tolerance_deg;
    rotation_options.direction_deg = kParallelDeg;
    rotation_options.same_rotation_deg = kSamePoseDeg;
    std::vector<Matrix3d> rotations = enumerate_rotations(source_axes_, target_axes_, rotation_options);
    if (rotations.empty()) rotations = turns_of_parallels(rotation_options);
    std::vector<double> aligned;
    for (const Matrix3d& rotation : rotations) aligned.push_back(aligned_length(rotation));
    const double most = aligned.empty() ? 0.0 : *std::max_element(aligned.begin(), aligned.end());
    std::vector<Matrix3d> kept;
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      if (aligned[i] > 0.0 && aligned[i] >= kMinAlignedShare * most) kept.push_back(rotations[i]);
    }
    return kept;
  }

  /// Where the sets share one direction only.
  [[nodiscard]] std::vector<Matrix3d> turns_of_parallels(const RotationOptions& rotation_options) const {
    std::vector<Matrix3d> all;
    for (const AxisDirection& from : source_axes_) {
      for (const AxisDirection& to : target_axes_) {
        const std::vector<Matrix3d> some = parallel_rotations(source_, target_, from, to, rotation_options);
        all.insert(all.end(), some.begin(), some.end());
      }
    }
    return all;
  }

  /// Length of the source whose directions are directions of the target too.
  [[nodiscard]] double aligned_length(const Matrix3d& rotation) const {
    const double near = std::cos(radians(kParallelDeg));
    double sum = 0.0;
    for (const AxisDirection& a : source_axes_) {
      const Vector3d turned = rotation * a.direction;
      const bool met = std::any_of(target_axes_.begin(), target_axes_.end(), [&](const AxisDirection& b) {
        return std::abs(turned.dot(b.direction)) >= near;
      });
      if (met) sum += a.weight;
    }
    return sum;
  }

  [[nodiscard]] std::vector<PoseCandidate> poses_of(const Matrix3d& rotation) const {
    const std::vector<Vector3d> shifts = vote_shifts(source_, target_, rotation, target_axes_, kParallelDeg);
    std::vector<SegmentSample> turned = pieces_;
    for (SegmentSample& piece : turned) {
      piece.at = rotation * piece.at;
      piece.direction = rotation * piece.direction;
    }
    std::vector<PoseCandidate> poses;
    for (const Vector3d& shift : shifts)
      poses.push_back({{rotation, shift}, support(turned, shift, kCoarseStride)});
    sort_best_first(poses);
    poses.resize(std::min(poses.size(), std::max(kLeastSecondLook, poses.size() / kSecondLook)));
    for (PoseCandidate& pose : poses) fit(turned, pose);
    std::erase_if(poses, [](const PoseCandidate& pose) { return !(pose.precedence > 0.0); });
    return poses;
  }

  [[nodiscard]] double support(const std::vector<SegmentSample>& turned, const Vector3d& shift,
                               std::size_t stride) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < turned.size(); i += stride) {
      const SegmentHit hit = lookup_.nearest(turned[i].at + shift, turned[i].direction);
      sum += gain(turned[i], hit);
    }
    return sum;
  }

  /// IV-D (13 and 14): the shift that lays all pieces that meet on their lines, and its support.
  void fit(const std::vector<SegmentSample>& turned, PoseCandidate& pose) const {
    Vector3d& shift = pose.target_from_source.translation;
    for (int round = 0; round < kSegmentFitRounds; ++round) {
      std::vector<LinePair> pairs;
      for (const SegmentSample& piece : turned) {
        const SegmentHit hit = lookup_.nearest(piece.at + shift, piece.direction);
        const double weight = gain(piece, hit);
        if (!(weight > 0.0)) continue;
        const Segment& met = target_segments_[static_cast<std::size_t>(hit.segment)];
        pairs.push_back({{piece.at, piece.direction}, {met.a, met.direction()}, weight, std::nullopt});
      }
      if (pairs.empty()) break;
      const Vector3d moved = translation_from_lines(Matrix3d::Identity(), pairs, shift).translation;
      if ((moved - shift).norm() > kSegmentReachM) break;
      shift = moved;
    }
    pose.precedence = support(turned, shift, 1);
  }

  static void sort_best_first(std::vector<PoseCandidate>& poses) {
    std::stable_sort(poses.begin(), poses.end(), [](const PoseCandidate& a, const PoseCandidate& b) {
      return a.precedence > b.precedence;
    });
  }

  [[nodiscard]] std::vector<PoseCandidate> distinct(std::vector<PoseCandidate>& poses) const {
    sort_best_first(poses);
    std::vector<PoseCandidate> kept;
    std::vector<Vector3d> middles;
    for (const PoseCandidate& pose : poses) {
      if (kept.size() == kMostSegmentPoses) break;
      const Vector3d middle = pose.target_from_source * middle_;
      bool known = false;
      for (std::size_t k = 0; k < kept.size() && !known; ++k) {
        if ((middles[k] - middle).squaredNorm() >= kSameSegmentShiftM * kSameSegmentShiftM) continue;
        const Matrix3d turn =
            kept[k].target_from_source.rotation.transpose() * pose.target_from_source.rotation;
        known = rotation_angle(turn) < radians(kSamePoseDeg);
      }
      if (known) continue;
      kept.push_back(pose);
      middles.push_back(middle);
    }
    return kept;
  }

  const SegmentPoseOptions& options_;
  VotingSegments source_;
  VotingSegments target_;
  std::vector<AxisDirection> source_axes_;
  std::vector<AxisDirection> target_axes_;
  const std::vector<Segment>& target_segments_;
  SegmentLookup lookup_;
  std::vector<SegmentSample> pieces_;
  Vector3d middle_ = Vector3d::Zero();
};

}  // namespace

std::vector<PoseCandidate> enumerate_segment_poses(const std::vector<Segment>& source,
                                                   const std::vector<Segment>& target,
                                                   const SegmentPoseOptions& options) {
  if (source.empty() || target.empty()) return {};
  if (total_length(source) <= total_length(target)) return SegmentEnumerator(source, target, options).run();
  std::vector<PoseCandidate> poses = SegmentEnumerator(target, source, options).run();
  for (PoseCandidate& pose : poses) pose.target_from_source = inverse(pose.target_from_source);
  return poses;
}

}  // namespace limen
