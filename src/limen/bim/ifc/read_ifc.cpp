// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/read_ifc.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/bim/ifc/ifc4x3.h"
#include "limen/bim/ifc/ifc_process.h"
#include "limen/bim/ifc/ifc_stream.h"
#include "limen/bim/ifc/ifc_structure.h"
#include "limen/bim/ifc/ifc_types.h"
#include "limen/bim/ifc/step_file.h"
#include "limen/files/zip.h"
#include "limen/io/table/record_table.h"

namespace limen {
namespace {

/// limen_ifc is run again for so many entities that kill it, and for so long.
constexpr std::size_t kMostRestarts = 10;
constexpr double kLongestRestarting_s = 40.0;
/// More warnings of one sort than this are counted, not listed.
constexpr std::size_t kMostListed = 10;
constexpr std::size_t kLargestUnpacked = std::size_t{2000} * 1000 * 1000;
/// IFC text becomes five to twenty times as small; what becomes far smaller is made to fill the memory.
constexpr std::size_t kMostExpansion = 100;
constexpr std::size_t kAnyMember = 1'000'000;  // bytes that a member may have in any case
constexpr const char* kWayRound = "export the model as IFC4 or IFC2X3, or as a mesh (OBJ, PLY)";

void require_schema(const StepFile& file, const std::string& name) {
  const std::string& schema = file.schema();
  if (schema.empty())
    throw Error("the file names no schema (FILE_SCHEMA): its header is damaged", name, kWayRound);
  if (schema.compare(0, 3, "IFC") != 0)
    throw Error(fmt::format("this is a STEP file of schema {}, not a building model", schema.substr(0, 60)),
                name, kWayRound);
  const bool known = schema.compare(0, 5, "IFC2X") == 0 || Ifc4x3::is_schema(schema) ||
                     (schema.compare(0, 4, "IFC4") == 0 && schema.compare(0, 5, "IFC4X") != 0);
  if (!known)
    throw Error(fmt::format("the schema {} is not supported", schema.substr(0, 60)), name, kWayRound);
}

/// Lists of warnings of one sort, shortened.
class WarningList {
 public:
  void add(std::string text) {
    ++count_;
    if (lines_.size() < kMostListed) lines_.push_back(std::move(text));
  }
  void append_to(std::vector<std::string>& warnings, const std::string& what) const {
    warnings.insert(warnings.end(), lines_.begin(), lines_.end());
    if (count_ > lines_.size())
      warnings.push_back(fmt::format("and {} more {}", count_ - lines_.size(), what));
  }

 private:
  std::size_t count_ = 0;
  std::vector<std::string> lines_;
};

/// The shapes, got by as many runs of limen_ifc as it takes.
class ShapeSource {
 public:
  ShapeSource(std::string text, const std::string& name, Monitor& monitor)
      : text_(std::move(text)), name_(name), monitor_(monitor) {}

  IfcShapes get(std::vector<std::string>& warnings) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::int64_t> skip;
    for (;;) {
      const IfcRun run = run_ifc_helper(text_, skip, {}, monitor_);
      IfcShapes shapes = parse_ifc_stream(run.output);
      if (shapes.complete) return shapes;
      refuse(shapes, run);
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      if (shapes.begun == 0 || skip.size() >= kMostRestarts || taken.count() > kLongestRestarting_s) {
        warnings.push_back(fmt::format("limen_ifc {} after {} shapes: the rest of the file is missing",
                                       run.ended_how, shapes.products.size()));
        return shapes;
      }
      skip.push_back(shapes.begun);
      warnings.push_back(
          fmt::format("#{} is left out: limen_ifc {} while it built its shape", shapes.begun, run.ended_how));
    }
  }

 private:
  /// Throws where not even the file could be loaded.
  void refuse(const IfcShapes& shapes, const IfcRun& run) const {
    if (!shapes.refused.empty())
      throw Error("the IFC file cannot be read: " + shapes.refused.substr(0, 200), name_, kWayRound);
    if (shapes.loaded) return;
    throw Error(
        fmt::format("the IFC file cannot be read: limen_ifc {}", run.ended_how), name_,
        "the file is damaged, or larger than the memory allows: export it again, or as a mesh (OBJ, PLY)");
  }

