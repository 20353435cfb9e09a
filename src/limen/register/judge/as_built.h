// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "limen/geometry/linear.h"
#include "limen/model/look_alike_evidence.h"
#include "limen/register/judge/evidence_table.h"

namespace limen {

/// A surface of the building where two scans saw it, the source's moved into the target's upright frame.
struct CommonSurface {
  Vector3d at = Vector3d::Zero();  ///< middle of what both saw
  Vector3d normal = Vector3d::UnitZ();
  std::array<Vector3d, 2> along = {Vector3d::UnitX(), Vector3d::UnitY()};  ///< within it, across one another
  std::array<double, 2> length_m = {1.0, 1.0};                             ///< what both saw, along these
  /// The source's surface less the target's: across at `at`, metres, and its slopes along both, radians; and
  /// the covariance that the scatter of the points leaves of it.
  Vector3d deviation = Vector3d::Zero();
  Matrix3d measured = Matrix3d::Identity();
  /// Mean of the normals of the whole planes, and what scatter leaves of it along both. Long planes only.
  bool long_enough = false;
  Vector3d mean_normal = Vector3d::UnitZ();
  std::array<double, 2> normal_sigma_rad = {0.0, 0.0};
};

/// How well a building is built: one standard deviation from what was drawn.
struct BuiltQuality {
  double weight = 1.0;  ///< share of buildings
  double offset_m = 0.0;
  double turn_rad = 0.0;
};

/// By how far a surface of a building is from where it was drawn, one standard deviation over all buildings.
double built_offset_m();

/// By how much two measurements of one surface differ as a whole, besides scatter, one standard deviation.
struct BuiltBend {
  double weight = 1.0;
  double offset_m = 0.0;
};

/// Which surfaces of a place built alike are the very same ones going on: a row of equal bays has one floor
/// and one façade.
enum class GoingOn { none, slabs, along_first, along_second };
inline constexpr std::array<GoingOn, 4> kGoingOn = {GoingOn::none, GoingOn::slabs, GoingOn::along_first,
                                                    GoingOn::along_second};

/// Logarithms of the density of what was seen, up to a term common to all.
class AsBuiltDensity {
 public:
  AsBuiltDensity(std::span<const CommonSurface> surfaces, double stray);

  /// Whether any wall tells what is square.
  [[nodiscard]] bool knows_square() const { return known_; }
  [[nodiscard]] double of_one_place(const BuiltQuality& quality, const BuiltBend& bend) const;
  [[nodiscard]] double of_look_alike(const BuiltQuality& quality, const BuiltBend& bend, GoingOn same) const;

 private:
  [[nodiscard]] bool goes_on(const CommonSurface& surface, GoingOn same) const;
  [[nodiscard]] double of_deviations(const BuiltQuality& quality, const BuiltBend& bend,
                                     const bool* goes_on) const;
  [[nodiscard]] double of_directions(const BuiltQuality& quality, const BuiltBend& bend,
                                     const bool* goes_on) const;

  std::vector<CommonSurface> surfaces_;
  double stray_;
  bool known_ = false;
  std::array<Vector3d, 3> axes_;  ///< of the square; the third is up
};

/// No two rooms are equal to the millimetre: walls are drawn square, plumb and alike, and built some
/// millimetres and minutes of arc off, each in its own way. How well what two scans saw of the building's
/// surfaces fits one place, and a place built alike. The pose has been fitted to these very surfaces: its six
/// freedoms are integrated out in either explanation. How well the building is built is shown by its own
/// walls, so that one that is exactly as drawn (a simulated one) says nothing.
BuiltEvidence built_evidence(std::span<const CommonSurface> surfaces);

/// Probabilities of the amounts by which the scans of a pair are bent; the sum is 1.
using BendBelief = std::array<double, kBendLevels>;

/// What is believed of pairs of any sensor. `bent`: probability that walls say nothing.
BendBelief bends_beforehand(double bent = evidence_table::kBent);

/// What is believed of how a building was built, and of how it was scanned.
struct BuiltBelief {
  BendBelief bends = bends_beforehand();
  double as_drawn = evidence_table::kAsDrawn;  ///< that it is exactly as drawn
};

/// Nats for one place against one built alike. `share`: of what the pair shows of walls, the part that
/// counts, for other pairs show the rest as well. Whether pairs are bent together or each for itself is not
/// known: the mean of both is taken.
double built_nats(const BuiltEvidence& evidence, const BuiltBelief& belief = {}, double share = 1.0);
/// Nats for a building that is exactly as drawn, if the scans show one place.
double as_drawn_nats(const BuiltEvidence& evidence, const BendBelief& bends = bends_beforehand());
/// The probability of that, given these nats.
double probability_as_drawn(double nats);
/// Of each amount by which scans are bent, the logarithm of the density of what was seen of one place.
/// `seems_bent`: share of the pairs that are not bent and seem so.
BendBelief logs_of_bends(const BuiltEvidence& evidence, double seems_bent = evidence_table::kSeemsBent);

}  // namespace limen
