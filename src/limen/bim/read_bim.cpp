// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/read_bim.h"

#include <array>
#include <string>
#include <string_view>
#include <system_error>

#include "limen/base/error.h"
#include "limen/bim/build/bim_builder.h"
#include "limen/bim/ifc/read_ifc.h"
#include "limen/bim/mesh/read_mesh.h"
#include "limen/files/mapped_file.h"

namespace limen {
namespace {

/// A format that is read, recognised by its bytes.
struct Format {
  bool (*matches)(std::string_view bytes);
  RawModel (*read)(std::string_view bytes, const std::string& name, Monitor& monitor);
};

RawModel obj(std::string_view bytes, const std::string& name, Monitor& /*monitor*/) {
  return read_obj(bytes, name);
}
RawModel mesh_ply(std::string_view bytes, const std::string& name, Monitor& /*monitor*/) {
  return read_mesh_ply(bytes, name);
}

constexpr std::array<Format, 4> kFormats{{
    {looks_like_step, read_ifc},
    {looks_like_ifczip, read_ifczip},
    {looks_like_mesh_ply, mesh_ply},
    {looks_like_obj, obj},
}};

/// Scales a mesh. Throws Error for a file that tells its unit.
void set_unit(RawModel& raw, double metres_per_unit, const std::string& name) {
  if (raw.head.schema != "OBJ" && raw.head.schema != "PLY")
    throw Error("an IFC file states its own length unit", name, "leave the option for the unit out");
  raw.head.metres_per_unit = metres_per_unit;
  if (metres_per_unit == 1.0) return;
  for (RawElement& element : raw.elements) {
    for (Solid& solid : element.shapes) move(solid, metres_per_unit, Vector3d::Zero());
  }
}

const Format* format_of(std::string_view bytes) {
  for (const Format& format : kFormats) {
    if (format.matches(bytes)) return &format;
  }
  return nullptr;
}

}  // namespace

bool is_bim_file(const std::filesystem::path& path) {
  std::error_code ignored;
  // A pipe can be read only once: whoever reads it will see what it is.
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  try {
    const MappedFile file(path);
    return format_of(file.bytes()) != nullptr;
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    return false;
  }
}

BimModel read_bim(const std::filesystem::path& path, Monitor& monitor,
                  std::optional<double> metres_per_unit) {
  const std::string name = path.string();
  const CancelScope scope(monitor);
  CancelScope::check();
  const MappedFile file(path);
  const Format* format = format_of(file.bytes());
  if (format == nullptr) {
    refuse_vendor_format(file.bytes(), path);
    throw Error("this is not a model that limen can read", name,
                "give an IFC file (IFC2X3 or IFC4, .ifc or .ifczip), or a mesh as OBJ or PLY with faces");
  }
  RawModel raw = with_whole_inputs([&] { return format->read(file.bytes(), name, monitor); });
  monitor.throw_if_cancelled();
  if (metres_per_unit) set_unit(raw, *metres_per_unit, name);
  return built(std::move(raw), monitor);
}

}  // namespace limen
