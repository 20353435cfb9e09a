// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/assemble.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/text.h"
#include "limen/project/result/stated_passes.h"
#include "limen/project/solve/adjust_planes.h"
#include "limen/project/solve/judge_decisions.h"
#include "limen/project/solve/place_survey.h"
#include "limen/project/solve/project_graph.h"
#include "limen/project/solve/scans_in_feet.h"
#include "limen/project/solve/straighten_links.h"
#include "limen/project/solve/survey_points.h"
#include "limen/project/state/scan_names.h"
#include "limen/project/survey/survey.h"

namespace limen {
namespace {

class Assembler {
 public:
  Assembler(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs, Survey survey,
            const UserWords& words, const VerdictOptions& bounds, const PoseQuery& query,
            ProjectResult& result)
      : nodes_(nodes),
        pairs_(pairs),
        words_(words),
        survey_(std::move(survey)),
        risk_(bounds.risk),
        probable_risk_(bounds.probable_risk),
        query_(query),
        result_(result) {}

  void run() {
    ProjectGraph made = make_graph(nodes_, pairs_, words_);
    add_target_links(survey_, made);
    add_survey_links(survey_, made);
    solved_ = solve_graph(made.graph, risk_, query_, probable_risk_);
    if (confirm_by_points(survey_, solved_, made))
      solved_ = solve_graph(made.graph, risk_, query_, probable_risk_);
    straighten(made);
    stand_alone();
    placed_ = place_survey(survey_, made, solved_);
    adjust(made);
    graph_ = made.graph;
    pair_of_ = made.pair_of;
    pair_in_place_ = made.pair_in_place;
    settle_frame();
    for (std::size_t n = 0; n < nodes_.size(); ++n) tell_scan(n);
    for (std::size_t k = 0; k < graph_.links.size(); ++k) tell_link(k);
    for (std::size_t k = 0; k < graph_.measured_in_place.size(); ++k) tell_in_place(k);
    tell_moved();
    tell_feet();
    state_look_alikes();
    tell_survey();
    result_.decisions =
        judged_decisions({nodes_, pairs_, words_, broken_, placed_.controlled, graph_, solved_, pair_of_});
    result_.loops = solved_.loops;
    result_.components = solved_.components;
    for (const GraphQuestion& question : solved_.questions) tell_question(question);
    fill_copies();
    settle_outcome();
  }

 private:
  [[nodiscard]] const ScanDigest& digest(int node) const {
    return nodes_[static_cast<std::size_t>(node)].digest;
  }
  [[nodiscard]] std::string name_of(int node) const {
    return scan_name(result_.scans[nodes_[static_cast<std::size_t>(node)].scan]);
  }

  /// A scan alone is its own frame.
  void stand_alone() {
    if (nodes_.size() != 1 || solved_.nodes.front().component >= 0) return;
    solved_.nodes.front().state = NodeState::registered;
    solved_.nodes.front().component = 0;
    solved_.components = 1;
  }

  /// Links measured against the part of a bent pass that saw what is common: solved once more with them.
  void straighten(const ProjectGraph& made) {
    if (const std::optional<PoseGraph> straight = straightened(nodes_, pairs_, made, solved_))
      solved_ = solve_graph(*straight, risk_, query_, probable_risk_);
  }

