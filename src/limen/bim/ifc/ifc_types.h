// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "limen/model/bim_model.h"

namespace limen {

/// What an element of an IFC type ("IfcWallStandardCase", any case) is; `predefined` as the file has it
/// ("ROOF") or empty.
BimKind kind_of_ifc_type(const std::string& type, const std::string& predefined = {});

/// "IfcWallStandardCase" for "IFCWALLSTANDARDCASE": the types of building elements that a model may hold.
/// Empty for all other types.
std::string element_type_named(std::string_view upper_case);

}  // namespace limen
