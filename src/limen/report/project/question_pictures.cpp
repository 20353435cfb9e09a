// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/question_pictures.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limen/project/state/scan_names.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/project/evaluate_project.h"
#include "limen/report/project/project_axes.h"

namespace limen {
namespace {

constexpr std::size_t kMostPoints = 5000;           // of a scan in a picture
constexpr std::array<double, 2> kCut = {0.6, 2.0};  // metres above what is lowest
constexpr double kGap = 20.0;
constexpr double kSize = 480.0;  // of a panel, the drawing's units

/// Places of a scan from above, and how they are drawn.
struct FromAbove {
  std::vector<Vector2d> places;
  const char* colour;
};

/// The points of a scan that are at the height of windows, where `view_from_scan` lays them; none of a model.
FromAbove from_above(const Scan& scan, const Rigid3& view_from_scan, const char* colour) {
  std::vector<Vector3d> points;
  std::vector<double> heights;
  for (const Vector3d& point : scan.points) {
    points.emplace_back(view_from_scan * point);
    heights.push_back(points.back().z());
  }
  const double lowest = quantile(std::move(heights), 0.02);
  std::vector<Vector2d> kept;
  for (const Vector3d& point : points) {
    const double height = point.z() - lowest;
    if (height > kCut[0] && height < kCut[1]) kept.emplace_back(point.head<2>());
  }
  const std::size_t step = kept.size() / kMostPoints + 1;
  FromAbove seen{{}, colour};
  for (std::size_t k = 0; k < kept.size(); k += step) seen.places.push_back(kept[k]);
  return seen;
}

/// A square of the drawing with the central part of what was seen.
std::string panel(int number, const std::vector<FromAbove>& seen, const std::string& name) {
  Vector2d low;
  Vector2d high;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (const FromAbove& one : seen) {
      for (const Vector2d& place : one.places) values.push_back(place[axis]);
    }
    low[axis] = quantile(values, 0.03);
    high[axis] = quantile(std::move(values), 0.97);
  }
  const double scale = 0.92 * kSize / std::max((high - low).maxCoeff(), 1.0);
  const double left = number * (kSize + kGap);
  std::string text = fmt::format(
      "<rect x=\"{0:.0f}\" y=\"0\" width=\"{1:.0f}\" height=\"{1:.0f}\" fill=\"#fff\" stroke=\"#bbb\"/>",
      left, kSize);
  for (const FromAbove& one : seen) {
    text += "<path d=\"";
    for (const Vector2d& place : one.places) {
      const Vector2d at = scale * (place - 0.5 * (low + high));
      if (at.cwiseAbs().maxCoeff() < 0.5 * kSize)
        text += fmt::format("M{:.0f} {:.0f}h0", left + 0.5 * kSize + at.x(), 0.5 * kSize - at.y());
    }
    text += fmt::format("\" stroke=\"{}\" stroke-width=\"2\" stroke-linecap=\"round\"/>", one.colour);
  }
  return text + fmt::format(
                    "<text x=\"{:.0f}\" y=\"{:.0f}\" font-family=\"sans-serif\" font-size=\"20\" fill=\"{}\" "
                    "translate=\"no\">{}</text>\n",
                    left + 4.0, kSize + 22.0, seen.size() > 1 ? "#666" : seen.front().colour, escaped(name));
}

std::string picture_of(const ProjectResult& result, const ProjectLink& link,
                       const std::vector<ProjectPicture>& pictures) {
  const auto s = static_cast<std::size_t>(link.source);
  const auto t = static_cast<std::size_t>(link.target);
  const Scan& source = pictures[s].points;
  const Scan& target = pictures[t].points;
  const std::optional<Rigid3>& placed = result.scans[t].frame_from_scan;
  const Matrix3d axes = project_axes(result) * (placed ? placed->rotation : Matrix3d::Identity());
  const Rigid3 view_from_target{axes, Vector3d::Zero()};
  const FromAbove moved = from_above(
      source, view_from_target * to_local(link.target_from_source, source.local_origin, target.local_origin),
      "#a85300");
  const FromAbove still = from_above(target, view_from_target, "#1f6fb4");
  if (moved.places.empty() || still.places.empty()) return {};
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"alike\" viewBox=\"0 0 {:.0f} {:.0f}\" "
             "role=\"img\" aria-label=\"Both scans from above, one by one and together\">\n",
             3 * kSize + 2 * kGap, kSize + 30.0) +
         panel(0, {moved}, shown_name(result.scans[s])) + panel(1, {still}, shown_name(result.scans[t])) +
         panel(2, {moved, still}, "1 + 2") + "</svg>\n";
}

const ProjectLink* link_between(const ProjectResult& result, const std::vector<std::string>& scans) {
  const auto name = [&](int scan) { return scan_name(result.scans[static_cast<std::size_t>(scan)]); };
  for (const ProjectLink& link : result.links) {
    if (scans.size() == 2 && name(link.source) == scans[0] && name(link.target) == scans[1]) return &link;
  }
  return nullptr;
}

}  // namespace

std::vector<std::vector<Decision>> asked_of(const ProjectQuestion& question) {
  std::vector<std::vector<Decision>> asked;
  for (const Decision& answer : question.answers) {
    const auto same = [&](const std::vector<Decision>& others) { return others[0].scans == answer.scans; };
    const auto known = std::find_if(asked.begin(), asked.end(), same);
    if (known == asked.end())
      asked.push_back({answer});
    else
      known->push_back(answer);
  }
  return asked;
}

std::string asked_words(const std::vector<Decision>& answers) {
  const std::vector<std::string>& scans = answers.front().scans;
  const auto last = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  return fmt::format("Are these two the same place, fitted together as shown? {} and {}", last(scans.front()),
                     last(scans.back()));
}

std::vector<std::string> question_pictures(const ProjectResult& result,
                                           const std::vector<ProjectPicture>& pictures) {
  std::vector<std::string> drawn;
  for (const ProjectQuestion& question : result.questions) {
    for (const std::vector<Decision>& answers : asked_of(question)) {
      if (pictures.size() != result.scans.size() || drawn.size() >= kMostPictures) return drawn;
      const ProjectLink* link = link_between(result, answers.front().scans);
      drawn.push_back(link == nullptr ? "" : picture_of(result, *link, pictures));
    }
  }
  return drawn;
}

}  // namespace limen
