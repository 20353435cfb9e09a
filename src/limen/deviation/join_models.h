// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/model/bim_model.h"

namespace limen {

/// A model of a building, and how it comes into the coordinates of the first one.
struct PlacedModel {
  BimModel model;
  Rigid3 first_from_model;  ///< world to world; of the first: the identity
};

/// Several models of one building as one.
struct JoinedModel {
  BimModel model;                              ///< elements and faces, about the first one's local origin
  std::vector<std::int32_t> model_of_element;  ///< which of them an element is from
  std::size_t doubled = 0;                     ///< elements left out: an earlier model has their GUID
};

/// Puts the elements of all of them in one, model after model. An element whose GUID an earlier one has with
/// faces is the same element: the later one is left out. Rooms and openings are left out.
JoinedModel join_models(const std::vector<PlacedModel>& models);

}  // namespace limen
