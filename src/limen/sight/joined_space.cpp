// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/joined_space.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limen {
namespace {

/// Which of two answers stays.
int rank_of(SightKind kind) {
  switch (kind) {
    case SightKind::surface:
      return 3;
    case SightKind::free:
      return 2;
    case SightKind::hidden:
      return 1;
    case SightKind::unseen:
      break;
  }
  return 0;
}

bool stands_before(const Sight& a, const Sight& b) {
  if (a.kind == SightKind::surface && b.kind == SightKind::surface)
    return std::abs(a.distance_m) < std::abs(b.distance_m);
  return rank_of(a.kind) > rank_of(b.kind);
}

}  // namespace

JoinedSpace::JoinedSpace(std::vector<Member> members) : members_(std::move(members)) {}

Sight JoinedSpace::look(const SightQuery& query) const {
  Sight best;
  for (const Member& member : members_) {
    Sight sight = member.view->look(query);
    if (!stands_before(sight, best)) continue;
    if (sight.plane >= 0) sight.plane = member.joint_plane[static_cast<std::size_t>(sight.plane)];
    best = sight;
  }
  return best;
}

void JoinedSpace::look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                                  const Rigid3& view_from_scan, const LookTolerances& tolerances,
                                  Looks& looks) const {
  const auto sight_of = [](const Looks& all, std::size_t k) {
    return Sight{static_cast<SightKind>(all.kind[k]), -1, static_cast<double>(all.distance_m[k])};
  };
  std::fill_n(looks.kind.begin(), size, static_cast<std::int32_t>(SightKind::unseen));
  std::fill_n(looks.plane.begin(), size, -1);
  std::fill_n(looks.distance_m.begin(), size, 0.0F);
  Looks of_member;
  for (const Member& member : members_) {
    member.view->look_at_surface(asked, begin, size, view_from_scan, tolerances, of_member);
    for (std::size_t k = 0; k < size; ++k) {
      if (!stands_before(sight_of(of_member, k), sight_of(looks, k))) continue;
      looks.kind[k] = of_member.kind[k];
      const std::int32_t plane = of_member.plane[k];
      looks.plane[k] = plane < 0 ? -1 : member.joint_plane[static_cast<std::size_t>(plane)];
      looks.distance_m[k] = of_member.distance_m[k];
    }
  }
}

}  // namespace limen