  /// Where control points contradict one another for good, all is solved as if there were none.
  void adjust(ProjectGraph& made) {
    JointFinding finding = adjust_planes(nodes_, pairs_, made, words_, solved_, placed_);
    if (finding.contradicted) {
      std::string words = "the control points do not define the frame: ";
      for (std::size_t p = 0, named = 0; p < placed_.points.size(); ++p) {
        if (placed_.settled.verdicts[p].known_left_out)
          words += (named++ == 0 ? "" : ", ") + survey_.marks[p].name;
      }
      words += " contradict the others, and without them too few are left";
      made = make_graph(nodes_, pairs_, words_);
      Survey noted = survey_;
      add_target_links(noted, made);
      solved_ = solve_graph(made.graph, risk_, query_, probable_risk_);
      straighten(made);
      stand_alone();
      const std::string file = std::exchange(survey_.file, {});
      for (SurveyMark& mark : survey_.marks) mark.point.known_enters = false;
      placed_ = place_survey(survey_, made, solved_);
      survey_.file = file;
      placed_.words = words;
      finding = adjust_planes(nodes_, pairs_, made, words_, solved_, placed_);
    }
    broken_ = finding.broken;
    bent_ = finding.passes;
    tell_adjustment(finding);
  }

  void tell_survey() {
    result_.points = stated_points(survey_, placed_, nodes_);
    result_.control_file = survey_.file;
    result_.control_words = placed_.words;
    for (const std::string& note : survey_.notes) result_.notes.push_back(note);
    note_sights_left_out();
    if (!survey_.file.empty() && !placed_.placed) result_.notes.push_back(placed_.words);
    if (placed_.placed && placed_.settled.redundancy > 0.0)
      result_.control_factor = placed_.settled.chi_square / placed_.settled.redundancy;
  }

  /// Targets that one scan sees elsewhere than the others do: two of them may be exchanged.
  void note_sights_left_out() {
    std::map<int, std::string> of_scans;
    for (const ProjectPoint& point : result_.points) {
      if (point.state == PointState::not_placed || point.role == PointRole::check) continue;
      const bool others = std::any_of(point.sights.begin(), point.sights.end(),
                                      [](const ProjectSight& it) { return it.used; });
      for (const ProjectSight& sight : point.sights) {
        if (sight.used || !sight.missed_m || !others) continue;
        std::string& names = of_scans[sight.scan];
        names += fmt::format("{}{} ({:.3f} m)", names.empty() ? "" : ", ", point.name, *sight.missed_m);
      }
    }
    for (const auto& [scan, names] : of_scans)
      result_.notes.push_back(
          fmt::format("targets of {} are left out, because they are elsewhere by the other scans: {}",
                      scan_name(result_.scans[static_cast<std::size_t>(scan)]), names));
  }

  void tell_adjustment(const JointFinding& finding) {
    result_.variance_factor = finding.variance_factor;
    if (finding.torn.empty()) return;
    const std::string names = listed(finding.torn, 3, [&](int node) { return name_of(node); });
    result_.notes.push_back(
        fmt::format("the joint adjustment of planes was not applied: it would have moved {} by up to {:.0f} "
                    "mm, more than the links allow; the poses come from the links alone",
                    names, 1e3 * finding.most_moved_m));
  }

  /// The first node of each component that is held firmly lends it its world.
  void settle_frame() {
    frame_node_.assign(static_cast<std::size_t>(std::max(1, solved_.components)), -1);
    for (const bool firm : {true, false}) {
      for (int n = 0; n < graph_.nodes; ++n) {
        const SolvedNode& node = solved_.nodes[static_cast<std::size_t>(n)];
        if (node.component < 0 || (firm && !is_placed(node.state))) continue;
        int& frame = frame_node_[static_cast<std::size_t>(node.component)];
        if (frame < 0) frame = n;
      }
    }
    result_.frame_kind = "none";
    if (solved_.components == 0) return;
    if (placed_.placed) {
      frame_node_.front() = kSurvey;
      result_.frame_kind = "control";
      return;
    }
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      const SolvedNode& solved = solved_.nodes[node];
      if (solved.component == 0 && solved.covariance.isZero())
        result_.sigma_scan = static_cast<int>(nodes_[node].scan);
    }
    const auto n = static_cast<std::size_t>(frame_node_.front());
    result_.frame_scan = static_cast<int>(nodes_[n].scan);
    if (nodes_[n].digest.upright) result_.up = nodes_[n].digest.upright_from_scan.row(2).transpose();
    result_.frame_kind = nodes_[n].digest.mobile  ? "mobile"
                         : nodes_[n].digest.model ? "model"
                         : nodes_[n].grouped      ? "file"
                                                  : "station";
  }

