// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/stated_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/project/control/fit_points.h"
#include "limen/project/retrieve/predict_overlap.h"
#include "limen/project/scan_names.h"

namespace limen {
namespace {

constexpr double kSearched_m3 = 40.0 * 40.0 * 10.0;
constexpr double kTrust = 0.95;         // share of stated places that mean what they say
constexpr double kMostPriorNats = 6.9;  // a place singles a pose out of a thousand others
constexpr double kMostSigmas = 4.0;     // by which stated places may be off where scans meet
constexpr int kLeastFitRedundancy = 6;  // of the fit that all places are compared by: four places
const double kFileSigmaRad = radians(5.0);

double log_normal(double miss_m, double variance, double freedoms) {
  return -0.5 * (miss_m * miss_m / variance + freedoms * std::log(2.0 * std::numbers::pi * variance));
}

/// Of the scanner positions: how the source's lies against the target's, in target axes, and as it is stated.
struct Against {
  const StatedPlace& source;
  const StatedPlace& target;
  Vector3d found;   ///< target axes
  Vector3d stated;  ///< frame axes
  double variance;  ///< m^2, of each coordinate
};

double log_density(const Against& two, const ScanDigest& target, bool upright) {
  const double far = std::max(two.stated.norm(), std::sqrt(two.variance));
  if (two.target.frame_from_scan) {
    const Vector3d miss = *two.target.frame_from_scan * two.found - two.stated;
    return log_normal(miss.norm(), two.variance + far * far * two.target.sigma_rad * two.target.sigma_rad,
                      3.0);
  }
  if (!upright) {
    const double miss = two.found.norm() - two.stated.norm();
    return log_normal(miss, two.variance, 1.0) - std::log(4.0 * std::numbers::pi * far * far);
  }
  // Any heading: a ring about the vertical.
  const Vector3d up = target.upright_from_scan.row(2).transpose();
  const double height = two.found.dot(up);
  const double across = (two.found - height * up).norm();
  const double stated_across = two.stated.head<2>().norm();
  const double ring = std::max(stated_across, std::sqrt(two.variance));
  return log_normal(across - stated_across, two.variance, 1.0) - std::log(2.0 * std::numbers::pi * ring) +
         log_normal(height - two.stated.z(), two.variance, 1.0);
}

double log_turn(const StatedPlace& source, const StatedPlace& target, const Rigid3& pose) {
  if (!source.frame_from_scan || !target.frame_from_scan) return 0.0;
  const Matrix3d stated = target.frame_from_scan->transpose() * *source.frame_from_scan;
  const double variance = source.sigma_rad * source.sigma_rad + target.sigma_rad * target.sigma_rad;
  return std::log(2.0 * std::numbers::pi) +
         log_normal(rotation_angle(stated.transpose() * pose.rotation), variance, 1.0);
}

Vector3d place_in(const ScanDigest& digest) {
  return digest.stations.empty() ? digest.middle : digest.stations.front();
}

StatedPlace place_of(const StatedPose& pose, const ScanDigest& digest) {
  StatedPlace place;
  place.at = pose.of_origin ? Vector3d(-digest.local_origin) : place_in(digest);
  place.x = pose.x;
  place.covariance = pose.covariance;
  place.frame_from_scan = pose.frame_from_scan;
  place.sigma_rad = pose.sigma_rad;
  return place;
}

}  // namespace

void take_stated_places(const std::vector<StatedPose>& poses, std::optional<double> file_sigma_m,
                        const std::vector<ProjectScan>& scans, std::vector<ProjectNode>& nodes,
                        std::vector<std::string>& notes) {
  if (file_sigma_m) {
    for (ProjectNode& node : nodes) {
      if (!node.grouped) continue;
      node.grouped = false;
      StatedPose pose;
      pose.x = node.digest.local_origin + place_in(node.digest);
      pose.covariance *= *file_sigma_m * *file_sigma_m;
      pose.frame_from_scan = Matrix3d::Identity();
      pose.sigma_rad = kFileSigmaRad;
      node.stated = place_of(pose, node.digest);
    }
  }
  for (const StatedPose& pose : poses) {
    const int node = node_called(pose.scan, nodes, scans);
    if (node < 0) {
      notes.push_back(
          fmt::format("a position is stated for {}, which is not one scan of the project", pose.scan));
      continue;
    }
    ProjectNode& known = nodes[static_cast<std::size_t>(node)];
    if (!known.digest.mobile && !known.digest.model) known.stated = place_of(pose, known.digest);
  }
}

double log_prior_of_places(const ProjectNode& source, const ProjectNode& target, const Rigid3& pose) {
  if (!source.stated || !target.stated) return 0.0;
  const Against two{*source.stated, *target.stated, pose * source.stated->at - target.stated->at,
                    source.stated->x - target.stated->x,
                    (source.stated->covariance + target.stated->covariance).trace() / 3.0};
  const double density = log_density(two, target.digest, source.digest.upright && target.digest.upright) +
                         log_turn(*source.stated, *target.stated, pose) + std::log(kSearched_m3);
  return std::min(kMostPriorNats, std::log(kTrust * std::exp(density) + 1.0 - kTrust));
}

bool can_meet(const ProjectNode& a, const ProjectNode& b) {
  if (!a.stated || !b.stated) return true;
  const auto reach = [](const ProjectNode& node) {
    const Eigen::AlignedBox3d box = box_of_planes(node.digest, Rigid3{});
    return box.isEmpty() ? 0.0 : 0.5 * box.diagonal().norm() + (box.center() - node.stated->at).norm();
  };
  const double sigma = std::sqrt((a.stated->covariance + b.stated->covariance).trace() / 3.0);
  return (a.stated->x - b.stated->x).norm() < reach(a) + reach(b) + kMostSigmas * sigma;
}

void compare_with_stated(const std::vector<ProjectNode>& nodes, ProjectResult& result) {
  std::vector<PointPair> pairs;
  std::vector<ProjectScan*> scans;
  Vector3d origin = Vector3d::Zero();
  for (const ProjectNode& node : nodes) {
    if (!node.stated) continue;
    ProjectScan& scan = result.scans[node.scan];
    scan.stated = StatedPosition{node.stated->x, node.stated->covariance, {}, false};
    if (scan.component != 0 || !scan.frame_from_scan || !is_placed(scan.state)) continue;
    if (pairs.empty()) origin = *scan.frame_from_scan * (node.digest.local_origin + node.stated->at);
    PointPair pair;
    pair.x_in_source = node.stated->x;
    pair.source_covariance = node.stated->covariance;
    pair.x_in_target = *scan.frame_from_scan * (node.digest.local_origin + node.stated->at) - origin;
    pairs.push_back(pair);
    scans.push_back(&scan);
  }
  if (pairs.empty()) return;
  const Vector3d shift = pairs.front().x_in_source;
  for (PointPair& pair : pairs) pair.x_in_source -= shift;
  const PointFit fit = fit_points(pairs);
  if (fit.state == PointFitState::contradictory || fit.redundancy < kLeastFitRedundancy) return;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double missed = (fit.pose.target_from_source * pairs[k].x_in_source - pairs[k].x_in_target).norm();
    const double sigma = std::sqrt(pairs[k].source_covariance.trace() / 3.0);
    StatedPosition& stated = *scans[k]->stated;
    stated.missed_m = missed;
    stated.contradicted = !fit.taken[k];
    if (stated.contradicted)
      result.notes.push_back(
          fmt::format("{} is {:.1f} m from its stated position (sigma {:.1f} m), by all scans",
                      scan_name(*scans[k]), missed, sigma));
  }
}

}  // namespace limen