  std::string text_;
  const std::string& name_;
  Monitor& monitor_;
};

bool is_no_element(const std::string& type) {
  static constexpr std::array<std::string_view, 9> kOthers{
      "IfcOpening", "IfcVoidingFeature", "IfcSpace",      "IfcSpatialZone",   "IfcExternalSpatial",
      "IfcProject", "IfcStructural",     "IfcAnnotation", "IfcBuildingStorey"};
  return type == "IfcBuilding" || std::any_of(kOthers.begin(), kOthers.end(), [&](std::string_view other) {
           return std::string_view(type).substr(0, other.size()) == other;
         });
}

/// Puts shapes and words together.
class Assembly {
 public:
  Assembly(const StepFile& file, IfcStructure structure, IfcShapes shapes)
      : file_(file), structure_(std::move(structure)), shapes_(std::move(shapes)) {}

  RawModel assemble() {
    place();
    for (const IfcProductShapes& product : shapes_.products) {
      if (structure_.elements.count(product.id) == 0 && !is_no_element(product.type)) add_unlisted(product);
    }
    for (auto& [id, element] : structure_.elements) {
      index_of_.emplace(id, static_cast<std::int32_t>(model_.elements.size()));
      model_.elements.push_back({std::move(element), take_shapes(id)});
    }
    for (const IfcVoid& gap : structure_.voids) add_opening(gap);
    for (auto& [id, space] : structure_.spaces) model_.spaces.push_back({std::move(space), take_shapes(id)});
    tell();
    return std::move(model_);
  }

 private:
  /// Shapes into metres and into the map.
  void place() {
    const double scale = structure_.metres_per_unit / shapes_.metres_per_unit;
    for (IfcProductShapes& product : shapes_.products) {
      for (Solid& shape : product.shapes) {
        if (std::abs(scale - 1.0) > 1e-12) move(shape, scale, Vector3d::Zero());
        if (structure_.map) to_map(shape);
      }
    }
    for (std::size_t i = 0; i < shapes_.products.size(); ++i) product_of_.emplace(shapes_.products[i].id, i);
  }

  void to_map(Solid& solid) const {
    for (Vector3d& point : solid.mesh.points) point = structure_.map->to_map(point);
    for (Solid& child : solid.children) to_map(child);
  }

  /// An element of a type that limen has no name for, or a site with a surface.
  void add_unlisted(const IfcProductShapes& product) {
    const StepEntity* entity = file_.find(product.id);
    BimElement element;
    element.type = product.type;
    element.kind = kind_of_ifc_type(product.type);
    element.file_id = product.id;
    if (entity != nullptr) {
      const std::vector<std::string_view> arguments = step_arguments(entity->arguments);
      if (!arguments.empty()) element.guid = step_text(arguments[0]);
      if (arguments.size() > 2) element.name = step_text(arguments[2]);
    }
    structure_.elements.emplace(product.id, std::move(element));
  }

  std::vector<Solid> take_shapes(std::int64_t id) {
    const auto found = product_of_.find(id);
    return found == product_of_.end() ? std::vector<Solid>{}
                                      : std::move(shapes_.products[found->second].shapes);
  }

  std::int32_t index_of(std::int64_t id) const {
    const auto found = index_of_.find(id);
    return found == index_of_.end() ? -1 : found->second;
  }

  void add_opening(const IfcVoid& gap) {
    RawOpening opening;
    opening.guid = gap.guid;
    opening.filling = index_of(gap.filling);
    for (const std::int64_t host : with_parts(structure_, gap.host)) {
      if (index_of(host) >= 0) opening.hosts.push_back(index_of(host));
    }
    opening.shapes = take_shapes(gap.opening);
    if (opening.hosts.empty()) return;
    if (opening.shapes.empty()) {
      lost_.add(fmt::format("opening #{} has no shape: it is not cut out of #{}", gap.opening, gap.host));
      return;
    }
    model_.openings.push_back(std::move(opening));
  }

  /// True where the file gives the element a shape (IfcProduct.Representation).
  bool should_have_shape(std::int64_t id) const {
    const StepEntity* entity = file_.find(id);
    if (entity == nullptr) return false;
    const std::vector<std::string_view> arguments = step_arguments(entity->arguments);
    return arguments.size() > 6 && step_reference(arguments[6]).has_value();
  }

