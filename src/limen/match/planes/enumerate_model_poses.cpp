// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_model_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/LU>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/geometry/cell_key.h"
#include "limen/match/planes/enumerate_rotations.h"

namespace limen {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kMinDeterminant = 0.2;  // three normals flatter than this do not fix a shift
constexpr double kOtherDirection = 0.8;  // cosine: normals nearer than this are no two directions
constexpr double kMeetM = 0.15;          // boxes of planes that meet may miss each other by this

/// A plane with the box around it.
struct BoxedPlane {
  const PlanarPolygon* polygon = nullptr;
  Vector3d normal = Vector3d::UnitZ();
  Vector3d middle = Vector3d::Zero();  // a point of it
  Box box;
};

/// The plane turned by `rotation`.
BoxedPlane boxed(const PlanarPolygon& polygon, const Matrix3d& rotation) {
  BoxedPlane plane{&polygon, rotation * polygon.plane.normal,
                   rotation * polygon.plane.project(polygon.centroid), Box()};
  for (const Polygon& part : polygon.parts) {
    for (const Vector2d& p : part.outer) plane.box.extend(rotation * polygon.frame.to_space(p));
  }
  return plane;
}

/// Places on a line of shifts, base + s * along.
struct Stretch {
  double from = -1e300;
  double to = 1e300;
  [[nodiscard]] bool empty() const { return from > to; }
};

/// Narrows `stretch` to the shifts at which box `a` meets box `b`.
void narrow(const Box& a, const Box& b, const Vector3d& base, const Vector3d& along, Stretch& stretch) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double low = b.min()[k] - kMeetM - a.max()[k] - base[k];
    const double high = b.max()[k] + kMeetM - a.min()[k] - base[k];
    if (std::abs(along[k]) < 1e-9) {
      if (low > 0 || high < 0) stretch.to = stretch.from - 1.0;
      continue;
    }
    const double first = low / along[k];
    const double second = high / along[k];
    stretch.from = std::max(stretch.from, std::min(first, second));
    stretch.to = std::min(stretch.to, std::max(first, second));
  }
}

/// A plane of the model that an anchor may lie on, and the shift along its normal that brings it there.
struct Partner {
  const BoxedPlane* plane = nullptr;
  double shift = 0.0;
};

struct Anchor {
  BoxedPlane plane;
  std::vector<Partner> partners;
};

/// Poses found under one rotation, near ones counted together.
class Ballot {
 public:
  explicit Ballot(double cell_m) : cell_m_(cell_m) {}

  void add(const Vector3d& translation) {
    const std::int64_t key = cell_key((translation / cell_m_).array().round());
    const auto [place, fresh] = place_.try_emplace(key, found_.size());
    if (fresh) found_.push_back({translation, 0});
    ++found_[place->second].votes;
  }

  struct Found {
    Vector3d translation;
    int votes = 0;
  };
  [[nodiscard]] const std::vector<Found>& found() const { return found_; }

 private:
  double cell_m_;
  std::vector<Found> found_;
  std::unordered_map<std::int64_t, std::size_t> place_;
};

class Enumerator {
 public:
  Enumerator(const Features& scan, const Features& model, const ModelPoseOptions& options)
      : options_(options) {
    for (const PlanarPolygon& polygon : model.planes) {
      if (polygon.area_m2 >= options.min_plane_m2) model_.push_back(boxed(polygon, Matrix3d::Identity()));
    }
    for (const PlanarPolygon& polygon : scan.planes) largest_.push_back(&polygon);
    std::stable_sort(largest_.begin(), largest_.end(),
                     [](const PlanarPolygon* a, const PlanarPolygon* b) { return a->area_m2 > b->area_m2; });
    if (largest_.size() > static_cast<std::size_t>(options.max_scan_planes))
      largest_.resize(static_cast<std::size_t>(options.max_scan_planes));
  }

  [[nodiscard]] std::vector<PoseCandidate> poses_of(const Matrix3d& rotation) const {
    const std::array<std::vector<Anchor>, 3> anchors = anchors_of(rotation);
    if (std::any_of(anchors.begin(), anchors.end(), [](const auto& list) { return list.empty(); })) return {};
    Ballot ballot(options_.same_shift_m);
    for (const Anchor& a : anchors[0]) {
      for (const Anchor& b : anchors[1]) vote_pairs(a, b, anchors[2], ballot);
    }
    std::vector<PoseCandidate> poses;
    for (const Ballot::Found& found : ballot.found())
      poses.push_back({{rotation, found.translation}, static_cast<double>(found.votes), 0});
    return poses;
  }

 private:
  /// The scan's largest planes by direction: three that differ most from one another, largest first.
  [[nodiscard]] std::array<std::vector<Anchor>, 3> anchors_of(const Matrix3d& rotation) const {
    std::array<std::vector<Anchor>, 3> anchors;
    std::array<Vector3d, 3> directions;
    std::size_t known = 0;
    const double near = std::cos(radians(options_.direction_deg));
    for (const PlanarPolygon* polygon : largest_) {
      const Vector3d normal = rotation * polygon->plane.normal;
      std::size_t at = 0;
      while (at < known && std::abs(normal.dot(directions[at])) < near) ++at;
      if (at == known) {
        if (known == 3 || !independent(normal, directions, known)) continue;
        directions[known++] = normal;
      }
      if (anchors[at].size() >= static_cast<std::size_t>(options_.anchors)) continue;
      Anchor anchor{boxed(*polygon, rotation), {}};
      add_partners(anchor);
      if (!anchor.partners.empty()) anchors[at].push_back(std::move(anchor));
    }
    // The direction with the fewest partners goes last: it is looked up most often.
    const auto partners = [](const std::vector<Anchor>& list) {
      std::size_t sum = 0;
      for (const Anchor& anchor : list) sum += anchor.partners.size();
      return sum;
    };
    std::stable_sort(anchors.begin(), anchors.end(),
                     [&](const auto& a, const auto& b) { return partners(a) > partners(b); });
    return anchors;
  }

