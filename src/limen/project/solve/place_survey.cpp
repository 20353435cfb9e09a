// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/place_survey.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/length_unit.h"
#include "limen/base/progress.h"
#include "limen/base/ranked.h"
#include "limen/base/text.h"
#include "limen/geometry/linear.h"
#include "limen/project/control/control_datum.h"
#include "limen/project/solve/joint_problem.h"

namespace limen {
namespace {

// A scan whose targets fit their coordinates is elsewhere about as seldom as any link is wrong.
constexpr double kTargetsWrong = 1e-6;
constexpr double kTargetsM2 =
    1000.0;  // what targets say of a scan no other scan says: they are witnesses of their own

constexpr double kRigidM = 0.004;
const double kRigidRad = radians(0.03);

std::string names_of(const Survey& survey, const std::vector<std::size_t>& points) {
  return listed(points, 6, [&](std::size_t k) { return survey.marks[k].name; });
}

std::vector<std::size_t> suspects_of(const ControlDatum& datum) {
  std::vector<std::size_t> points;
  for (const std::size_t k : datum.fit.suspects) points.push_back(datum.points[k]);
  return points;
}

std::vector<MarkedPoint> points_of(const Survey& survey) {
  std::vector<MarkedPoint> points;
  for (const SurveyMark& mark : survey.marks) points.push_back(mark.point);
  return points;
}

/// The scan alone, in its own frame.
FramedNodes only(int node, int nodes) {
  FramedNodes framed;
  framed.frame_from_node.resize(static_cast<std::size_t>(nodes));
  framed.covariance.assign(static_cast<std::size_t>(nodes), Matrix6d::Zero());
  framed.member.assign(static_cast<std::size_t>(nodes), false);
  framed.member[static_cast<std::size_t>(node)] = true;
  return framed;
}

/// Other ways in which the coordinates of control points may be meant. Eastings and northings are often
/// exchanged: the mirrored coordinates contradict one another, or, where the points are in a plane, agree
/// with scans that are upside down. Others are not in metres.
class OtherReadings {
 public:
  explicit OtherReadings(const Survey& survey) : up_(survey.up) {
    Matrix3d swap;
    swap << 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    add(survey, swap, swap,
        "agree with the scans only in a mirror, as if x and y are exchanged: check columns and signs");
    for (const LengthUnit& unit : length_units()) {
      const Matrix3d scale = unit.metres_per_unit * Matrix3d::Identity();
      if (unit.metres_per_unit == 1.0) continue;
      // Their deviations may be in metres all the same.
      for (const Matrix3d& of_sigma : {scale, Matrix3d(Matrix3d::Identity())})
        add(survey, scale, of_sigma, fmt::format("agree with the scans only in {}: give metres", unit.name));
    }
  }

  /// The words for the first of them that explains all, where the points as they are (`datum`) do not.
  [[nodiscard]] std::string better(const ControlDatum& datum, const FramedNodes& nodes) const {
    if (explains_all(datum, nodes)) return {};
    for (const auto& [words, points] : readings_) {
      if (explains_all(control_datum(points, nodes), nodes)) return words;
    }
    return {};
  }

 private:
  void add(const Survey& survey, const Matrix3d& change, const Matrix3d& of_sigma, const std::string& words) {
    std::vector<MarkedPoint> points = points_of(survey);
    for (MarkedPoint& point : points) {
      if (point.known)
        point.known =
            KnownPlace{change * point.known->x, of_sigma * point.known->covariance * of_sigma.transpose()};
    }
    readings_.emplace_back(words, std::move(points));
  }

  /// All points agree, and the scans that are known to be upright stay so.
  [[nodiscard]] bool explains_all(const ControlDatum& datum, const FramedNodes& nodes) const {
    const std::vector<bool>& taken = datum.fit.taken;
    if (datum.fit.state != PointFitState::fixed ||
        std::find(taken.begin(), taken.end(), false) != taken.end())
      return false;
    for (std::size_t n = 0; n < up_.size(); ++n) {
      const Matrix3d turn = datum.fit.pose.target_from_source.rotation * nodes.frame_from_node[n].rotation;
      if (nodes.member[n] && (turn * up_[n]).z() < 0.0) return false;
    }
    return true;
  }

