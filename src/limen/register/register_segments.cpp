// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/register_segments.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/match/segments/enumerate_segment_poses.h"
#include "limen/match/segments/segment_distance.h"
#include "limen/register/judge/verdict.h"
#include "limen/register/refine/refine_segments.h"

namespace limen {
namespace {

constexpr double kLevelDeg = 2.0;         // segments nearer to the vertical, or to level, are so
constexpr double kLevelShare = 0.6;       // of the length of a set that shows its vertical
constexpr double kVerticalShare = 0.1;    // of it, that must be vertical
constexpr std::size_t kListedOthers = 8;  // different poses that are listed though they are no rivals
constexpr std::size_t kMostListed = 200;  // poses besides the best that are reported
constexpr std::size_t kRefinedSegmentPoses = 300;
constexpr double kLeastCommonM = 4.0;      // length in common that a pose must show, long segments cut short
constexpr int kLeastSegments = 6;          // segments in common
constexpr double kLeastChanceShare = 0.3;  // where rivals explain as much, less than this is chance: no match
constexpr double kRivalEvidence = 0.5;  // a pose with a smaller share of the best one's evidence is no rival
constexpr double kRivalShare = 0.45;  // nor one for which less of what distinguishes the two supports it ...
constexpr double kLeadM = 2.0;        // ... where at least this much more supports the best
constexpr double kHeldM = 0.3;        // length (times lever^2 for turns) that must hold each freedom
constexpr double kLooseM = 0.02;      // a shift known less well than this counts as open
constexpr double kLooseDeg = 0.2;     // and so does a turn
constexpr double kSegmentPoseDeg = 1.0;  // poses nearer than both bounds are one pose
constexpr double kSegmentPoseM = 0.06;
constexpr double kUprightEvidence = 0.8;  // an upright pose as good as this is believed before a tilted one

/// Whether most of a set is vertical or level.
bool looks_level(const std::vector<Segment>& segments) {
  double vertical = 0.0;
  double level = 0.0;
  for (const Segment& segment : segments) {
    const double rise = std::abs(segment.b.z() - segment.a.z());
    const double length = segment.length();
    if (rise > std::cos(radians(kLevelDeg)) * length) vertical += length;
    if (rise < std::sin(radians(kLevelDeg)) * length) level += length;
  }
  const double total = total_length(segments);
  return vertical > kVerticalShare * total && vertical + level > kLevelShare * total;
}

struct Judged {
  SegmentFit fit;
  double score_m = 0.0;
};

/// What distinguishes two poses, metres of evidence for either.
struct Contrast {
  double for_first_m = 0.0;
  double for_second_m = 0.0;
};

Contrast contrast(const SegmentFit& first, const SegmentFit& second) {
  Contrast sum;
  for (std::size_t i = 0; i < first.met_m.size(); ++i) {
    const double lead = first.met_m[i] - second.met_m[i];
    (lead > 0.0 ? sum.for_first_m : sum.for_second_m) += std::abs(lead);
  }
  return sum;
}

/// The work with the smaller set, which is moved on the larger one.
class SegmentRegistration {
 public:
  SegmentRegistration(const std::vector<Segment>& moved, const std::vector<Segment>& fixed, Gravity gravity)
      : moved_(moved), fixed_(fixed), gravity_(gravity), refiner_(moved, fixed) {}

  void find_candidates() {
    candidates_ = enumerate_segment_poses(moved_, fixed_, {.gravity_known = gravity_ == Gravity::up});
    const auto worst = std::find_if(candidates_.begin(), candidates_.end(), [&](const PoseCandidate& c) {
      return c.precedence < 0.5 * candidates_.front().precedence;
    });
    candidates_.erase(worst, candidates_.end());
    if (candidates_.size() > kRefinedSegmentPoses) candidates_.resize(kRefinedSegmentPoses);
  }

  void refine() {
    std::vector<SegmentFit> fits(candidates_.size());
    parallel_for(fits.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) fits[i] = refiner_.refine(candidates_[i].target_from_source);
    });
    drop_tilted(fits);
    keep_distinct(fits);
    score();
  }

  /// Fills all of `result` but stages; poses still take the moved set to the fixed one.
  void decide(RegistrationResult& result) {
    if (poses_.empty()) {
      result.reason = "no two directions of the segments of one set are found in the other";
      return;
    }
    const SegmentFit& best = poses_.front().fit;
    if (best.evidence_m < kLeastCommonM || best.matched_segments < kLeastSegments) {
      result.reason = fmt::format("the sets have only {} segments, {:.1f} m, in common at best",
                                  best.matched_segments, best.matched_m);
      return;
    }
    result.unobserved = unobserved_freedoms(best.pose, kHeldM);
    if (too_loose(result.unobserved)) {
      result.unobserved.clear();
      result.reason =
          fmt::format("the {} segments in common do not even fix the rotation", best.matched_segments);
      return;
    }
    judge_rivals(result);
  }

