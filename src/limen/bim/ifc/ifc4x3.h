// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>

#include "limen/bim/ifc/step_file.h"

namespace limen {

/// Reads the part of an IFC4X3 file that its buildings share with IFC4. Of the entities of shapes most are
/// the same in both; a few have their arguments otherwise, and are rewritten. An element becomes a proxy,
/// since its type is read elsewhere. A product whose place or shape needs an entity that is not known to be
/// the same is left out.
class Ifc4x3 {
 public:
  /// `file` must outlive the object.
  explicit Ifc4x3(const StepFile& file);
  /// Whether a schema is a published one of IFC4X3.
  static bool is_schema(std::string_view schema);

  [[nodiscard]] bool left_out(std::int64_t product) const { return products_.count(product) > 0; }
  /// Types of entities for which products are left out, upper case.
  [[nodiscard]] const std::set<std::string>& types_left_out() const { return types_; }
  /// An entity in IFC4: its type and arguments with the brackets.
  [[nodiscard]] static std::string in_ifc4(const StepEntity& entity);

 private:
  std::unordered_set<std::int64_t> products_;
  std::set<std::string> types_;
};

/// The part of an IFC file that its shapes need, as a STEP file of its own: the project with its units, the
/// products that have shapes, and all that these refer to. No relations, properties and styles; comments,
/// damaged statements and texts beyond ASCII are gone. Quicker to read, and less that can be wrong.
/// `newer`: of an IFC4X3 file, which becomes IFC4.
std::string text_of_shapes(const StepFile& file, const std::optional<Ifc4x3>& newer = {});

/// Whether an entity is a product with a shape: IfcProduct.Representation is the seventh argument of every
/// one.
bool has_ifc_shape(const StepFile& file, const StepEntity& entity);

}  // namespace limen
