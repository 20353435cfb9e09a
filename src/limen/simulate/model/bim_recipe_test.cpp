// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_recipe.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "limen/base/atomic_file.h"
#include "limen/bim/read_bim.h"

namespace limen {
namespace {

struct Sums {
  Vector3d normals = Vector3d::Zero();
  double area = 0.0;
  double volume = 0.0;
};

Sums sums_of(const BimModel& model, std::size_t element) {
  Sums sums;
  for (const BimFace& face : model.faces) {
    if (face.element != static_cast<int>(element)) continue;
    sums.normals += face.area_m2 * face.plane.normal;
    sums.area += face.area_m2;
    sums.volume += face.area_m2 * face.plane.offset / 3.0;
  }
  return sums;
}

double prism_volume(const BimPrism& prism) {
  return area(prism.profile) * prism.depth_m;
}

TEST(BimRecipe, EveryElementOfTheOfficeIsClosedAndHasItsVolume) {
  const BimRecipe recipe = office_recipe();
  const BimModel model = model_of(recipe);
  ASSERT_EQ(model.elements.size(), recipe.elements.size());
  for (std::size_t i = 0; i < recipe.elements.size(); ++i) {
    double volume = 0.0;
    for (const BimPrism& solid : recipe.elements[i].solids) volume += prism_volume(solid);
    for (const RecipeOpening& opening : recipe.openings)
      if (opening.host == static_cast<int>(i)) volume -= prism_volume(opening.solid);
    const Sums sums = sums_of(model, i);
    // Clipping rounds to 10 um.
    EXPECT_LT(sums.normals.norm(), 1e-4) << recipe.elements[i].name;
    EXPECT_NEAR(sums.volume, volume, 1e-3) << recipe.elements[i].name;
  }
}

TEST(BimRecipe, OpeningsLieOnTheirWallsAndHoldTheirFillings) {
  const BimModel model = model_of(office_recipe());
  EXPECT_GT(model.openings.size(), 40U);
  for (const BimOpening& opening : model.openings) {
    ASSERT_GE(opening.host, 0);
    const Vector3d right = (opening.corners[1] - opening.corners[0]).normalized();
    const Vector3d up = (opening.corners[3] - opening.corners[0]).normalized();
    EXPECT_GT(right.cross(up).dot(opening.normal), 0.999);
    EXPECT_GT(up.z(), 0.999);
    for (const double depth : {0.0, opening.thickness_m}) {
      // A face of the host lies there, looking along the normal or against it.
      const Vector3d at = opening.corners[0] - depth * opening.normal;
      const Vector3d normal = depth == 0.0 ? opening.normal : Vector3d(-opening.normal);
      EXPECT_TRUE(std::any_of(model.faces.begin(), model.faces.end(), [&](const BimFace& face) {
        return face.element == opening.host && face.plane.normal.dot(normal) > 0.999 &&
               std::abs(face.plane.signed_distance(at)) < 1e-6;
      }));
    }
  }
}

TEST(WriteIfc, EveryReferenceIsDefinedBeforeAndGuidsAreUnique) {
  const std::string text = ifc_text(office_recipe());
  std::set<std::string> defined;
  std::set<std::string> guids;
  std::size_t begin = text.find("DATA;\n") + 6;
  const std::regex reference("#[0-9]+");
  const std::regex guid("^[A-Z0-9]+\\('([0-3][0-9A-Za-z_$]{21})',");
  while (text.compare(begin, 6, "ENDSEC") != 0) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t equals = line.find('=');
    const std::string body = line.substr(equals + 1);
    ASSERT_EQ(line.back(), ';');
    ASSERT_EQ(std::count(body.begin(), body.end(), '('), std::count(body.begin(), body.end(), ')')) << line;
    for (std::sregex_iterator it(body.begin(), body.end(), reference), last; it != last; ++it)
      ASSERT_TRUE(defined.count(it->str()) == 1) << line;
    std::smatch match;
    if (std::regex_search(body, match, guid)) {
      ASSERT_TRUE(guids.insert(match[1]).second) << line;
    }
    defined.insert(line.substr(0, equals));
  }
  EXPECT_GT(guids.size(), 150U);
}

#ifdef LIMEN_WITH_IFC
/// Area of the upright faces of walls, reveals included.
double wall_area(const BimModel& model) {
  double sum = 0.0;
  for (const BimFace& face : model.faces)
    if (model.elements[static_cast<std::size_t>(face.element)].kind == BimKind::wall &&
        std::abs(face.plane.normal.z()) < 0.1)
      sum += face.area_m2;
  return sum;
}

void expect_read_back(IfcUnit unit) {
  const BimModel planned = model_of(office_recipe());
  const auto path = std::filesystem::temp_directory_path() /
                    ("limen-office-" + std::to_string(static_cast<long>(getpid())) + ".ifc");
  write_file(path, ifc_text(office_recipe(), unit));
  const BimModel read = read_bim(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(read.warnings.empty()) << read.warnings.front();
  EXPECT_NEAR(read.metres_per_unit, unit == IfcUnit::metre ? 1.0 : 0.001, 1e-12);
  ASSERT_EQ(read.elements.size(), planned.elements.size());
  EXPECT_EQ(read.openings.size(), planned.openings.size());
  EXPECT_EQ(read.spaces.size(), planned.spaces.size());
  EXPECT_NEAR(wall_area(read), wall_area(planned), 1e-3 * wall_area(planned));
  std::map<std::string, std::size_t> by_guid;
  for (std::size_t i = 0; i < read.elements.size(); ++i) by_guid[read.elements[i].guid] = i;
  for (std::size_t i = 0; i < planned.elements.size(); ++i) {
    ASSERT_EQ(by_guid.count(planned.elements[i].guid), 1U);
    const std::size_t other = by_guid[planned.elements[i].guid];
    EXPECT_EQ(read.elements[other].kind, planned.elements[i].kind) << planned.elements[i].name;
    EXPECT_EQ(read.elements[other].storey, planned.elements[i].storey);
    const double volume = sums_of(planned, i).volume;
    EXPECT_NEAR(sums_of(read, other).volume, volume, 1e-3 * volume) << planned.elements[i].name;
  }
}

TEST(WriteIfc, ReadsBackInMetres) {
  expect_read_back(IfcUnit::metre);
}

TEST(WriteIfc, ReadsBackInMillimetres) {
  expect_read_back(IfcUnit::millimetre);
}

TEST(WriteIfc, OpeningsReadBackWhereTheyAre) {
  const BimModel planned = model_of(office_recipe());
  const auto path = std::filesystem::temp_directory_path() /
                    ("limen-openings-" + std::to_string(static_cast<long>(getpid())) + ".ifc");
  write_file(path, ifc_text(office_recipe()));
  const BimModel read = read_bim(path);
  std::filesystem::remove(path);
  for (const BimOpening& opening : planned.openings) {
    const auto same = std::find_if(read.openings.begin(), read.openings.end(),
                                   [&](const BimOpening& o) { return o.guid == opening.guid; });
    ASSERT_NE(same, read.openings.end());
    EXPECT_NEAR(same->thickness_m, opening.thickness_m, 1e-4);
    const auto middle = [&](const BimOpening& o) {
      return Vector3d(0.5 * (o.corners[0] + o.corners[2]) - 0.5 * o.thickness_m * o.normal);
    };
    EXPECT_LT((middle(*same) + read.local_origin - middle(opening)).norm(), 1e-4);
    EXPECT_NEAR((same->corners[1] - same->corners[0]).norm(),
                (opening.corners[1] - opening.corners[0]).norm(), 1e-4);
    EXPECT_EQ(same->filling >= 0, opening.filling >= 0);
  }
}
#endif

}  // namespace
}  // namespace limen
