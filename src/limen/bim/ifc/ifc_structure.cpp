// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_structure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/bim/ifc/ifc_types.h"

namespace limen {
namespace {

using Arguments = std::vector<std::string_view>;

/// A wall has layers, a stair its flights. A file of which every element is part of the last would otherwise
/// take time quadratic in its length.
constexpr std::size_t kMostParts = 500;

/// Prefixes of SI units.
double factor_of_prefix(const std::string& prefix) {
  static constexpr std::array<std::pair<std::string_view, double>, 10> kPrefixes{{{"KILO", 1e3},
                                                                                  {"HECTO", 1e2},
                                                                                  {"DECA", 1e1},
                                                                                  {"DECI", 1e-1},
                                                                                  {"CENTI", 1e-2},
                                                                                  {"MILLI", 1e-3},
                                                                                  {"MICRO", 1e-6},
                                                                                  {"NANO", 1e-9},
                                                                                  {"MEGA", 1e6},
                                                                                  {"GIGA", 1e9}}};
  for (const auto& [name, factor] : kPrefixes) {
    if (prefix == name) return factor;
  }
  return 1.0;
}

/// Every element of a storey carries its name: no more than this of it, and no character by half.
std::string shortened(std::string name) {
  constexpr std::size_t kLongestName = 200;
  if (name.size() <= kLongestName) return name;
  std::size_t end = kLongestName;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0U) == 0x80U) --end;
  name.resize(end);
  return name;
}

/// Reads the structure in one pass over relations, then over what they relate.
class StructureReader {
 public:
  explicit StructureReader(const StepFile& file) : file_(file) {}

  IfcStructure read() {
    for (const StepEntity& entity : file_.entities()) {
      CancelScope::check();
      read_relation(entity);
    }
    read_units();
    read_map();
    for (const StepEntity& entity : file_.entities()) {
      CancelScope::check();
      read_object(entity);
    }
    for (IfcVoid& gap : structure_.voids) {
      const auto filling = filling_of_.find(gap.opening);
      if (filling != filling_of_.end()) gap.filling = filling->second;
      const StepEntity* opening = file_.find(gap.opening);
      if (opening != nullptr) gap.guid = step_text(argument(step_arguments(opening->arguments), 0));
    }
    std::stable_sort(structure_.voids.begin(), structure_.voids.end(),
                     [](const IfcVoid& a, const IfcVoid& b) { return a.opening < b.opening; });
    return std::move(structure_);
  }

 private:
  static std::string_view argument(const Arguments& arguments, std::size_t index) {
    return index < arguments.size() ? arguments[index] : std::string_view{};
  }

  Arguments arguments_of(std::int64_t id) const {
    const StepEntity* entity = file_.find(id);
    return entity == nullptr ? Arguments{} : step_arguments(entity->arguments);
  }

  std::string type_of(std::int64_t id) const {
    const StepEntity* entity = file_.find(id);
    return entity == nullptr ? std::string{} : upper_case(entity->type);
  }

  void warn(std::string text) { structure_.warnings.push_back(std::move(text)); }

  void read_relation(const StepEntity& entity) {
    const std::string type = upper_case(entity.type);
    if (type == "IFCMAPCONVERSION") maps_.push_back(entity.id);
    if (type == "IFCPROJECT") projects_.push_back(entity.id);
    if (type == "IFCUNITASSIGNMENT") assignments_.push_back(entity.id);
    if (type.compare(0, 6, "IFCREL") != 0) return;
    const Arguments arguments = step_arguments(entity.arguments);
    const std::optional<std::int64_t> first = step_reference(argument(arguments, 4));
    const std::optional<std::int64_t> second = step_reference(argument(arguments, 5));
    if (type == "IFCRELVOIDSELEMENT" && first && second) {
      structure_.voids.push_back({*second, *first, 0, {}});
      host_of_.emplace(*second, *first);
    }
    if (type == "IFCRELFILLSELEMENT" && first && second) {
      filling_of_.emplace(*first, *second);
      opening_of_.emplace(*second, *first);
    }
    if (type == "IFCRELCONTAINEDINSPATIALSTRUCTURE" && second) {
      for (const std::int64_t id : step_references(argument(arguments, 4)))
        container_of_.emplace(id, *second);
    }
    if (type == "IFCRELAGGREGATES" && first) {
      for (const std::int64_t id : step_references(argument(arguments, 5))) {
        whole_of_.emplace(id, *first);
        structure_.parts[*first].push_back(id);
      }
    }
  }

