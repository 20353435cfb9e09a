// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/html/html_view.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// The script elements that hold a scene for the page's own script: numbers and names as JSON, points and
/// faces as base64.
std::string scene_elements(const RegistrationReport& report, const ReportScene& scene, const SceneView& view);

}  // namespace limen
