// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc4x3.h"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/bim/ifc/ifc_types.h"

namespace limen {
namespace {

/// Entities of places and shapes that are the same in both, but for those that in_ifc4() rewrites; each
/// without its IFC.
constexpr std::string_view kSame =
    "CARTESIANPOINT DIRECTION VECTOR AXIS1PLACEMENT AXIS2PLACEMENT2D AXIS2PLACEMENT3D LOCALPLACEMENT "
    "CARTESIANTRANSFORMATIONOPERATOR2D CARTESIANTRANSFORMATIONOPERATOR2DNONUNIFORM "
    "CARTESIANTRANSFORMATIONOPERATOR3D CARTESIANTRANSFORMATIONOPERATOR3DNONUNIFORM "
    "PRODUCTDEFINITIONSHAPE SHAPEREPRESENTATION REPRESENTATIONMAP MAPPEDITEM GEOMETRICREPRESENTATIONCONTEXT "
    "GEOMETRICREPRESENTATIONSUBCONTEXT LINE POLYLINE CIRCLE ELLIPSE TRIMMEDCURVE COMPOSITECURVE "
    "COMPOSITECURVESEGMENT INDEXEDPOLYCURVE BSPLINECURVEWITHKNOTS RATIONALBSPLINECURVEWITHKNOTS "
    "CARTESIANPOINTLIST2D CARTESIANPOINTLIST3D PLANE CYLINDRICALSURFACE BSPLINESURFACEWITHKNOTS "
    "RATIONALBSPLINESURFACEWITHKNOTS SURFACEOFLINEAREXTRUSION SURFACEOFREVOLUTION ARBITRARYCLOSEDPROFILEDEF "
    "ARBITRARYOPENPROFILEDEF ARBITRARYPROFILEDEFWITHVOIDS RECTANGLEPROFILEDEF RECTANGLEHOLLOWPROFILEDEF "
    "ROUNDEDRECTANGLEPROFILEDEF CIRCLEPROFILEDEF CIRCLEHOLLOWPROFILEDEF ELLIPSEPROFILEDEF ISHAPEPROFILEDEF "
    "LSHAPEPROFILEDEF TSHAPEPROFILEDEF USHAPEPROFILEDEF CSHAPEPROFILEDEF ZSHAPEPROFILEDEF "
    "TRAPEZIUMPROFILEDEF DERIVEDPROFILEDEF COMPOSITEPROFILEDEF EXTRUDEDAREASOLID REVOLVEDAREASOLID "
    "SWEPTDISKSOLID BOOLEANRESULT BOOLEANCLIPPINGRESULT HALFSPACESOLID POLYGONALBOUNDEDHALFSPACE "
    "BOXEDHALFSPACE CSGSOLID BLOCK SPHERE RIGHTCIRCULARCYLINDER RIGHTCIRCULARCONE RECTANGULARPYRAMID "
    "FACETEDBREP FACETEDBREPWITHVOIDS ADVANCEDBREP ADVANCEDBREPWITHVOIDS CLOSEDSHELL OPENSHELL "
    "CONNECTEDFACESET FACE FACESURFACE ADVANCEDFACE FACEBOUND FACEOUTERBOUND POLYLOOP EDGELOOP ORIENTEDEDGE "
    "EDGECURVE EDGE VERTEXPOINT FACEBASEDSURFACEMODEL SHELLBASEDSURFACEMODEL POLYGONALFACESET "
    "TRIANGULATEDFACESET INDEXEDPOLYGONALFACE INDEXEDPOLYGONALFACEWITHVOIDS BOUNDINGBOX GEOMETRICSET "
    "GEOMETRICCURVESET ";

/// Products that are no elements, and are kept as they are.
constexpr std::string_view kSpatial = "OPENINGELEMENT SPACE SITE BUILDING BUILDINGSTOREY ";

/// Products that are not read from IFC4 either.
constexpr std::string_view kNotDrawn =
    "ANNOTATION GRID DISTRIBUTIONPORT VIRTUALELEMENT VOIDINGFEATURE SPATIALZONE EXTERNALSPATIALELEMENT ";

bool is_one_of(std::string_view words, std::string_view ifc_type) {
  static constexpr std::string_view kIfc = "IFC";
  if (ifc_type.substr(0, kIfc.size()) != kIfc) return false;
  const std::string word = std::string(ifc_type.substr(kIfc.size())) + " ";
  for (std::size_t at = words.find(word); at != std::string_view::npos; at = words.find(word, at + 1)) {
    if (at == 0 || words[at - 1] == ' ') return true;
  }
  return false;
}

/// Finds what cannot be read in all that an entity refers to, each entity looked at once.
class Search {
 public:
  Search(const StepFile& file, std::set<std::string>& types) : file_(file), types_(types) {}