  /// Metres per unit of a length unit; nothing where it is no length or damaged.
  std::optional<double> metres_of_unit(std::int64_t id, int depth = 0) const {
    const Arguments arguments = arguments_of(id);
    const std::string type = type_of(id);
    if (depth > 4 || step_enumeration(argument(arguments, 1)) != "LENGTHUNIT") return {};
    if (type == "IFCSIUNIT") return factor_of_prefix(step_enumeration(argument(arguments, 2)));
    if (type.compare(0, 22, "IFCCONVERSIONBASEDUNIT") != 0) return {};
    const Arguments measure = arguments_of(step_reference(argument(arguments, 3)).value_or(0));
    const std::optional<double> value = step_number(argument(measure, 0));
    const std::optional<double> base =
        metres_of_unit(step_reference(argument(measure, 1)).value_or(0), depth + 1);
    if (!value || !base || !(*value > 0.0)) return {};
    return *value * *base;
  }

  /// Of the project's units; of a file that has lost its project any.
  void read_units() {
    std::vector<std::int64_t> assignments;
    for (const std::int64_t project : projects_)
      assignments.push_back(step_reference(argument(arguments_of(project), 8)).value_or(0));
    if (projects_.empty()) {
      warn("the file has no project: it is damaged");
      assignments = assignments_;
    }
    std::set<std::int64_t> asked;  // nothing is read twice, however often it is named
    for (const std::int64_t assignment : assignments) {
      if (!asked.insert(assignment).second) continue;
      for (const std::int64_t unit : step_references(argument(arguments_of(assignment), 0))) {
        if (!asked.insert(unit).second) continue;
        const std::optional<double> metres = metres_of_unit(unit);
        if (!metres) continue;
        structure_.metres_per_unit = *metres;
        return;
      }
    }
    warn("the file states no length unit: metres are assumed");
  }

  /// Metres per unit of the map's coordinates: the target's own; without one metres where the scale turns the
  /// project's units into metres, else the project's.
  double metres_of_map(std::int64_t target, double scale) const {
    const Arguments arguments = arguments_of(target);
    constexpr std::size_t kMostArguments = 12;  // of a coordinate system there are seven
    for (std::size_t k = std::min(arguments.size(), kMostArguments); k > 0; --k) {
      const std::optional<std::int64_t> unit = step_reference(arguments[k - 1]);
      const std::optional<double> metres = unit ? metres_of_unit(*unit) : std::nullopt;
      if (metres) return *metres;
    }
    const double to_metres = scale / structure_.metres_per_unit;
    return !plausible_scale(scale) && plausible_scale(to_metres) ? 1.0 : structure_.metres_per_unit;
  }

  static bool plausible_scale(double scale) { return scale > 0.9 && scale < 1.1; }

  void read_map() {
    if (maps_.empty()) return;
    if (maps_.size() > 1) warn("the file has several map conversions: the first is used");
    const Arguments arguments = arguments_of(maps_.front());
    const auto number = [&](std::size_t k, double otherwise) {
      return step_number(argument(arguments, k)).value_or(otherwise);
    };
    const double scale = number(7, 1.0);
    const double metres = metres_of_map(step_reference(argument(arguments, 1)).value_or(0), scale);
    MapConversion map;
    map.shift_m = metres * Vector3d(number(2, 0.0), number(3, 0.0), number(4, 0.0));
    const double length = std::hypot(number(5, 1.0), number(6, 0.0));
    if (length > 0.0) {
      map.cosine = number(5, 1.0) / length;
      map.sine = number(6, 0.0) / length;
    }
    map.scale = scale_of_map(scale, metres);
    structure_.map = map;
  }

  /// The scale between metres and metres. It should carry the change of units too; many files leave that out.
  double scale_of_map(double scale, double metres_of_map_unit) {
    const double between_metres = scale * metres_of_map_unit / structure_.metres_per_unit;
    if (plausible_scale(between_metres)) return between_metres;
    if (plausible_scale(scale)) {
      warn(fmt::format("the map conversion's scale {:g} ignores the units: it is applied between metres",
                       scale));
      return scale;
    }
    warn(fmt::format("the map conversion's scale {:g} is not plausible for a map: it is ignored", scale));
    return 1.0;
  }

