// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_model_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/base/progress.h"
#include "limen/geometry/cell_key.h"
#include "limen/geometry/cell_lists.h"
#include "limen/match/planes/enumerate_rotations.h"

namespace limen {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kModelDirectionDeg = 5.0;     // normals nearer than this are one direction
constexpr std::size_t kMostScanPlanes = 24;    // largest planes of the scan that are looked at
constexpr double kLeastPieceM2 = 0.3;          // smaller pieces of the model are not tried
constexpr double kSameModelShiftM = 0.08;      // poses nearer than about this are one
constexpr double kMinNormalDeterminant = 0.2;  // three normals flatter than this do not fix a shift
constexpr double kOtherDirection = 0.8;        // cosine: normals nearer than this are no two directions
constexpr double kMeetM = 0.15;                // boxes of planes that meet may miss each other by this
// Along each axis two planes that are one share this much of the shorter: what a scan saw of a wall lies in
// that wall, or holds it where a scan saw several pieces as one; corners that only touch show nothing.
constexpr double kCommonShare = 0.3;

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

/// Narrows `stretch` to those of its shifts that lie in `shifts`.
void narrow(const Box& shifts, const Vector3d& base, const Vector3d& along, Stretch& stretch) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double low = shifts.min()[k] - base[k];
    const double high = shifts.max()[k] - base[k];
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

/// Planes of a model to be found by where they stand, in a grid.
class PlanesByPlace {
 public:
  explicit PlanesByPlace(const std::vector<BoxedPlane>& planes) : planes_(planes) {
    for (const BoxedPlane& plane : planes) all_.extend(plane.box);
    if (planes.empty()) return;
    cell_m_ = std::max(kCellM, all_.sizes().maxCoeff() / kMostCells);
    std::vector<std::vector<std::int64_t>> cells_of(planes.size());
    for (std::size_t i = 0; i < planes.size(); ++i)
      for_cells(planes[i].box, [&](const Vector3d& cell) { cells_of[i].push_back(cell_key(cell)); });
    cells_ = CellLists(std::move(cells_of));
  }

  /// Numbers of the planes whose boxes meet `box`, ascending.
  void meeting(const Box& box, std::vector<std::int32_t>& found) const {
    found.clear();
    const Box asked = box.intersection(all_);
    if (asked.isEmpty()) return;
    const Vector3d first = cell_of(asked.min(), cell_m_);
    for_cells(asked, [&](const Vector3d& cell) {
      for (const std::int32_t i : cells_.at(cell_key(cell))) {
        const Box& other = planes_[static_cast<std::size_t>(i)].box;
        // Of the cells that both stand in the first one tells.
        if (cell_of(other.min(), cell_m_).cwiseMax(first) == cell && other.intersects(box))
          found.push_back(i);
      }
    });
    std::sort(found.begin(), found.end());
  }

 private:
  static constexpr double kCellM = 4.0;
  static constexpr double kMostCells = 128.0;  // along each axis

  template <typename Visit>
  void for_cells(const Box& box, const Visit& visit) const {
    const Vector3d low = cell_of(box.min(), cell_m_);
    const Vector3d high = cell_of(box.max(), cell_m_);
    for (double x = low.x(); x <= high.x(); ++x)
      for (double y = low.y(); y <= high.y(); ++y)
        for (double z = low.z(); z <= high.z(); ++z) visit(Vector3d(x, y, z));
  }

