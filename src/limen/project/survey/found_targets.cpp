// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/survey/found_targets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limen/base/progress.h"
#include "limen/files/table_cells.h"
#include "limen/project/control/control_file.h"
#include "limen/project/control/fit_points.h"
#include "limen/project/control/match_points.h"

namespace limen {
namespace {

/// A target so near to a known point, and not matched with it, may be either that point or another.
constexpr double kMayBeOneM = 0.1;

/// Points that targets are compared with, about one of them.
struct ReferencePoints {
  std::vector<std::string> names;
  std::vector<MeasuredPoint> points;
};

std::vector<MeasuredPoint> points_of_targets(const std::vector<FoundTarget>& targets) {
  std::vector<MeasuredPoint> points;
  for (const FoundTarget& target : targets)
    points.push_back({target.centre - targets.front().centre, target.sigma_m});
  return points;
}

ReferencePoints surveyed(const ProjectInputs& inputs) {
  ReferencePoints reference;
  Vector3d origin = Vector3d::Zero();
  for (const std::string& file : {inputs.control, inputs.check}) {
    if (file.empty()) continue;
    for (const SurveyedPoint& point : read_surveyed_points(file)) {
      if (reference.points.empty()) origin = point.x;
      reference.names.push_back(point.name);
      reference.points.push_back({point.x - origin, std::sqrt(point.covariance.diagonal().maxCoeff())});
    }
  }
  return reference;
}

Matrix3d round_covariance(double sigma) {
  return sigma * sigma * Matrix3d::Identity();
}

/// How the points of a scan lie about those that they are matched with.
LinkPose pose_of(const std::vector<MeasuredPoint>& seen, const std::vector<int>& matched,
                 const std::vector<MeasuredPoint>& known) {
  std::vector<PointPair> pairs;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (matched[k] < 0) continue;
    const MeasuredPoint& point = known[static_cast<std::size_t>(matched[k])];
    pairs.push_back({seen[k].x, round_covariance(seen[k].sigma_m), point.x, round_covariance(point.sigma_m)});
  }
  return fit_points(pairs).pose;
}

/// Gives the targets of all scans their names.
class TargetNamer {
 public:
  explicit TargetNamer(const std::vector<TargetsOfScan>& scans) {
    for (const TargetsOfScan& scan : scans) {
      seen_.push_back(points_of_targets(scan.targets));
      names_.emplace_back(scan.targets.size());
      open_.insert(seen_.size() - 1);
    }
  }

  std::vector<std::vector<std::string>> run(ReferencePoints known) {
    for (const std::string& name : known.names) given_.insert(name);
    if (!known.points.empty()) grow(std::move(known));
    // Scans that see none of these may still see the same as one another.
    while (const std::optional<std::size_t> most = scan_with_most()) {
      ReferencePoints group;
      take(*most, {}, LinkPose{}, group);
      grow(std::move(group));
    }
    forget_lone_names();
    return std::move(names_);
  }

 private:
  static std::size_t count_of(const std::vector<int>& matched) {
    return matched.size() - static_cast<std::size_t>(std::count(matched.begin(), matched.end(), -1));
  }

  /// Of those that have no names yet and targets enough; the first where several have as many.
  [[nodiscard]] std::optional<std::size_t> scan_with_most() const {
    std::optional<std::size_t> most;
    for (const std::size_t scan : open_) {
      if (seen_[scan].size() >= 3 && (!most || seen_[scan].size() > seen_[*most].size())) most = scan;
    }
    return most;
  }

  /// Takes scan after scan that sees the group's points, those that see most first; with each the group
  /// grows.
  void grow(ReferencePoints group) {
    for (bool grew = true; grew;) {
      grew = false;
      std::vector<std::pair<std::size_t, std::size_t>> by_count;  // how many others than the most; scan
      for (const std::size_t scan : open_) {
        CancelScope::check();
        const std::size_t count = count_of(match_points(seen_[scan], group.points));
        if (count > 0) by_count.emplace_back(seen_[scan].size() - count, scan);
      }
      std::sort(by_count.begin(), by_count.end());
      for (const auto& [unused, scan] : by_count) {
        const std::vector<int> matched = match_points(seen_[scan], group.points);
        if (count_of(matched) == 0) continue;
        take(scan, matched, pose_of(seen_[scan], matched, group.points), group);
        grew = true;
      }
    }
  }