  std::vector<Vector3d> up_;
  std::vector<std::pair<std::string, std::vector<MarkedPoint>>> readings_;
};

class SurveyPlacer {
 public:
  SurveyPlacer(const Survey& survey, ProjectGraph& made, SolvedGraph& solved)
      : survey_(survey), made_(made), solved_(solved), readings_(survey) {}

  PlacedSurvey run() {
    placed_.points = points_of(survey_);
    placed_.candidates.assign(placed_.points.size(), false);
    take_out_anchor();
    placed_.controlled.assign(solved_.nodes.size(), false);
    std::vector<bool> held(static_cast<std::size_t>(std::max(0, solved_.components)), false);
    for (std::size_t c = 0; c < held.size(); ++c) held[c] = hold(static_cast<int>(c));
    give_references(placed_.controlled, solved_);
    if (placed_.placed) renumber(held);
    keep_firm_sights();
    tell();
    return std::move(placed_);
  }

 private:
  /// The survey's node and its links have done their work: they joined components and closed loops.
  void take_out_anchor() {
    if (made_.graph.anchor < 0) return;
    const auto anchor = static_cast<std::size_t>(made_.graph.anchor);
    solved_.nodes.resize(anchor);
    made_.graph.nodes = made_.graph.anchor;
    std::size_t links = made_.graph.links.size();
    while (links > 0 && made_.graph.links[links - 1].target == made_.graph.anchor) --links;
    made_.graph.links.resize(links);
    made_.pair_of.resize(links);
    solved_.links.resize(links);
    const auto gone = [links](int link) { return static_cast<std::size_t>(link) >= links; };
    for (GraphQuestion& question : solved_.questions) {
      for (std::vector<int>* list : {&question.current, &question.rival})
        list->erase(std::remove_if(list->begin(), list->end(), gone), list->end());
    }
    solved_.loops.erase(std::remove_if(solved_.loops.begin(), solved_.loops.end(),
                                       [&](const GraphLoop& loop) {
                                         return std::any_of(loop.links.begin(), loop.links.end(), gone);
                                       }),
                        solved_.loops.end());
    made_.graph.anchor = -1;
  }

  /// Moves a component into the survey's frame where its points tell how; false: they do not.
  bool hold(int component) {
    FramedNodes nodes;
    for (const SolvedNode& node : solved_.nodes) {
      nodes.frame_from_node.push_back(node.frame_from_node);
      nodes.covariance.push_back(node.covariance);
      nodes.member.push_back(node.component == component && is_placed(node.state));
    }
    const ControlDatum datum = control_datum(placed_.points, nodes);
    if (datum.points.empty()) return false;
    if (const std::string words = readings_.better(datum, nodes); !words.empty()) {
      refused_ += "; the control points " + words;
      return false;
    }
    const auto agreeing = std::count(datum.fit.taken.begin(), datum.fit.taken.end(), true);
    if (datum.fit.state == PointFitState::too_few || agreeing < 3) {
      refuse(component, datum);
      return false;
    }
    move(component, datum.fit.pose.target_from_source);
    for (std::size_t k = 0; k < datum.points.size(); ++k) {
      placed_.candidates[datum.points[k]] = true;
      placed_.points[datum.points[k]].known_enters = datum.fit.taken[k];
    }
    // Which of them is wrong, all together tell best.
    for (const std::size_t p : suspects_of(datum)) placed_.points[p].known_enters = true;
    placed_.placed = true;
    return true;
  }