  const std::vector<BoxedPlane>& planes_;
  Box all_;
  double cell_m_ = kCellM;
  CellLists cells_;
};

/// A plane of the model that an anchor may lie on, the shift along its normal that brings it there, and all
/// shifts at which the boxes of both meet.
struct Partner {
  const BoxedPlane* plane = nullptr;
  double shift = 0.0;
  Box meeting;
};

struct Anchor {
  BoxedPlane plane;
  std::vector<Partner> partners;              ///< in the order of the model's planes
  std::vector<std::int32_t> partner_of = {};  ///< of each of them; -1: it is none
};

/// The shifts at which box `a` has kCommonShare of the smaller in common with box `b`, along each axis.
Box meeting_shifts(const Box& a, const Box& b) {
  const Vector3d less = (kCommonShare * a.sizes().cwiseMin(b.sizes())).array() - kMeetM;
  return {b.min() - a.max() + less, b.max() - a.min() - less};
}

/// What holds every box that box `a` meets so under one of the shifts.
Box met_under(const Box& a, const Box& shifts) {
  constexpr double kSlackM = kMeetM + 1e-6;
  return {shifts.min() + a.min() - Vector3d::Constant(kSlackM),
          shifts.max() + a.max() + Vector3d::Constant(kSlackM)};
}

/// The share of box `a`, shifted, that lies in box `b`. Over planes side by side it adds up to 1 at most.
double common_share(const Box& a, const Box& b, const Vector3d& shift) {
  double share = 1.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double common =
        std::min(a.max()[k] + shift[k], b.max()[k]) - std::max(a.min()[k] + shift[k], b.min()[k]);
    share *= std::clamp((common + kMeetM) / (a.sizes()[k] + kMeetM), 0.0, 1.0);
  }
  return share;
}

constexpr double kOneWay = 1e-6;  // normals that differ by less face one way

/// A stretch of a line of shifts, base + s * along.
struct ShiftWay {
  Vector3d base;
  Vector3d along;
  Stretch stretch;

  [[nodiscard]] Vector3d at(double s) const { return base + s * along; }
};

/// A partner that a way of shifts meets, and where.
struct MetPartner {
  std::uint32_t number = 0;
  Vector3d shift;
};

/// The lines of shifts that two pairs of planes leave open, by their normals. Most pairs that follow one
/// another have the same.
struct OpenLine {
  Vector3d first = Vector3d::Zero();
  Vector3d second = Vector3d::Zero();
  Matrix3d solve = Matrix3d::Identity();  ///< shift from the two offsets and the place along
  bool open = false;                      ///< whether the two normals are far enough from parallel

  /// Makes it that of two normals.
  void be_of(const Vector3d& p, const Vector3d& q) {
    if (p == first && q == second) return;
    first = p;
    second = q;
    const Vector3d across = p.cross(q);
    open = across.norm() >= 0.3;
    if (!open) return;
    Matrix3d rows;
    rows << p.transpose(), q.transpose(), across.normalized().transpose();
    solve = rows.inverse();
  }
};

/// What voting needs again and again.
struct VoteRoom {
  std::vector<std::int32_t> near;
  std::vector<MetPartner> met;
  OpenLine line;
};

/// The partners of an anchor, to be found by where they cross a line of shifts: those that face exactly one
/// way lie along it in the order of their offsets.
class PartnersInOrder {
 public:
  explicit PartnersInOrder(const std::vector<Partner>& partners) {
    for (std::uint32_t i = 0; i < partners.size(); ++i) {
      const Partner& partner = partners[i];
      row_of(partner.plane->normal)
          .entries.push_back({partner.shift, i, partner.plane->normal, partner.meeting});
    }
    for (Row& row : rows_) {
      std::sort(row.entries.begin(), row.entries.end(), [](const Entry& a, const Entry& b) {
        return a.shift != b.shift ? a.shift < b.shift : a.number < b.number;
      });
    }
  }

  /// Partners that the way meets, in their own order.
  void met_on(const ShiftWay& way, std::vector<MetPartner>& met) const {
    met.clear();
    const Vector3d begin = way.at(way.stretch.from);
    const Vector3d end = way.at(way.stretch.to);
    const double slack = 1e-9 + kOneWay * (begin.norm() + end.norm());
    for (const Row& row : rows_) {
      const double at_begin = row.normal.dot(begin);
      const double at_end = row.normal.dot(end);
      const double most = std::max(at_begin, at_end) + slack;
      auto place =
          std::lower_bound(row.entries.begin(), row.entries.end(), std::min(at_begin, at_end) - slack,
                           [](const Entry& entry, double shift) { return entry.shift < shift; });
      for (; place != row.entries.end() && place->shift <= most; ++place) place->meet(way, met);
    }
    std::sort(met.begin(), met.end(),
              [](const MetPartner& a, const MetPartner& b) { return a.number < b.number; });
  }

