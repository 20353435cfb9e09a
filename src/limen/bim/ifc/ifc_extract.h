// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/bim/ifc/step_file.h"

namespace limen {

/// The part of an IFC file that its shapes need, as a STEP file of its own: the project with its units, the
/// products that have shapes, and all that these refer to. No relations, properties and styles; comments,
/// damaged statements and texts beyond ASCII are gone. Quicker to read, and less that can be wrong.
std::string text_of_shapes(const StepFile& file);

}  // namespace limen
