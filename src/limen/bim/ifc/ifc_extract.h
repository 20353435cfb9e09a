// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "limen/bim/ifc/ifc4x3.h"
#include "limen/bim/ifc/step_file.h"

namespace limen {

/// The part of an IFC file that its shapes need, as a STEP file of its own: the project with its units, the
/// products that have shapes, and all that these refer to. No relations, properties and styles; comments,
/// damaged statements and texts beyond ASCII are gone. Quicker to read, and less that can be wrong.
/// `newer`: of an IFC4X3 file, which becomes IFC4.
std::string text_of_shapes(const StepFile& file, const std::optional<Ifc4x3>& newer = {});

/// Whether an entity is a product with a shape: IfcProduct.Representation is the seventh argument of every
/// one.
bool has_ifc_shape(const StepFile& file, const StepEntity& entity);

}  // namespace limen
