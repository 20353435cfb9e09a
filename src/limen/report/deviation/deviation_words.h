// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/deviation/deviation.h"
#include "limen/report/json/json_values.h"

namespace limen {

/// What the files of a scan's and of a building's deviation have in common.
Json shift_json(const ElementShift& shift);
Json element_json(const ElementDeviation& it, const BimElement& element);
Json unmodelled_json(const UnmodelledObject& piece, const Vector3d& local_origin);
/// Elements by presence, and those found by their class.
Json presence_json(const std::vector<ElementDeviation>& elements);
Json found_by_loa_json(const std::vector<ElementDeviation>& elements);

}  // namespace limen