  void refuse(int component, const ControlDatum& datum) {
    const std::string which =
        solved_.components > 1 ? fmt::format("group {} keeps", component) : "the scans keep";
    if (datum.fit.state == PointFitState::too_few) {
      refused_ +=
          fmt::format("; {} a frame of their own: {} control point{} seen there, too {} to determine a frame",
                      which, datum.points.size(), datum.points.size() == 1 ? " is" : "s are",
                      datum.points.size() < 3 ? "few" : "nearly in a line, or known too poorly,");
    } else {
      refused_ += fmt::format(
          "; {} a frame of their own: {} contradict one another, and it cannot be decided which is wrong, or "
          "their standard deviations are larger than given",
          which, names_of(survey_, suspects_of(datum)));
    }
  }

  void move(int component, const Rigid3& control_from_frame) {
    Matrix6d turn = Matrix6d::Zero();
    turn.topLeftCorner<3, 3>() = control_from_frame.rotation;
    turn.bottomRightCorner<3, 3>() = control_from_frame.rotation;
    for (std::size_t n = 0; n < solved_.nodes.size(); ++n) {
      SolvedNode& node = solved_.nodes[n];
      if (node.component != component) continue;
      placed_.controlled[n] = true;
      node.frame_from_node = control_from_frame * node.frame_from_node;
      for (Rigid3& other : node.alternatives) other = control_from_frame * other;
      node.covariance = turn * node.covariance * turn.transpose();
    }
  }

  /// Held components become one, the first.
  void renumber(const std::vector<bool>& held) {
    std::vector<int> number(held.size(), 0);
    int next = 1;
    for (std::size_t c = 0; c < held.size(); ++c) {
      if (!held[c]) number[c] = next++;
    }
    for (SolvedNode& node : solved_.nodes) {
      if (node.component >= 0) node.component = number[static_cast<std::size_t>(node.component)];
    }
    solved_.components = next;
  }

  /// Scans that are in doubt do not say where points are.
  void keep_firm_sights() {
    placed_.sights.resize(placed_.points.size());
    for (const MarkedPoint& point : placed_.points)
      placed_.seen_at.emplace_back(point.sights.size(), Vector3d::Zero());
    for (std::size_t p = 0; p < placed_.points.size(); ++p) {
      MarkedPoint& point = placed_.points[p];
      std::vector<PointSight> kept;
      for (std::size_t k = 0; k < point.sights.size(); ++k) {
        const auto n = static_cast<std::size_t>(point.sights[k].node);
        const SolvedNode& node = solved_.nodes[n];
        if (node.component != 0 || !is_placed(node.state)) continue;
        if (placed_.placed && !placed_.controlled[n]) continue;
        kept.push_back(point.sights[k]);
        placed_.sights[p].push_back(k);
      }
      point.sights = std::move(kept);
      if (!placed_.placed) point.known_enters = false;
    }
  }

  void tell() {
    if (survey_.file.empty()) return;
    std::set<int> nodes;
    std::size_t points = 0;
    for (const MarkedPoint& point : placed_.points) {
      if (point.sights.empty() || !point.known || !point.enters) continue;
      ++points;
      for (const PointSight& sight : point.sights) nodes.insert(sight.node);
    }
    if (placed_.placed) {
      placed_.words = fmt::format("{} control points are seen by {} scan{}", points, nodes.size(),
                                  nodes.size() == 1 ? "" : "s");
    } else {
      placed_.words = "the control points do not define the frame";
      if (refused_.empty()) placed_.words += ": no registered scan sees any of them";
    }
    placed_.words += refused_;
  }

