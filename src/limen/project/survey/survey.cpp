// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/survey/survey.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/named.h"
#include "limen/base/text.h"
#include "limen/geometry/spline_motion.h"
#include "limen/project/control/control_file.h"
#include "limen/project/state/scan_names.h"

namespace limen {
namespace {

constexpr double kScannerM = 1e-4;       // a scanner's place in its own scan is known
constexpr double kLeastStrayedM = 0.02;  // trajectories stray by this though their own points do not show it
constexpr double kBeyondS = 1.0;         // a target's time may lie so far before or after all points

/// Where along its way a pass saw a target: at that time, or else where it came nearest; nothing where it was
/// not under way then.
std::optional<double> place_on(const PassWay& way, const SeenTarget& target, const Vector3d& x) {
  if (target.time_s) {
    const double beyond = std::max(way.times_s.front() - *target.time_s, *target.time_s - way.times_s.back());
    return beyond > kBeyondS ? std::nullopt : std::optional(place_among(way.times_s, *target.time_s));
  }
  double nearest_m = std::numeric_limits<double>::infinity();
  double place = 0.0;
  for (std::size_t k = 0; k + 1 < way.places.size(); ++k) {
    const Vector3d along = way.places[k + 1] - way.places[k];
    const double share =
        std::clamp((x - way.places[k]).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
    const double away_m = (way.places[k] + share * along - x).norm();
    if (away_m >= nearest_m) continue;
    nearest_m = away_m;
    place = static_cast<double>(k) + share;
  }
  return place;
}

class SurveyReader {
 public:
  SurveyReader(const std::vector<ProjectNode>& nodes, const std::vector<ProjectScan>& scans)
      : nodes_(nodes), scans_(scans) {}

  Survey run(const ProjectInputs& inputs) {
    survey_.file = inputs.control;
    if (!inputs.control.empty()) add_points(inputs.control, PointRole::control);
    if (!inputs.check.empty()) add_points(inputs.check, PointRole::check);
    if (!inputs.targets.empty()) add_targets(inputs.targets);
    std::vector<std::string> unseen;
    for (auto& [name, mark] : marks_) {
      const bool seen = !mark.point.sights.empty() || seen_late_.count(name) > 0;
      if (!seen) add_scanner(mark);
      if (!seen && mark.point.sights.empty()) unseen.push_back(name);
      survey_.marks.push_back(std::move(mark));
    }
    note("no scan sees", unseen);
    note("targets are given for scans that are not part of the project:", strangers_);
    note("these targets are ignored, because their times are before or after all points of their scan:",
         late_);
    about_origin();
    for (const ProjectNode& node : nodes_) {
      survey_.node_names.push_back(scan_name(scans_[node.scan]));
      const ScanDigest& digest = node.digest;
      survey_.up.push_back(digest.upright ? Vector3d(digest.upright_from_scan.transpose().col(2))
                                          : Vector3d::Zero());
    }
    return std::move(survey_);
  }

 private:
  void note(const std::string& words, const std::vector<std::string>& names) {
    if (names.empty()) return;
    survey_.notes.push_back(words + " " + listed(names, 5, [](const std::string& name) { return name; }));
  }

  void add_points(const std::string& file, PointRole role) {
    for (const SurveyedPoint& point : read_surveyed_points(file)) {
      SurveyMark mark;
      mark.name = point.name;
      mark.role = role;
      mark.given = point.x;
      mark.point.known = KnownPlace{point.x, point.covariance};
      mark.point.enters = role == PointRole::control;
      if (!marks_.emplace(point.name, mark).second)
        throw Error("the point " + point.name + " is both control and check point", file,
                    "take it out of one of the two files");
    }
  }

  void add_targets(const std::string& file) {
    for (const SeenTarget& target : read_seen_targets(file)) {
      const int node = node_of(target.scan);
      if (node < 0) {
        if (std::find(strangers_.begin(), strangers_.end(), target.scan) == strangers_.end())
          strangers_.push_back(target.scan);
        continue;
      }
      SurveyMark& mark = marks_[target.name];
      mark.name = target.name;
      const ScanDigest& digest = nodes_[static_cast<std::size_t>(node)].digest;
      PointSight sight{node, target.x_in_scan - digest.local_origin, target.covariance};
      if (digest.mobile)
        sight.strayed_m = std::max(nodes_[static_cast<std::size_t>(node)].strays_m(), kLeastStrayedM);
      if (digest.track.way.known()) {
        sight.place = place_on(digest.track.way, target, sight.x_in_node);
        if (!sight.place) {
          late_.push_back(fmt::format("{} of {}", target.name, target.scan));
          seen_late_.insert(target.name);
          continue;
        }
      }
      mark.point.sights.push_back(sight);
    }
    for (auto& [name, mark] : marks_) {
      std::vector<PointSight>& sights = mark.point.sights;
      std::sort(sights.begin(), sights.end(), [](const PointSight& a, const PointSight& b) {
        return std::pair(a.node, a.place) < std::pair(b.node, b.place);
      });
      for (std::size_t k = 0; k < sights.size(); ++k) sights[k].number = k;
    }
  }

  /// A point that no scan sees and that is called as a scan is where its scanner stood.
  void add_scanner(SurveyMark& mark) {
    const int node = node_of(mark.name);
    if (node < 0) return;
    const ScanDigest& digest = nodes_[static_cast<std::size_t>(node)].digest;
    if (digest.mobile || digest.stations.size() != 1) return;
    mark.scanner = true;
    mark.point.sights.push_back(
        {node, digest.stations.front(), kScannerM * kScannerM * Matrix3d::Identity()});
  }

  [[nodiscard]] int node_of(const std::string& name) const {
    const int node = node_called(name, nodes_, scans_);
    return node >= 0 && nodes_[static_cast<std::size_t>(node)].digest.model ? -1 : node;
  }

  /// Large coordinates meet in one subtraction.
  void about_origin() {
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (const SurveyMark& mark : survey_.marks) {
      if (!mark.given || mark.role != PointRole::control) continue;
      sum += *mark.given;
      ++count;
    }
    if (count > 0) survey_.origin = (sum / count).array().round();
    for (SurveyMark& mark : survey_.marks) {
      if (mark.given) mark.point.known->x = *mark.given - survey_.origin;
    }
  }

  const std::vector<ProjectNode>& nodes_;
  const std::vector<ProjectScan>& scans_;
  Survey survey_;
  std::map<std::string, SurveyMark> marks_;
  std::vector<std::string> strangers_;
  std::vector<std::string> late_;    ///< targets at times at which their pass was not under way
  std::set<std::string> seen_late_;  ///< their names
};

}  // namespace

const char* to_string(PointState state) {
  static constexpr Named<PointState> names[] = {{PointState::used, "used"},
                                                {PointState::left_out, "left_out"},
                                                {PointState::compared, "compared"},
                                                {PointState::not_placed, "not_placed"}};
  return name_of(names, state);
}

const char* to_string(PointRole role) {
  static constexpr Named<PointRole> names[] = {
      {PointRole::control, "control"}, {PointRole::check, "check"}, {PointRole::tie, "tie"}};
  return name_of(names, role);
}

Survey read_survey(const ProjectInputs& inputs, const std::vector<ProjectNode>& nodes,
                   const std::vector<ProjectScan>& scans) {
  return SurveyReader(nodes, scans).run(inputs);
}

}  // namespace limen
