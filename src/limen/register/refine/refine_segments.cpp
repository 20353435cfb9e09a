// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/refine_segments.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "limen/base/angles.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

using Rows = Eigen::Matrix<double, 3, 6>;

constexpr double kFirstSegmentGateM = 0.15;  // segments nearer than this are matched in the first round
constexpr int kSegmentRounds = 10;
constexpr double kPieceM = 0.2;
constexpr double kPieces = 1500.0;       // about, at most
constexpr double kFullEvidenceM = 1.5;   // a longer segment is no more of a coincidence
constexpr double kShortM = 0.2;          // a match this long has half the weight of a long one
constexpr double kPastEndM = 0.03;       // a piece may lie this far beyond the end of a segment
constexpr double kLeastScatterM = 1e-4;  // no set of segments is known better
constexpr double kCorrelation = 1.7;     // variances are raised by this: neighbouring edges share errors
constexpr double kFlatM = 0.1;           // matched segments nearer than this to a plane lie in it

/// Of a line with noisy ends the mean square distance along it is 2/3 of an end's, in two components.
constexpr double kFreedomsPerEnd = 4.0 / 3.0;

/// Residual of a point against a line by (turn, shift) about `centre`: (I - d d^T) [-[x]x | I].
Rows rows_of(const Vector3d& x, const Vector3d& direction) {
  const Matrix3d across = Matrix3d::Identity() - direction * direction.transpose();
  Rows rows;
  rows << -across * skew(x), across;
  return rows;
}

double tukey(double residual, double gate) {
  const double x = residual / gate;
  return x >= 1.0 ? 0.0 : (1.0 - x * x) * (1.0 - x * x);
}

}  // namespace

SegmentRefiner::SegmentRefiner(const std::vector<Segment>& moved, const std::vector<Segment>& fixed)
    : fixed_(fixed), lookup_(fixed, kFirstSegmentGateM, radians(kMatchedSegmentsDeg)) {
  pieces_ = sample_segments(moved, std::max(kPieceM, total_length(moved) / kPieces));
  for (const SegmentSample& piece : pieces_) {
    const double length = moved[static_cast<std::size_t>(piece.segment)].length();
    evidence_m_.push_back(piece.length_m * std::min(1.0, kFullEvidenceM / length));
    total_evidence_m_ += evidence_m_.back();
  }
}

std::vector<SegmentRefiner::Match> SegmentRefiner::match(const Rigid3& pose, double gate_m) const {
  std::vector<Match> matches;
  std::size_t first = 0;  // match of the current moved segment: its pieces follow one another
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (i > 0 && pieces_[i].segment != pieces_[i - 1].segment) first = weigh(first, matches);
    const Vector3d at = pose * pieces_[i].at;
    const SegmentHit hit = lookup_.nearest(at, pose.rotation * pieces_[i].direction);
    if (hit.segment < 0 || hit.distance_m >= gate_m) continue;
    const Segment& line = fixed_[static_cast<std::size_t>(hit.segment)];
    const Vector3d direction = line.direction();
    const double along = direction.dot(at - line.a);
    if (along < -kPastEndM || along > line.length() + kPastEndM) continue;
    matches.push_back({i, hit.segment, at, line.a + along * direction - at, direction, 0.0});
  }
  weigh(first, matches);
  return matches;
}

/// Shares two ends' worth of evidence among the pieces of one moved segment that lie on one fixed segment.
/// Returns where the next segment's matches begin.
std::size_t SegmentRefiner::weigh(std::size_t first, std::vector<Match>& matches) const {
  for (std::size_t k = first; k < matches.size(); ++k) {
    double length = 0.0;
    double pieces = 0.0;
    for (std::size_t j = first; j < matches.size(); ++j) {
      if (matches[j].fixed != matches[k].fixed) continue;
      length += pieces_[matches[j].piece].length_m;
      pieces += 1.0;
    }
    matches[k].weight = 2.0 / pieces * length / (length + kShortM);
  }
  return matches.size();
}

