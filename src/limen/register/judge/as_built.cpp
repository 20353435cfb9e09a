// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/as_built.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "limen/base/angles.h"
#include "limen/register/judge/share_belief.h"

namespace limen {
namespace {

constexpr double kMostAskewRad = radians(1.5);  // what is off the square by more was drawn so
constexpr double kUprightNormal = 0.1;          // sine of a wall's lean, at most
constexpr double kLevelNormal = 0.9;
constexpr double kParallelNormal = 0.2;  // sine: a wall goes on along a direction
constexpr double kStrayOffsetM = 0.03;
constexpr double kStrayTurnRad = radians(1.5);
constexpr double kFreeSigma = 1.0;  // of the pose, metres and radians: nothing beside what surfaces say
constexpr int kRounds = 4;

using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// Three numbers that depend on six unknown ones: value - rows * unknown is normal, or, for a stray one,
/// spread wider.
struct Seen {
  Matrix36 rows = Matrix36::Zero();
  Vector3d value = Vector3d::Zero();
  std::array<Matrix3d, 2> information;
  std::array<double, 2> log_weight = {0.0, 0.0};

  void spread(const Matrix3d& variance, const Vector3d& stray_sigma, double stray) {
    const Matrix3d wider = variance + Matrix3d(stray_sigma.cwiseAbs2().asDiagonal());
    information = {inverse_of(variance), inverse_of(wider)};
    log_weight = {std::log(1.0 - stray) - 0.5 * std::log(variance.determinant()),
                  std::log(stray) - 0.5 * std::log(wider.determinant())};
  }
};

/// log of the density of all, the six numbers integrated out about their likeliest values (Laplace; exact
/// where nothing is stray).
double log_density(const std::vector<Seen>& all) {
  Vector6d unknown = Vector6d::Zero();
  Matrix6d information;
  double sum = 0.0;
  for (int round = 0; round <= kRounds; ++round) {
    information = Matrix6d::Identity() / (kFreeSigma * kFreeSigma);
    Vector6d right = Vector6d::Zero();
    sum = -0.5 * unknown.squaredNorm() / (kFreeSigma * kFreeSigma);
    for (const Seen& one : all) {
      const Vector3d left = one.value - one.rows * unknown;
      const double in = one.log_weight[0] - 0.5 * left.dot(one.information[0] * left);
      const double out = one.log_weight[1] - 0.5 * left.dot(one.information[1] * left);
      const double mixed = std::max(in, out) + std::log1p(std::exp(-std::abs(in - out)));
      sum += mixed;
      const double share = std::exp(in - mixed);
      const Matrix3d weight = share * one.information[0] + (1.0 - share) * one.information[1];
      const Eigen::Matrix<double, 6, 3> weighted = one.rows.transpose() * weight;
      information += weighted * one.rows;
      right += weighted * one.value;
    }
    if (round < kRounds) unknown = solve_symmetric(information, right);
  }
  return sum - 0.5 * log_determinant_of(information);
}

double squared(double x) {
  return x * x;
}

double off_square(const Vector3d& normal, double square_rad) {
  return std::remainder(std::atan2(normal.y(), normal.x()) - square_rad, 0.5 * std::numbers::pi);
}

bool is_wall(const CommonSurface& surface) {
  return surface.long_enough && std::abs(surface.mean_normal.z()) < kUprightNormal;
}

/// What the bends of a surface leave of its slope.
double slope_of(const BuiltBend& bend, double length_m) {
  return 2.0 * bend.offset_m / length_m;
}

// What is believed beforehand of buildings that are not exactly as drawn. scripts/fit_evidence ROWS.jsonl, of
// four buildings: of two real ones and of two of another simulator.
constexpr std::array<BuiltQuality, 5> kQualities = {{{0.238, 0.001, radians(0.05)},
                                                     {0.238, 0.002, radians(0.1)},
                                                     {0.428, 0.004, radians(0.2)},
                                                     {0.048, 0.008, radians(0.4)},
                                                     {0.048, 0.012, radians(0.6)}}};
constexpr BuiltQuality kAsDrawnQuality;
constexpr std::array<BuiltBend, kBendLevels - 1> kBends = {
    {{0.461, 0.0003}, {0.175, 0.001}, {0.046, 0.002}, {0.060, 0.004}, {0.145, 0.008}, {0.113, 0.016}}};
constexpr double kStraySurface = 0.05;  // share of the surfaces that are of two things, or were moved

/// Of each amount of bends the logarithm of the density of what is seen of such pairs. `logs` has it of pairs
/// that seem bent so; a share of those that are not bent seem bent by the next amount, where little is seen.
BendBelief as_it_seems(BendBelief logs, double seems_bent = evidence_table::kSeemsBent) {
  if (seems_bent > 0.0)
    logs[0] = log_sum_exp({std::log1p(-seems_bent) + logs[0], std::log(seems_bent) + logs[1]});
  return logs;
}

/// As drawn with this probability, or not, for each amount of bends.
BendBelief drawn_or_not(const BendBelief& logs, const BendBelief& as_drawn, double probability) {
  BendBelief either{};
  for (std::size_t j = 0; j < kBendLevels; ++j)
    either[j] = log_sum_exp({std::log1p(-probability) + logs[j], std::log(probability) + as_drawn[j]});
  return either;
}

/// By how much the scans are bent is not known. `share`: of what was seen, the part that counts.
double log_density(BendBelief logs, const BendBelief& bends, double share = 1.0) {
  for (std::size_t j = 0; j < kBendLevels; ++j) logs[j] = share * logs[j] + std::log(bends[j]);
  return log_sum_exp(logs);
}

}  // namespace

AsBuiltDensity::AsBuiltDensity(std::span<const CommonSurface> surfaces, double stray)
    : surfaces_(surfaces.begin(), surfaces.end()), stray_(stray) {
  // The heading that most walls follow, by their lengths.
  double most_m = 0.0;
  for (const CommonSurface& first : surfaces_) {
    if (!is_wall(first)) continue;
    const double heading = std::atan2(first.mean_normal.y(), first.mean_normal.x());
    double along_m = 0.0;
    for (const CommonSurface& other : surfaces_)
      if (is_wall(other) && std::abs(off_square(other.mean_normal, heading)) < kMostAskewRad)
        along_m += other.length_m[0];
    if (along_m <= most_m) continue;
    most_m = along_m;
    known_ = true;
    axes_[0] = {std::cos(heading), std::sin(heading), 0.0};
  }
  axes_[2] = Vector3d::UnitZ();
  if (known_) axes_[1] = axes_[2].cross(axes_[0]);
}

bool AsBuiltDensity::goes_on(const CommonSurface& surface, GoingOn same) const {
  if (same == GoingOn::none) return false;
  if (std::abs(surface.normal.z()) > kLevelNormal) return true;
  if (same == GoingOn::slabs) return false;
  return std::abs(surface.normal.dot(axes_[same == GoingOn::along_first ? 0 : 1])) < kParallelNormal;
}

double AsBuiltDensity::of_deviations(const BuiltQuality& quality, const BuiltBend& bend,
                                     const bool* goes_on) const {
  std::vector<Seen> all(surfaces_.size());
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const CommonSurface& surface = surfaces_[i];
    Seen& seen = all[i];
    seen.value = surface.deviation;
    seen.rows.row(0) << surface.at.cross(surface.normal).transpose(), surface.normal.transpose();
    Vector3d variance(squared(bend.offset_m), 0.0, 0.0);
    for (int k = 0; k < 2; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      seen.rows.block<1, 3>(k + 1, 0) = surface.along[axis].cross(surface.normal).transpose();
      variance[k + 1] = squared(slope_of(bend, surface.length_m[axis]));
    }
    if (!goes_on[i])
      variance +=
          2.0 * Vector3d(squared(quality.offset_m), squared(quality.turn_rad), squared(quality.turn_rad));
    seen.spread(surface.measured + Matrix3d(variance.asDiagonal()),
                {kStrayOffsetM, kStrayTurnRad, kStrayTurnRad}, stray_);
  }
  return log_density(all);
}