  void tell() {
    for (const RawElement& element : model_.elements) {
      if (element.shapes.empty() && should_have_shape(element.about.file_id))
        lost_.add(
            fmt::format("#{} {} has no shape that can be read", element.about.file_id, element.about.type));
    }
    std::vector<std::string>& warnings = model_.head.warnings;
    warnings = std::move(structure_.warnings);
    lost_.append_to(warnings, "without a shape");
    WarningList messages;
    for (const auto& [id, text] : shapes_.messages)
      messages.add(fmt::format("#{}: {}", id, text.substr(0, 200)));
    messages.append_to(warnings, "messages of limen_ifc");
    if (file_.damaged() > 0)
      warnings.push_back(fmt::format("{} statements of the file are damaged and skipped", file_.damaged()));
    model_.head.metres_per_unit = structure_.metres_per_unit;
    model_.head.georeferenced = structure_.map.has_value();
  }

  const StepFile& file_;
  IfcStructure structure_;
  IfcShapes shapes_;
  RawModel model_;
  std::map<std::int64_t, std::size_t> product_of_;  ///< entity -> shapes
  std::map<std::int64_t, std::int32_t> index_of_;   ///< entity -> element
  WarningList lost_;
};

bool is_ifc_name(const std::string& name) {
  const std::string lower = lower_case(name);
  return lower.size() > 4 && lower.compare(lower.size() - 4, 4, ".ifc") == 0 &&
         lower.compare(0, 8, "__macosx") != 0;
}

std::vector<ZipMember> ifc_members(std::string_view bytes) {
  std::vector<ZipMember> members = zip_members(bytes);
  std::erase_if(members, [](const ZipMember& member) { return !is_ifc_name(member.name); });
  return members;
}

std::string unpacked_model(std::string_view bytes, const ZipMember& member, const std::string& name) {
  return unpacked(bytes, member, name,
                  std::min(kLargestUnpacked, std::max(kAnyMember, kMostExpansion * member.packed)));
}

}  // namespace

bool looks_like_step(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && bytes.substr(begin, 13) == "ISO-10303-21;";
}

bool looks_like_ifczip(std::string_view bytes) {
  return bytes.substr(0, 2) == "PK" && !ifc_members(bytes).empty();
}

RawModel read_ifc(std::string_view bytes, const std::string& name, Monitor& monitor) {
  const StepFile file(bytes);
  require_schema(file, name);
  if (!file.whole())
    throw Error("the file is cut off: it does not end with END-ISO-10303-21", name,
                "get the whole file, or export it again");
  IfcStructure structure = read_ifc_structure(file);
  monitor.throw_if_cancelled();
  std::vector<std::string> warnings;
  const std::optional<Ifc4x3> newer =
      Ifc4x3::is_schema(file.schema()) ? std::optional<Ifc4x3>(file) : std::nullopt;
  if (newer && !newer->types_left_out().empty())
    warnings.push_back(fmt::format("{} is read as IFC4; elements that need {} are left out", file.schema(),
                                   fmt::join(newer->types_left_out(), ", ")));
  IfcShapes shapes = ShapeSource(text_of_shapes(file, newer), name, monitor).get(warnings);
  RawModel model = Assembly(file, std::move(structure), std::move(shapes)).assemble();
  model.head.name = name;
  model.head.schema = file.schema();
  model.head.warnings.insert(model.head.warnings.begin(), warnings.begin(), warnings.end());
  return model;
}

RawModel read_ifczip(std::string_view bytes, const std::string& name, Monitor& monitor) {
  const std::vector<ZipMember> members = ifc_members(bytes);
  if (members.size() != 1) {
    throw Error(fmt::format("the archive holds {} IFC files", members.size()), name,
                "give an archive with one, or unpack it and give the file");
  }
  const std::string text = unpacked_model(bytes, members.front(), name);
  return read_ifc(text, name, monitor);
}

std::optional<MapConversion> map_of_ifc(std::string_view bytes, const std::string& name) {
  if (looks_like_step(bytes)) return read_ifc_structure(StepFile(bytes)).map;
  const std::vector<ZipMember> members =
      looks_like_ifczip(bytes) ? ifc_members(bytes) : std::vector<ZipMember>{};
  if (members.size() != 1) return {};
  const std::string text = unpacked_model(bytes, members.front(), name);
  return map_of_ifc(text, name);
}

}  // namespace limen