Vector3d SegmentRefiner::middle_of(const std::vector<Match>& matches) {
  Vector3d sum = Vector3d::Zero();
  double weights = 0.0;
  for (const Match& m : matches) {
    sum += m.weight * m.at;
    weights += m.weight;
  }
  return sum / weights;
}

/// One Gauss-Newton step.
void SegmentRefiner::adjust(const std::vector<Match>& matches, double gate_m, Rigid3& pose) {
  const Vector3d centre = middle_of(matches);
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  for (const Match& m : matches) {
    const Rows rows = rows_of(m.at - centre, m.direction);
    const double weight = m.weight * tukey(m.residual.norm(), gate_m);
    normal += weight * rows.transpose() * rows;
    right += weight * rows.transpose() * m.residual;
  }
  const Vector6d step =
      solve_symmetric(Matrix6d(normal + 1e-6 * normal.trace() * Matrix6d::Identity()), right);
  const Matrix3d turn = rotation_exp(step.head<3>());
  pose.rotation = nearest_rotation(turn * pose.rotation);
  pose.translation = turn * (pose.translation - centre) + centre + step.tail<3>();
}

void SegmentRefiner::summarise(const std::vector<Match>& matches, double gate_m, SegmentFit& fit) {
  RefinedPose& pose = fit.pose;
  pose.centre = middle_of(matches);
  double squares = 0.0;
  double weights = 0.0;
  Matrix3d spread = Matrix3d::Zero();
  for (const Match& m : matches) {
    const Rows rows = rows_of(m.at - pose.centre, m.direction);
    const double weight = m.weight * tukey(m.residual.norm(), gate_m);
    pose.information += weight * rows.transpose() * rows;
    squares += weight * m.residual.squaredNorm();
    weights += weight;
    spread += m.weight * (m.at - pose.centre) * (m.at - pose.centre).transpose();
  }
  if (!(weights > 0.0)) return;
  const double freedoms = std::max(0.5, kFreedomsPerEnd * weights - 6.0);
  const double scatter = std::max(squares / freedoms, kLeastScatterM * kLeastScatterM);
  pose.information /= kCorrelation * scatter;
  pose.rms_m = std::sqrt(squares / weights);
  const Spectrum3 spectrum = spectrum_of(spread);
  fit.in_one_plane = spectrum.values[0] < kFlatM * kFlatM * weights;
}

void SegmentRefiner::count(const std::vector<Match>& matches, SegmentFit& fit) const {
  fit.met_m.assign(pieces_.size(), 0.0);
  std::set<int> segments;
  for (const Match& m : matches) {
    const SegmentSample& piece = pieces_[m.piece];
    const double share = m.residual.norm() / kLastSegmentGateM;
    fit.met_m[m.piece] = evidence_m_[m.piece] * std::max(0.0, 1.0 - share * share);
    fit.evidence_m += fit.met_m[m.piece];
    fit.matched_m += piece.length_m;
    segments.insert(piece.segment);
    const Rows rows = rows_of(m.at - fit.pose.centre, m.direction);
    fit.pose.geometry_m2 += piece.length_m * rows.transpose() * rows;
  }
  fit.matched_segments = static_cast<int>(segments.size());
}

SegmentFit SegmentRefiner::refine(const Rigid3& fixed_from_moved) const {
  SegmentFit fit;
  fit.pose.target_from_source = fixed_from_moved;
  for (int round = 0; round < kSegmentRounds; ++round) {
    const double share = static_cast<double>(round) / (kSegmentRounds - 1);
    const double gate = kFirstSegmentGateM * std::pow(kLastSegmentGateM / kFirstSegmentGateM, share);
    const std::vector<Match> matches = match(fit.pose.target_from_source, gate);
    if (matches.size() < 3) break;
    adjust(matches, gate, fit.pose.target_from_source);
  }
  const std::vector<Match> matches = match(fit.pose.target_from_source, kLastSegmentGateM);
  fit.met_m.assign(pieces_.size(), 0.0);
  if (matches.empty()) return fit;
  summarise(matches, kLastSegmentGateM, fit);
  count(matches, fit);
  return fit;
}

}  // namespace limen