 private:
  struct Entry {
    double shift = 0.0;
    std::uint32_t number = 0;
    Vector3d normal;
    Box meeting;

    void meet(const ShiftWay& way, std::vector<MetPartner>& met) const {
      const double slope = normal.dot(way.along);
      if (std::abs(slope) < kMinNormalDeterminant) return;
      const double s = (shift - normal.dot(way.base)) / slope;
      if (s < way.stretch.from || s > way.stretch.to) return;
      const Vector3d at = way.at(s);
      if (meeting.contains(at)) met.push_back({number, at});
    }
  };
  struct Row {
    Vector3d normal;
    std::vector<Entry> entries;  ///< by shift
  };

  Row& row_of(const Vector3d& normal) {
    for (Row& row : rows_) {
      if ((row.normal - normal).squaredNorm() < kOneWay * kOneWay) return row;
    }
    rows_.push_back({normal, {}});
    return rows_.back();
  }

  std::vector<Row> rows_;
};

/// An anchor of the direction that is looked up for every pair of the others.
struct ThirdAnchor {
  const Anchor* anchor = nullptr;
  PartnersInOrder partners;
};

/// A shift under one of the rotations, and how much the triples of planes that agree on it have in common.
struct Found {
  Vector3d translation;
  double weight = 0.0;
  std::uint32_t rotation = 0;
};

/// Leaves the `most` of the greatest weight, of equal ones those found first, in the order they are in.
void keep_most(std::vector<Found>& found, std::size_t most) {
  if (found.size() <= most) return;
  std::vector<double> weights;
  weights.reserve(found.size());
  for (const Found& it : found) weights.push_back(it.weight);
  const auto last = weights.begin() + static_cast<std::ptrdiff_t>(most - 1);
  std::nth_element(weights.begin(), last, weights.end(), std::greater<>());
  const double least = *last;
  const auto above = static_cast<std::size_t>(
      std::count_if(found.begin(), found.end(), [&](const Found& it) { return it.weight > least; }));
  std::size_t room = most - above;
  std::erase_if(found, [&](const Found& it) {
    if (it.weight != least) return it.weight < least;
    if (room == 0) return true;
    --room;
    return false;
  });
}

/// Poses found under one rotation, near ones counted together.
class Ballot {
 public:
  explicit Ballot(double cell_m) : cell_m_(cell_m), slots_(kFirstSlots, kFree) {}

  void add(const Vector3d& translation, double weight) {
    const std::int64_t key = cell_key((translation / cell_m_).array().round());
    std::uint32_t& slot = slot_of(key);
    if (slot != kFree) {
      Found& known = found_[slot];
      known.weight += weight;
      known.translation += weight / known.weight * (translation - known.translation);
      return;
    }
    slot = static_cast<std::uint32_t>(found_.size());
    found_.push_back({translation, weight, 0});
    keys_.push_back(key);
    if (2 * found_.size() > slots_.size()) enlarge();
  }

  [[nodiscard]] std::vector<Found> weightiest(std::size_t most) && {
    keep_most(found_, most);
    found_.shrink_to_fit();
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kFirstSlots = 1024;
  static constexpr std::uint32_t kFree = 0xffffffffU;

  /// Where the key is, or would be: a table of numbers into found_, the next free place taken.
  std::uint32_t& slot_of(std::int64_t key) {
    const std::uint64_t mixed = static_cast<std::uint64_t>(key) * 0x9E3779B97F4A7C15ULL;
    std::size_t at = static_cast<std::size_t>(mixed >> 32U) & (slots_.size() - 1);
    while (slots_[at] != kFree && keys_[slots_[at]] != key) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }

  void enlarge() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::uint32_t i = 0; i < keys_.size(); ++i) slot_of(keys_[i]) = i;
  }

  double cell_m_;
  std::vector<Found> found_;
  std::vector<std::int64_t> keys_;    // of what was found
  std::vector<std::uint32_t> slots_;  // a power of two, half of them free at least
};

