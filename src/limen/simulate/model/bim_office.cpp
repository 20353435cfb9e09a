// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "limen/simulate/model/bim_recipe.h"

namespace limen {
namespace {

constexpr double kLength = 24.0;  // m, along x, outside
constexpr double kWidth = 13.0;
constexpr double kOuter = 0.36;  // thickness of walls
constexpr double kInner = 0.12;
constexpr double kClear = 3.1;  // height of rooms
constexpr double kSlab = 0.3;
constexpr double kSouth = 5.5;  // the corridor's walls: y of the sides that look away from it
constexpr double kNorth = 7.5;
constexpr double kOffice = 3.6;  // width of an office

/// A rectangle on the ground, or in the frame of a wall.
struct Plot {
  double x0, y0, x1, y1;
  [[nodiscard]] Polygon polygon() const { return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}; }
};

/// A hole in a wall: place of its middle along the wall's line, and its size.
struct Hole {
  double at;
  double width;
  double height;
  double sill;
};

/// Puts the building together, storey by storey.
class OfficeBuilder {
 public:
  BimRecipe run() && {
    recipe_.name = "office";
    recipe_.storeys = {{"Ground floor", 0.0}, {"Upper floor", kClear + kSlab}};
    add_slab("Base slab", 0, -kSlab, BimKind::slab);
    for (storey_ = 0; storey_ < 2; ++storey_) {
      base_ = recipe_.storeys[static_cast<std::size_t>(storey_)].elevation_m;
      add_outer_walls();
      add_corridor();
      storey_ == 0 ? add_ground_rooms() : add_upper_rooms();
    }
    const int floor = add_slab("Intermediate slab", 1, kClear, BimKind::slab);
    recipe_.openings.push_back({floor, -1, {level(kClear), Plot{11.7, 7.98, 12.9, 11.6}.polygon(), kSlab}});
    add_slab("Roof slab", 1, 2.0 * kClear + kSlab, BimKind::roof);
    add_stairs();
    return std::move(recipe_);
  }

 private:
  static PlaneFrame level(double z) { return {{0.0, 0.0, z}, Vector3d::UnitX(), Vector3d::UnitY()}; }

  int add(BimKind kind, const std::string& type, const std::string& name, std::vector<BimPrism> solids) {
    recipe_.elements.push_back({kind, type, name, storey_, std::move(solids)});
    return static_cast<int>(recipe_.elements.size()) - 1;
  }

  int add_slab(const std::string& name, int storey, double z, BimKind kind) {
    storey_ = storey;
    return add(kind, "IfcSlab", name, {{level(z), Plot{0.0, 0.0, kLength, kWidth}.polygon(), kSlab}});
  }

  /// A wall on the left of the line a -> b; holes are seen from its right.
  void add_wall(const std::string& name, const Vector2d& a, const Vector2d& b, double thickness,
                const std::vector<Hole>& holes = {}) {
    const Vector2d along = (b - a).normalized();
    const Vector2d left(-along.y(), along.x());
    const Polygon plan{{a, b, b + thickness * left, a + thickness * left}, {}};
    const int wall = add(BimKind::wall, "IfcWall", name, {{level(base_), plan, kClear}});
    for (const Hole& hole : holes) {
      // From inside the wall's u is to the left of who looks at it: against a -> b.
      const Vector2d corner = a + (hole.at + 0.5 * hole.width) * along;
      const PlaneFrame face{{corner.x(), corner.y(), base_ + hole.sill},
                            Vector3d(-along.x(), -along.y(), 0.0),
                            Vector3d::UnitZ()};
      const Polygon outline = Plot{0.0, 0.0, hole.width, hole.height}.polygon();
      const int filling = hole.sill > 0.0 ? add_window(face, hole) : add_door(face, hole, thickness);
      recipe_.openings.push_back({wall, filling, {face, outline, thickness}});
    }
  }

  static PlaneFrame deeper(const PlaneFrame& face, double depth) {
    return {face.origin + depth * face.u.cross(face.v), face.u, face.v};
  }