  const Survey& survey_;
  ProjectGraph& made_;
  SolvedGraph& solved_;
  OtherReadings readings_;
  PlacedSurvey placed_;
  std::string refused_;
};

/// A link by targets, whose pose is known as `pose` says.
void add_link(int source, int target, LinkPose pose, ProjectGraph& made) {
  GraphLink link;
  link.source = source;
  link.target = target;
  link.trust = LinkTrust::given;
  link.by_targets = true;
  link.chance = kTargetsWrong;
  pose.agreeing_m2 = kTargetsM2;
  // As rigid as scans are taken to be in the loops; the adjustment has the sights themselves.
  for (Eigen::Index k = 0; k < 6; ++k)
    pose.covariance(k, k) += k < 3 ? kRigidRad * kRigidRad : kRigidM * kRigidM;
  link.poses.push_back(pose);
  made.graph.links.push_back(std::move(link));
  made.pair_of.push_back(-1);
}

void link_to_survey(int node, const LinkPose& pose, ProjectGraph& made) {
  add_link(node, made.graph.anchor, pose, made);
}

/// Targets that two scans see.
struct SharedTargets {
  std::vector<PointPair> pairs;
  std::vector<std::size_t> marks;
};

/// By the scans, the lower first. Of passes the place of a target hangs on its time: they are left out.
std::map<std::pair<int, int>, SharedTargets> shared_targets(const Survey& survey) {
  std::map<std::pair<int, int>, SharedTargets> all;
  for (std::size_t m = 0; m < survey.marks.size(); ++m) {
    const SurveyMark& mark = survey.marks[m];
    if (mark.role == PointRole::check || mark.scanner) continue;
    const std::vector<PointSight>& sights = mark.point.sights;  // by their nodes
    for (std::size_t b = 1; b < sights.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        if (sights[a].node == sights[b].node || sights[a].strayed_m > 0.0 || sights[b].strayed_m > 0.0)
          continue;
        SharedTargets& shared = all[{sights[a].node, sights[b].node}];
        shared.pairs.push_back(
            {sights[a].x_in_node, sights[a].covariance, sights[b].x_in_node, sights[b].covariance});
        shared.marks.push_back(m);
      }
    }
  }
  return all;
}

/// Targets against the poses that pairs of scans are sure of without them. Wrong units, axes and columns are
/// wrong in all scans alike, so that targets agree with one another.
class TargetsAgainstScans {
 public:
  TargetsAgainstScans(const std::map<std::pair<int, int>, SharedTargets>& all, const ProjectGraph& made) {
    for (const GraphLink& link : made.graph.links) {
      if (link.trust != LinkTrust::measured || link.chance + link.look_alike > kSound) continue;
      const bool forward = link.source < link.target;
      const LinkPose& pose = link.poses.front();
      const std::pair<int, int> nodes = std::minmax(link.source, link.target);
      const auto shared = all.find(nodes);
      if (shared != all.end()) compare(nodes, shared->second, forward ? pose : reversed(pose));
    }
  }

  /// The pairs of scans whose targets are elsewhere by more than half.
  [[nodiscard]] const std::set<std::pair<int, int>>& wrong() const { return wrong_; }
  [[nodiscard]] bool all_wrong() const { return wrong_.size() > right_; }
  [[nodiscard]] std::string words() const {
    std::vector<double> missed = missed_m_;
    return fmt::format(
        "the targets are not used: they are {:.2f} m apart in {} of {} pairs of scans whose surfaces agree; "
        "check "
        "their unit and the order of their columns",
        median(missed), wrong_.size(), wrong_.size() + right_);
  }

 private:
  static constexpr double kSound = 1e-3;

  void compare(const std::pair<int, int>& nodes, const SharedTargets& shared, const LinkPose& pose) {
    std::vector<double> missed;
    for (const PointPair& pair : shared.pairs) {
      const Vector3d at = pose.target_from_source * pair.x_in_source;
      const Matrix3d& turn = pose.target_from_source.rotation;
      const Matrix3d covariance = pair.target_covariance + turn * pair.source_covariance * turn.transpose() +
                                  moved_covariance(pose, Rigid3{}, at).bottomRightCorner<3, 3>();
      const Vector3d miss = pair.x_in_target - at;
      if (miss.dot(solve_symmetric(covariance, miss)) > kPointChiSquareBound) missed.push_back(miss.norm());
    }
    if (2 * missed.size() <= shared.pairs.size()) {
      ++right_;
      return;
    }
    wrong_.insert(nodes);
    missed_m_.insert(missed_m_.end(), missed.begin(), missed.end());
  }

