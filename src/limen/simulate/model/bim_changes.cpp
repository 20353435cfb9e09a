// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_changes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limen/simulate/scanner/ray_caster.h"

namespace limen {
namespace {

constexpr double kMissingShare = 0.15;  // of doors, furniture and what bears no load
// At most this share of what the stations see along one direction has moved along it: the model's frame stays
// what most of the building says.
constexpr double kMostMovedShare = 0.4;
constexpr double kNoShift = 0.004;  // m: less along a direction misleads nobody
constexpr int kProbes = 4000;

bool moves_sideways(BimKind kind) {
  return kind == BimKind::wall || kind == BimKind::column || kind == BimKind::window ||
         kind == BimKind::door || kind == BimKind::plate;
}

bool bears_nothing(BimKind kind) {
  return kind == BimKind::door || kind == BimKind::furniture || kind == BimKind::railing ||
         kind == BimKind::other;
}

Vector3d random_shift(BimKind kind, RandomStream& random) {
  if (kind == BimKind::slab)
    return {0.0, 0.0, (random.below(2) == 0 ? 1.0 : -1.0) * random.uniform(0.005, 0.02)};
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double length = random.uniform(0.01, 0.05);
  return {length * std::cos(angle), length * std::sin(angle), 0.0};
}

/// Surface that stations see of each element along two horizontal directions of the building and upwards.
struct SeenSurface {
  std::array<Vector3d, 3> axes = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  std::vector<Vector3d> per_element;  ///< m^2 per axis
  Vector3d total = Vector3d::Zero();
};

/// One ray's piece of surface.
struct SeenPatch {
  int element;
  Vector3d normal;
  double area;
};

std::vector<SeenPatch> patches_of(const std::vector<BimStation>& stations, const BimMesh& planned) {
  const RayCaster caster(planned.mesh);
  std::vector<SeenPatch> patches;
  for (const BimStation& station : stations) {
    for (const Vector3d& direction : spread_directions(kProbes)) {
      double from = 0.05;
      RayHit hit = caster.cast(station.position, direction, from);
      for (int pane = 0; pane < 4 && hit.found(); ++pane) {
        if (planned.mesh.surfaces()[static_cast<std::size_t>(hit.surface)].element != Element::glass) break;
        from = hit.range_m + 1e-3;
        hit = caster.cast(station.position, direction, from);
      }
      if (!hit.found() || hit.inside) continue;
      const auto surface = static_cast<std::size_t>(hit.surface);
      const double area =
          4.0 * std::numbers::pi / kProbes * hit.range_m * hit.range_m / std::max(0.1, hit.cosine);
      patches.push_back(
          {planned.element_of_surface[surface], planned.mesh.surfaces()[surface].plane.normal, area});
    }
  }
  return patches;
}

SeenSurface seen_surface(const BimModel& model, const std::vector<BimStation>& stations,
                         const BimMesh& planned) {
  SeenSurface seen;
  seen.per_element.assign(model.elements.size(), Vector3d::Zero());
  const std::vector<SeenPatch> patches = patches_of(stations, planned);
  // The building's direction: of the largest upright piece, good enough for sorting by direction.
  double largest = 0.0;
  for (const SeenPatch& patch : patches) {
    if (std::abs(patch.normal.z()) > 0.1 || patch.area <= largest) continue;
    largest = patch.area;
    seen.axes[0] = Vector3d(patch.normal.x(), patch.normal.y(), 0.0).normalized();
    seen.axes[1] = Vector3d::UnitZ().cross(seen.axes[0]);
  }
  for (const SeenPatch& patch : patches) {
    Eigen::Index axis = 0;
    double best = -1.0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double along = std::abs(patch.normal.dot(seen.axes[static_cast<std::size_t>(i)]));
      if (along <= best) continue;
      best = along;
      axis = i;
    }
    seen.total[axis] += patch.area;
    if (patch.element >= 0) seen.per_element[static_cast<std::size_t>(patch.element)][axis] += patch.area;
  }
  return seen;
}

/// The wall that holds each window and door, or -1.
std::vector<int> hosts_of(const BimModel& model) {
  std::vector<int> hosts(model.elements.size(), -1);
  for (const BimOpening& opening : model.openings)
    if (opening.filling >= 0 && opening.host >= 0)
      hosts[static_cast<std::size_t>(opening.filling)] = opening.host;
  return hosts;
}

/// Chooses the shifts of elements; a window's or door's is added to that of its wall.
class Mover {
 public:
  Mover(const BimModel& model, const AsBuiltOptions& options, RandomStream& random)
      : hosts_(hosts_of(model)), own_(model.elements.size(), Vector3d::Zero()) {
    for (std::size_t i = 0; i < own_.size(); ++i) {
      const BimKind kind = model.elements[i].kind;
      const bool chosen = random.uniform() < options.moved_share;
      const Vector3d shift = random_shift(kind, random);
      if (chosen && (moves_sideways(kind) || kind == BimKind::slab)) own_[i] = shift;
    }
  }