  /// A frame with one pane, or with two and a mullion.
  int add_window(const PlaneFrame& face, const Hole& hole) {
    constexpr double kBar = 0.07;
    constexpr double kDepth = 0.08;
    constexpr double kPane = 0.024;
    const int panes = hole.width > 1.5 ? 2 : 1;
    const double clear = (hole.width - (panes + 1) * kBar) / panes;
    Polygon frame = Plot{0.0, 0.0, hole.width, hole.height}.polygon();
    std::vector<BimPrism> solids(1);
    for (int i = 0; i < panes; ++i) {
      const double u = kBar + i * (clear + kBar);
      const double top = hole.height - kBar;
      frame.holes.push_back({{u, kBar}, {u, top}, {u + clear, top}, {u + clear, kBar}});
      solids.push_back(
          {deeper(face, 0.12 + 0.5 * (kDepth - kPane)), Plot{u, kBar, u + clear, top}.polygon(), kPane});
    }
    solids[0] = {deeper(face, 0.12), frame, kDepth};
    return add(BimKind::window, "IfcWindow", "Window " + std::to_string(++windows_), std::move(solids));
  }

  /// A lining on three sides and a leaf.
  int add_door(const PlaneFrame& face, const Hole& hole, double thickness) {
    constexpr double kLining = 0.05;
    const double w = hole.width;
    const double h = hole.height;
    const double l = kLining;
    const Polygon lining{
        {{0.0, 0.0}, {l, 0.0}, {l, h - l}, {w - l, h - l}, {w - l, 0.0}, {w, 0.0}, {w, h}, {0.0, h}}, {}};
    const Polygon leaf = Plot{l, 0.0, w - l, h - l}.polygon();
    const double depth = std::min(0.1, thickness);
    const double start = 0.5 * (thickness - depth);
    return add(BimKind::door, "IfcDoor", "Door " + std::to_string(++doors_),
               {{deeper(face, start), lining, depth}, {deeper(face, start + 0.03), leaf, 0.04}});
  }

  void add_outer_walls() {
    // Offices have one window each; the long windows belong to the rooms that are unique.
    std::vector<Hole> south;
    for (int i = 0; i < 4; ++i) south.push_back({office_x(i) + 0.5 * kOffice, 1.8, 1.4, 0.9});
    std::vector<Hole> north;
    if (storey_ == 0) {
      for (const double x : {17.2, 21.4}) south.push_back({x, 2.4, 1.7, 0.6});
      for (const double x : {14.92, 18.64}) north.push_back({kLength - x, 1.8, 1.4, 0.9});
      north.push_back({kLength - 2.0, 1.8, 2.3, 0.0});
      for (const double x : {4.6, 7.2}) north.push_back({kLength - x, 1.6, 2.0, 0.4});
    } else {
      for (const double x : {17.28, 21.54}) south.push_back({x, 1.8, 1.4, 0.9});
      for (const double x : {15.0, 18.3, 21.6}) north.push_back({kLength - x, 2.0, 1.4, 0.9});
      for (const double x : {2.5, 6.8}) north.push_back({kLength - x, 2.4, 1.6, 0.7});
    }
    north.push_back({kLength - 10.4, 1.0, 1.6, 0.9});
    add_wall("South wall", {0.0, 0.0}, {kLength, 0.0}, kOuter, south);
    add_wall("North wall", {kLength, kWidth}, {0.0, kWidth}, kOuter, north);
    const double corridor = 0.5 * (kSouth + kNorth);
    add_wall("East wall", {kLength, kOuter}, {kLength, kWidth - kOuter}, kOuter,
             {{corridor - kOuter, 1.0, 2.0, 0.4}});
    add_wall("West wall", {0.0, kWidth - kOuter}, {0.0, kOuter}, kOuter,
             {{kWidth - kOuter - corridor, 1.0, 2.0, 0.4}});
  }

  static double office_x(int i) { return kOuter + i * (kOffice + kInner); }

