// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/survey_points.h"

#include <algorithm>

#include <fmt/format.h>

namespace limen {
namespace {

Vector3d sigmas(const Matrix3d& covariance) {
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

/// What coordinates miss that did not enter.
PointTest test_apart(const KnownPlace& given, const PointFinding& finding) {
  PointTest test;
  test.residual = given.x - finding.x;
  test.sigma = sigmas(given.covariance + finding.covariance);
  test.w = test.residual.cwiseQuotient(test.sigma);
  test.squared = missed_squared(finding, given);
  test.redundancy = 3.0;
  return test;
}

std::string reason_of(const ProjectPoint& point, const PointVerdict& verdict, bool placed) {
  switch (point.state) {
    case PointState::used:
      return {};
    case PointState::compared:
      return point.given ? "only compared, not used in the adjustment" : "a target without coordinates";
    case PointState::left_out:
      return fmt::format("{}: off by {:.1f} mm, chi-squared {:.0f} with 3 degrees of freedom",
                         verdict.suspected ? "it, or another that contradicts it, is wrong"
                                           : "contradicts all other observations",
                         1e3 * point.test.residual.norm(), verdict.squared);
    case PointState::not_placed:
      break;
  }
  return placed ? "no registered scan sees it" : "the control points do not define the frame";
}

ProjectPoint stated_point(const SurveyMark& mark, const PlacedSurvey& placed, std::size_t p,
                          const Survey& survey, const std::vector<ProjectNode>& nodes) {
  ProjectPoint stated;
  stated.name = mark.name;
  stated.role = mark.role;
  stated.scanner = mark.scanner;
  stated.given = mark.given;
  if (mark.given) stated.given_sigma = sigmas(mark.point.known->covariance);
  const auto scan_of = [&](const PointSight& sight) {
    return static_cast<int>(nodes[static_cast<std::size_t>(sight.node)].scan);
  };
  const bool seen = !placed.settled.findings.empty() && !placed.points[p].sights.empty();
  for (const PointSight& sight : mark.point.sights) stated.sights.push_back({scan_of(sight), false, {}});
  if (!seen || (!placed.placed && mark.role != PointRole::tie)) {
    stated.reason = reason_of(stated, {}, placed.placed || mark.role == PointRole::tie);
    return stated;
  }
  const PointFinding& finding = placed.settled.findings[p];
  const PointVerdict& verdict = placed.settled.verdicts[p];
  // Without a frame of their own, points have no coordinates; how well scans agree on them is known.
  if (placed.placed) {
    stated.found = finding.x + survey.origin;
    stated.found_sigma = sigmas(finding.covariance);
  }
  for (const std::size_t k : placed.sights[p]) {
    stated.sights[k].missed_m = (placed.seen_at[p][k] - finding.x).norm();
    stated.sights[k].used =
        std::any_of(placed.points[p].sights.begin(), placed.points[p].sights.end(),
                    [&](const PointSight& kept) { return placed.points[p].enters && kept.number == k; });
  }
  stated.state = placed.points[p].is_known()       ? PointState::used
                 : mark.role == PointRole::control ? PointState::left_out
                                                   : PointState::compared;
  if (mark.given)
    stated.test = placed.points[p].is_known() ? finding.known : test_apart(*mark.point.known, finding);
  stated.reason = reason_of(stated, verdict, true);
  return stated;
}

}  // namespace

std::vector<ProjectPoint> stated_points(const Survey& survey, const PlacedSurvey& placed,
                                        const std::vector<ProjectNode>& nodes) {
  std::vector<ProjectPoint> stated;
  for (std::size_t p = 0; p < survey.marks.size(); ++p)
    stated.push_back(stated_point(survey.marks[p], placed, p, survey, nodes));
  return stated;
}

}  // namespace limen