  static bool independent(const Vector3d& normal, const std::array<Vector3d, 3>& directions,
                          std::size_t known) {
    for (std::size_t k = 0; k < known; ++k) {
      if (std::abs(normal.dot(directions[k])) > kOtherDirection) return false;
    }
    return known < 2 || std::abs(directions[0].cross(directions[1]).dot(normal)) > kMinDeterminant;
  }

  void add_partners(Anchor& anchor) const {
    const double near = std::cos(radians(options_.direction_deg));
    for (const BoxedPlane& plane : model_) {
      const double cosine = anchor.plane.normal.dot(plane.normal);
      const bool oriented = anchor.plane.polygon->oriented && plane.polygon->oriented;
      if ((oriented ? cosine : std::abs(cosine)) < near) continue;
      anchor.partners.push_back(
          {&plane, plane.polygon->plane.offset - plane.normal.dot(anchor.plane.middle)});
    }
  }

  void vote_pairs(const Anchor& a, const Anchor& b, const std::vector<Anchor>& thirds, Ballot& ballot) const {
    const Vector3d reach = a.plane.box.merged(b.plane.box).sizes();
    for (const Partner& p : a.partners) {
      Box around = p.plane->box;
      around.min() -= reach;
      around.max() += reach;
      for (const Partner& q : b.partners) {
        if (!around.intersects(q.plane->box)) continue;
        vote(a, p, b, q, thirds, ballot);
      }
    }
  }

  /// Two pairs leave a line of shifts open; every third pair that is met on it closes it.
  static void vote(const Anchor& a, const Partner& p, const Anchor& b, const Partner& q,
                   const std::vector<Anchor>& thirds, Ballot& ballot) {
    Matrix3d rows;
    rows.row(0) = p.plane->normal.transpose();
    rows.row(1) = q.plane->normal.transpose();
    const Vector3d open = p.plane->normal.cross(q.plane->normal);
    if (open.norm() < 0.3) return;
    rows.row(2) = open.normalized().transpose();
    const Matrix3d solve = rows.inverse();
    const Vector3d base = solve * Vector3d(p.shift, q.shift, 0.0);
    const Vector3d along = solve.col(2);
    Stretch stretch;
    narrow(a.plane.box, p.plane->box, base, along, stretch);
    narrow(b.plane.box, q.plane->box, base, along, stretch);
    if (stretch.empty()) return;
    for (const Anchor& c : thirds) {
      for (const Partner& r : c.partners) {
        const double slope = r.plane->normal.dot(along);
        if (std::abs(slope) < kMinDeterminant) continue;
        const double s = (r.shift - r.plane->normal.dot(base)) / slope;
        if (s < stretch.from || s > stretch.to) continue;
        Stretch at{s, s};
        narrow(c.plane.box, r.plane->box, base, along, at);
        if (!at.empty()) ballot.add(base + s * along);
      }
    }
  }

  const ModelPoseOptions& options_;
  std::vector<BoxedPlane> model_;
  std::vector<const PlanarPolygon*> largest_;
};

}  // namespace

void ModelPoseOptions::check() const {
  if (anchors < 1) throw_bad_option("anchors", anchors, "1 or more");
  if (max_scan_planes < 1) throw_bad_option("max_scan_planes", max_scan_planes, "1 or more");
  if (!(min_plane_m2 > 0)) throw_bad_option("min_plane_m2", min_plane_m2, "more than 0");
  if (!(same_shift_m > 0)) throw_bad_option("same_shift_m", same_shift_m, "more than 0");
  if (max_poses < 1) throw_bad_option("max_poses", max_poses, "1 or more");
}

std::vector<PoseCandidate> enumerate_model_poses(const Features& scan, const Features& model,
                                                 const ModelPoseOptions& options) {
  options.check();
  RotationOptions turning;
  turning.gravity_known = options.gravity_known;
  turning.gravity_tolerance_deg = options.gravity_tolerance_deg;
  turning.direction_deg = options.direction_deg;
  const std::vector<Matrix3d> rotations = enumerate_rotations(
      axis_directions(scan, options.direction_deg), axis_directions(model, options.direction_deg), turning);
  const Enumerator enumerator(scan, model, options);
  std::vector<std::vector<PoseCandidate>> found(rotations.size());
  parallel_for(rotations.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = enumerator.poses_of(rotations[i]);
  });
  std::vector<PoseCandidate> all;
  for (const std::vector<PoseCandidate>& poses : found) all.insert(all.end(), poses.begin(), poses.end());
  std::stable_sort(all.begin(), all.end(), [](const PoseCandidate& a, const PoseCandidate& b) {
    return a.support_m2 > b.support_m2;
  });
  if (all.size() > static_cast<std::size_t>(options.max_poses))
    all.resize(static_cast<std::size_t>(options.max_poses));
  return all;
}

}  // namespace limen
