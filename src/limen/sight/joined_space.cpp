// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/joined_space.h"

#include <cmath>
#include <utility>

namespace limen {
namespace {

/// Which of two answers stands.
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

void JoinedSpace::fetch(std::span<const SightQuery> queries) const {
  for (const Member& member : members_) member.view->fetch(queries);
}

Sight JoinedSpace::look(const SightQuery& query) const {
  Sight best;
  best.kind = SightKind::unseen;
  for (const Member& member : members_) {
    Sight sight = member.view->look(query);
    if (!stands_before(sight, best)) continue;
    if (sight.plane >= 0) sight.plane = member.joint_plane[static_cast<std::size_t>(sight.plane)];
    best = sight;
  }
  return best;
}

}  // namespace limen