class ModelEnumerator {
 public:
  ModelEnumerator(const Features& scan, const Features& model, const ModelPoseOptions& options)
      : options_(options) {
    for (const PlanarPolygon& polygon : model.planes) {
      if (polygon.area_m2 >= kLeastPieceM2) model_.push_back(boxed(polygon, Matrix3d::Identity()));
    }
    for (const PlanarPolygon& polygon : scan.planes) largest_.push_back(&polygon);
    std::stable_sort(largest_.begin(), largest_.end(),
                     [](const PlanarPolygon* a, const PlanarPolygon* b) { return a->area_m2 > b->area_m2; });
    if (largest_.size() > kMostScanPlanes) largest_.resize(kMostScanPlanes);
    places_.emplace(model_);
  }

  /// The shifts under one rotation.
  [[nodiscard]] std::vector<Found> shifts_of(const Matrix3d& rotation) const {
    const std::array<std::vector<Anchor>, 3> anchors = anchors_of(rotation);
    if (std::any_of(anchors.begin(), anchors.end(), [](const auto& list) { return list.empty(); })) return {};
    std::vector<ThirdAnchor> thirds;
    for (const Anchor& c : anchors[2]) thirds.push_back({&c, PartnersInOrder(c.partners)});
    Ballot ballot(kSameModelShiftM);
    VoteRoom room;
    for (const Anchor& a : anchors[0]) {
      for (const Anchor& b : anchors[1]) vote_pairs(a, b, thirds, room, ballot);
    }
    return std::move(ballot).weightiest(static_cast<std::size_t>(options_.max_poses));
  }

