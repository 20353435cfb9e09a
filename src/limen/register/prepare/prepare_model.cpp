// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/prepare_model.h"

#include "limen/base/error.h"
#include "limen/sight/model_space.h"

namespace limen {

PreparedScan prepare_model(const BimModel& model, const ModelFeatureOptions& options, Monitor& monitor) {
  PreparedScan prepared;
  prepared.extracted.features = model_features(model, options).features;
  monitor.throw_if_cancelled();
  if (prepared.extracted.features.planes.empty()) {
    throw Error("the model has no walls, slabs or other built surface", model.name,
                "give a model with geometry; `limen info` lists what it has");
  }
  prepared.space = std::make_unique<ModelSpace>(prepared.extracted.features);
  prepared.upright = true;
  prepared.model = true;
  prepared.rooms = model.spaces;
  prepared.settle_reach();
  return prepared;
}

}  // namespace limen
