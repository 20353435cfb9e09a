// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/model/bim_model.h"
#include "limen/model/scan.h"

namespace limen {

/// Throws Error where points cannot be a scan of a building or a street in metres: nearly all of them
/// together are smaller than a hand, larger than a country, or as high and deep as they are wide over more
/// than a kilometre (a room in millimetres). Points far from the others, up to one in a hundred at either end
/// of an axis, do not count. Empty scans pass.
void require_plausible_size(const Scan& scan);

/// Whether require_plausible_size() lets a scan pass.
bool has_plausible_size(const Scan& scan);

/// A sentence with a question and an option where a scan is far larger or smaller than a building, though not
/// beyond belief: "measures 312 x 240 x 114 m: were its numbers inches ...". Empty where there is nothing to
/// ask.
std::string size_hint(const Scan& scan);

/// A sentence where a mesh looks as if its y axis pointed up: its floors and ceilings face y, which is its
/// least extent. Empty where there is nothing to ask; an IFC file says where up is.
std::string axes_hint(const BimModel& model);

/// Throws Error where a model cannot be a building in metres: it is smaller than a chair, or has so much
/// surface that no computer of today could look at every hand's breadth of it, or such long outlines of
/// faces. Bounds what is made of a model's surface and edges: visible_surface() asks first.
void require_plausible_size(const BimModel& model);

}  // namespace limen
