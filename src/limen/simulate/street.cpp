// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/street.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

Vector2d right_of(const Vector2d& d) {
  return {d.y(), -d.x()};
}

Vector3d lifted(const Vector2d& p, double z) {
  return {p.x(), p.y(), z};
}

void add_cylinder(Mesh& mesh, const Vector3d& base, double radius, double height, Element element) {
  std::vector<Vector3d> ring;
  for (int i = 0; i < 10; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 10;
    ring.push_back(base + radius * Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }
  mesh.add_prism(ring, height, surface_of(element));
}

/// A trunk and a crown of loose leaves: many small triangles that lie in no plane.
void add_tree(Mesh& mesh, const Vector2d& at, RandomStream& random) {
  const double crown = random.uniform(1.0, 1.9);
  const double trunk = random.uniform(2.0, 3.4);
  add_cylinder(mesh, lifted(at, 0.0), random.uniform(0.1, 0.2), trunk + 0.5 * crown, Element::tree);
  const int leaves = mesh.add_surface(surface_of(Element::tree));
  const Vector3d middle = lifted(at, trunk + crown);
  const int count = static_cast<int>(450.0 * crown * crown);
  for (int i = 0; i < count; ++i) {
    const Vector3d p = middle + crown * vector_in_ball(random).cwiseProduct(Vector3d(1.0, 1.0, 1.25));
    const double size = random.uniform(0.06, 0.16);
    const Vector3d tip = p + size * vector_in_ball(random);
    mesh.add_triangle(p, p + size * vector_in_ball(random), tip, leaves);
  }
}

/// A body and a cabin with slanting screens, drawn as a profile and pulled across.
void add_car(Mesh& mesh, const Vector2d& at, const Vector2d& along, RandomStream& random) {
  const double length = random.uniform(3.8, 4.7);
  const double width = random.uniform(1.65, 1.85);
  const double height = random.uniform(1.4, 1.9);
  const Vector2d side = right_of(along);
  Surface paint = surface_of(Element::car);
  paint.reflectivity = random.uniform(0.08, 0.6);
  const double yaw = std::atan2(along.y(), along.x());
  mesh.add_box({lifted(at, 0.22), yaw}, {length, width, 0.62}, paint);
  const double low = 0.84;
  const double half = 0.5 * width - 0.08;
  const std::vector<Vector2d> cabin = {
      {-0.42 * length, low}, {0.22 * length, low}, {0.08 * length, height}, {-0.33 * length, height}};
  std::vector<Vector3d> left;
  std::vector<Vector3d> right;
  for (const Vector2d& p : cabin) {
    left.push_back(lifted(at + p.x() * along - half * side, p.y()));
    right.push_back(lifted(at + p.x() * along + half * side, p.y()));
  }
  mesh.add_polygon(right, paint);
  mesh.add_polygon({left[3], left[2], left[1], left[0]}, paint);
  for (std::size_t i = 1; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    mesh.add_polygon({right[next], right[i], left[i], left[next]}, paint);
  }
  for (const double x : {-0.32, 0.32})
    for (const double y : {-0.42, 0.42})
      mesh.add_box({lifted(at + x * length * along + y * width * side, 0.0), yaw}, {0.6, 0.2, 0.6}, paint);
}

/// A row of houses with windows and bare rooms behind, facing the street.
void add_opposite(World& world, const Vector2d& begin, const Vector2d& end, const FacadeOptions& facade,
                  RandomStream& random) {
  const double length = (end - begin).norm();
  if (length < 8.0) return;
  PlanOptions plan;
  const int bays = static_cast<int>(length / random.uniform(2.8, 3.6));
  for (int i = 0; i < bays; ++i) plan.main_bays_m.push_back(length / bays);
  plan.south_depth_m = random.uniform(4.5, 6.5);
  plan.storeys = 2 + static_cast<int>(random.below(3));
  plan.ground_floor_m = random.uniform(0.15, 0.8);
  plan.storey_height_m = random.uniform(2.9, 3.5);
  plan.bays_per_room = 3;
  plan.use = RoomUse::empty;
  FacadeOptions look = facade;
  look.interior_doors = false;
  look.variation = random.uniform() < 0.5 ? 0.0 : 0.15;
  look.blank_share = random.uniform(0.0, 0.25);
  look.window_width_m = random.uniform(0.9, 1.4);
  look.window_height_m = random.uniform(1.3, 1.8);
  const Vector2d along = (begin - end).normalized();
  add_building(world, moved(make_floor_plan(plan, random), end, std::atan2(along.y(), along.x())), look,
               random);
}

/// A chain with its corners rounded and its ends drawn out: what a vehicle drives.
std::vector<Vector2d> driven(std::vector<Vector2d> chain, double run_up) {
  chain.front() -= run_up * (chain[1] - chain[0]).normalized();
  chain.back() += run_up * (chain.back() - chain[chain.size() - 2]).normalized();
  std::vector<Vector2d> path = {chain.front()};
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
    const Vector2d before = chain[i - 1] - chain[i];
    const Vector2d after = chain[i + 1] - chain[i];
    const double reach = std::min({6.0, 0.45 * before.norm(), 0.45 * after.norm()});
    for (int k = 0; k <= 12; ++k) {
      const double t = k / 12.0;
      path.emplace_back(chain[i] + (1.0 - t) * (1.0 - t) * reach * before.normalized() +
                        t * t * reach * after.normalized());
    }
  }
  path.push_back(chain.back());
  return path;
}

