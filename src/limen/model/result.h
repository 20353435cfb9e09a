// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/linear.h"
#include "limen/geometry/rigid.h"
#include "limen/model/look_alike_evidence.h"
#include "limen/model/registration_picture.h"
#include "limen/model/scanner_place.h"

namespace limen {

/// The verdict of a registration. A wrong pose must never carry the first name.
enum class Outcome {
  registered,  ///< one pose explains the data clearly better than every different one, six freedoms held
  probable,    ///< the same, but all else is together more probable than the risk: up to one in twenty
  ambiguous,   ///< several different poses explain the data about equally well: see alternatives
  under_constrained,  ///< the best pose leaves some direction free: see unobserved
  no_match            ///< nothing in common was found, or that nothing is shared is the likelier explanation
};
const char* to_string(Outcome outcome);

/// A direction the data does not fix.
struct UnobservedFreedom {
  bool rotation = false;                   ///< a turn about `direction`, else a shift along it
  Vector3d direction = Vector3d::UnitX();  ///< unit vector, target frame
  std::string name;                        ///< in a user's words: "shift along (0.00, 1.00, 0.00)"
};

/// How well a pose is known, in the target frame, about `centre`.
struct PoseSigma {
  Vector3d rotation_rad = Vector3d::Zero();   ///< one standard deviation about x, y, z
  Vector3d translation_m = Vector3d::Zero();  ///< along x, y, z, of the point `centre`
  Vector3d centre = Vector3d::Zero();         ///< the point known best, near the common surface; target world
  /// Of (rotation, translation of `centre`), radians and metres; its diagonal is the squares of the above. A
  /// trajectory's error is in it.
  Matrix6d covariance = Matrix6d::Zero();
  /// The same from the scatter of the points alone, as if no plane stood elsewhere for one scan than for the
  /// other: what `covariance` has beyond it is how far matched planes disagree. Zero where it is not stated.
  Matrix6d formal_covariance = Matrix6d::Zero();
};

/// A candidate pose and how well it explains both scans.
struct Hypothesis {
  Rigid3 target_from_source;  ///< world to world, metres
  PoseSigma sigma;            ///< how well it is known, were it the right one
  /// That the scans were taken so, among all that may be; not of segments.
  std::optional<double> probability;
  double score = 0.0;            ///< higher is better, m^2 of agreeing surface less the contradicted one
  double agreeing_m2 = 0.0;      ///< surface of each scan met by the other, symmetrised
  double contradicted_m2 = 0.0;  ///< surface of one scan standing where the other's rays passed free
  double rms_m = 0.0;            ///< point-to-plane residual over the agreeing surface
  int matched_planes = 0;
  int matched_openings = 0;
  int matched_segments = 0;               ///< of registering sets of segments; `score` is in metres there
  double agreeing_length_m = 0.0;         ///< length of the smaller set of segments that lies on the other
  std::optional<double> explained_share;  ///< against a model: of the walls that the scan saw
  std::string room;                       ///< of a model with named rooms: where the (first) station then is
  std::optional<LookAlikeEvidence> look_alike;  ///< whether it lays a place on a look-alike one, where asked
  bool tie = false;  ///< of an alternative: it cannot be distinguished from the best
};

/// A pair of planes that agree under the final pose.
struct PlaneMatch {
  int source = -1;          ///< index into the source's planes
  int target = -1;          ///< index into the target's planes
  double distance_m = 0.0;  ///< signed, along the target's normal, at the middle of the overlap
  double angle_rad = 0.0;
  double overlap_m2 = 0.0;
};

/// A pair of openings that agree under the final pose.
struct MatchedOpenings {
  int source = -1;              ///< index into the source's openings
  int target = -1;              ///< index into the target's openings
  double shift_across_m = 0.0;  ///< of the target's rectangle against the source's, within the wall
  double shift_up_m = 0.0;
  bool by_outline = false;  ///< both scans saw it arched or round, of one shape
};

/// The thickness of a wall that one scan saw from inside and the other from outside.
struct MeasuredThickness {
  int source_plane = -1;  ///< index into the source's planes
  int target_plane = -1;
  int openings = 0;      ///< that show the two planes to be one wall
  double value_m = 0.0;  ///< distance of the two faces at the openings
  double sigma_m = 0.0;  ///< one standard deviation; large where nothing fixes the pose along the normal
};

/// Seconds of one stage of the pipeline.
struct StageTime {
  std::string name;
  double seconds = 0.0;
};

/// What else may explain two scans than one of the poses found; with the poses' own probabilities the sum
/// is 1.
struct OtherExplanations {
  double nothing_shared = 0.0;  ///< the scans show different places
  double look_alike = 0.0;      ///< different places built alike, which the best pose lays on one another
  double unlisted_pose = 0.0;   ///< they share a place, under a pose that was not proposed
};

/// What became of a start that was given.
struct StartAgreement {
  double shift_m = 0.0;  ///< of the middle of the source, from where the start puts it
  double turn_rad = 0.0;
  double sigmas = 0.0;  ///< the larger of both, in the standard deviations that were given
  /// The start is farther off than its deviations bear, and the data say otherwise.
  [[nodiscard]] bool refuted() const { return sigmas > 4.0; }
};

/// What a published method says of its own pose.
struct PublishedScore {
  std::string method;  ///< "2021-cluster"
  double value = 0.0;  ///< what the method chose its pose by
  std::string unit;    ///< of `value`: "m2" or "m3"
  bool lower_is_better = false;
  std::size_t hypotheses = 0;  ///< poses that it compared
};

struct RegistrationResult {
  Outcome outcome = Outcome::no_match;
  std::string reason;  ///< one sentence for a user: why this verdict
  Hypothesis best;     ///< meaningless for no_match
  PoseSigma sigma;     ///< of `best`; not stated by a published method
  std::vector<UnobservedFreedom> unobserved;
  std::vector<Hypothesis> alternatives;  ///< different poses, best first, without `best`
  std::vector<PlaneMatch> matches;
  /// Planes of a model that were probably not built where it has them; of two scans, that lie beside their
  /// counterparts.
  std::vector<PlaneMatch> moved;
  std::vector<MatchedOpenings> openings;
  std::vector<MeasuredThickness> thickness;  ///< of the walls between the scans, most openings first
  std::size_t judged_poses = 0;              ///< poses that were refined and judged
  std::optional<OtherExplanations> others;   ///< where poses have probabilities
  std::size_t rivals = 0;                    ///< alternatives that cannot be distinguished from `best`
  std::optional<StartAgreement> start;       ///< where one was given and a pose was found
  ScannerPlace source_place;                 ///< where the scanner of each side stood, and who says so
  ScannerPlace target_place;
  std::vector<StageTime> stages;
  std::optional<PublishedScore> published;  ///< set where a published method was asked for and found a pose
  std::shared_ptr<const RegistrationPicture> picture;  ///< null unless it was asked for
};

}  // namespace limen
