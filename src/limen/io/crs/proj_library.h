// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace limen {

// The few functions of PROJ (https://proj.org) that are needed, found when the program runs: nobody needs
// PROJ, its database and what it is linked with to build or start limen.

struct ProjContext;
struct ProjObject;

/// Four numbers as PROJ passes them: PJ_COORD.
struct ProjCoordinate {
  double v[4] = {0.0, 0.0, 0.0, 0.0};
};

/// Functions with the names and types that PROJ 6.2 and later give them.
struct ProjLibrary {
  ProjContext* (*context_create)() = nullptr;
  ProjContext* (*context_destroy)(ProjContext*) = nullptr;
  int (*log_level)(ProjContext*, int) = nullptr;
  ProjObject* (*create)(ProjContext*, const char*) = nullptr;
  ProjObject* (*destroy)(ProjObject*) = nullptr;
  int (*is_crs)(const ProjObject*) = nullptr;
  const char* (*get_name)(const ProjObject*) = nullptr;
  const char* (*get_id_auth_name)(const ProjObject*, int) = nullptr;
  const char* (*get_id_code)(const ProjObject*, int) = nullptr;
  const char* (*as_wkt)(ProjContext*, const ProjObject*, int, const char* const*) = nullptr;
  int (*is_equivalent_to)(const ProjObject*, const ProjObject*, int) = nullptr;
  ProjObject* (*get_sub_crs)(ProjContext*, const ProjObject*, int) = nullptr;
  ProjObject* (*create_crs_to_crs_from_pj)(ProjContext*, const ProjObject*, const ProjObject*, void*,
                                           const char* const*) = nullptr;
  ProjObject* (*normalize_for_visualization)(ProjContext*, const ProjObject*) = nullptr;
  ProjCoordinate (*trans)(ProjObject*, int, ProjCoordinate) = nullptr;
};

/// PROJ, or nullptr where the machine has none.
const ProjLibrary* proj_library();

/// An object of PROJ with the context that it lives in; neither is shared by threads.
class ProjHandle {
 public:
  using Context = std::unique_ptr<ProjContext, void (*)(ProjContext*)>;
  using Object = std::unique_ptr<ProjObject, void (*)(ProjObject*)>;

  /// What a text names; empty where it names nothing.
  explicit ProjHandle(const std::string& text);
  [[nodiscard]] ProjObject* get() const { return object_.get(); }
  [[nodiscard]] ProjContext* context() const { return context_.get(); }

 private:
  Context context_;
  Object object_;
};

/// Takes care of an object that PROJ made.
ProjHandle::Object owned(ProjObject* object);

}  // namespace limen
