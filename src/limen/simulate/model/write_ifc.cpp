// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/simulate/model/bim_recipe.h"

namespace limen {
namespace {

/// Writes entities one after another; each method returns the number of what it wrote ("#12").
class IfcWriter {
 public:
  IfcWriter(const BimRecipe& recipe, IfcUnit unit)
      : recipe_(recipe), unit_(unit), scale_(unit == IfcUnit::metre ? 1.0 : 1000.0) {}

  std::string run() && {
    text_ = fmt::format(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [ReferenceView_V1.2]'),'2;1');\n"
        "FILE_NAME('{}.ifc','2000-01-01T00:00:00',(''),(''),'limen','limen','');\n"
        "FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n",
        recipe_.name);
    write_frame();
    for (std::size_t i = 0; i < recipe_.elements.size(); ++i) elements_.push_back(write_element(i));
    for (std::size_t i = 0; i < recipe_.openings.size(); ++i) write_opening(i);
    write_structure();
    return text_ + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

 private:
  std::string add(const std::string& entity) {
    text_ += fmt::format("#{}={};\n", ++count_, entity);
    return fmt::format("#{}", count_);
  }

  /// A real of the exchange format: a point, and no more digits than micrometres need.
  static std::string real(double value) {
    std::string text = fmt::format("{:.6f}", value);
    while (text.back() == '0') text.pop_back();
    return text == "-0." ? "0." : text;
  }
  [[nodiscard]] std::string length(double metres) const { return real(scale_ * metres); }

  std::string point(const Vector3d& x) {
    return add(fmt::format("IFCCARTESIANPOINT(({},{},{}))", length(x.x()), length(x.y()), length(x.z())));
  }
  std::string direction(const Vector3d& d) {
    return add(fmt::format("IFCDIRECTION(({},{},{}))", real(d.x()), real(d.y()), real(d.z())));
  }
  std::string placement(const PlaneFrame& frame) {
    const std::string origin = point(frame.origin);
    const std::string axis = direction(frame.u.cross(frame.v));
    return add(fmt::format("IFCAXIS2PLACEMENT3D({},{},{})", origin, axis, direction(frame.u)));
  }
  std::string local_placement(const std::string& parent, const PlaneFrame& frame) {
    return add(fmt::format("IFCLOCALPLACEMENT({},{})", parent, placement(frame)));
  }

  std::string polyline(const Ring& ring) {
    std::vector<std::string> points;
    for (const Vector2d& p : ring)
      points.push_back(add(fmt::format("IFCCARTESIANPOINT(({},{}))", length(p.x()), length(p.y()))));
    points.push_back(points.front());
    return add(fmt::format("IFCPOLYLINE(({}))", fmt::join(points, ",")));
  }

  std::string profile(const Polygon& polygon) {
    const std::string outer = polyline(polygon.outer);
    if (polygon.holes.empty()) return add(fmt::format("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,{})", outer));
    std::vector<std::string> holes;
    for (const Ring& hole : polygon.holes) holes.push_back(polyline(hole));
    return add(
        fmt::format("IFCARBITRARYPROFILEDEFWITHVOIDS(.AREA.,$,{},({}))", outer, fmt::join(holes, ",")));
  }

  /// Coordinates are about the storey's floor.
  std::string shape(const std::vector<BimPrism>& solids, int storey) {
    std::vector<std::string> items;
    for (const BimPrism& solid : solids) {
      PlaneFrame base = solid.base;
      base.origin.z() -= recipe_.storeys[static_cast<std::size_t>(storey)].elevation_m;
      const std::string area = profile(solid.profile);
      const std::string place = placement(base);
      items.push_back(
          add(fmt::format("IFCEXTRUDEDAREASOLID({},{},{},{})", area, place, up_, length(solid.depth_m))));
    }
    const std::string body = add(
        fmt::format("IFCSHAPEREPRESENTATION({},'Body','SweptSolid',({}))", context_, fmt::join(items, ",")));
    return add(fmt::format("IFCPRODUCTDEFINITIONSHAPE($,$,({}))", body));
  }

  std::string next_guid() { return recipe_guid(recipe_, RecipePart::relation, relations_++); }

  void write_frame() {
    up_ = direction(Vector3d::UnitZ());
    const std::string world = placement(PlaneFrame{});
    context_ = add(fmt::format("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,{},$)", world));
    const char* prefix = unit_ == IfcUnit::metre ? "$" : ".MILLI.";
    const std::string metre = add(fmt::format("IFCSIUNIT(*,.LENGTHUNIT.,{},.METRE.)", prefix));
    const std::string area = add("IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.)");
    const std::string volume = add("IFCSIUNIT(*,.VOLUMEUNIT.,$,.CUBIC_METRE.)");
    const std::string angle = add("IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.)");
    const std::string units =
        add(fmt::format("IFCUNITASSIGNMENT(({},{},{},{}))", metre, area, volume, angle));
    project_ = add(
        fmt::format("IFCPROJECT('{}',$,'{}',$,$,$,$,({}),{})", next_guid(), recipe_.name, context_, units));
    const std::string at = local_placement("$", PlaneFrame{});
    site_ = add(fmt::format("IFCSITE('{}',$,'Site',$,$,{},$,$,.ELEMENT.,$,$,$,$,$)", next_guid(), at));
    const std::string inside = local_placement(at, PlaneFrame{});
    building_ = add(fmt::format("IFCBUILDING('{}',$,'{}',$,$,{},$,$,.ELEMENT.,$,$,$)", next_guid(),
                                recipe_.name, inside));
    for (const RecipeStorey& storey : recipe_.storeys) {
      const PlaneFrame floor{{0.0, 0.0, storey.elevation_m}, Vector3d::UnitX(), Vector3d::UnitY()};
      storey_placements_.push_back(local_placement(inside, floor));
      storeys_.push_back(
          add(fmt::format("IFCBUILDINGSTOREY('{}',$,'{}',$,$,{},$,$,.ELEMENT.,{})", next_guid(), storey.name,
                          storey_placements_.back(), length(storey.elevation_m))));
    }
  }

  /// The attributes that follow the tag, by the element's type.
  [[nodiscard]] std::string further_attributes(const RecipeElement& element) const {
    const Box2 box = box_of(std::vector<Polygon>{element.solids[0].profile});
    const std::string size = length(box.high.y() - box.low.y()) + "," + length(box.high.x() - box.low.x());
    switch (element.kind) {
      case BimKind::window:
        return size + ",.WINDOW.,.NOTDEFINED.,$";
      case BimKind::door:
        return size + ",.DOOR.,.NOTDEFINED.,$";
      case BimKind::slab:
        return ".FLOOR.";
      case BimKind::roof:
        return ".ROOF.";
      case BimKind::column:
        return ".COLUMN.";
      case BimKind::stair:
        return "$,$,$,$,.STRAIGHT.";
      default:
        return ".NOTDEFINED.";
    }
  }

  std::string write_element(std::size_t index) {
    const RecipeElement& element = recipe_.elements[index];
    const std::string type = upper_case(element.type);
    const std::string at =
        local_placement(storey_placements_[static_cast<std::size_t>(element.storey)], PlaneFrame{});
    placements_.push_back(at);
    const std::string body = shape(element.solids, element.storey);
    return add(fmt::format("{}('{}',$,'{}',$,$,{},{},$,{})", type,
                           recipe_guid(recipe_, RecipePart::element, index), element.name, at, body,
                           further_attributes(element)));
  }

  void write_opening(std::size_t index) {
    const RecipeOpening& opening = recipe_.openings[index];
    const auto host = static_cast<std::size_t>(opening.host);
    const std::string at = local_placement(placements_[host], PlaneFrame{});
    const std::string body = shape({opening.solid}, recipe_.elements[host].storey);
    const std::string hole =
        add(fmt::format("IFCOPENINGELEMENT('{}',$,'Opening {}',$,$,{},{},$,.OPENING.)",
                        recipe_guid(recipe_, RecipePart::opening, index), index + 1, at, body));
    add(fmt::format("IFCRELVOIDSELEMENT('{}',$,$,$,{},{})", next_guid(), elements_[host], hole));
    if (opening.filling >= 0)
      add(fmt::format("IFCRELFILLSELEMENT('{}',$,$,$,{},{})", next_guid(), hole,
                      elements_[static_cast<std::size_t>(opening.filling)]));
  }

  void aggregate(const std::string& whole, const std::vector<std::string>& parts) {
    if (!parts.empty())
      add(fmt::format("IFCRELAGGREGATES('{}',$,$,$,{},({}))", next_guid(), whole, fmt::join(parts, ",")));
  }

  void write_structure() {
    aggregate(project_, {site_});
    aggregate(site_, {building_});
    aggregate(building_, storeys_);
    for (std::size_t storey = 0; storey < storeys_.size(); ++storey) {
      std::vector<std::string> spaces;
      for (std::size_t i = 0; i < recipe_.spaces.size(); ++i) {
        const RecipeSpace& space = recipe_.spaces[i];
        if (space.storey != static_cast<int>(storey)) continue;
        const std::string at = local_placement(storey_placements_[storey], PlaneFrame{});
        const std::string body = shape({space.solid}, space.storey);
        spaces.push_back(
            add(fmt::format("IFCSPACE('{}',$,'{}',$,$,{},{},'{}',.ELEMENT.,.INTERNAL.,$)",
                            recipe_guid(recipe_, RecipePart::space, i), space.number, at, body, space.name)));
      }
      aggregate(storeys_[storey], spaces);
      std::vector<std::string> contained;
      for (std::size_t i = 0; i < elements_.size(); ++i)
        if (recipe_.elements[i].storey == static_cast<int>(storey)) contained.push_back(elements_[i]);
      add(fmt::format("IFCRELCONTAINEDINSPATIALSTRUCTURE('{}',$,$,$,({}),{})", next_guid(),
                      fmt::join(contained, ","), storeys_[storey]));
    }
  }

  const BimRecipe& recipe_;
  IfcUnit unit_;
  double scale_;
  std::string text_;
  std::size_t count_ = 0;
  std::size_t relations_ = 0;
  std::string up_;
  std::string context_;
  std::string project_;
  std::string site_;
  std::string building_;
  std::vector<std::string> storeys_;
  std::vector<std::string> storey_placements_;
  std::vector<std::string> elements_;
  std::vector<std::string> placements_;
};

}  // namespace

std::string ifc_text(const BimRecipe& recipe, IfcUnit unit) {
  return IfcWriter(recipe, unit).run();
}

}  // namespace limen
