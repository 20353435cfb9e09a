// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/model/bim_model.h"
#include "limen/report/json/json_values.h"

namespace limen {

/// Three numbers, to the millimetre.
std::string point_text(const Json& point);

/// What `limen info` tells of a model: schema, units, extent, elements by kind, storeys, openings, rooms,
/// warnings.
Json json_of_model(const std::string& path, const BimModel& model);

/// The same for a reader.
std::string text_of_model(const Json& model);

}  // namespace limen