  [[nodiscard]] Vector3d shift(std::size_t element) const {
    const int host = hosts_[element];
    return host < 0 ? own_[element] : Vector3d(own_[element] + own_[static_cast<std::size_t>(host)]);
  }

  /// Takes back shifts, of what is seen most first, until most of the building is where it should be.
  void keep_majority(const SeenSurface& seen) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      while (moved_area(seen, axis) > kMostMovedShare * seen.total[static_cast<Eigen::Index>(axis)])
        take_back(seen, axis);
  }

 private:
  [[nodiscard]] bool has_moved(std::size_t element, const Vector3d& axis) const {
    return std::abs(shift(element).dot(axis)) > kNoShift;
  }

  [[nodiscard]] double moved_area(const SeenSurface& seen, std::size_t axis) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < own_.size(); ++i)
      if (has_moved(i, seen.axes[axis])) sum += seen.per_element[i][static_cast<Eigen::Index>(axis)];
    return sum;
  }

  void take_back(const SeenSurface& seen, std::size_t axis) {
    std::size_t worst = own_.size();
    double most = -1.0;
    for (std::size_t i = 0; i < own_.size(); ++i) {
      const double area = seen.per_element[i][static_cast<Eigen::Index>(axis)];
      if (!has_moved(i, seen.axes[axis]) || area <= most) continue;
      most = area;
      worst = i;
    }
    own_[worst].setZero();
    if (hosts_[worst] >= 0) own_[static_cast<std::size_t>(hosts_[worst])].setZero();
  }

  std::vector<int> hosts_;
  std::vector<Vector3d> own_;
};

}  // namespace

void open_doors(const BimModel& model, double open_share, RandomStream& random, BuiltState& built) {
  for (std::size_t i = 0; i < model.elements.size(); ++i)
    if (model.elements[i].kind == BimKind::door && random.uniform() < open_share) built.there[i] = 0;
}

BuiltState as_built(const BimModel& model, const AsBuiltOptions& options, const BuiltState& doors,
                    const std::vector<BimStation>& stations, const BimMesh& planned, RandomStream& random) {
  BuiltState built = doors;
  Mover mover(model, options, random);
  mover.keep_majority(seen_surface(model, stations, planned));
  for (std::size_t i = 0; i < model.elements.size(); ++i) {
    built.shift_m[i] = mover.shift(i);
    if (random.uniform() < kMissingShare && bears_nothing(model.elements[i].kind)) built.there[i] = 0;
  }
  return built;
}

std::vector<ModelChange> changes_of(const BimModel& model, const BuiltState& doors, const BuiltState& built) {
  std::vector<ModelChange> changes;
  for (std::size_t i = 0; i < model.elements.size(); ++i) {
    ModelChange change;
    change.element = static_cast<int>(i);
    change.guid = model.elements[i].guid;
    change.kind = to_string(model.elements[i].kind);
    if (built.there[i] == 0) {
      change.state = doors.there[i] == 0 ? ModelState::open : ModelState::missing;
      changes.push_back(change);
    } else if (built.shift_m[i].norm() > 0.0) {
      change.shift_m = built.shift_m[i];
      changes.push_back(change);
    }
  }
  return changes;
}

}  // namespace limen
