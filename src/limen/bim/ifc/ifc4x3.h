// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

}  // namespace limen
