// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments_sight.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kPointsPerPixel = 1.5;
constexpr double kAnyJump = 1e12;    // links between scan lines are never cut
constexpr double kTouchSlope = 1.5;  // how steeply what is on a surface may rise as the scanner sees it
constexpr int kLooks = 3;
constexpr double kWidestGap_m = 0.5;  // between scan lines on a surface
constexpr double kAlikeDeg = 20.0;    // planes that differ by more face another way

}  // namespace

BorderSight::BorderSight(const Scan& scan, const ExtractedFeatures& extracted, double same_m)
    : scan_(&scan), extracted_(&extracted), same_m_(same_m) {
  if (scan.centres.size() == 1) make_image();
  if (scan.mobile() && scan.topology.known()) make_grid();
}

std::size_t BorderSight::pixel_at(const Vector3d& direction) const {
  Eigen::Index axis = 0;
  const double largest = direction.cwiseAbs().maxCoeff(&axis);
  const double half = 0.5 * static_cast<double>(edge_);
  const auto cell = [&](double x) {
    return std::min(edge_ - 1, static_cast<std::size_t>(std::max(0.0, half * (x / largest + 1.0))));
  };
  const std::size_t face = 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0.0 ? 1 : 0);
  return (face * edge_ + cell(direction[(axis + 1) % 3])) * edge_ + cell(direction[(axis + 2) % 3]);
}

void BorderSight::make_image() {
  const double wanted = std::sqrt(static_cast<double>(scan_->size()) / (6.0 * kPointsPerPixel));
  edge_ = static_cast<std::size_t>(std::clamp(wanted, 16.0, 1024.0));
  pixels_.resize(6 * edge_ * edge_);
  const Vector3d& centre = scan_->centre(0);
  for (std::size_t i = 0; i < scan_->size(); ++i) {
    const Vector3d ray = scan_->points[i] - centre;
    const auto range = static_cast<float>(ray.norm());
    if (!(range > 0.01F)) continue;
    Pixel& pixel = pixels_[pixel_at(ray)];
    if (pixel.near < 0 || range < pixel.near_m) {
      pixel.near_m = range;
      pixel.near = static_cast<std::int32_t>(i);
    }
    if (range > pixel.far_m) {
      pixel.far_m = range;
      pixel.far = static_cast<std::int32_t>(i);
    }
  }
}

void BorderSight::make_grid() {
  grid_ = std::make_unique<ScanGrid>(*scan_, kAnyJump);
  place_of_.resize(scan_->size());
  for (std::size_t at = 0; at < grid_->size(); ++at)
    place_of_[grid_->scan_index(at)] = static_cast<std::uint32_t>(at);
}

/// False where the point belongs to a plane that faces another way.
bool BorderSight::faces_like(const Plane& plane, std::size_t point) const {
  const std::int32_t label = extracted_->labels[point];
  if (label < 0) return true;
  const Plane& own = extracted_->features.planes[static_cast<std::size_t>(label)].plane;
  return std::abs(own.normal.dot(plane.normal)) > std::cos(radians(kAlikeDeg));
}

/// What the ray of a point says, where it meets the plane beyond the border.
void BorderSight::vote(const BorderPlace& place, std::size_t point, Votes& votes) const {
  const Vector3d& x = scan_->points[point];
  const Vector3d& centre = scan_->centre(point);
  const double height = place.plane.signed_distance(centre);
  const double depth = height - place.plane.signed_distance(x);
  // From the centre to the plane takes this share of the ray.
  const double share = std::abs(depth) > 1e-9 ? height / depth : -1.0;
  if (share <= 0.0) return;
  const Vector3d meets = centre + share * (x - centre);
  const double out = (meets - place.edge).dot(place.outward);
  const double widest = grid_ ? kWidestGap_m : 6.0 * place.step_m + 0.02;
  if (out < 0.25 * place.step_m || out > widest) return;
  const double before = height > 0.0 ? place.plane.signed_distance(x) : -place.plane.signed_distance(x);
  if (std::abs(before) <= same_m_ && faces_like(place.plane, point)) {
    ++votes.same;
  } else if (before < 0.0) {
    ++votes.open;
  } else if ((x - place.edge).norm() < kTouchSlope * out) {
    ++votes.touching;
  } else {
    ++votes.hidden;
  }
}

BorderSight::Votes BorderSight::votes_of_image(const BorderPlace& place) const {
  const Vector3d ray = place.edge - scan_->centre(0);
  const double range = std::max(0.01, ray.norm());
  const double slant = std::max(0.05, std::abs(place.plane.normal.dot(ray)) / range);
  const double footprint = 2.0 / static_cast<double>(edge_) * range;
  // Seen at a slant only what lies along the ray is drawn out.
  const double drawn = std::abs(place.outward.dot(ray)) / range;
  const double step = std::max(place.step_m, 0.7 * footprint * (1.0 + drawn * (1.0 / slant - 1.0)));
  BorderPlace wide = place;
  wide.step_m = step;
  Votes votes;
  std::size_t before = pixels_.size();
  for (int k = 1; k <= kLooks; ++k) {
    const Vector3d looked = place.edge + k * step * place.outward;
    const std::size_t at = pixel_at(looked - scan_->centre(0));
    if (at == before) continue;
    before = at;
    const Pixel& pixel = pixels_[at];
    if (pixel.near < 0) continue;
    vote(wide, static_cast<std::size_t>(pixel.near), votes);
    if (pixel.far != pixel.near) vote(wide, static_cast<std::size_t>(pixel.far), votes);
  }
  return votes;
}

BorderSight::Votes BorderSight::votes_of_lines(const BorderPlace& place) const {
  Votes votes;
  const auto walk = [&](std::int32_t from, ScanGrid::Link link, int steps) {
    for (int k = 0; k < steps && from >= 0; ++k) {
      vote(place, grid_->scan_index(static_cast<std::size_t>(from)), votes);
      from = grid_->links(static_cast<std::size_t>(from))[link];
    }
  };
  const auto& links = grid_->links(place_of_[place.point]);
  walk(links[ScanGrid::previous], ScanGrid::previous, kLooks);
  walk(links[ScanGrid::next], ScanGrid::next, kLooks);
  walk(links[ScanGrid::line_before], ScanGrid::line_before, kLooks);
  walk(links[ScanGrid::line_after], ScanGrid::line_after, kLooks);
  return votes;
}

Beyond BorderSight::look(const BorderPlace& place) const {
  if (!knows()) return Beyond::unknown;
  const Votes votes = grid_ ? votes_of_lines(place) : votes_of_image(place);
  const int most = std::max({votes.hidden, votes.touching, votes.open});
  // The next scan line may be far away: of a mobile scan that nothing speaks of a place says nothing.
  if (most == 0) return votes.same > 0 || grid_ ? Beyond::same : Beyond::silent;
  if (votes.hidden == most) return Beyond::hidden;
  return votes.open == most ? Beyond::open : Beyond::touching;
}

}  // namespace limen
