// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/simulate/model/bim_recipe.h"

namespace limen {

/// The built-in model: two storeys of 24 x 13 m with a corridor, rows of equal offices on both floors, a
/// meeting room and a hall with columns that are unique, a stairwell, windows and doors.
BimRecipe office_recipe();

}  // namespace limen