 private:
  /// The scan's largest planes by direction: three that differ most from one another, largest first.
  [[nodiscard]] std::array<std::vector<Anchor>, 3> anchors_of(const Matrix3d& rotation) const {
    std::array<std::vector<Anchor>, 3> anchors;
    std::array<Vector3d, 3> directions;
    std::size_t known = 0;
    const double near = std::cos(radians(kModelDirectionDeg));
    for (const PlanarPolygon* polygon : largest_) {
      const Vector3d normal = rotation * polygon->plane.normal;
      std::size_t at = 0;
      while (at < known && std::abs(normal.dot(directions[at])) < near) ++at;
      if (at == known) {
        if (known == 3 || !independent(normal, directions, known)) continue;
        directions[known++] = normal;
      }
      if (anchors[at].size() >= static_cast<std::size_t>(options_.anchors)) continue;
      Anchor anchor{boxed(*polygon, rotation), {}, {}};
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
    return known < 2 || std::abs(directions[0].cross(directions[1]).dot(normal)) > kMinNormalDeterminant;
  }

  void add_partners(Anchor& anchor) const {
    const double near = std::cos(radians(kModelDirectionDeg));
    anchor.partner_of.assign(model_.size(), -1);
    for (std::size_t i = 0; i < model_.size(); ++i) {
      const BoxedPlane& plane = model_[i];
      const double cosine = anchor.plane.normal.dot(plane.normal);
      const bool oriented = anchor.plane.polygon->oriented && plane.polygon->oriented;
      if ((oriented ? cosine : std::abs(cosine)) < near) continue;
      anchor.partner_of[i] = static_cast<std::int32_t>(anchor.partners.size());
      anchor.partners.push_back({&plane, plane.polygon->plane.offset - plane.normal.dot(anchor.plane.middle),
                                 meeting_shifts(anchor.plane.box, plane.box)});
    }
  }

  void vote_pairs(const Anchor& a, const Anchor& b, const std::vector<ThirdAnchor>& thirds, VoteRoom& room,
                  Ballot& ballot) const {
    const Vector3d reach = a.plane.box.merged(b.plane.box).sizes();
    for (const Partner& p : a.partners) {
      CancelScope::check();
      Box around = p.plane->box;
      around.min() -= reach;
      around.max() += reach;
      places_->meeting(around.intersection(met_under(b.plane.box, p.meeting)), room.near);
      for (const std::int32_t i : room.near) {
        const std::int32_t partner = b.partner_of[static_cast<std::size_t>(i)];
        if (partner < 0) continue;
        const Partner& q = b.partners[static_cast<std::size_t>(partner)];
        // One shift has to bring both pairs together.
        if (p.meeting.intersects(q.meeting)) vote(a, p, b, q, thirds, room, ballot);
      }
    }
  }

  /// Two pairs leave a line of shifts open; every third pair that is met on it closes it.
  static void vote(const Anchor& a, const Partner& p, const Anchor& b, const Partner& q,
                   const std::vector<ThirdAnchor>& thirds, VoteRoom& room, Ballot& ballot) {
    room.line.be_of(p.plane->normal, q.plane->normal);
    if (!room.line.open) return;
    const Vector3d base = room.line.solve * Vector3d(p.shift, q.shift, 0.0);
    const Vector3d along = room.line.solve.col(2);
    Stretch stretch;
    narrow(p.meeting, base, along, stretch);
    narrow(q.meeting, base, along, stretch);
    if (stretch.empty()) return;
    const ShiftWay way{base, along, stretch};
    for (const ThirdAnchor& c : thirds) {
      c.partners.met_on(way, room.met);
      for (const MetPartner& met : room.met) {
        const Partner& r = c.anchor->partners[met.number];
        const double common = std::min({common_share(a.plane.box, p.plane->box, met.shift),
                                        common_share(b.plane.box, q.plane->box, met.shift),
                                        common_share(c.anchor->plane.box, r.plane->box, met.shift)});
        ballot.add(met.shift, common);
      }
    }
  }

  const ModelPoseOptions& options_;
  std::vector<BoxedPlane> model_;
  std::optional<PlanesByPlace> places_;  ///< of these
  std::vector<const PlanarPolygon*> largest_;
};

}  // namespace

std::vector<PoseCandidate> enumerate_model_poses(const Features& scan, const Features& model,
                                                 const ModelPoseOptions& options) {
  RotationOptions turning;
  turning.gravity_known = options.gravity_known;
  turning.gravity_tolerance_deg = options.gravity_tolerance_deg;
  turning.direction_deg = kModelDirectionDeg;
  const std::vector<Matrix3d> rotations = enumerate_rotations(
      axis_directions(scan, kModelDirectionDeg), axis_directions(model, kModelDirectionDeg), turning);
  const ModelEnumerator enumerator(scan, model, options);
  // Some rotations at a time: of a large building each has a hundred thousand shifts.
  constexpr std::size_t kAtOnce = 16;
  const auto most = static_cast<std::size_t>(options.max_poses);
  std::vector<Found> all;
  for (std::size_t first = 0; first < rotations.size(); first += kAtOnce) {
    std::vector<std::vector<Found>> found(std::min(kAtOnce, rotations.size() - first));
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = enumerator.shifts_of(rotations[first + i]);
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (Found& shift : found[i]) shift.rotation = static_cast<std::uint32_t>(first + i);
      all.insert(all.end(), found[i].begin(), found[i].end());
      if (all.size() > 2 * most) keep_most(all, most);
    }
  }
  keep_most(all, most);
  std::stable_sort(all.begin(), all.end(),
                   [](const Found& a, const Found& b) { return a.weight > b.weight; });
  std::vector<PoseCandidate> poses;
  poses.reserve(all.size());
  for (const Found& it : all) poses.push_back({{rotations[it.rotation], it.translation}, it.weight});
  return poses;
}

}  // namespace limen