  [[nodiscard]] Rigid3 world_pose(const Rigid3& solved, int node, int frame) const {
    const Vector3d& origin = frame == kSurvey ? survey_.origin : digest(frame).local_origin;
    return to_world(stated_from_solved(frame) * solved, digest(node).local_origin, origin);
  }
  /// From the frame that the graph was solved in to that of the result.
  [[nodiscard]] Rigid3 stated_from_solved(int frame) const {
    if (frame == kSurvey) return {};
    return inverse(solved_.nodes[static_cast<std::size_t>(frame)].frame_from_node);
  }

  void tell_scan(std::size_t n) {
    ProjectScan& scan = result_.scans[nodes_[n].scan];
    const SolvedNode& node = solved_.nodes[n];
    scan.component = node.component;
    scan.state = node.state;
    scan.doubt = node.doubt;
    for (const PlaneDigest& plane : nodes_[n].digest.planes) scan.surface_m2 += plane.area_m2;
    if (scan.mobile) scan.rigid = why_rigid(nodes_[n].digest);
    if (node.component < 0) {
      scan.reason = "no reliable overlap with any other scan";
      return;
    }
    const int frame = frame_node_[static_cast<std::size_t>(node.component)];
    scan.frame_from_scan = world_pose(node.frame_from_node, static_cast<int>(n), frame);
    for (const Rigid3& other : node.alternatives)
      scan.alternatives.push_back(world_pose(other, static_cast<int>(n), frame));
    for (const Vector3d& station : nodes_[n].digest.stations)
      scan.stations.push_back(*scan.frame_from_scan * (nodes_[n].digest.local_origin + station));
    tell_sigma(node, static_cast<int>(n), frame, scan);
    tell_bend(static_cast<int>(n), frame, scan);
    tell_patches(nodes_[n].digest, scan);
    // Only the first component has the project's frame.
    if (node.component > 0 && scan.state != NodeState::floating) {
      scan.state = NodeState::floating;
      scan.reason = fmt::format("{} within group {}; no link between this group and the main group",
                                node.state == NodeState::registered ? "registered"
                                : node.state == NodeState::probable ? "probable"
                                                                    : "uncertain",
                                node.component);
      return;
    }
    scan.reason = reason_of(n);
  }

  void tell_sigma(const SolvedNode& node, int n, int frame, ProjectScan& scan) const {
    const ScanDigest& own = digest(n);
    const Vector3d at = own.stations.empty() ? own.middle : own.stations.front();
    const Rigid3 frame_from_solved = stated_from_solved(frame);
    const LinkPose pose{node.frame_from_node, node.covariance, node.frame_from_node.translation, 0.0};
    const Matrix6d moved =
        moved_covariance(pose, frame_from_solved, frame_from_solved * node.frame_from_node * at);
    for (Eigen::Index k = 0; k < 3; ++k) {
      scan.sigma.rotation_rad[k] = std::sqrt(std::max(0.0, moved(k, k)));
      scan.sigma.translation_m[k] = std::sqrt(std::max(0.0, moved(k + 3, k + 3)));
    }
    scan.sigma.centre = *scan.frame_from_scan * (own.local_origin + at);
  }

  void tell_bend(int n, int frame, ProjectScan& scan) const {
    const auto found =
        std::find_if(bent_.begin(), bent_.end(), [&](const BentPass& pass) { return pass.node == n; });
    if (found == bent_.end()) return;
    const Vector3d& origin = frame == kSurvey ? survey_.origin : digest(frame).local_origin;
    scan.correction = stated_correction(*found, digest(n).track.way, stated_from_solved(frame), origin);
    scan.rigid.clear();
  }

