// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/bim_model.h"
#include "limen/model/features.h"
#include "limen/project/store/byte_stream.h"

namespace limen {

/// Features as bytes and back, bit for bit.
void put_features(ByteWriter& writer, const Features& features);
Features get_features(ByteReader& reader);

/// Rooms of a model, likewise.
void put_rooms(ByteWriter& writer, const std::vector<BimSpace>& rooms);
std::vector<BimSpace> get_rooms(ByteReader& reader);

}  // namespace limen
