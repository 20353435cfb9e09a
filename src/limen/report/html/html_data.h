// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_view.h"
#include "limen/report/html/language.h"
#include "limen/report/json/json_values.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// Corners of outlines that a page has room for, per side.
inline constexpr std::size_t kMostCorners = 30000;

/// One side as the page's script reads it, and the elements with its points; `planes`: as plane_of_points.
Json side_json(const std::string& name, const SceneSide& side, const QuantisedPoints& points,
               std::size_t most_corners = kMostCorners);
std::string side_blobs(const std::string& name, const SceneSide& side, const QuantisedPoints& points,
                       const std::vector<std::uint8_t>& planes);
/// The points of a side, else the corners of its faces.
QuantisedPoints quantised_side(const SceneSide& side);

/// The script elements that hold a scene for the page's own script: numbers and names as JSON, points and
/// faces as base64. The poses' tables and probabilities are in the language.
std::string scene_elements(const RegistrationReport& report, const ReportScene& scene, const SceneView& view,
                           Language language);

}  // namespace limen
