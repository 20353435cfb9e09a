// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/model/bim_model.h"
#include "limen/model/scan.h"

namespace limen {

/// Throws Error where points cannot be a scan of a building or a street in metres: nearly all of them
/// together are smaller than a hand, larger than a country, or as high and deep as they are wide over more
/// than a kilometre (a room in millimetres), or x and y are degrees. Points far from the others, up to one in
/// a hundred at either end of an axis, do not count. Empty scans pass. `units_option`: by which the user of
/// the running command names a unit; empty: there is none.
void require_plausible_size(const Scan& scan, const std::string& units_option = {});

/// Whether require_plausible_size() lets a scan pass.
bool has_plausible_size(const Scan& scan);

/// Whether a scan of a building, a room or a street may have these sides in metres: the least is the height
/// of a step to that of a church, the longest less than two kilometres.
bool is_size_of_building(const Vector3d& sides_m);

/// A sentence with a question and an option where a scan is far larger or smaller than a building, though not
/// beyond belief: "measures 312 x 240 x 114 m: were its numbers inches ...". Empty where there is nothing to
/// ask. `units_option` as above.
std::string size_hint(const Scan& scan, const std::string& units_option = {});

/// A sentence where a scan has too few points for three planes; empty where it has enough.
std::string few_points_hint(const Scan& scan);

/// To what the coordinates are rounded, metres: by a few decimals, or by single precision far from 0, where
/// export programs lose millimetres; the coarsest axis. 0 where a scanner's noise is more.
double coordinate_step_m(const Scan& scan);
/// A sentence where that is by single precision; empty where not: few decimals may be meant.
std::string rounding_hint(const Scan& scan);

/// A sentence where x and y look like degrees beside heights in metres; empty where they do not.
std::string degrees_hint(const Scan& scan);

/// All of these that a scan gives reason for.
std::vector<std::string> hints_about(const Scan& scan, const std::string& units_option = {});

/// A sentence where a mesh looks as if its y axis pointed up: its floors and ceilings face y, which is its
/// least extent. Empty where there is nothing to ask; an IFC file says where up is.
std::string axes_hint(const BimModel& model);

/// A sentence where what points up in a scan is its y axis; empty where it is another.
std::string up_hint(const Vector3d& up_in_scan);

/// Throws Error where a model cannot be a building in metres: it is smaller than a chair, or has so much
/// surface that no computer of today could look at every hand's breadth of it, or such long outlines of
/// faces. Bounds what is made of a model's surface and edges: visible_surface() asks first.
void require_plausible_size(const BimModel& model, const std::string& units_option = {});

}  // namespace limen