  bool is_good(std::int64_t root) {
    std::vector<std::pair<std::int64_t, bool>> open{{root, false}};
    while (!open.empty()) {
      const auto [id, entered] = open.back();
      open.pop_back();
      const StepEntity* entity = file_.find(id);
      if (entity == nullptr) continue;  // missing entities are reported where files are read
      if (!entered && !good_.emplace(id, true).second) continue;
      if (entered) {
        for_each_step_reference(entity->arguments, [&, here = id](std::int64_t part) {
          const auto known = good_.find(part);
          if (known != good_.end() && !known->second) good_[here] = false;
        });
        continue;
      }
      const std::string type = upper_case(entity->type);
      if (!is_known(type)) {
        good_[id] = false;
        types_.insert(type);
        continue;
      }
      open.emplace_back(id, true);
      for_each_step_reference(entity->arguments, [&](std::int64_t part) { open.emplace_back(part, false); });
    }
    const auto found = good_.find(root);
    return found == good_.end() || found->second;
  }

 private:
  bool is_known(const std::string& type) {
    const auto [found, is_new] = known_.emplace(type, false);
    if (is_new) found->second = is_one_of(kSame, type);
    return found->second;
  }

  const StepFile& file_;
  std::set<std::string>& types_;
  std::unordered_map<std::int64_t, bool> good_;
  std::unordered_map<std::string, bool> known_;
};

}  // namespace

bool Ifc4x3::is_schema(std::string_view schema) {
  return schema == "IFC4X3" || schema == "IFC4X3_TC1" || schema == "IFC4X3_ADD1" || schema == "IFC4X3_ADD2";
}

Ifc4x3::Ifc4x3(const StepFile& file) {
  Search search(file, types_);
  for (const StepEntity& entity : file.entities()) {
    CancelScope::check();
    if (!has_ifc_shape(file, entity)) continue;
    const std::string type = upper_case(entity.type);
    const std::vector<std::string_view> arguments = step_arguments(entity.arguments);
    bool good = !element_type_named(type).empty() || is_one_of(kSpatial, type);
    if (!good && !is_one_of(kNotDrawn, type)) types_.insert(type);
    for (const std::size_t part : {5U, 6U}) {  // place and shape
      const std::optional<std::int64_t> id = step_reference(arguments[part]);
      good = good && (!id || search.is_good(*id));
    }
    if (!good) products_.insert(entity.id);
  }
}

std::string Ifc4x3::in_ifc4(const StepEntity& entity) {
  const std::string type = upper_case(entity.type);
  std::vector<std::string_view> arguments = step_arguments(entity.arguments);
  const auto written = [&](std::string_view name) {
    return fmt::format("{}({})", name, fmt::join(arguments, ","));
  };
  if (!element_type_named(type).empty() && arguments.size() >= 7) {
    arguments.resize(7);
    arguments.insert(arguments.end(), {"$", "$"});
    return written("IFCBUILDINGELEMENTPROXY");
  }
  // Newer last arguments: the points' tags, the unit's name.
  if ((type == "IFCCARTESIANPOINTLIST2D" || type == "IFCCARTESIANPOINTLIST3D") && arguments.size() == 2)
    arguments.pop_back();
  if (type == "IFCDERIVEDUNIT" && arguments.size() == 4) arguments.pop_back();
  // Closed comes before the normals now.
  if (type == "IFCTRIANGULATEDFACESET" && arguments.size() == 5 &&
      (arguments[1].substr(0, 1) == "." || arguments[2].substr(0, 1) == "("))
    std::swap(arguments[1], arguments[2]);
  return written(type);
}

namespace {

bool is_type(const StepEntity* entity, std::string_view upper) {
  return entity != nullptr && entity->type.size() == upper.size() &&
         std::equal(upper.begin(), upper.end(), entity->type.begin(),
                    [](char a, char b) { return a == b || (b >= 'a' && b <= 'z' && a == b - 'a' + 'A'); });
}

bool is_ifc_type(std::string_view type) {
  return type.size() > 3 && (type[0] == 'I' || type[0] == 'i') && (type[1] == 'F' || type[1] == 'f') &&
         (type[2] == 'C' || type[2] == 'c');
}

/// All that the project, its units and the products refer to, over any number of steps.
std::unordered_set<std::int64_t> needed(const StepFile& file, const std::optional<Ifc4x3>& newer) {
  std::unordered_set<std::int64_t> ids;
  std::vector<std::int64_t> open;
  const auto add = [&](std::int64_t id) {
    if (ids.insert(id).second) open.push_back(id);
  };
  for (const StepEntity& entity : file.entities()) {
    if (is_type(&entity, "IFCPROJECT") || is_type(&entity, "IFCUNITASSIGNMENT") ||
        (has_ifc_shape(file, entity) && !(newer && newer->left_out(entity.id))))
      add(entity.id);
  }
  while (!open.empty()) {
    const StepEntity* entity = file.find(open.back());
    open.pop_back();
    if (entity != nullptr) for_each_step_reference(entity->arguments, add);
  }
  return ids;
}

/// Writes arguments on one line; texts with escapes or bytes beyond ASCII become empty, references to what is
/// not there become $.
class ArgumentWriter {
 public:
  ArgumentWriter(const StepFile& file, std::string& text) : file_(file), text_(text) {}

