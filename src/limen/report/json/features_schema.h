// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limen {

/// JSON Schemas (draft 2020-12) of what features_json, openings_json and segments_json write.
std::string planes_schema();
std::string openings_schema();
std::string segments_schema();

}  // namespace limen