  /// The planes that stand or lie: as large as tiles spread over them.
  void tell_patches(const ScanDigest& digest, ProjectScan& scan) const {
    constexpr double kUpright = 0.1;
    constexpr double kLevel = 0.995;
    constexpr double kLeastM2 = 1.5;
    constexpr double kMostM = 40.0;
    const Rigid3& frame_from_scan = *scan.frame_from_scan;
    for (const PlaneDigest& plane : digest.planes) {
      const Vector3d normal = frame_from_scan.rotation * plane.plane.normal;
      const double rise = std::abs(normal.dot(result_.up));
      if ((rise > kUpright && rise < kLevel) || plane.area_m2 < kLeastM2 || plane.moments.count < 3) continue;
      PlanPatch patch;
      patch.upright = rise <= kUpright;
      const Matrix3d spread =
          frame_from_scan.rotation * plane.moments.covariance() * frame_from_scan.rotation.transpose();
      const Vector3d along = patch.upright ? result_.up.cross(normal).normalized()
                                           : Vector3d(spectrum_of(spread).vectors.col(2));
      const Vector3d across = normal.cross(along).normalized();
      // Evenly spread tiles: the half length is the root of three deviations squared.
      const auto half = [&](const Vector3d& way) {
        return std::sqrt(3.0 * std::max(0.0, way.dot(spread * way))) * way;
      };
      patch.along = half(along);
      patch.across = half(across);
      if (std::max(patch.along.norm(), patch.across.norm()) > kMostM) continue;
      patch.middle = frame_from_scan * (digest.local_origin + plane.centroid + plane.moments.mean());
      scan.patches.push_back(patch);
    }
  }

  /// Known points that a node sees and that count.
  [[nodiscard]] std::size_t known_targets_of(int node) const {
    std::size_t count = 0;
    for (const MarkedPoint& point : placed_.points) {
      const bool seen = std::any_of(point.sights.begin(), point.sights.end(),
                                    [&](const PointSight& sight) { return sight.node == node; });
      count += point.is_known() && seen ? 1 : 0;
    }
    return count;
  }

  [[nodiscard]] std::string reason_of(std::size_t n) const {
    std::size_t verified = 0;
    std::size_t bridges = 0;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (link.source != static_cast<int>(n) && link.target != static_cast<int>(n)) continue;
      verified += solved_.links[k].state == LinkState::verified ? 1 : 0;
      bridges += solved_.links[k].state == LinkState::bridge ? 1 : 0;
    }
    switch (solved_.nodes[n].state) {
      case NodeState::registered:
        if (verified > 0)
          return fmt::format("registered by {} link{} checked by loops", verified, verified == 1 ? "" : "s");
        if (bridges == 0 && placed_.controlled[n])
          return known_targets_of(static_cast<int>(n)) > 3
                     ? "registered by its own targets"
                     : "registered by three targets of its own: an error of one of them perpendicular to "
                       "their plane would not be detected";
        if (bridges == 0)
          return nodes_.size() == 1 ? "the only scan" : "registered by what its links say together";
        return fmt::format("registered by {} link{} that no loop checks", bridges, bridges == 1 ? "" : "s");
      case NodeState::probable:
        return fmt::format("probability {} ({:.3g} % is needed for registered)",
                           percent_words(1.0 - solved_.nodes[n].doubt), 100.0 * (1.0 - risk_));
      case NodeState::ambiguous:
        if (solved_.nodes[n].alternatives.empty())
          return fmt::format("another place is possible ({}): see questions",
                             percent_words(solved_.nodes[n].doubt));
        return "another place fits as well: see alternatives and questions";
      case NodeState::under_constrained:
        return "its links leave a direction undetermined or poorly determined";
      case NodeState::floating:
        break;
    }
    return "not connected to any other scan";
  }

