// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// What a project of many stations costs beside its features and pairs: choosing pairs, and the solution with
// all covariances. Features are simulated, no clouds; pairs are answered by the truth with noise.
//
// An office building: rooms of about 6 x 5 m on floors, three stations in each, doors between neighbours,
// staircases. Every station has any place and any heading.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <sys/resource.h>

#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/project/assemble.h"
#include "limen/project/run/waves.h"
#include "limen/project/solve/project_graph.h"
#include "limen/project/state/project_node.h"

namespace {

using namespace limen;

constexpr int kPerRoom = 3;
constexpr double kTileM = 0.003;    // scatter of a tile's point
constexpr double kCommonM = 0.002;  // of a plane as one scan sees it
constexpr double kLinkM = 0.003;
constexpr double kLinkRad = 0.0004;
constexpr double kDoorSight = 0.6;  // share of pairs of stations on both sides of a door that share enough

/// A piece of a surface: its middle, its normal, its size.
struct Surface {
  Vector3d middle;
  Vector3d normal;
  double width_m = 0.0;
  double height_m = 0.0;
};

struct Room {
  int x = 0;
  int y = 0;
  int floor = 0;
  std::vector<Surface> own;  ///< the first six: walls, floor, ceiling; then things
};

class Office {
 public:
  Office(int stations, std::uint64_t seed) : seed_(seed) {
    const int rooms = (stations + kPerRoom - 1) / kPerRoom;
    const int per_floor = std::max(4, std::min(60, rooms));
    const int wide = std::max(2, static_cast<int>(std::lround(std::sqrt(1.5 * per_floor))));
    RandomStream random(seed, 0);
    for (int r = 0; r < rooms; ++r) {
      rooms_.push_back(furnished(r % per_floor % wide, r % per_floor / wide, r / per_floor, random));
      at_[{rooms_.back().x, rooms_.back().y, rooms_.back().floor}] = r;
    }
    for (int k = 0; k < stations; ++k) add_station(k % rooms, random);
  }

  [[nodiscard]] const std::vector<ProjectNode>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<Rigid3>& truth() const { return world_from_node_; }

  /// What registering the two would give.
  [[nodiscard]] TriedPair pair(std::size_t source, std::size_t target) const {
    TriedPair tried{source, target, {}, {}};
    if (!share(source, target)) return tried;
    const Rigid3 truth = inverse(world_from_node_[target]) * world_from_node_[source];
    RandomStream random(seed_ + 1, source * nodes_.size() + target);
    Vector6d error;
    for (Eigen::Index j = 0; j < 6; ++j) error[j] = (j < 3 ? kLinkRad : kLinkM) * random.normal();
    RegistrationResult& result = tried.result;
    result.outcome = Outcome::registered;
    Hypothesis& best = result.best;
    best.target_from_source = {rotation_exp(error.head<3>()) * truth.rotation,
                               truth.translation + error.tail<3>()};
    best.sigma.centre = truth.translation;
    best.sigma.rotation_rad.setConstant(kLinkRad);
    best.sigma.translation_m.setConstant(kLinkM);
    best.sigma.covariance.diagonal().head<3>().setConstant(kLinkRad * kLinkRad);
    best.sigma.covariance.diagonal().tail<3>().setConstant(kLinkM * kLinkM);
    best.probability = 1.0 - 1e-5;
    result.sigma = best.sigma;
    result.others = OtherExplanations{};
    for (const auto& [surface, plane] : plane_of_[source]) {
      const auto other = plane_of_[target].find(surface);
      if (other == plane_of_[target].end()) continue;
      const double area = nodes_[source].digest.planes[static_cast<std::size_t>(plane)].area_m2;
      result.matches.push_back({plane, other->second, 0.0, 0.0, area});
      best.agreeing_m2 += area;
    }
    best.score = best.agreeing_m2;
    return tried;
  }

  /// Whether two stations see enough of one another's surroundings.
  [[nodiscard]] bool share(std::size_t a, std::size_t b) const {
    const int i = room_of_[a];
    const int j = room_of_[b];
    if (i == j) return true;
    if (!joined(i, j)) return false;
    RandomStream random(seed_ + 2, std::max(a, b) * nodes_.size() + std::min(a, b));
    return random.uniform(0.0, 1.0) < kDoorSight;
  }