  std::set<std::pair<int, int>> wrong_;
  std::size_t right_ = 0;
  std::vector<double> missed_m_;
};

/// Looks for scans of one component that known points confirm.
class Confirmer {
 public:
  Confirmer(const Survey& survey, const SolvedGraph& solved, int component) : points_(points_of(survey)) {
    for (const SolvedNode& node : solved.nodes) {
      framed_.frame_from_node.push_back(node.frame_from_node);
      framed_.covariance.push_back(node.covariance);
      framed_.member.push_back(node.component == component &&
                               (is_placed(node.state) || node.state == NodeState::ambiguous));
    }
  }

  /// Where the scan is in the survey's frame by the points of all others; empty where they do not determine
  /// it, or it sees its own elsewhere, or none.
  [[nodiscard]] std::optional<LinkPose> place(int node) const {
    if (!sees_known(node)) return {};
    FramedNodes others = framed_;
    others.member[static_cast<std::size_t>(node)] = false;
    const ControlDatum datum = control_datum(apart_from(node), others);
    if (datum.fit.state != PointFitState::fixed || !datum.fit.suspects.empty()) return {};
    const Rigid3& own = framed_.frame_from_node[static_cast<std::size_t>(node)];
    const Rigid3& survey = datum.fit.pose.target_from_source;
    LinkPose placed;
    placed.target_from_source = survey * own;
    placed.centre = placed.target_from_source.translation;
    const LinkPose in_frame{own, framed_.covariance[static_cast<std::size_t>(node)], own.translation, 0.0};
    placed.covariance = moved_covariance(in_frame, survey, placed.centre) +
                        moved_covariance(datum.fit.pose, Rigid3{}, placed.centre);
    for (const MarkedPoint& point : points_) {
      for (const PointSight& sight : point.sights) {
        if (sight.node == node && point.is_known() && !predicted(point, sight, placed)) return {};
      }
    }
    return placed;
  }

 private:
  static constexpr double kSharpM =
      0.15;  // look-alike places are further from each other than what is predicted as well as this

  [[nodiscard]] bool sees_known(int node) const {
    return std::any_of(points_.begin(), points_.end(), [&](const MarkedPoint& point) {
      return point.is_known() && std::any_of(point.sights.begin(), point.sights.end(),
                                             [&](const PointSight& sight) { return sight.node == node; });
    });
  }

  [[nodiscard]] static bool predicted(const MarkedPoint& point, const PointSight& sight,
                                      const LinkPose& placed) {
    const Vector3d at = placed.target_from_source * sight.x_in_node;
    const Matrix3d& turn = placed.target_from_source.rotation;
    const Matrix3d covariance = moved_covariance(placed, Rigid3{}, at).bottomRightCorner<3, 3>() +
                                turn * sight.whole_covariance() * turn.transpose() + point.known->covariance;
    const Vector3d missed = at - point.known->x;
    return covariance.trace() < kSharpM * kSharpM &&
           missed.dot(solve_symmetric(covariance, missed)) <= kPointChiSquareBound;
  }

  /// Points that the scan sees say nothing of the others, whoever sees them too.
  [[nodiscard]] std::vector<MarkedPoint> apart_from(int node) const {
    std::vector<MarkedPoint> points = points_;
    for (MarkedPoint& point : points) {
      const bool seen = std::any_of(point.sights.begin(), point.sights.end(),
                                    [&](const PointSight& sight) { return sight.node == node; });
      if (seen) point.enters = false;
    }
    return points;
  }

  std::vector<MarkedPoint> points_;
  FramedNodes framed_;
};

}  // namespace