  void tell_link(std::size_t k) {
    const GraphLink& link = graph_.links[k];
    const ScanDigest& source = digest(link.source);
    const ScanDigest& target = digest(link.target);
    ProjectLink stated;
    stated.source = static_cast<int>(nodes_[static_cast<std::size_t>(link.source)].scan);
    stated.target = static_cast<int>(nodes_[static_cast<std::size_t>(link.target)].scan);
    stated.solved = solved_.links[k];
    const auto taken = static_cast<std::size_t>(std::max(0, stated.solved.pose));
    const auto world = [&](const LinkPose& pose) {
      return to_world(pose.target_from_source, source.local_origin, target.local_origin);
    };
    stated.target_from_source = world(link.poses[taken]);
    if (!link.by_targets) stated.agreeing_m2 = link.poses[taken].agreeing_m2;
    stated.sigma = sigma_of(link.poses[taken], target);
    for (std::size_t p = 0; p < link.poses.size(); ++p) {
      if (p != taken)
        stated.alternatives.push_back(
            {link.number_of(static_cast<int>(p)), world(link.poses[p]), link.poses[p].agreeing_m2});
    }
    stated.number = link.number_of(static_cast<int>(taken));
    stated.given = link.trust == LinkTrust::given;
    stated.look_alike = link.look_alike;
    stated.chance = link.chance;
    if (pair_of_[k] >= 0) {
      const RegistrationResult& pair = pairs_[static_cast<std::size_t>(pair_of_[k])].result;
      stated.pair = pair.outcome;
      stated.reason = pair.reason;
      note_change(link, stated);
      // They are those of the pair's own best pose; of another one nothing is known.
      if (stated.number == 0) {
        stated.matches = pair.matches;
        stated.openings = pair.openings;
        if (stated.solved.pose >= 0) stated.adjusted = adjusted_matches(link, pair);
      }
    } else {
      stated.pair = Outcome::registered;
      stated.reason = link.by_targets ? "given by the targets that both see" : "given in the file";
    }
    result_.links.push_back(std::move(stated));
  }

  void tell_in_place(std::size_t k) {
    if (!solved_.in_place[k]) return;
    const PoseEdge& measured = graph_.measured_in_place[k];
    const ScanDigest& source = digest(measured.source);
    const ScanDigest& target = digest(measured.target);
    const RegistrationResult& pair = pairs_[static_cast<std::size_t>(pair_in_place_[k])].result;
    ProjectLink stated;
    stated.source = static_cast<int>(nodes_[static_cast<std::size_t>(measured.source)].scan);
    stated.target = static_cast<int>(nodes_[static_cast<std::size_t>(measured.target)].scan);
    stated.solved.state = LinkState::in_place;
    stated.solved.pose = 0;
    const auto frame_from = [&](int node) -> const Rigid3& {
      return solved_.nodes[static_cast<std::size_t>(node)].frame_from_node;
    };
    take_misfit(measured.pose, inverse(frame_from(measured.target)) * frame_from(measured.source),
                stated.solved);
    stated.target_from_source =
        to_world(measured.pose.target_from_source, source.local_origin, target.local_origin);
    stated.agreeing_m2 = measured.pose.agreeing_m2;
    stated.sigma = sigma_of(measured.pose, target);
    stated.look_alike = pair.others ? pair.others->look_alike : 0.0;
    stated.chance = std::max(0.0, 1.0 - measured.pose.probability - stated.look_alike);
    stated.pair = pair.outcome;
    stated.matches = pair.matches;
    stated.openings = pair.openings;
    stated.reason = "measured from where the other links place both scans";
    result_.links.push_back(std::move(stated));
  }

  static PoseSigma sigma_of(const LinkPose& pose, const ScanDigest& target) {
    const Vector6d sigma = pose.covariance.diagonal().cwiseSqrt();
    return {sigma.head<3>(), sigma.tail<3>(), pose.centre + target.local_origin};
  }

  static bool is_sure(Outcome pair) { return pair == Outcome::registered || pair == Outcome::probable; }