 private:
  Room furnished(int x, int y, int floor, RandomStream& random) const {
    Room room{x, y, floor, {}};
    const auto inset = [&] { return random.uniform(0.08, 0.45); };
    const double west = 6.0 * x + inset();
    const double east = 6.0 * (x + 1) - inset();
    const double south = 5.0 * y + inset();
    const double north = 5.0 * (y + 1) - inset();
    const double low = 3.5 * floor;
    const double high = low + random.uniform(2.7, 3.2);
    const Vector3d middle(0.5 * (west + east), 0.5 * (south + north), 0.5 * (low + high));
    const auto put = [&](const Vector3d& at, const Vector3d& normal, double width, double height) {
      room.own.push_back({at, normal, width, height});
    };
    const Vector3d ex = Vector3d::UnitX();
    const Vector3d ey = Vector3d::UnitY();
    const Vector3d ez = Vector3d::UnitZ();
    put({west, middle.y(), middle.z()}, ex, north - south, high - low);
    put({east, middle.y(), middle.z()}, -ex, north - south, high - low);
    put({middle.x(), south, middle.z()}, ey, east - west, high - low);
    put({middle.x(), north, middle.z()}, -ey, east - west, high - low);
    put({middle.x(), middle.y(), low}, ez, east - west, north - south);
    put({middle.x(), middle.y(), high}, -ez, east - west, north - south);
    for (int k = 0; k < 10; ++k) {
      const Vector3d at =
          uniform_vector(Vector3d(west, south, low + 0.3), Vector3d(east, north, low + 2.0), random);
      const Vector3d normals[] = {ex, ey, -ex, -ey, ez};
      const Vector2d size = uniform_vector(Vector2d(0.6, 0.6), Vector2d(2.0, 1.5), random);
      put(at, normals[k % 5], size.x(), size.y());
    }
    return room;
  }

  [[nodiscard]] bool joined(int i, int j) const {
    const Room& a = rooms_[static_cast<std::size_t>(i)];
    const Room& b = rooms_[static_cast<std::size_t>(j)];
    const int apart = std::abs(a.x - b.x) + std::abs(a.y - b.y);
    if (a.floor == b.floor) return apart == 1;
    return std::abs(a.floor - b.floor) == 1 && apart == 0 && (a.x + a.y) % 4 == 0;  // staircases
  }

  void add_station(int r, RandomStream& random) {
    const Room& room = rooms_[static_cast<std::size_t>(r)];
    Rigid3 pose;
    pose.rotation = rotation_exp({0.0, 0.0, random.uniform(-3.1, 3.1)});
    const Vector2d in = uniform_vector(Vector2d(1.5, 1.5), Vector2d(4.5, 3.5), random);
    pose.translation = Vector3d(6.0 * room.x + in.x(), 5.0 * room.y + in.y(), 3.5 * room.floor + 1.6);
    ProjectNode node;
    node.scan = node.file = nodes_.size();
    node.digest.upright = true;
    node.digest.stations = {Vector3d::Zero()};
    node.digest.noise_m = 0.002;
    std::map<std::pair<int, int>, int> planes;
    for (int s = 0; s < static_cast<int>(room.own.size()); ++s) see(r, s, 1.0, pose, planes, node, random);
    for (int other = 0; other < static_cast<int>(rooms_.size()); ++other) {
      if (!joined(r, other)) continue;
      // Through the door: strips of what lies beyond.
      for (const int s : {0, 1, 2, 3, 4, 5}) see(other, s, 0.25, pose, planes, node, random);
    }
    nodes_.push_back(std::move(node));
    plane_of_.push_back(std::move(planes));
    room_of_.push_back(r);
    world_from_node_.push_back(pose);
  }

  static void see(const Surface& surface, double share, const Rigid3& pose, ProjectNode& node,
                  RandomStream& random) {
    const Rigid3 node_from_world = inverse(pose);
    const Vector3d u = surface.normal.unitOrthogonal();
    const Vector3d v = surface.normal.cross(u);
    const double common = kCommonM * random.normal();
    PlaneDigest plane;
    plane.centroid = node_from_world * surface.middle;
    const double half = 0.5 * std::sqrt(surface.width_m * surface.height_m * share);
    constexpr int kTiles = 24;
    for (int k = 0; k < kTiles; ++k) {
      const double off = common + kTileM * random.normal();
      const Vector2d in = uniform_vector(Vector2d(-half, -half), Vector2d(half, half), random);
      const Vector3d point = surface.middle + in.x() * u + in.y() * v + off * surface.normal;
      plane.moments.add(node_from_world * point - plane.centroid);
    }
    plane.plane.normal = node_from_world.rotation * surface.normal;
    plane.plane.offset = plane.plane.normal.dot(plane.centroid);
    plane.area_m2 = surface.width_m * surface.height_m * share;
    plane.oriented = plane.interior = true;
    node.digest.planes.push_back(plane);
  }