bool confirm_by_points(const Survey& survey, const SolvedGraph& solved, ProjectGraph& made) {
  if (survey.file.empty()) return false;
  const int nodes = made.graph.anchor >= 0 ? made.graph.anchor : made.graph.nodes;
  std::set<int> linked;
  for (const GraphLink& link : made.graph.links) {
    if (link.target == made.graph.anchor && made.graph.anchor >= 0) linked.insert(link.source);
  }
  std::vector<std::pair<int, LinkPose>> found;
  for (int component = 0; component < solved.components; ++component) {
    const Confirmer confirmer(survey, solved, component);
    for (int n = 0; n < nodes; ++n) {
      CancelScope::check();
      const SolvedNode& node = solved.nodes[static_cast<std::size_t>(n)];
      if (linked.count(n) > 0 || node.component != component || node.state == NodeState::under_constrained)
        continue;
      if (const std::optional<LinkPose> pose = confirmer.place(n)) found.emplace_back(n, *pose);
    }
  }
  if (found.empty()) return false;
  if (made.graph.anchor < 0) made.graph.anchor = made.graph.nodes++;
  for (const auto& [node, pose] : found) link_to_survey(node, pose, made);
  return true;
}

void add_target_links(Survey& survey, ProjectGraph& made) {
  const std::map<std::pair<int, int>, SharedTargets> all = shared_targets(survey);
  const TargetsAgainstScans against(all, made);
  if (against.all_wrong()) {
    survey.notes.push_back(against.words());
    for (SurveyMark& mark : survey.marks)
      if (!mark.scanner) mark.point.sights.clear();
    return;
  }
  for (const auto& [nodes, shared] : all) {
    CancelScope::check();
    if (against.wrong().count(nodes) > 0) {
      survey.notes.push_back(fmt::format("the targets of {} and {} contradict the surface that both see",
                                         survey.node_names[static_cast<std::size_t>(nodes.first)],
                                         survey.node_names[static_cast<std::size_t>(nodes.second)]));
      continue;
    }
    const PointFit fit = fit_points(shared.pairs);
    if (fit.state == PointFitState::too_few) continue;
    if (!fit.suspects.empty()) {
      std::vector<std::size_t> suspects;
      for (const std::size_t k : fit.suspects) suspects.push_back(shared.marks[k]);
      survey.notes.push_back(fmt::format("targets of {} and {} that contradict one another: {}",
                                         survey.node_names[static_cast<std::size_t>(nodes.first)],
                                         survey.node_names[static_cast<std::size_t>(nodes.second)],
                                         names_of(survey, suspects)));
    }
    if (fit.state == PointFitState::fixed) add_link(nodes.first, nodes.second, fit.pose, made);
  }
}

void add_survey_links(Survey& survey, ProjectGraph& made) {
  if (survey.file.empty()) return;
  const int nodes = made.graph.nodes;
  const std::vector<MarkedPoint> points = points_of(survey);
  const OtherReadings readings(survey);
  for (int n = 0; n < nodes; ++n) {
    const FramedNodes alone = only(n, nodes);
    const ControlDatum datum = control_datum(points, alone);
    if (datum.fit.state == PointFitState::too_few) continue;
    if (const std::string words = readings.better(datum, alone); !words.empty()) {
      survey.notes.push_back(fmt::format("the control points that {} sees {}",
                                         survey.node_names[static_cast<std::size_t>(n)], words));
      continue;
    }
    if (!datum.fit.suspects.empty())
      survey.notes.push_back(fmt::format("targets of {} that contradict one another: {}",
                                         survey.node_names[static_cast<std::size_t>(n)],
                                         names_of(survey, suspects_of(datum))));
    if (datum.fit.state != PointFitState::fixed) continue;
    if (made.graph.anchor < 0) made.graph.anchor = made.graph.nodes++;
    link_to_survey(n, datum.fit.pose, made);
  }
}

PlacedSurvey place_survey(const Survey& survey, ProjectGraph& made, SolvedGraph& solved) {
  return SurveyPlacer(survey, made, solved).run();
}

}  // namespace limen