  void add_corridor() {
    const double x0 = kOuter;
    const double x1 = kLength - kOuter;
    // Lines run such that the corridor is on their right.
    std::vector<Hole> south;
    for (int i = 0; i < 4; ++i) south.push_back({x1 - office_x(i) - 0.7, 0.9, 2.1, 0.0});
    south.push_back({x1 - 16.4, storey_ == 0 ? 1.3 : 0.9, 2.1, 0.0});
    if (storey_ == 1) south.push_back({x1 - 20.6, 0.9, 2.1, 0.0});
    std::vector<Hole> north;
    north.push_back({(storey_ == 0 ? 2.6 : 7.4) - x0, storey_ == 0 ? 1.8 : 0.9, 2.1, 0.0});
    north.push_back({10.1 - x0, 1.0, 2.1, 0.0});
    if (storey_ == 0) {
      for (const double x : {16.02, 19.74, 21.2}) north.push_back({x - x0, 0.9, 2.1, 0.0});
    } else {
      for (const double x : {14.2, 22.4}) north.push_back({x - x0, 0.9, 2.1, 0.0});
    }
    add_wall("Corridor wall south", {x1, kSouth + kInner}, {x0, kSouth + kInner}, kInner, south);
    add_wall("Corridor wall north", {x0, kNorth - kInner}, {x1, kNorth - kInner}, kInner, north);
    add_space("Corridor", {x0, kSouth + kInner, x1, kNorth - kInner});
  }

  void add_space(const std::string& name, const Plot& plot) {
    const int number = (storey_ + 1) * 100 + ++numbers_[static_cast<std::size_t>(storey_)];
    recipe_.spaces.push_back({std::to_string(number), name, storey_, {level(base_), plot.polygon(), kClear}});
  }

  /// Rooms side by side between the corridor and an outer wall: `ends` are where each ends along x.
  void add_row(bool south, double from, const std::vector<std::pair<std::string, double>>& ends) {
    const double y0 = south ? kOuter : kNorth;
    const double y1 = south ? kSouth : kWidth - kOuter;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const double to = ends[i].second;
      add_space(ends[i].first, {from, y0, to, y1});
      if (i + 1 == ends.size()) break;
      add_wall("Partition " + std::to_string(++partitions_), {to + kInner, y0}, {to + kInner, y1}, kInner);
      from = to + kInner;
    }
  }

  static std::vector<std::pair<std::string, double>> four_offices() {
    std::vector<std::pair<std::string, double>> row;
    for (int i = 0; i < 4; ++i) row.emplace_back("Office", office_x(i) + kOffice);
    return row;
  }

  void add_ground_rooms() {
    const double end = kLength - kOuter;
    auto south = four_offices();
    south.emplace_back("Meeting room", end);
    add_row(true, kOuter, south);
    add_row(false, kOuter,
            {{"Hall", 9.0},
             {"Stairs", 13.0},
             {"Office", 13.12 + kOffice},
             {"Office", 16.84 + kOffice},
             {"Store", end}});
    for (const double x : {3.4, 6.4})
      add(BimKind::column, "IfcColumn", "Column",
          {{level(base_), Plot{x, 9.6, x + 0.3, 9.9}.polygon(), kClear}});
  }

  void add_upper_rooms() {
    const double end = kLength - kOuter;
    auto south = four_offices();
    south.emplace_back("Studio", 19.32);
    south.emplace_back("Studio", end);
    add_row(true, kOuter, south);
    add_row(false, kOuter, {{"Lounge", 9.0}, {"Stairs", 13.0}, {"Open office", end}});
  }

  /// One straight flight along the stairwell's east wall, going up to the south.
  void add_stairs() {
    constexpr int kSteps = 17;
    constexpr double kTread = 0.26;
    const double riser = (kClear + kSlab) / kSteps;
    Ring profile;
    profile.emplace_back(0.0, 0.0);
    profile.emplace_back(0.4, 0.0);
    profile.emplace_back(kSteps * kTread, kSteps * riser - 0.35);
    for (int i = kSteps; i > 0; --i) {
      profile.emplace_back(i * kTread, i * riser);
      profile.emplace_back((i - 1) * kTread, i * riser);
    }
    storey_ = 0;
    const PlaneFrame side{{12.9, 12.4, 0.0}, -Vector3d::UnitY(), Vector3d::UnitZ()};
    add(BimKind::stair, "IfcStairFlight", "Flight", {{side, {profile, {}}, 1.2}});
  }

  BimRecipe recipe_;
  int storey_ = 0;
  double base_ = 0.0;
  int windows_ = 0;
  int doors_ = 0;
  int partitions_ = 0;
  std::vector<int> numbers_ = {0, 0};
};

}  // namespace

BimRecipe office_recipe() {
  return OfficeBuilder().run();
}

}  // namespace limen