  /// Distinct poses, best first; after decide() rivals of the best come before the others.
  [[nodiscard]] const std::vector<Judged>& poses() const { return poses_; }
  [[nodiscard]] std::size_t rivals() const { return rivals_; }

 private:
  static bool too_loose(const std::vector<UnobservedFreedom>& unobserved) {
    return unobserved.size() > 2 || std::any_of(unobserved.begin(), unobserved.end(),
                                                [](const UnobservedFreedom& f) { return f.rotation; });
  }

  /// Where the vertical shows in both sets, poses that do not keep it are dropped - unless one of them is
  /// clearly better: then z is not up in both.
  void drop_tilted(std::vector<SegmentFit>& fits) const {
    if (gravity_ != Gravity::automatic || !looks_level(moved_) || !looks_level(fixed_)) return;
    const double upright = std::cos(radians(SegmentPoseOptions{}.gravity_tolerance_deg));
    double best = 0.0;
    double best_upright = 0.0;
    const auto keeps_up = [&](const SegmentFit& fit) {
      return fit.pose.target_from_source.rotation(2, 2) > upright;
    };
    for (const SegmentFit& fit : fits) {
      best = std::max(best, fit.evidence_m);
      if (keeps_up(fit)) best_upright = std::max(best_upright, fit.evidence_m);
    }
    if (best_upright < kUprightEvidence * best) return;
    std::erase_if(fits, [&](const SegmentFit& fit) { return !keeps_up(fit); });
  }

  [[nodiscard]] bool same(const RefinedPose& a, const RefinedPose& b,
                          const std::vector<UnobservedFreedom>& open) const {
    const Matrix3d turn = a.target_from_source.rotation.transpose() * b.target_from_source.rotation;
    if (rotation_angle(turn) > radians(kSegmentPoseDeg)) return false;
    const Vector3d middle = inverse(a.target_from_source) * a.centre;
    Vector3d shift = b.target_from_source * middle - a.centre;
    for (const UnobservedFreedom& freedom : open) {
      if (!freedom.rotation) shift -= freedom.direction.dot(shift) * freedom.direction;
    }
    return shift.norm() <= kSegmentPoseM;
  }

  /// Fills poses_.
  void keep_distinct(std::vector<SegmentFit>& fits) {
    std::stable_sort(fits.begin(), fits.end(),
                     [](const SegmentFit& a, const SegmentFit& b) { return a.evidence_m > b.evidence_m; });
    for (SegmentFit& fit : fits) {
      if (!(fit.evidence_m > 0.0)) continue;
      const bool known = std::any_of(poses_.begin(), poses_.end(),
                                     [&](const Judged& other) { return same(other.fit.pose, fit.pose, {}); });
      if (!known) poses_.push_back({std::move(fit), 0.0});
    }
  }

  /// (8) and (14), as a length: what is covered, from both sides, in metres. Ranks the poses by it.
  void score() {
    SegmentDistanceOptions measuring;
    measuring.max_distance_m = kLastSegmentGateM;
    measuring.max_angle_rad = radians(kMatchedSegmentsDeg);
    const SegmentSetMeasure measure(fixed_, measuring);
    const double squared = measuring.max_distance_m * measuring.max_distance_m;
    parallel_for(poses_.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const SetDistance distance = measure.to(moved_, poses_[i].fit.pose.target_from_source);
        poses_[i].score_m = 0.5 * (distance.nominal - distance.distance) / squared;
      }
    });
    std::stable_sort(poses_.begin(), poses_.end(),
                     [](const Judged& a, const Judged& b) { return a.score_m > b.score_m; });
  }

  [[nodiscard]] bool is_rival(const SegmentFit& best, const SegmentFit& other) const {
    if (other.evidence_m < kRivalEvidence * best.evidence_m) return false;
    const Contrast stated = contrast(best, other);
    return stated.for_first_m - stated.for_second_m < kLeadM ||
           stated.for_second_m > kRivalShare * stated.for_first_m;
  }

  void judge_rivals(RegistrationResult& result) {
    const SegmentFit& best = poses_.front().fit;
    const auto others = std::stable_partition(poses_.begin() + 1, poses_.end(), [&](const Judged& other) {
      return !same(best.pose, other.fit.pose, result.unobserved) && is_rival(best, other.fit);
    });
    const auto rivals = static_cast<std::size_t>(others - poses_.begin()) - 1;
    rivals_ = rivals;
    const double share = best.evidence_m / refiner_.total_evidence_m();
    if (rivals > 0 && share < kLeastChanceShare) {
      result.unobserved.clear();
      result.reason = fmt::format(
          "at best {:.0f} % of the smaller set coincides with the other, and {} different poses reach as "
          "much: this is chance",
          100.0 * share, rivals);
      return;
    }
    if (rivals > 0) {
      result.outcome = Outcome::ambiguous;
      result.reason = fmt::format("{} other pose{} fit{} the segments nearly as well", rivals,
                                  rivals == 1 ? "" : "s", rivals == 1 ? "s" : "");
      return;
    }
    if (result.unobserved.empty()) {
      result.unobserved = loose_freedoms(covariance_of(best.pose), kLooseM, kLooseDeg);
    }
    if (!result.unobserved.empty()) {
      result.outcome = Outcome::under_constrained;
      result.reason = "the segments in common do not fix the " + result.unobserved.front().name;
      return;
    }
    result.outcome = Outcome::registered;
    result.reason =
        fmt::format("{} segments, {:.1f} m, coincide{}, and no other pose fits nearly as well",
                    best.matched_segments, best.matched_m, best.in_one_plane ? " in one plane" : "");
  }

  const std::vector<Segment>& moved_;
  const std::vector<Segment>& fixed_;
  Gravity gravity_;
  SegmentRefiner refiner_;
  std::vector<PoseCandidate> candidates_;
  std::vector<Judged> poses_;  // distinct, best first
  std::size_t rivals_ = 0;
};

