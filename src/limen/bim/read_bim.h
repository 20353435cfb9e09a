// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "limen/base/progress.h"
#include "limen/model/bim_model.h"

namespace limen {

/// Whether the file's content is that of a model: IFC (STEP text), a zip archive with one, OBJ, or a PLY file
/// with faces. False for everything else, also for files that cannot be opened.
bool is_bim_file(const std::filesystem::path& path);

/// Reads a model of any format that limen knows, chosen by content. Throws Error where it cannot be read;
/// what is damaged or left out of a model that can be read in part is in BimModel::warnings.
/// `metres_per_unit`: of a mesh, which says nothing of its unit; empty: 1. An IFC file tells its own, and
/// another one is refused.
BimModel read_bim(const std::filesystem::path& path, Monitor& monitor = silent_monitor(),
                  std::optional<double> metres_per_unit = {});

}  // namespace limen
