// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "limen/bim/build/bim_builder.h"

namespace limen {

/// Whether the bytes begin a PLY file with faces.
bool looks_like_mesh_ply(std::string_view bytes);

/// Reads the faces of a PLY file as one element "mesh"; coordinates are metres, z up, an offset in a comment
/// (see parse_ply_header) is added. `name` is for messages. Throws Error where the file is damaged.
RawModel read_mesh_ply(std::string_view bytes, const std::string& name);

/// Whether the text is an OBJ file: its lines begin with OBJ's words and there is a vertex.
bool looks_like_obj(std::string_view bytes);

/// Reads the faces of a Wavefront OBJ file: polygons over v, negative indices, o and g as elements (one
/// "mesh" where there are none). Coordinates are taken as metres, z up; normals, textures, lines and points
/// are passed over. `name` is for messages. Throws Error with the line where a vertex or an index is wrong.
RawModel read_obj(std::string_view bytes, const std::string& name);

}  // namespace limen