double AsBuiltDensity::of_directions(const BuiltQuality& quality, const BuiltBend& bend,
                                     const bool* goes_on) const {
  std::vector<Seen> all;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const CommonSurface& surface = surfaces_[i];
    if (!surface.long_enough) continue;
    for (const Vector3d& axis : axes_) {
      const double cosine = surface.mean_normal.dot(axis);
      if (std::abs(cosine) < std::cos(kMostAskewRad)) continue;
      const Vector3d drawn = cosine < 0.0 ? Vector3d(-axis) : axis;
      Vector3d variance = Vector3d::Ones();
      Seen& seen = all.emplace_back();
      for (int k = 0; k < 2; ++k) {
        const auto which = static_cast<std::size_t>(k);
        seen.rows.block<1, 3>(k, 0) = drawn.cross(surface.along[which]).transpose();
        seen.value[k] = surface.along[which].dot(surface.mean_normal - drawn);
        // Two surfaces that are askew each in its own way are less so in the mean.
        variance[k] = squared(surface.normal_sigma_rad[which]) +
                      0.5 * squared(slope_of(bend, surface.length_m[which])) +
                      (goes_on[i] ? 1.0 : 0.5) * squared(quality.turn_rad);
      }
      seen.spread(variance.asDiagonal(), {kMostAskewRad, kMostAskewRad, 0.0}, stray_);
    }
  }
  return log_density(all);
}