  /// A pair that is sure of its pose, beside which the solution puts its scans, shows that something changed.
  void note_change(const GraphLink& link, const ProjectLink& stated) {
    const SolvedLink& solved = stated.solved;
    if (!is_sure(stated.pair) || solved.state != LinkState::rejected ||
        solved.loop_error_m > kNoOtherPlaceM || solved.loop_error_rad > kOtherPlaceRad)
      return;
    result_.notes.push_back(
        fmt::format("{} and {} alone fit {:.0f} mm and {:.2f} deg from where all scans together have them: "
                    "something was moved or rebuilt between the scans, or one of them is bent",
                    name_of(link.source), name_of(link.target), 1e3 * solved.loop_error_m,
                    degrees(solved.loop_error_rad)));
  }

  /// So do planes that lie beside their counterparts in a pair that is sure of its pose.
  void tell_moved() {
    constexpr std::size_t kNamed = 3;
    std::string pairs;
    std::size_t count = 0;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (pair_of_[k] < 0 || solved_.links[k].pose != link.best || digest(link.source).model ||
          digest(link.target).model)
        continue;
      const RegistrationResult& pair = pairs_[static_cast<std::size_t>(pair_of_[k])].result;
      if (!is_sure(pair.outcome)) continue;
      double most_m = 0.0;
      double area_m2 = 0.0;
      for (const PlaneMatch& plane : pair.moved) {
        most_m = std::max(most_m, std::abs(plane.distance_m));
        area_m2 += plane.overlap_m2;
      }
      if (area_m2 > 0.0 && ++count <= kNamed)
        pairs += fmt::format("{}{} and {} ({:.1f} m2, up to {:.0f} mm)", count == 1 ? "" : "; ",
                             name_of(link.source), name_of(link.target), area_m2, 1e3 * most_m);
    }
    if (count == 0) return;
    if (count > kNamed) pairs += fmt::format("; and {} more", count - kNamed);
    result_.notes.push_back(
        "something was moved or rebuilt between scans, and their accuracy allows for either side: planes lie "
        "beside one another in " +
        pairs);
  }

  void tell_feet() {
    for (const std::size_t n : scans_in_feet(nodes_, solved_))
      result_.notes.push_back(fmt::format(
          "the scanner of {} was 3.28 times as high above its floor as those of the placed scans: "
          "its numbers seem to be feet; export it in metres",
          name_of(static_cast<int>(n))));
  }

  /// The distances of a pair's planes under the poses of the solution; none of passes that were bent.
  [[nodiscard]] std::vector<PlaneMatch> adjusted_matches(const GraphLink& link,
                                                         const RegistrationResult& pair) const {
    const auto bends = [&](const BentPass& pass) {
      return pass.node == link.source || pass.node == link.target;
    };
    if (std::any_of(bent_.begin(), bent_.end(), bends)) return {};
    const ScanDigest& source = digest(link.source);
    const ScanDigest& target = digest(link.target);
    const auto frame_from = [&](int node) {
      return solved_.nodes[static_cast<std::size_t>(node)].frame_from_node;
    };
    const Rigid3 own = to_local(pair.best.target_from_source, source.local_origin, target.local_origin);
    const Rigid3 solved = inverse(frame_from(link.target)) * frame_from(link.source);
    std::vector<PlaneMatch> matches = pair.matches;
    for (PlaneMatch& match : matches) {
      const PlaneDigest& from = source.planes[static_cast<std::size_t>(match.source)];
      const PlaneDigest& to = target.planes[static_cast<std::size_t>(match.target)];
      const auto middle = [](const PlaneDigest& plane) {
        return Vector3d(plane.centroid + plane.moments.mean());
      };
      // What both saw lies in the smaller one.
      const Vector3d x = from.area_m2 < to.area_m2 ? middle(from) : Vector3d(inverse(own) * middle(to));
      match.distance_m += to.plane.normal.dot(solved * x - own * x);
    }
    return matches;
  }

  /// Pairs whose scans are more probably two places built alike: no links, but worth knowing of.
  void state_look_alikes() {
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const RegistrationResult& pair = pairs_[k].result;
      const bool linked = std::find(pair_of_.begin(), pair_of_.end(), static_cast<int>(k)) != pair_of_.end();
      if (linked || pairs_[k].placed || pair.outcome == Outcome::no_match) continue;
      ProjectLink stated;
      stated.source = static_cast<int>(nodes_[pairs_[k].source].scan);
      stated.target = static_cast<int>(nodes_[pairs_[k].target].scan);
      stated.solved.state = LinkState::rejected;
      stated.target_from_source = pair.best.target_from_source;
      stated.agreeing_m2 = pair.best.agreeing_m2;
      stated.sigma = pair.sigma;
      stated.look_alike = pair.others ? pair.others->look_alike : 0.0;
      stated.pair = pair.outcome;
      stated.matches = pair.matches;
      stated.openings = pair.openings;
      const auto said = words_.pairs.find({pairs_[k].source, pairs_[k].target});
      const bool rejected = said != words_.pairs.end() && said->second.kind == DecisionKind::reject;
      stated.reason = rejected ? "rejected by your decision" : pair.reason;
      result_.links.push_back(std::move(stated));
    }
  }

  [[nodiscard]] std::string words_of(const std::vector<int>& links) const {
    return listed(links, 3, [&](int k) {
      const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
      return name_of(link.source) + " with " + name_of(link.target);
    });
  }

  /// To accept a link, another of its poses if there are any, or to reject it.
  void add_answers(int k, ProjectQuestion& stated) const {
    const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
    if (pair_of_[static_cast<std::size_t>(k)] < 0) return;
    const std::vector<std::string> scans = {name_of(link.source), name_of(link.target)};
    const int taken = solved_.links[static_cast<std::size_t>(k)].pose;
    for (std::size_t p = 0; p < link.poses.size() && p < kMostAnswers; ++p) {
      const int number = link.number_of(static_cast<int>(p));
      if (link.poses[p].probability < kPossible && static_cast<int>(p) != std::max(0, taken)) continue;
      stated.answers.push_back({number == 0 ? DecisionKind::accept : DecisionKind::choose, scans, number});
    }
    for (const DecisionKind kind : {DecisionKind::reject, DecisionKind::forget})
      stated.answers.push_back({kind, scans, 0});
  }

  /// Accepted links between these nodes and the others, those that know of several places.
  [[nodiscard]] std::vector<int> links_across(const std::vector<int>& moved) const {
    const auto moves = [&](int node) { return std::find(moved.begin(), moved.end(), node) != moved.end(); };
    std::vector<int> across;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (solved_.links[k].pose >= 0 && link.poses.size() > 1 && moves(link.source) != moves(link.target))
        across.push_back(static_cast<int>(k));
    }
    return across;
  }

  void tell_question(const GraphQuestion& question) {
    ProjectQuestion stated;
    // Of one part there may be doubts about many places; its scans list them all.
    for (const GraphQuestion& other : solved_.questions) {
      if (&other == &question) break;
      const bool same_kind = (other.doubt > 0.0) == (question.doubt > 0.0);
      if (same_kind && other.moved == question.moved && other.current == question.current) return;
    }
    for (const int node : question.moved)
      stated.scans.push_back(static_cast<int>(nodes_[static_cast<std::size_t>(node)].scan));
    const std::string scans = listed(question.moved, 3, [&](int node) { return name_of(node); });
    stated.current = question.current;
    stated.rival = question.rival;
    // One pair at a time: what a person says of it decides the others, or the next question asks of them.
    for (const std::vector<int>& links : {question.current, question.rival, links_across(question.moved)}) {
      for (std::size_t k = 0; k < links.size() && stated.answers.empty(); ++k) add_answers(links[k], stated);
    }
    if (question.doubt > 0.0) {
      const std::string by = question.current.empty()       ? "few observations"
                             : question.current.size() == 1 ? "the link " + words_of(question.current)
                                                            : "the links " + words_of(question.current);
      stated.text = fmt::format(
          "{} {} placed only by {}, which may be wrong ({}). Add a scan that sees both sides, or accept or "
          "reject a link",
          scans, question.moved.size() == 1 ? "is" : "are", by, percent_words(question.doubt));
    } else if (question.rival.empty() && question.current.empty()) {
      stated.text = fmt::format(
          "{} fits equally well in two places. Add a scan that overlaps both it and one of its neighbours",
          scans);
    } else {
      stated.text = fmt::format(
          "Where is {}? Its present place follows from: {}. Another place follows from: {}. Which of these "
          "links is right?",
          scans, question.current.empty() ? "no link" : words_of(question.current),
          question.rival.empty() ? "no link" : words_of(question.rival));
    }
    result_.questions.push_back(std::move(stated));
  }

  void fill_copies() {
    for (ProjectScan& copy : result_.scans) {
      if (copy.copy_of.empty() || !copy.readable) continue;
      for (const ProjectScan& scan : result_.scans) {
        if (scan.file != copy.copy_of || scan.index != copy.index) continue;
        const std::string file = copy.file;
        const std::string of = copy.copy_of;
        copy = scan;
        copy.file = file;
        copy.copy_of = of;
        copy.reason = "identical to " + of + ", with the same pose";
        break;
      }
    }
  }

  void settle_outcome() {
    std::size_t all = 0;
    std::size_t registered = 0;
    std::size_t probable = 0;
    std::size_t unreadable = 0;
    for (const ProjectScan& scan : result_.scans) {
      ++all;
      registered += scan.readable && scan.state == NodeState::registered ? 1 : 0;
      probable += scan.readable && scan.state == NodeState::probable ? 1 : 0;
      unreadable += scan.readable ? 0 : 1;
    }
    result_.outcome = registered == all        ? ProjectOutcome::registered
                      : solved_.components > 0 ? ProjectOutcome::partial
                                               : ProjectOutcome::no_match;
    result_.reason = fmt::format("{} of {} scans are registered in one frame", registered, all);
    if (probable > 0)
      result_.reason += fmt::format(", {} more {} probable", probable, probable == 1 ? "is" : "are");
    if (unreadable > 0) result_.reason += fmt::format(", {} could not be read", unreadable);
    if (!result_.questions.empty())
      result_.reason += fmt::format("; {} question{} open", result_.questions.size(),
                                    result_.questions.size() == 1 ? " is" : "s are");
  }

  const std::vector<ProjectNode>& nodes_;
  const std::vector<TriedPair>& pairs_;
  static constexpr std::size_t kMostAnswers = 3;
  static constexpr double kPossible = 0.01;  // probability of a pose that a question offers
  static constexpr int kSurvey = -2;         ///< in place of a node: the survey's frame

  const UserWords& words_;
  std::vector<bool> broken_;
  std::vector<BentPass> bent_;
  Survey survey_;
  PlacedSurvey placed_;
  double risk_;
  double probable_risk_;
  const PoseQuery& query_;
  ProjectResult& result_;
  PoseGraph graph_;
  SolvedGraph solved_;
  std::vector<int> pair_of_;        ///< of each link: index into pairs_, -1: given
  std::vector<int> pair_in_place_;  ///< the same of each pose measured in place
  std::vector<int> frame_node_;     ///< of each component
};

}  // namespace

void assemble(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
              const ProjectInputs& inputs, const UserWords& words, const VerdictOptions& bounds,
              const PoseQuery& query, ProjectResult& result) {
  Assembler(nodes, pairs, read_survey(inputs, nodes, result.scans), words, bounds, query, result).run();
}

}  // namespace limen