  const std::string& name_of_storey(std::int64_t id) {
    const auto [place, is_new] = storey_names_.try_emplace(id);
    if (is_new) {
      const Arguments arguments = arguments_of(id);
      place->second = step_text(argument(arguments, 2));
      if (place->second.empty()) place->second = step_text(argument(arguments, 7));
      place->second = shortened(std::move(place->second));
    }
    return place->second;
  }

  /// The name of the storey that holds an object, over what it is part of, is in, or fills.
  std::string storey_of(std::int64_t id) {
    constexpr int kLongestWay = 20;
    for (int step = 0; step < kLongestWay; ++step) {
      if (type_of(id) == "IFCBUILDINGSTOREY") return name_of_storey(id);
      const std::int64_t above = above_of(id);
      if (above == 0) return {};
      id = above;
    }
    return {};
  }

  std::int64_t above_of(std::int64_t id) const {
    for (const auto* way : {&container_of_, &whole_of_, &opening_of_, &host_of_}) {
      const auto found = way->find(id);
      if (found != way->end()) return found->second;
    }
    return 0;
  }

  void read_object(const StepEntity& entity) {
    const std::string type = upper_case(entity.type);
    const std::string element_type = element_type_named(type);
    if (element_type.empty() && type != "IFCSPACE") return;
    const Arguments arguments = step_arguments(entity.arguments);
    if (type == "IFCSPACE") {
      BimSpace space;
      space.guid = step_text(argument(arguments, 0));
      space.name = step_text(argument(arguments, 2));
      const std::string long_name = step_text(argument(arguments, 7));
      if (!long_name.empty() && long_name != space.name)
        space.name += (space.name.empty() ? "" : " ") + long_name;
      space.storey = storey_of(entity.id);
      structure_.spaces.emplace(entity.id, std::move(space));
      return;
    }
    BimElement element;
    element.type = element_type;
    element.kind = kind_of(entity.id, element_type, step_enumeration(argument(arguments, 8)));
    element.guid = step_text(argument(arguments, 0));
    element.name = step_text(argument(arguments, 2));
    element.storey = storey_of(entity.id);
    element.file_id = entity.id;
    structure_.elements.emplace(entity.id, std::move(element));
  }

  /// A layer of a wall is wall, a slab of a roof is roof.
  BimKind kind_of(std::int64_t id, const std::string& type, const std::string& predefined) const {
    const BimKind kind = kind_of_ifc_type(type, predefined);
    const auto whole = whole_of_.find(id);
    if (whole == whole_of_.end()) return kind;
    const BimKind of_whole = kind_of_ifc_type(type_of(whole->second));
    if (kind == BimKind::slab && of_whole == BimKind::roof) return BimKind::roof;
    return type == "IfcBuildingElementPart" ? of_whole : kind;
  }

  const StepFile& file_;
  IfcStructure structure_;
  std::vector<std::int64_t> projects_;
  std::vector<std::int64_t> assignments_;
  std::vector<std::int64_t> maps_;
  std::map<std::int64_t, std::int64_t> filling_of_;    ///< opening -> what is in it
  std::map<std::int64_t, std::int64_t> opening_of_;    ///< the other way
  std::map<std::int64_t, std::int64_t> host_of_;       ///< opening -> what it is cut out of
  std::map<std::int64_t, std::int64_t> container_of_;  ///< object -> storey or space
  std::map<std::int64_t, std::int64_t> whole_of_;      ///< part -> whole
  std::map<std::int64_t, std::string> storey_names_;   ///< of the storeys asked for so far
};

}  // namespace

IfcStructure read_ifc_structure(const StepFile& file) {
  return StructureReader(file).read();
}

std::vector<std::int64_t> with_parts(const IfcStructure& structure, std::int64_t element) {
  std::vector<std::int64_t> all{element};
  std::set<std::int64_t> seen{element};
  for (std::size_t at = 0; at < all.size() && all.size() < kMostParts; ++at) {
    const auto parts = structure.parts.find(all[at]);
    if (parts == structure.parts.end()) continue;
    for (const std::int64_t part : parts->second) {
      if (all.size() < kMostParts && seen.insert(part).second) all.push_back(part);
    }
  }
  return all;
}

}  // namespace limen