double AsBuiltDensity::of_one_place(const BuiltQuality& quality, const BuiltBend& bend) const {
  const auto all = std::make_unique<bool[]>(surfaces_.size());
  std::fill_n(all.get(), surfaces_.size(), true);
  return of_deviations(quality, bend, all.get()) + of_directions(quality, bend, all.get());
}

double AsBuiltDensity::of_look_alike(const BuiltQuality& quality, const BuiltBend& bend, GoingOn same) const {
  const auto which = std::make_unique<bool[]>(surfaces_.size());
  for (std::size_t i = 0; i < surfaces_.size(); ++i) which[i] = goes_on(surfaces_[i], same);
  return of_deviations(quality, bend, which.get()) + of_directions(quality, bend, which.get());
}

BuiltEvidence built_evidence(std::span<const CommonSurface> surfaces) {
  BuiltEvidence evidence;
  const AsBuiltDensity density(surfaces, kStraySurface);
  if (!density.knows_square()) return evidence;
  std::array<double, kBends.size()> look_alikes{};
  for (std::size_t j = 0; j < kBends.size(); ++j) {
    std::vector<double> one;
    std::vector<double> look_alike;
    for (const BuiltQuality& quality : kQualities) {
      const double weight = std::log(quality.weight);
      one.push_back(weight + density.of_one_place(quality, kBends[j]));
      for (const GoingOn same : kGoingOn)
        look_alike.push_back(weight - std::log(kGoingOn.size()) +
                             density.of_look_alike(quality, kBends[j], same));
    }
    evidence.one[j] = log_sum_exp(one);
    evidence.look_alike[j] = log_sum_exp(look_alike);
    evidence.as_drawn[j] = density.of_one_place(kAsDrawnQuality, kBends[j]);
    look_alikes[j] = std::log(kBends[j].weight) + evidence.look_alike[j];
  }
  evidence.one.back() = evidence.look_alike.back() = evidence.as_drawn.back() = log_sum_exp(look_alikes);
  return evidence;
}

BendBelief bends_beforehand(double bent) {
  BendBelief belief{};
  double sum = 0.0;
  for (const BuiltBend& bend : kBends) sum += bend.weight;
  for (std::size_t j = 0; j < kBends.size(); ++j) belief[j] = (1.0 - bent) * kBends[j].weight / sum;
  belief.back() = bent;
  return belief;
}

double built_offset_m() {
  double squares = 0.0;
  for (const BuiltQuality& quality : kQualities) squares += quality.weight * squared(quality.offset_m);
  return std::sqrt(squares);
}

double built_nats(const BuiltEvidence& evidence, const BuiltBelief& belief, double share) {
  const BendBelief one = as_it_seems(drawn_or_not(evidence.one, evidence.as_drawn, belief.as_drawn));
  const BendBelief look_alike =
      as_it_seems(drawn_or_not(evidence.look_alike, evidence.as_drawn, belief.as_drawn));
  const double together = share * (log_density(one, belief.bends) - log_density(look_alike, belief.bends));
  if (share == 1.0) return together;
  const double each = log_density(one, belief.bends, share) - log_density(look_alike, belief.bends, share);
  return 0.5 * (together + each);
}

double as_drawn_nats(const BuiltEvidence& evidence, const BendBelief& bends) {
  return log_density(as_it_seems(evidence.as_drawn), bends) - log_density(as_it_seems(evidence.one), bends);
}

double probability_as_drawn(double nats) {
  return 1.0 / (1.0 + (1.0 / evidence_table::kAsDrawn - 1.0) * std::exp(-nats));
}

BendBelief logs_of_bends(const BuiltEvidence& evidence, double seems_bent) {
  return as_it_seems(drawn_or_not(evidence.one, evidence.as_drawn, evidence_table::kAsDrawn), seems_bent);
}

}  // namespace limen
