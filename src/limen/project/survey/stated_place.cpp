// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/survey/stated_place.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/project/control/fit_points.h"
#include "limen/project/retrieve/choose_pairs.h"
#include "limen/project/state/scan_names.h"

namespace limen {
namespace {

constexpr double kMostSigmas = 4.0;     // by which stated positions may be off where scans meet
constexpr double kUpsideDown = 0.9;     // cosine
constexpr double kRollKnown = 0.5;      // radians: positions in a line leave it open
constexpr int kLeastFitRedundancy = 6;  // of the fit that all are compared by: four positions

Vector3d place_in(const ScanDigest& digest) {
  return digest.stations.empty() ? digest.middle : digest.stations.front();
}

/// How far a scan's planes reach from its scanner, no less.
double reach_of(const ScanDigest& digest) {
  const Eigen::AlignedBox3d box = box_of_planes(digest, Rigid3{});
  return box.isEmpty() ? 0.0 : 0.5 * box.diagonal().norm() + (box.center() - place_in(digest)).norm();
}

/// Variance of the difference of two stated positions, mean of its axes.
double variance_between(const SurveyedPoint& a, const SurveyedPoint& b) {
  return (a.covariance + b.covariance).trace() / 3.0;
}

}  // namespace

void take_stated_positions(const std::vector<SurveyedPoint>& positions, std::optional<double> file_sigma_m,
                           const std::vector<ProjectScan>& scans, std::vector<ProjectNode>& nodes,
                           std::vector<std::string>& notes) {
  for (ProjectNode& node : nodes) {
    if (!file_sigma_m || !node.grouped) continue;
    node.grouped = false;
    node.stated = SurveyedPoint{"", node.digest.local_origin + place_in(node.digest),
                                *file_sigma_m * *file_sigma_m * Matrix3d::Identity()};
  }
  for (const SurveyedPoint& position : positions) {
    const int node = node_called(position.name, nodes, scans);
    if (node < 0) {
      notes.push_back(
          fmt::format("a position is stated for {}, which is not one scan of the project", position.name));
      continue;
    }
    ProjectNode& known = nodes[static_cast<std::size_t>(node)];
    if (!known.digest.mobile && !known.digest.model) known.stated = position;
  }
  for (ProjectNode& node : nodes)
    if (node.stated) node.reach_m = reach_of(node.digest);
}

bool can_meet(const ProjectNode& a, const ProjectNode& b) {
  if (!a.stated || !b.stated) return true;
  const double sigma = std::sqrt(variance_between(*a.stated, *b.stated));
  return (a.stated->x - b.stated->x).norm() < a.reach_m + b.reach_m + kMostSigmas * sigma;
}

/// Notes scans without a place whose stated position is too far from all other stated ones: no pair of them
/// is tried.
void note_far_ones(const std::vector<ProjectNode>& nodes, ProjectResult& result) {
  for (const ProjectNode& node : nodes) {
    const ProjectScan& scan = result.scans[node.scan];
    if (!node.stated || is_placed(scan.state)) continue;
    const auto others = [&](bool meeting) {
      return std::any_of(nodes.begin(), nodes.end(), [&](const ProjectNode& other) {
        return &other != &node && other.stated && (!meeting || can_meet(node, other));
      });
    };
    if (others(false) && !others(true))
      result.notes.push_back(fmt::format(
          "the stated position of {} is too far from all others for an overlap: check it", scan_name(scan)));
  }
}

void compare_with_stated(const std::vector<ProjectNode>& nodes, ProjectResult& result) {
  note_far_ones(nodes, result);
  std::vector<PointPair> pairs;
  std::vector<ProjectScan*> scans;
  Vector3d origin = Vector3d::Zero();
  Vector3d up = Vector3d::Zero();  // of the frame, where scans know it
  for (const ProjectNode& node : nodes) {
    if (!node.stated) continue;
    ProjectScan& scan = result.scans[node.scan];
    scan.stated = StatedPosition{node.stated->x, node.stated->covariance, {}, false};
    if (scan.component != 0 || !scan.frame_from_scan || !is_placed(scan.state)) continue;
    const Vector3d found = *scan.frame_from_scan * (node.digest.local_origin + place_in(node.digest));
    if (pairs.empty()) origin = found;
    PointPair pair;
    pair.x_in_source = node.stated->x;
    pair.source_covariance = node.stated->covariance;
    pair.x_in_target = found - origin;
    pairs.push_back(pair);
    scans.push_back(&scan);
    if (node.digest.upright)
      up += scan.frame_from_scan->rotation * node.digest.upright_from_scan.row(2).transpose();
  }
  if (pairs.empty()) return;
  const Vector3d shift = pairs.front().x_in_source;
  for (PointPair& pair : pairs) pair.x_in_source -= shift;
  const PointFit fit = fit_points(pairs);
  if (fit.state == PointFitState::contradictory)
    result.notes.push_back(
        "the scans contradict the stated positions, and which of them are wrong cannot be decided");
  if (fit.state == PointFitState::contradictory || fit.redundancy < kLeastFitRedundancy) return;
  const bool roll_known = fit.pose.covariance.topLeftCorner<2, 2>().trace() < kRollKnown * kRollKnown;
  if (roll_known && up.dot(fit.pose.target_from_source.rotation.col(2)) < -kUpsideDown * up.norm()) {
    result.notes.push_back(
        "the stated positions fit the scans only upside down: their x and y may be exchanged, or one axis "
        "reversed");
    return;
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double missed = (fit.pose.target_from_source * pairs[k].x_in_source - pairs[k].x_in_target).norm();
    const double sigma = std::sqrt(pairs[k].source_covariance.trace() / 3.0);
    StatedPosition& stated = *scans[k]->stated;
    stated.missed_m = missed;
    stated.contradicted = !fit.taken[k];
    if (stated.contradicted)
      result.notes.push_back(
          fmt::format("the scans contradict the stated position of {}: it is {:.1f} m off (sigma {:.2g} m)",
                      scan_name(*scans[k]), missed, sigma));
  }
}

}  // namespace limen