  void write(std::string_view arguments) {
    const StepComments comments(arguments);
    for (std::size_t at = 0; at < arguments.size(); ++at) {
      const char c = arguments[at];
      if (c == '\'') {
        at = write_text(arguments, at);
      } else if (c == '#') {
        at = write_reference(arguments, at);
      } else if (comments.begins_at(at)) {
        at = comments.behind(at) - 1;
      } else if (c > ' ' && c < 127) {
        text_ += c;
      }
    }
  }

 private:
  /// These return the place of the last character they took.
  std::size_t write_text(std::string_view arguments, std::size_t at) {
    const std::size_t end = std::min(arguments.find('\'', at + 1), arguments.size());
    const std::string_view word = arguments.substr(at, end - at);
    if (std::all_of(word.begin(), word.end(), [](char k) { return k >= ' ' && k < 127 && k != '\\'; })) {
      text_.append(word);
    } else {
      text_ += '\'';
    }
    text_ += '\'';
    return end;
  }

  std::size_t write_reference(std::string_view arguments, std::size_t at) {
    std::size_t end = at + 1;
    while (end < arguments.size() && arguments[end] >= '0' && arguments[end] <= '9') ++end;
    const std::string_view word = arguments.substr(at, end - at);
    const std::optional<std::int64_t> id = step_reference(word);
    if (id && file_.find(*id) != nullptr) {
      text_.append(word);
    } else {
      text_ += '$';
    }
    return end - 1;
  }

  const StepFile& file_;
  std::string& text_;
};

/// A project for a file that has lost its own: with the file's units where these are there.
std::string project_for(const StepFile& file) {
  std::int64_t next = 1;
  std::string units = "$";
  for (const StepEntity& entity : file.entities()) {
    if (is_type(&entity, "IFCPROJECT")) return {};
    if (is_type(&entity, "IFCUNITASSIGNMENT")) units = '#' + std::to_string(entity.id);
    next = entity.id + 1;
  }
  const std::string length = std::to_string(next + 1);
  const std::string angle = std::to_string(next + 2);
  const std::string both = std::to_string(next + 3);
  std::string text;
  if (units == "$") {
    text += "#" + length + "=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n";
    text += "#" + angle + "=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n";
    text += "#" + both + "=IFCUNITASSIGNMENT((#" + length + ",#" + angle + "));\n";
    units = '#' + both;
  }
  return text + "#" + std::to_string(next) + "=IFCPROJECT('0',$,$,$,$,$,$,$," + units + ");\n";
}

}  // namespace

bool has_ifc_shape(const StepFile& file, const StepEntity& entity) {
  if (entity.arguments.size() < 20) return false;
  const std::vector<std::string_view> arguments = step_arguments(entity.arguments);
  if (arguments.size() < 7) return false;
  const std::optional<std::int64_t> shape = step_reference(arguments[6]);
  return shape && is_type(file.find(*shape), "IFCPRODUCTDEFINITIONSHAPE");
}

std::string text_of_shapes(const StepFile& file, const std::optional<Ifc4x3>& newer) {
  std::string text =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_"
      "SCHEMA(('";
  text += (newer ? "IFC4" : file.schema()) + "'));\nENDSEC;\nDATA;\n";
  const std::unordered_set<std::int64_t> ids = needed(file, newer);
  ArgumentWriter writer(file, text);
  for (const StepEntity& entity : file.entities()) {
    CancelScope::check();
    if (ids.count(entity.id) == 0 || !is_ifc_type(entity.type)) continue;
    text += '#';
    text += std::to_string(entity.id);
    text += '=';
    if (newer) {
      writer.write(Ifc4x3::in_ifc4(entity));
    } else {
      writer.write(entity.type);
      text += '(';
      writer.write(entity.arguments);
      text += ')';
    }
    text += ";\n";
  }
  text += project_for(file);
  return text + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace limen
