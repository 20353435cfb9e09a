// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/crs/proj_library.h"

#include <optional>

#include "limen/base/system.h"

namespace limen {
namespace {

// Versions 9, 8, 7 and 6.2 of PROJ, then whatever a developer has.
constexpr const char* kProjFiles[] = {"libproj.so.25", "libproj.so.22", "libproj.so.19", "libproj.so.15",
                                      "libproj.so",    "proj_9.dll",    "proj.dll"};

template <typename Function>
bool find_function(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(function_in(library, name));
  return function != nullptr;
}

std::optional<ProjLibrary> loaded_proj() {
  void* library = nullptr;
  for (const char* file : kProjFiles) {
    library = load_library(file);
    if (library != nullptr) break;
  }
  if (library == nullptr) return {};
  ProjLibrary proj;
  const bool all =
      find_function(library, "proj_context_create", proj.context_create) &&
      find_function(library, "proj_context_destroy", proj.context_destroy) &&
      find_function(library, "proj_log_level", proj.log_level) &&
      find_function(library, "proj_create", proj.create) &&
      find_function(library, "proj_destroy", proj.destroy) &&
      find_function(library, "proj_is_crs", proj.is_crs) &&
      find_function(library, "proj_get_name", proj.get_name) &&
      find_function(library, "proj_get_id_auth_name", proj.get_id_auth_name) &&
      find_function(library, "proj_get_id_code", proj.get_id_code) &&
      find_function(library, "proj_as_wkt", proj.as_wkt) &&
      find_function(library, "proj_is_equivalent_to", proj.is_equivalent_to) &&
      find_function(library, "proj_crs_get_sub_crs", proj.get_sub_crs) &&
      find_function(library, "proj_create_crs_to_crs_from_pj", proj.create_crs_to_crs_from_pj) &&
      find_function(library, "proj_normalize_for_visualization", proj.normalize_for_visualization) &&
      find_function(library, "proj_trans", proj.trans);
  return all ? std::optional(proj) : std::nullopt;
}

void destroy_context(ProjContext* context) {
  if (context != nullptr) proj_library()->context_destroy(context);
}

void destroy_object(ProjObject* object) {
  if (object != nullptr) proj_library()->destroy(object);
}

}  // namespace

const ProjLibrary* proj_library() {
  static const std::optional<ProjLibrary> kLibrary = loaded_proj();
  return kLibrary ? &*kLibrary : nullptr;
}

ProjHandle::Object owned(ProjObject* object) {
  return {object, &destroy_object};
}

ProjHandle::ProjHandle(const std::string& text)
    : context_(nullptr, &destroy_context), object_(nullptr, &destroy_object) {
  const ProjLibrary* proj = proj_library();
  if (proj == nullptr) return;
  context_.reset(proj->context_create());
  proj->log_level(context_.get(), 0);
  object_.reset(proj->create(context_.get(), text.c_str()));
}

}  // namespace limen