/// Calls place(point, direction) about every `spacing` along a chain.
template <typename Place>
void along_chain(const std::vector<Vector2d>& chain, double spacing, RandomStream& random,
                 const Place& place) {
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const double length = (chain[i + 1] - chain[i]).norm();
    const Vector2d along = (chain[i + 1] - chain[i]) / length;
    for (double s = spacing * random.uniform(0.2, 0.8); s < length; s += spacing * random.uniform(0.8, 1.3))
      place(Vector2d(chain[i] + s * along), along);
  }
}

void add_pavement(Mesh& mesh, const Ring& envelope, std::size_t edge) {
  const Vector2d& a = envelope[edge % envelope.size()];
  const Vector2d& b = envelope[(edge + 1) % envelope.size()];
  const Vector2d along = (b - a).normalized();
  const Vector2d middle = 0.5 * (a + b) + 1.25 * right_of(along);
  mesh.add_box({lifted(middle, 0.0), std::atan2(along.y(), along.x())}, {(b - a).norm(), 2.5, 0.12},
               surface_of(Element::pavement));
}

/// Houses across, trees, cars and poles.
void line_street(World& world, const Ring& envelope, const StreetOptions& o, RandomStream& random) {
  const auto chain = [&](double distance) { return offset_chain(envelope, o.first_edge, o.edges, distance); };
  Mesh& mesh = world.mesh;
  if (o.opposite_m > 0.0) {
    const std::vector<Vector2d> across = chain(o.opposite_m);
    for (std::size_t i = 0; i + 1 < across.size(); ++i) {
      const Vector2d along = (across[i + 1] - across[i]).normalized();
      add_opposite(world, across[i] + 2.0 * along, across[i + 1] - 2.0 * along, o.opposite, random);
    }
  }
  if (o.tree_spacing_m > 0.0) {
    along_chain(chain(2.9), o.tree_spacing_m, random,
                [&](const Vector2d& p, const Vector2d&) { add_tree(mesh, p, random); });
    along_chain(chain(o.opposite_m - 2.5), 0.7 * o.tree_spacing_m, random,
                [&](const Vector2d& p, const Vector2d&) { add_tree(mesh, p, random); });
  }
  for (const double distance : {o.path_m - 3.0, o.path_m + 3.2}) {
    along_chain(chain(distance), 6.0, random, [&](const Vector2d& p, const Vector2d& along) {
      if (random.uniform() < o.car_share) add_car(mesh, p, along, random);
    });
  }
  along_chain(chain(2.2), 21.0, random, [&](const Vector2d& p, const Vector2d&) {
    add_cylinder(mesh, lifted(p, 0.0), 0.08, random.uniform(2.5, 7.0), Element::pole);
  });
}

}  // namespace

std::vector<Vector2d> offset_chain(const Ring& envelope, std::size_t first, std::size_t count,
                                   double distance) {
  const std::size_t n = envelope.size();
  const auto direction = [&](std::size_t edge) {
    return Vector2d((envelope[(edge + 1) % n] - envelope[edge % n]).normalized());
  };
  std::vector<Vector2d> chain;
  for (std::size_t k = 0; k <= count; ++k) {
    const Vector2d& corner = envelope[(first + k) % n];
    const Vector2d before = right_of(direction(first + (k == 0 ? 0 : k - 1)));
    const Vector2d after = right_of(direction(first + (k == count ? k - 1 : k)));
    const Vector2d bisector = (before + after).normalized();
    chain.emplace_back(corner + distance / bisector.dot(before) * bisector);
  }
  return chain;
}

VehiclePath add_street(World& world, std::size_t building, const StreetOptions& o, RandomStream& random) {
  const Ring envelope = world.buildings[building].plan.envelope;
  Mesh& mesh = world.mesh;
  for (std::size_t edge = o.first_edge; edge < o.first_edge + o.edges; ++edge) {
    if (!o.bare) add_pavement(mesh, envelope, edge);
    const Vector2d along = envelope[(edge + 1) % envelope.size()] - envelope[edge % envelope.size()];
    world.buildings[building].street_normals.push_back(right_of(along.normalized()));
  }
  if (!o.bare) line_street(world, envelope, o, random);
  return drive_past(envelope, o.first_edge, o.edges, o.path_m, o.antenna_m);
}

VehiclePath drive_past(const Ring& envelope, std::size_t first, std::size_t count, double distance_m,
                       double antenna_m) {
  VehiclePath trajectory;
  for (const Vector2d& p : driven(offset_chain(envelope, first, count, distance_m), 11.0))
    trajectory.points.push_back(lifted(p, antenna_m));
  return trajectory;
}

void add_ground(World& world) {
  constexpr double kReach = 200.0;
  world.mesh.add_polygon(
      {{-kReach, -kReach, 0.0}, {kReach, -kReach, 0.0}, {kReach, kReach, 0.0}, {-kReach, kReach, 0.0}},
      surface_of(Element::ground));
}

void add_garden(World& world, std::size_t building, std::size_t edge, RandomStream& random) {
  const Ring envelope = world.buildings[building].plan.envelope;
  const std::vector<Vector2d> trees = offset_chain(envelope, edge, 1, random.uniform(5.0, 8.0));
  along_chain(trees, 7.0, random, [&](const Vector2d& p, const Vector2d& along) {
    add_tree(world.mesh, p + random.uniform(-1.5, 2.5) * right_of(along), random);
  });
  const std::vector<Vector2d> fence = offset_chain(envelope, edge, 1, random.uniform(11.0, 15.0));
  const Vector2d along = (fence[1] - fence[0]).normalized();
  world.mesh.add_box({lifted(0.5 * (fence[0] + fence[1]), 0.0), std::atan2(along.y(), along.x())},
                     {(fence[1] - fence[0]).norm() + 10.0, 0.2, random.uniform(1.4, 2.2)},
                     surface_of(Element::wall));
}

}  // namespace limen