PoseSigma sigma_of(const RefinedPose& pose, const Vector3d& local_origin) {
  PoseSigma sigma;
  sigma.covariance = covariance_of(pose);
  const Eigen::Matrix<double, 6, 1> deviation = sigma.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  sigma.rotation_rad = deviation.head<3>();
  sigma.translation_m = deviation.tail<3>();
  sigma.centre = local_origin + pose.centre;
  return sigma;
}

Hypothesis hypothesis_of(const Judged& judged, bool swapped, const SegmentSet& source,
                         const SegmentSet& target) {
  Hypothesis hypothesis;
  const Rigid3& pose = judged.fit.pose.target_from_source;
  hypothesis.target_from_source =
      to_world(swapped ? inverse(pose) : pose, source.local_origin, target.local_origin);
  hypothesis.sigma = sigma_of(swapped ? inverted(judged.fit.pose) : judged.fit.pose, target.local_origin);
  hypothesis.score = judged.score_m;
  hypothesis.rms_m = judged.fit.pose.rms_m;
  hypothesis.matched_segments = judged.fit.matched_segments;
  hypothesis.agreeing_length_m = judged.fit.matched_m;
  return hypothesis;
}

/// Runs one step, timed and named.
template <typename Step>
void timed(const char* name, RegistrationResult& result, Monitor& monitor, const Step& step) {
  monitor.throw_if_cancelled();
  monitor.begin_stage(name);
  const auto start = std::chrono::steady_clock::now();
  step();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  result.stages.push_back({name, seconds.count()});
}

void refuse_unusable(const std::vector<Segment>& segments, const char* which) {
  const auto finite = [](const Segment& s) { return s.a.allFinite() && s.b.allFinite(); };
  if (std::all_of(segments.begin(), segments.end(), finite)) return;
  throw Error("coordinates are not finite", fmt::format("segments of the {}", which),
              "leave such segments out");
}

}  // namespace

RegistrationResult register_segments(const SegmentSet& source, const SegmentSet& target, Gravity gravity,
                                     Monitor& monitor) {
  refuse_unusable(source.segments, "source");
  refuse_unusable(target.segments, "target");
  const bool swapped = total_length(source.segments) > total_length(target.segments);
  SegmentRegistration work(swapped ? target.segments : source.segments,
                           swapped ? source.segments : target.segments, gravity);
  RegistrationResult result;
  timed("candidates", result, monitor, [&] { work.find_candidates(); });
  timed("refinement", result, monitor, [&] { work.refine(); });
  timed("verdict", result, monitor, [&] { work.decide(result); });
  if (result.outcome == Outcome::no_match) return result;
  const RefinedPose& found = work.poses().front().fit.pose;
  const RefinedPose best = swapped ? inverted(found) : found;
  for (UnobservedFreedom& freedom : result.unobserved) {
    if (swapped) freedom.direction = best.target_from_source.rotation * freedom.direction;
  }
  result.best = hypothesis_of(work.poses().front(), swapped, source, target);
  result.sigma = result.best.sigma;
  const std::size_t listed = std::min(std::max(work.rivals(), kListedOthers), kMostListed);
  result.rivals = std::min(work.rivals(), listed);
  for (std::size_t k = 1; k < work.poses().size() && k <= listed; ++k) {
    result.alternatives.push_back(hypothesis_of(work.poses()[k], swapped, source, target));
    result.alternatives.back().tie = k <= work.rivals();
  }
  return result;
}

}  // namespace limen