  /// Names the targets of a scan, and adds those that are new to the group, where `pose` has them.
  void take(std::size_t scan, const std::vector<int>& matched, const LinkPose& pose, ReferencePoints& group) {
    open_.erase(scan);
    const std::vector<MeasuredPoint> before = group.points;
    for (std::size_t k = 0; k < seen_[scan].size(); ++k) {
      std::string& name = names_[scan][k];
      if (!matched.empty() && matched[k] >= 0) {
        name = group.names[static_cast<std::size_t>(matched[k])];
        continue;
      }
      MeasuredPoint point{pose.target_from_source * seen_[scan][k].x, seen_[scan][k].sigma_m};
      if (!matched.empty()) {
        const Matrix6d moved = moved_covariance(pose, Rigid3{}, point.x);
        point.sigma_m = std::hypot(point.sigma_m, std::sqrt(moved.diagonal().tail<3>().maxCoeff()));
      }
      const bool doubtful = std::any_of(before.begin(), before.end(), [&](const MeasuredPoint& other) {
        return (other.x - point.x).norm() < kMayBeOneM;
      });
      if (doubtful) continue;
      name = fmt::format("T{}", ++number_);
      while (given_.count(name) > 0) name = fmt::format("T{}", ++number_);
      group.names.push_back(name);
      group.points.push_back(point);
    }
  }

  /// What one scan alone sees ties nothing, unless a surveyor has named it.
  void forget_lone_names() {
    std::map<std::string, int> seers;
    for (const auto& names : names_) {
      for (const std::string& name : names) ++seers[name];
    }
    for (auto& names : names_) {
      for (std::string& name : names) {
        if (seers[name] < 2 && given_.count(name) == 0) name.clear();
      }
    }
  }

  std::vector<std::vector<MeasuredPoint>> seen_;  ///< by scan, about its first target
  std::vector<std::vector<std::string>> names_;   ///< empty: none
  std::set<std::size_t> open_;                    ///< scans that were matched with nothing
  std::set<std::string> given_;                   ///< names of surveyed points
  int number_ = 0;
};

}  // namespace

TargetTable table_of_targets(const std::vector<TargetsOfScan>& scans, const ProjectInputs& inputs) {
  const bool known = !inputs.control.empty() || !inputs.check.empty();
  const ReferencePoints reference = known ? surveyed(inputs) : ReferencePoints{};
  const std::vector<std::vector<std::string>> names = TargetNamer(scans).run(reference);
  TargetTable table{"name,scan,x,y,z,sigma,kind,points\n", {}};
  std::size_t count = 0;
  std::size_t named = 0;
  std::size_t shared = 0;
  std::size_t seeing = 0;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    seeing += scans[s].targets.empty() ? 0 : 1;
    for (std::size_t k = 0; k < scans[s].targets.size(); ++k) {
      const FoundTarget& target = scans[s].targets[k];
      const std::string& name = names[s][k];
      const bool given =
          std::find(reference.names.begin(), reference.names.end(), name) != reference.names.end();
      named += given ? 1 : 0;
      shared += given || name.empty() ? 0 : 1;
      ++count;
      table.text +=
          fmt::format("{},{},{:.5f},{:.5f},{:.5f},{:.5f},{},{}\n",
                      csv_field(name.empty() ? fmt::format("unknown_{}", count - named - shared) : name),
                      csv_field(scans[s].scan), target.centre.x(), target.centre.y(), target.centre.z(),
                      target.sigma_m, to_string(target.kind), target.points);
    }
  }
  table.words = fmt::format("{} target{} found in {} scan{}", count, count == 1 ? "" : "s", seeing,
                            seeing == 1 ? "" : "s");
  if (count > 0 && known)
    table.words += fmt::format(", {} of them matched to control or check points", named);
  if (count > 0 && (!known || shared > 0))
    table.words += fmt::format(", {} {}matched between scans", shared, known ? "" : "of them ");
  if (count > 0) table.words += " (targets.csv)";
  return table;
}

}  // namespace limen
