// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "limen/base/progress.h"
#include "limen/bim/build/bim_builder.h"
#include "limen/bim/ifc/ifc_structure.h"

namespace limen {

/// Whether the bytes begin a STEP file, which is what an IFC file is.
bool looks_like_step(std::string_view bytes);
/// Whether the bytes are a zip archive that holds an IFC file.
bool looks_like_ifczip(std::string_view bytes);

/// Reads an IFC file (IFC2X3, IFC4). What it tells in words is read from its text (ifc_structure.h); shapes
/// are made by limen_ifc in a process of its own. Where that dies of one entity, it is run again without it,
/// and a warning names the entity. `name` is for messages. Throws Error where the schema is another one,
/// where limen_ifc is missing, and where the file cannot be read at all.
RawModel read_ifc(std::string_view bytes, const std::string& name, Monitor& monitor = silent_monitor());

/// The same of the IFC file in a zip archive (.ifczip).
RawModel read_ifczip(std::string_view bytes, const std::string& name, Monitor& monitor = silent_monitor());

/// How a map is made of the coordinates of an IFC file, in a zip archive or not; empty where it is not, or
/// the bytes are no IFC file's.
std::optional<MapConversion> map_of_ifc(std::string_view bytes, const std::string& name);

}  // namespace limen
