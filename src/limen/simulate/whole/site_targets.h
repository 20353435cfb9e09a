// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/whole/project_truth.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {

inline constexpr double kSphereRadiusM = 0.0725;
inline constexpr double kBoardSideM = 0.3;

/// A board of two dark and two bright quadrants, seen from the side of `frame`'s normal u x v.
void add_board(Mesh& mesh, const PlaneFrame& frame, double side_m = kBoardSideM);
/// A white sphere.
void add_sphere(Mesh& mesh, const Vector3d& centre, double radius_m = kSphereRadiusM);

/// The same on a pole.
void add_sphere_on_pole(Mesh& mesh, const Vector3d& centre, double floor_m);
/// Whether a sphere has room there: 25 cm to all that is in the way of light, 80 cm to other targets.
bool has_room_for_sphere(const RayCaster& caster, const Vector3d& centre,
                         const std::vector<SiteTarget>& others);

/// Puts up to `count` targets in each room with a station, where there is place: spheres on poles and boards
/// on walls by turns. Returns their centres in the building's frame.
std::vector<SiteTarget> put_up_targets(WholeBuilding& building, std::size_t count, std::uint64_t seed);

}  // namespace limen
