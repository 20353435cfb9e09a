// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "limen/model/result.h"
#include "limen/project/control/point_tests.h"
#include "limen/project/decide/decisions.h"
#include "limen/project/graph/pose_graph.h"

namespace limen {

/// What a project found as a whole.
enum class ProjectOutcome {
  registered,  ///< every scan is in one component, and none is in doubt
  partial,     ///< some do
  no_match     ///< no scan was joined to another
};
const char* to_string(ProjectOutcome outcome);

/// A plane as plans and elevations show it: a rectangle, given by its middle and two half sides.
struct PlanPatch {
  Vector3d middle = Vector3d::Zero();
  Vector3d along = Vector3d::Zero();   ///< of an upright plane level
  Vector3d across = Vector3d::Zero();  ///< of an upright plane upwards
  bool upright = false;
};

/// By how much a mobile pass was moved where it was at a time.
struct PassKnot {
  double time_s = 0.0;
  double distance_m = 0.0;               ///< travelled
  Vector3d place = Vector3d::Zero();     ///< of the scanner position, corrected; frame
  Vector3d turn_rad = Vector3d::Zero();  ///< frame axes, about the correction's pivot
  Vector3d shift_m = Vector3d::Zero();   ///< of the pivot
  Vector3d moved_m = Vector3d::Zero();   ///< by what the turn and the shift move the place
  Vector3d turn_sigma_rad = Vector3d::Zero();
  Vector3d moved_sigma_m = Vector3d::Zero();
};

/// How a mobile pass drifted: what its points are moved by once frame_from_scan has moved them
/// (geometry/spline_motion.h).
struct PassCorrection {
  Vector3d pivot = Vector3d::Zero();  ///< frame
  std::vector<PassKnot> knots;
  double shift_rate_m2_per_m = 0.0;  ///< of the random walk that explains it best, per axis
  double turn_rate_rad2_per_m = 0.0;
};

/// One scan (a station, a mobile pass) or one building model.
/// Where a user says that a scan was taken, and what the scans say to that.
struct StatedPosition {
  Vector3d x = Vector3d::Zero();  ///< as it is stated, metres
  Matrix3d covariance = Matrix3d::Identity();
  std::optional<double> missed_m;  ///< by all scans, where enough are placed to compare
  bool contradicted = false;       ///< off by more than chance is once in a thousand
};

struct ProjectScan {
  std::string file;      ///< as the user wrote it
  int index = 0;         ///< of the scan within its file, from 0
  bool several = false;  ///< its file holds others
  std::string sha256;    ///< of the file's bytes
  bool model = false;
  bool mobile = false;
  bool readable = true;
  std::string copy_of;  ///< another file of the same bytes; empty: none
  std::size_t points = 0;
  double surface_m2 = 0.0;  ///< of its planes
  NodeState state = NodeState::floating;
  int component = -1;  ///< 0: the project's; others have a frame of their own; -1: joined to nothing
  /// World of the component's frame from the scan's world; empty where it was joined to nothing.
  std::optional<Rigid3> frame_from_scan;
  PoseSigma sigma;                           ///< against `ProjectResult::sigma_scan`, frame axes
  std::vector<Rigid3> alternatives;          ///< of an ambiguous scan: other places that explain as much
  double doubt = 0.0;                        ///< probability that it is elsewhere than stated
  std::string reason;                        ///< one sentence for a user
  std::vector<Vector3d> stations;            ///< where the scanner stood, world of the component's frame
  std::optional<PassCorrection> correction;  ///< of a mobile pass that was bent
  std::string rigid;                         ///< why a mobile pass was not; empty: it was, or is none
  std::optional<StatedPosition> stated;      ///< if one is
  std::vector<PlanPatch> patches;            ///< its larger planes, upright or level, the same frame
};

struct ProjectAlternative {
  int number = 0;  ///< among the pair's poses
  Rigid3 target_from_source;
  double agreeing_m2 = 0.0;
};

/// A pair of scans that have something in common.
struct ProjectLink {
  int source = -1;  ///< index into ProjectResult::scans
  int target = -1;
  Outcome pair = Outcome::no_match;  ///< what the pair alone says
  bool given = false;                ///< the file says how its scans stand to one another
  SolvedLink solved;
  Rigid3 target_from_source;  ///< the accepted pose, else the best of the pair; world to world
  PoseSigma sigma;
  double agreeing_m2 = 0.0;
  int number = 0;           ///< of the accepted pose, else the best, among the pair's own
  double look_alike = 0.0;  ///< probability that it lays a place on another one built alike ...
  double chance = 0.0;      ///< ... and that it is wrong otherwise; both by the pair alone
  std::vector<ProjectAlternative> alternatives;
  std::string reason;
  std::vector<PlaneMatch> matches;        ///< planes that agree under the pair's own best pose
  std::vector<PlaneMatch> adjusted;       ///< the same where the adjustment of all lays the scans
  std::vector<MatchedOpenings> openings;  ///< and openings
};

/// What would settle a doubt.
struct ProjectQuestion {
  std::string text;
  std::vector<int> scans;         ///< that would move
  std::vector<int> current;       ///< links that support the present place
  std::vector<int> rival;         ///< links that support the other
  std::vector<Decision> answers;  ///< that would settle it
};

/// What became of a user's decision.
enum class DecisionState {
  kept,          ///< nothing contradicts it
  contradicted,  ///< other links or planes do
  unused         ///< there is nothing that it could speak of
};
const char* to_string(DecisionState state);

struct ProjectDecision {
  Decision decision;
  DecisionState state = DecisionState::unused;
  std::string reason;
};

/// What became of a surveyed point.
enum class PointState {
  used,       ///< its coordinates entered
  left_out,   ///< they contradict all else; or it is one of several that may be the wrong one
  compared,   ///< a check point, or a target without coordinates
  not_placed  ///< no scan that is in the frame sees it
};
const char* to_string(PointState state);

enum class PointRole { control, check, tie };
const char* to_string(PointRole role);

/// A scan that sees a surveyed point.
struct ProjectSight {
  int scan = -1;
  bool used = false;
  std::optional<double> missed_m;  ///< between where the scan has it and the adjusted point; none: not placed
};

/// A surveyed point, or a target that ties scans to one another.
struct ProjectPoint {
  std::string name;
  PointRole role = PointRole::control;
  PointState state = PointState::not_placed;
  bool scanner = false;           ///< the place of a scanner, no target
  std::optional<Vector3d> given;  ///< its coordinates, metres
  Vector3d given_sigma = Vector3d::Zero();
  std::optional<Vector3d> found;  ///< by the adjustment; without its own coordinates where they did not enter
  Vector3d found_sigma = Vector3d::Zero();
  PointTest test;  ///< given less found
  std::vector<ProjectSight> sights;
  std::string reason;
};

struct ProjectResult {
  ProjectOutcome outcome = ProjectOutcome::no_match;
  std::string reason;
  std::string frame_kind;           ///< "control", "mobile", "model", "file", "station", or "none"
  Vector3d up = Vector3d::UnitZ();  ///< of the frame
  int frame_scan = -1;  ///< the scan whose world coordinates are the frame; -1: control's, or none
  int sigma_scan = -1;  ///< the scan that is held fixed, against which deviations are stated; -1: none is
  std::string control_file;   ///< empty: none was given
  std::string control_words;  ///< what came of it
  /// Of squared deviations of control points against what they were given; 0: none.
  double control_factor = 0.0;
  std::vector<ProjectPoint> points;  ///< by name
  std::vector<ProjectDecision> decisions;
  std::vector<ProjectScan> scans;
  std::vector<ProjectLink> links;
  std::vector<GraphLoop> loops;  ///< of links, by index
  std::vector<ProjectQuestion> questions;
  std::vector<std::string> notes;
  std::size_t pairs_tried = 0;
  double variance_factor = 0.0;  ///< of the joint adjustment of planes; 0: there was none
  int components = 0;
  std::optional<double> tolerance_m;  ///< that stations are to keep with 95 %, if a user asks
};

}  // namespace limen
