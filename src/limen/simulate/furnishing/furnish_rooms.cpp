// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/furnishing/furnish_rooms.h"

#include <map>
#include <utility>

namespace limen {
namespace {

LayoutOptions random_options(const FurnishingStyle& style, RoomUse use, RandomStream& random) {
  LayoutOptions options;
  options.hide_share = random.uniform(style.least_hidden, style.most_hidden);
  options.free_per_m2 = random.uniform(0.02, 0.12);
  options.pictures_per_m2 = random.uniform(0.0, 0.2);
  options.small_per_m2 = style.small_per_m2 * random.uniform(0.3, 1.7);
  // Passages are kept passable.
  if (use != RoomUse::corridor) return options;
  options.hide_share *= 0.4;
  options.free_per_m2 = 0.0;
  options.small_per_m2 *= 0.5;
  return options;
}

/// What rooms of one design have in common.
struct Shared {
  bool alike = false;
  Layout layout;
};

Layout of_kind(const Layout& layout, bool small) {
  Layout result;
  for (const PlacedPiece& placed : layout)
    if ((placed.piece.kind == PieceKind::small_object) == small) result.push_back(placed);
  return result;
}

Layout another_day(const Layout& layout, const World& world, std::size_t building, std::size_t room,
                   const FurnishingStyle& style, std::uint64_t own) {
  const PlacingOptions placing{.shift_m = 0.01,
                               .turn_rad = 0.01,
                               .moved_share = style.moved_share,
                               .removed_share = style.removed_share,
                               .pushed_share = style.pushed_share,
                               .contents_share = style.contents_share};
  return as_placed(of_kind(layout, false), world, building, room, placing, mix64(own + style.day));
}

/// Bags and bottles on the floor, a picture or two.
Layout lying_about(const World& world, std::size_t building, std::size_t room, const FurnishingStyle& style,
                   std::uint64_t own) {
  const LayoutOptions small{
      .hide_share = 0.0, .free_per_m2 = 0.0, .pictures_per_m2 = 0.02, .small_per_m2 = style.small_per_m2};
  return make_layout(world, building, room, small, mix64(own + 17 * style.day + 1));
}

}  // namespace

std::vector<bool> furnish_rooms(World& world, std::size_t building, const FurnishingStyle& style,
                                std::uint64_t seed) {
  std::map<int, Shared> designs;
  std::vector<bool> alike;
  for (std::size_t room = 0; room < world.buildings[building].plan.rooms.size(); ++room) {
    const int design = world.buildings[building].plan.rooms[room].design;
    const RoomUse use = world.buildings[building].plan.rooms[room].use;
    const std::uint64_t own = mix64(seed * 7919 + room);
    const std::uint64_t common =
        design >= 0 ? mix64(seed * 104729 + static_cast<std::uint64_t>(design)) : own;
    Layout fixtures = make_fixtures(world, building, room, common);
    if (world.as_built_seed) fixtures = as_put_up(std::move(fixtures), style.fixtures_m, own);
    add_layout(world, building, room, fixtures);
    RandomStream random(own, 20);
    if (design >= 0 && designs.find(design) == designs.end()) {
      RandomStream choice(common, 21);
      Shared& shared = designs[design];
      shared.alike = choice.uniform() < style.alike_share;
      if (shared.alike)
        shared.layout = make_layout(world, building, room, random_options(style, use, choice), common);
    }
    alike.push_back(design >= 0 && designs[design].alike);
    Layout layout = alike.back()
                        ? of_kind(designs[design].layout, false)
                        : make_layout(world, building, room, random_options(style, use, random), own);
    // People put the same furniture at the same places as well as they can; what lies about is their own.
    if (alike.back()) {
      const PlacingOptions placing{.shift_m = style.shift_m, .turn_rad = style.turn_rad};
      layout = as_placed(layout, world, building, room, placing, own);
    }
    if (style.day > 0) layout = another_day(layout, world, building, room, style, own);
    add_layout(world, building, room, layout);
    if (alike.back() || style.day > 0)
      add_layout(world, building, room, lying_about(world, building, room, style, own));
  }
  return alike;
}

}  // namespace limen