  void see(int room, int s, double share, const Rigid3& pose, std::map<std::pair<int, int>, int>& planes,
           ProjectNode& node, RandomStream& random) const {
    planes[{room, s}] = static_cast<int>(node.digest.planes.size());
    see(rooms_[static_cast<std::size_t>(room)].own[static_cast<std::size_t>(s)], share, pose, node, random);
  }

  std::uint64_t seed_;
  std::vector<Room> rooms_;
  std::map<std::tuple<int, int, int>, int> at_;
  std::vector<ProjectNode> nodes_;
  std::vector<Rigid3> world_from_node_;
  std::vector<int> room_of_;
  std::vector<std::map<std::pair<int, int>, int>> plane_of_;
};

double megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void run(int stations, std::uint64_t seed, bool all_shared) {
  const Office office(stations, seed);
  double asked_s = 0.0;
  std::size_t sharing = 0;
  const auto answer = [&](const PairList& pairs) {
    const Clock clock;
    std::vector<TriedPair> tried;
    for (const auto& [source, target] : pairs) tried.push_back(office.pair(source, target));
    for (const TriedPair& pair : tried) sharing += pair.result.outcome == Outcome::registered ? 1 : 0;
    asked_s += clock.seconds();
    return tried;
  };
  const double before_mb = megabytes();
  const Clock choosing;
  std::vector<TriedPair> tried;
  if (all_shared) {
    PairList pairs;
    for (std::size_t i = 0; i < office.nodes().size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (office.share(i, j)) pairs.emplace_back(i, j);
      }
    }
    tried = answer(pairs);
  } else {
    tried = try_in_waves(office.nodes(), {}, 0.001, 12, answer);
  }
  const double choosing_s = choosing.seconds() - asked_s;
  ProjectResult result;
  for (std::size_t n = 0; n < office.nodes().size(); ++n) {
    ProjectScan scan;
    scan.file = fmt::format("station_{:04}", n);
    result.scans.push_back(scan);
  }
  const Clock solving;
  assemble(office.nodes(), tried, {}, {}, VerdictOptions{}, {}, result);
  const double solving_s = solving.seconds();
  int registered = 0;
  double worst = 0.0;
  const Rigid3 frame = office.truth()[static_cast<std::size_t>(std::max(0, result.frame_scan))];
  for (std::size_t n = 0; n < result.scans.size(); ++n) {
    const ProjectScan& scan = result.scans[n];
    if (scan.state != NodeState::registered || !scan.frame_from_scan) continue;
    ++registered;
    const Vector3d truth = inverse(frame) * office.truth()[n].translation;
    worst = std::max(worst, (scan.frame_from_scan->translation - truth).norm());
  }
  const double scans = stations;
  fmt::print("{:6} {:10.2f} {:10.2f} {:12.2f} {:10.2f} {:10.2f} {:10.2f} {:8.0f} {:8.0f} {:12} {:9.1f}\n",
             stations, static_cast<double>(tried.size()) / scans, static_cast<double>(sharing) / scans,
             choosing_s, solving_s, 1e3 * choosing_s / scans, 1e3 * solving_s / scans, before_mb, megabytes(),
             registered, 1e3 * worst);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> stations{100, 300, 1000};
  std::uint64_t seed = 1;
  int threads = 0;
  bool all_shared = false;
  CLI::App app{"Choosing the pairs of many stations, and solving them, from simulated features"};
  app.add_option("--stations", stations, "How many; each in turn");
  app.add_option("--seed", seed, "Of the building");
  app.add_option("--threads", threads, "0: of the machine");
  app.add_flag("--all-shared", all_shared, "Every pair that shares enough is tried, and no other");
  CLI11_PARSE(app, argc, argv);
  set_thread_count(threads);
  fmt::print("{:>6} {:>10} {:>10} {:>12} {:>10} {:>10} {:>10} {:>8} {:>8} {:>12} {:>9}\n", "scans",
             "pairs/scan", "sharing", "choosing s", "solving s", "ms/scan", "ms/scan", "MB then", "MB",
             "registered", "worst mm");
  for (const int count : stations) run(count, seed, all_shared);
  return 0;
}
