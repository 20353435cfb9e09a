// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/read_ifc.h"

#include <cstdlib>
#include <string>
#include <thread>

#include "support/test_support.h"
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "limen/base/error.h"
#include "limen/bim/ifc/ifc_process.h"
#include "limen/bim/read_bim.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

/// What a small house of one wall is written with.
struct WallFile {
  std::string schema = "IFC4";
  double units_per_metre = 1.0;
  std::string length_unit = "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)";
  std::string more;  ///< further entities from #200 on
  std::string wall_name = "'Wall 1'";
  std::string opening_z = "0.9";  ///< metres; the opening is 1 m high
};

/// A wall of 4 x 0.3 x 2.5 m along x from (10, 20, 0), in it a window of 1.2 x 1.0 m; a slab and a room.
std::string text_of(const WallFile& file) {
  const auto len = [&](double metres) { return fmt::format("{:.9f}", metres * file.units_per_metre); };
  const double z = std::stod(file.opening_z);
  std::string text =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('a','',(''),(''),'','','');\n";
  text += fmt::format("FILE_SCHEMA(('{}'));\nENDSEC;\nDATA;\n", file.schema);
  text += "#1=IFCPROJECT('0000000000000000000001',$,'p',$,$,$,$,(#5),#6);\n";
  text += "#2=IFCCARTESIANPOINT((0.,0.,0.));\n#3=IFCAXIS2PLACEMENT3D(#2,$,$);\n";
  text += "#5=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#3,$);\n#6=IFCUNITASSIGNMENT((#7,#8));\n";
  text += fmt::format("#7={};\n#8=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n", file.length_unit);
  text += fmt::format("#10=IFCCARTESIANPOINT(({},{},0.));\n", len(10.0), len(20.0));
  text +=
      "#11=IFCAXIS2PLACEMENT3D(#10,$,$);\n#12=IFCLOCALPLACEMENT($,#11);\n#13=IFCLOCALPLACEMENT(#12,#3);\n";
  text += "#14=IFCSITE('0000000000000000000002',$,'site',$,$,#12,$,$,.ELEMENT.,(49,0,0),(8,0,0),0.,$,$);\n";
  text +=
      "#15=IFCBUILDINGSTOREY('0000000000000000000003',$,'Erdgescho\\X2\\00DF\\X0\\',$,$,#13,$,$,.ELEMENT.,0.)"
      ";\n";
  text += "#16=IFCRELAGGREGATES('0000000000000000000004',$,$,$,#1,(#14));\n";
  text += "#17=IFCRELAGGREGATES('0000000000000000000005',$,$,$,#14,(#15));\n";
  text += "#20=IFCDIRECTION((0.,0.,1.));\n";
  const auto box = [&](int id, const Vector3d& low, const Vector3d& size) {
    std::string part =
        fmt::format("#{}=IFCCARTESIANPOINT(({},{}));\n", id, len(0.5 * size.x()), len(0.5 * size.y()));
    part += fmt::format("#{}=IFCAXIS2PLACEMENT2D(#{},$);\n", id + 1, id);
    part += fmt::format("#{}=IFCRECTANGLEPROFILEDEF(.AREA.,$,#{},{},{});\n", id + 2, id + 1, len(size.x()),
                        len(size.y()));
    part +=
        fmt::format("#{}=IFCCARTESIANPOINT(({},{},{}));\n", id + 3, len(low.x()), len(low.y()), len(low.z()));
    part += fmt::format("#{}=IFCAXIS2PLACEMENT3D(#{},$,$);\n", id + 4, id + 3);
    part += fmt::format("#{}=IFCEXTRUDEDAREASOLID(#{},#{},#20,{});\n", id + 5, id + 2, id + 4, len(size.z()));
    part += fmt::format("#{}=IFCSHAPEREPRESENTATION(#5,'Body','SweptSolid',(#{}));\n", id + 6, id + 5);
    return part + fmt::format("#{}=IFCPRODUCTDEFINITIONSHAPE($,$,(#{}));\n", id + 7, id + 6);
  };
  text += box(30, {0.0, 0.0, 0.0}, {4.0, 0.3, 2.5}) + box(40, {1.4, -0.1, z}, {1.2, 0.5, 1.0});
  text += box(50, {1.4, 0.1, z}, {1.2, 0.1, 1.0}) + box(60, {0.0, 0.0, -0.2}, {4.0, 3.0, 0.2});
  text += box(70, {0.0, 0.3, 0.0}, {4.0, 2.7, 2.5});
  const bool old = file.schema == "IFC2X3";
  text += fmt::format("#100=IFCWALLSTANDARDCASE('0000000000000000000010',$,{},$,$,#13,#37,$", file.wall_name);
  text += old ? ");\n" : ",.STANDARD.);\n";
  text += std::string("#101=IFCOPENINGELEMENT('0000000000000000000011',$,$,$,$,#13,#47,$") +
          (old ? ");\n" : ",.OPENING.);\n");
  text +=
      fmt::format("#102=IFCWINDOW('0000000000000000000012',$,'W',$,$,#13,#57,$,{},{}", len(1.0), len(1.2));
  text += old ? ");\n" : ",.WINDOW.,$,$);\n";
  text += "#103=IFCSLAB('0000000000000000000013',$,'S',$,$,#13,#67,$,.FLOOR.);\n";
  text += "#104=IFCSPACE('0000000000000000000014',$,'1.01',$,$,#13,#77,'Kitchen',.ELEMENT.,.INTERNAL.,$);\n";
  text += "#110=IFCRELVOIDSELEMENT('0000000000000000000020',$,$,$,#100,#101);\n";
  text += "#111=IFCRELFILLSELEMENT('0000000000000000000021',$,$,$,#101,#102);\n";
  text += "#112=IFCRELCONTAINEDINSPATIALSTRUCTURE('0000000000000000000022',$,$,$,(#100,#102,#103),#15);\n";
  text += "#113=IFCRELAGGREGATES('0000000000000000000023',$,$,$,#15,(#104));\n";
  return text + file.more + "ENDSEC;\nEND-ISO-10303-21;\n";
}

WallFile in_millimetres() {
  WallFile file;
  file.units_per_metre = 1000.0;
  file.length_unit = "IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)";
  return file;
}

/// The tests of whole files need limen_ifc, which can be left out of a build.
class ReadIfc : public ::testing::Test {
 protected:
  void SetUp() override {
#ifndef LIMEN_WITH_IFC
    GTEST_SKIP() << "limen is built without limen_ifc";
#endif
  }
  static BimModel model_of(const std::string& text) {
    const TemporaryFolder folder;
    return read_bim(folder.write("model.ifc", text));
  }
};

double area_of(const BimModel& model, std::int32_t element) {
  double sum = 0.0;
  for (const BimFace& face : model.faces) sum += face.element == element ? face.area_m2 : 0.0;
  return sum;
}

double wall_area() {
  const double sides = 2.0 * (4.0 * 2.5 - 1.2 * 1.0);
  const double ends = 2.0 * 0.3 * 2.5 + 2.0 * 0.3 * 4.0;
  return sides + ends + 0.3 * 2.0 * (1.2 + 1.0);
}

void expect_wall(const BimModel& model) {
  ASSERT_EQ(model.elements.size(), 3U);
  EXPECT_EQ(model.elements[0].type, "IfcWallStandardCase");
  EXPECT_EQ(model.elements[0].guid, "0000000000000000000010");
  EXPECT_EQ(model.elements[0].storey, "Erdgescho\xC3\x9F");
  EXPECT_EQ(model.elements[1].kind, BimKind::window);
  EXPECT_EQ(model.elements[2].kind, BimKind::slab);
  EXPECT_NEAR(area_of(model, 0), wall_area(), 2e-3);
  EXPECT_NEAR(area_of(model, 2), 2 * (12.0 + 0.8 + 0.6), 1e-3);
  ASSERT_EQ(model.openings.size(), 1U);
  const BimOpening& opening = model.openings[0];
  EXPECT_EQ(opening.host, 0);
  EXPECT_EQ(opening.filling, 1);
  EXPECT_NEAR(opening.thickness_m, 0.3, 1e-4);
  EXPECT_NEAR((opening.corners[1] - opening.corners[0]).norm(), 1.2, 1e-4);
  EXPECT_NEAR((opening.corners[3] - opening.corners[0]).norm(), 1.0, 1e-4);
  EXPECT_GT(opening.corners[3].z(), opening.corners[0].z());
  // Seen from outside the second corner is to the right of the first.
  const Vector3d right = Vector3d::UnitZ().cross(opening.normal);
  EXPECT_GT((opening.corners[1] - opening.corners[0]).dot(right), 1.19);
  ASSERT_EQ(model.spaces.size(), 1U);
  EXPECT_EQ(model.spaces[0].name, "1.01 Kitchen");
  EXPECT_EQ(model.spaces[0].faces.size(), 6U);
}

Vector3d low_corner(const BimModel& model) {
  Vector3d low = Vector3d::Constant(1e300);
  for (const BimFace& face : model.faces) {
    for (const Vector2d& p : face.outline.outer)
      low = low.cwiseMin(model.local_origin + face.frame.to_space(p));
  }
  return low;
}

TEST_F(ReadIfc, WallWithAWindowInMetres) {
  const BimModel model = model_of(text_of({}));
  expect_wall(model);
  EXPECT_EQ(model.schema, "IFC4");
  EXPECT_TRUE(model.warnings.empty()) << model.warnings.front();
  EXPECT_NEAR((low_corner(model) - Vector3d(10.0, 20.0, -0.2)).norm(), 0.0, 1e-4);
  EXPECT_FALSE(model.georeferenced);
}

TEST_F(ReadIfc, RevealsLookIntoTheOpening) {
  const BimModel model = model_of(text_of({}));
  const Vector3d middle = Vector3d(12.0, 20.15, 1.4) - model.local_origin;
  int reveals = 0;
  for (const BimFace& face : model.faces) {
    if (face.element != 0 || face.area_m2 > 0.4) continue;
    ++reveals;
    EXPECT_GT(face.plane.signed_distance(middle), 0.0);
  }
  EXPECT_EQ(reveals, 4);
}

TEST_F(ReadIfc, MillimetresOfAnOldSchema) {
  WallFile file = in_millimetres();
  file.schema = "IFC2X3";
  const BimModel model = model_of(text_of(file));
  expect_wall(model);
  EXPECT_DOUBLE_EQ(model.metres_per_unit, 0.001);
  EXPECT_NEAR((low_corner(model) - Vector3d(10.0, 20.0, -0.2)).norm(), 0.0, 1e-4);
}

TEST_F(ReadIfc, Feet) {
  WallFile file;
  file.units_per_metre = 1.0 / 0.3048;
  file.length_unit = "IFCCONVERSIONBASEDUNIT(#200,.LENGTHUNIT.,'FOOT',#201)";
  file.more =
      "#200=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n#201=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(304.8),#202);\n"
      "#202=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);\n";
  const BimModel model = model_of(text_of(file));
  expect_wall(model);
  EXPECT_NEAR(model.metres_per_unit, 0.3048, 1e-12);
  EXPECT_NEAR((low_corner(model) - Vector3d(10.0, 20.0, -0.2)).norm(), 0.0, 1e-4);
}

TEST_F(ReadIfc, MapConversionIsAppliedOnce) {
  WallFile file = in_millimetres();
  // A quarter turn: x to the north, y to the west.
  file.more =
      "#200=IFCPROJECTEDCRS('EPSG:25832',$,$,$,$,$,#201);\n#201=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
      "#202=IFCMAPCONVERSION(#5,#200,500000.,5400000.,110.,0.,1.,0.001);\n";
  const BimModel model = model_of(text_of(file));
  EXPECT_TRUE(model.georeferenced);
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_NEAR(area_of(model, 0), wall_area(), 2e-3);
  EXPECT_NEAR((low_corner(model) - Vector3d(500000.0 - 23.0, 5400010.0, 109.8)).norm(), 0.0, 2e-4);
}

TEST_F(ReadIfc, AMapConversionsScaleSaysTheUnitOfTheMapWhereNothingElseDoes) {
  WallFile file = in_millimetres();
  file.more =
      "#200=IFCPROJECTEDCRS('EPSG:25832',$,$,$,$,$,$);\n"
      "#202=IFCMAPCONVERSION(#5,#200,500000.,5400000.,110.,1.,0.,0.001);\n";
  const BimModel metres = model_of(text_of(file));
  EXPECT_TRUE(metres.warnings.empty());
  EXPECT_NEAR((low_corner(metres) - Vector3d(500010.0, 5400020.0, 109.8)).norm(), 0.0, 2e-4);
  // Without the scale the map is in the project's millimetres.
  file.more =
      "#200=IFCPROJECTEDCRS('EPSG:25832',$,$,$,$,$,$);\n"
      "#202=IFCMAPCONVERSION(#5,#200,500000000.,5400000000.,110000.,1.,0.,$);\n";
  const BimModel millimetres = model_of(text_of(file));
  EXPECT_TRUE(millimetres.warnings.empty());
  EXPECT_NEAR((low_corner(millimetres) - Vector3d(500010.0, 5400020.0, 109.8)).norm(), 0.0, 2e-4);
}

TEST_F(ReadIfc, MapConversionThatForgetsTheUnitsIsStatedOf) {
  WallFile file = in_millimetres();
  file.more =
      "#200=IFCPROJECTEDCRS('EPSG:25832',$,$,$,$,$,#201);\n#201=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
      "#202=IFCMAPCONVERSION(#5,#200,500000.,5400000.,110.,1.,0.,1.);\n";
  const BimModel model = model_of(text_of(file));
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_NE(model.warnings[0].find("scale"), std::string::npos);
  EXPECT_NEAR((low_corner(model) - Vector3d(500010.0, 5400020.0, 109.8)).norm(), 0.0, 2e-4);
}

TEST_F(ReadIfc, AHalfSpaceClipsTheWall) {
  WallFile file;
  // Above z = 2 m is cut off; the wall's own solid is #35.
  file.more =
      "#200=IFCCARTESIANPOINT((0.,0.,2.));\n#201=IFCAXIS2PLACEMENT3D(#200,$,$);\n#202=IFCPLANE(#201);\n"
      "#203=IFCHALFSPACESOLID(#202,.F.);\n#204=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#35,#203);\n";
  std::string text = text_of(file);
  const std::string plain = "'SweptSolid',(#35)";
  text.replace(text.find(plain), plain.size(), "'Clipping',(#204)");
  const BimModel model = model_of(text);
  EXPECT_NEAR(area_of(model, 0), wall_area() - 2.0 * 0.5 * 4.0 - 2.0 * 0.5 * 0.3, 2e-3);
  // A wall reaching to z = 2 m only, the window's top at 1.9 m: all whole.
  EXPECT_EQ(model.openings.size(), 1U);
}

TEST_F(ReadIfc, AnOpeningDownToTheFloorOpensTheFloorSide) {
  WallFile file;
  file.opening_z = "0.0";
  const BimModel model = model_of(text_of(file));
  const double expected = wall_area() - 2.0 * 0.3 * 1.2;
  EXPECT_NEAR(area_of(model, 0), expected, 2e-3);
}

TEST_F(ReadIfc, SameBytesOnEveryRun) {
  const std::string text = text_of({});
  const BimModel first = model_of(text);
  const BimModel second = model_of(text);
  ASSERT_EQ(first.faces.size(), second.faces.size());
  for (std::size_t i = 0; i < first.faces.size(); ++i) {
    EXPECT_EQ(first.faces[i].plane.offset, second.faces[i].plane.offset);
    EXPECT_EQ(first.faces[i].outline.outer, second.faces[i].outline.outer);
  }
}

TEST_F(ReadIfc, NamesOfAllWritings) {
  WallFile file;
  file.wall_name = "'Au\\S\\_enwand ''A'' \\\\ \\X\\E4 W\xE4nde W\xC3\xA4nde \\X2\\0421D83DDE00\\X0\\'";
  const BimModel model = model_of(text_of(file));
  EXPECT_EQ(model.elements[0].name,
            "Au\xC3\x9F"
            "enwand 'A' \\ \xC3\xA4 W\xC3\xA4nde W\xC3\xA4nde \xD0\xA1\xF0\x9F\x98\x80");
}

TEST_F(ReadIfc, DamagedStatementsAreCountedAndTheRestIsRead) {
  std::string text = text_of({});
  text.replace(text.find("#103=IFCSLAB('"), 14, "#103=IFCSLAB('x");  // shifts nothing but the text
  text.replace(text.find("#20=IFCDIRECTION"), 0, "#19=IFCDIRECTION((0.,0.,1.);\n*//*\n");
  const BimModel model = model_of(text);
  EXPECT_EQ(model.elements.size(), 3U);
  EXPECT_NEAR(area_of(model, 0), wall_area(), 2e-3);
  EXPECT_FALSE(model.warnings.empty());
}

TEST_F(ReadIfc, AWallWithoutItsShapeIsNamed) {
  std::string text = text_of({});
  text.erase(text.find("#35="), text.find('\n', text.find("#35=")) - text.find("#35=") + 1);
  const BimModel model = model_of(text);
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_NE(model.warnings[0].find("#100 IfcWallStandardCase"), std::string::npos);
  EXPECT_GT(area_of(model, 2), 26.0);
}

TEST_F(ReadIfc, BuildingsOfIfc4x3AreReadAsIfc4) {
  WallFile file;
  const BimModel before = model_of(text_of(file));
  file.schema = "IFC4X3_ADD2";
  // A pyramid with its flag before the normals, tags behind the points, a type and a unit's name that IFC4
  // lacks.
  file.more =
      "#200=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(4.,0.,0.),(0.,3.,0.),(0.,0.,2.)),$);\n"
      "#201=IFCTRIANGULATEDFACESET(#200,.T.,((0.,0.,1.),(1.,0.,0.),(0.,1.,0.),(0.,0.,1.)),((1,3,2),(1,2,4),("
      "2,3,4),"
      "(3,1,4)),$);\n"
      "#202=IFCSHAPEREPRESENTATION(#5,'Body','Tessellation',(#201));\n#203=IFCPRODUCTDEFINITIONSHAPE($,$,(#"
      "202));\n"
      "#204=IFCCOURSE('0000000000000000000030',$,'C',$,$,#13,#203,$,.PAVEMENT.);\n"
      "#205=IFCDERIVEDUNITELEMENT(#7,2);\n#206=IFCDERIVEDUNIT((#205),.USERDEFINED.,'u','name');\n";
  std::string text = text_of(file);
  text.replace(text.find("((#7,#8))"), 9, "((#7,#8,#206))");
  const BimModel model = model_of(text);
  EXPECT_EQ(model.schema, "IFC4X3_ADD2");
  ASSERT_EQ(model.elements.size(), before.elements.size() + 1);
  EXPECT_EQ(model.warnings, before.warnings);
  for (std::size_t k = 0; k < before.elements.size(); ++k) {
    EXPECT_EQ(model.elements[k].type, before.elements[k].type);
    EXPECT_NEAR(area_of(model, static_cast<std::int32_t>(k)), area_of(before, static_cast<std::int32_t>(k)),
                1e-9);
  }
  EXPECT_EQ(model.openings.size(), before.openings.size());
  EXPECT_EQ(model.spaces.size(), before.spaces.size());
  EXPECT_EQ(model.elements.back().type, "IfcCourse");
  EXPECT_NEAR(area_of(model, static_cast<std::int32_t>(before.elements.size())),
              6.0 + 4.0 + 3.0 + 0.5 * Vector3d(-4, 3, 0).cross(Vector3d(-4, 0, 2)).norm(), 1e-6);
}

TEST_F(ReadIfc, WhatIfc4DoesNotKnowIsLeftOutAndNamed) {
  WallFile file;
  file.schema = "IFC4X3";
  file.more =
      "#200=IFCLINEARPLACEMENT($,#201,$);\n#201=IFCAXIS2PLACEMENTLINEAR(#2,$,$);\n"
      "#202=IFCSLAB('0000000000000000000031',$,'far',$,$,#200,#67,$,.FLOOR.);\n"
      "#203=IFCSECTIONEDSOLIDHORIZONTAL(#2,(),());\n"
      "#204=IFCSHAPEREPRESENTATION(#5,'Body','AdvancedSweptSolid',(#203,#65));\n"
      "#205=IFCPRODUCTDEFINITIONSHAPE($,$,(#204));\n"
      "#206=IFCBEAM('0000000000000000000032',$,'half',$,$,#13,#205,$,.BEAM.);\n";
  const BimModel model = model_of(text_of(file));
  ASSERT_GE(model.warnings.size(), 3U);
  EXPECT_EQ(
      model.warnings[0],
      "IFC4X3 is read as IFC4; elements that need IFCLINEARPLACEMENT, IFCSECTIONEDSOLIDHORIZONTAL are left "
      "out");
  EXPECT_EQ(model.warnings[1], "#202 IfcSlab has no shape that can be read");
  EXPECT_EQ(model.warnings[2], "#206 IfcBeam has no shape that can be read");
  EXPECT_NEAR(area_of(model, 0), wall_area(), 2e-3);
}

TEST_F(ReadIfc, OtherSchemasAndNoGeometryAreRefused) {
  for (const char* schema : {"IFC4X1", "IFC4X3_RC2", "IFC5", "AUTOMOTIVE_DESIGN", ""}) {
    WallFile file;
    file.schema = schema;
    try {
      model_of(text_of(file));
      ADD_FAILURE() << "read as " << schema;
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::input);
      EXPECT_NE(error.remedy().find("OBJ"), std::string::npos);
    }
  }
  EXPECT_THROW(model_of("ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\nENDSEC;\n"), Error);
}

/// A zip archive of one member, stored or deflated.
std::string zip_of(const std::string& name, const std::string& bytes, bool deflated,
                   std::uint32_t claimed = 0) {
  std::string packed = bytes;
  if (deflated) {
    packed.assign(compressBound(bytes.size()) + 64, '\0');
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
  }
  const auto two = [](std::size_t value) { return testing_io::bytes_of(static_cast<std::uint16_t>(value)); };
  const auto four = [](std::size_t value) { return testing_io::bytes_of(static_cast<std::uint32_t>(value)); };
  const auto crc = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
  const std::string facts = two(20) + two(0) + two(deflated ? 8 : 0) + two(0) + two(0) + four(crc) +
                            four(packed.size()) + four(claimed != 0 ? claimed : bytes.size()) +
                            two(name.size()) + two(0);
  const std::string local = "PK\x03\x04" + facts + name + packed;
  const std::string entry =
      "PK\x01\x02" + two(20) + facts + two(0) + two(0) + two(0) + four(0) + four(0) + name;
  return local + entry + "PK\x05\x06" + two(0) + two(0) + two(1) + two(1) + four(entry.size()) +
         four(local.size()) + two(0);
}

TEST_F(ReadIfc, ZipArchivesStoredAndDeflated) {
  const TemporaryFolder folder;
  for (const bool deflated : {false, true}) {
    const auto path = folder.write("model.ifczip", zip_of("house/model.IFC", text_of({}), deflated));
    EXPECT_TRUE(is_bim_file(path));
    expect_wall(read_bim(path));
  }
  EXPECT_FALSE(is_bim_file(folder.write("other.zip", zip_of("readme.txt", "text", true))));
}

TEST(ZipArchives, DamageAndBombsAreErrors) {
  const TemporaryFolder folder;
  const std::string good = zip_of("a.ifc", text_of({}), true);
  std::string flipped = good;
  flipped[good.size() / 3] = static_cast<char>(flipped[good.size() / 3] ^ 0x55);
  EXPECT_THROW(read_bim(folder.write("flipped.ifczip", flipped)), Error);
  // It claims less, or far more, than it holds.
  EXPECT_THROW(read_bim(folder.write("less.ifczip", zip_of("a.ifc", text_of({}), true, 100))), Error);
  EXPECT_THROW(read_bim(folder.write("more.ifczip", zip_of("a.ifc", text_of({}), true, 4000000000U))), Error);
}

TEST_F(ReadIfc, AHelperThatDiesIsAnError) {
  const TemporaryFolder folder;
  const auto fake = [&](const std::string& script) {
    const auto path = folder.write("fake", "#!/bin/sh\n" + script);
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("LIMEN_IFC_HELPER", path.c_str(), 1);
  };
  for (const char* script : {"kill -SEGV $$\n", "exit 7\n", "echo garbage\n", "head -c 100000 /dev/zero\n",
                             "printf 'LIMENIFC1\\nP\\377\\377\\377\\177'\n"}) {
    fake(script);
    try {
      model_of(text_of({}));
      ADD_FAILURE() << script;
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::input) << script;
    }
  }
  setenv("LIMEN_IFC_HELPER", "/no/such/program", 1);
  EXPECT_THROW(model_of(text_of({})), Error);
  unsetenv("LIMEN_IFC_HELPER");
}

TEST_F(ReadIfc, AnEntityThatKillsTheHelperIsLeftOut) {
  const std::string real = find_ifc_helper().string();
  const TemporaryFolder folder;
  // Dies once it has begun with the window, unless it is to skip it.
  const auto path = folder.write(
      "fake",
      "#!/bin/sh\ncase \"$*\" in *102*) exec " + real + " \"$@\";; esac\n" + real +
          " --skip 102 --skip 103 --skip 104 > " + (folder / "out").string() + "\nhead -c -9 " +
          (folder / "out").string() +
          "\nprintf 'B\\010\\000\\000\\000\\146\\000\\000\\000\\000\\000\\000\\000'\nkill -SEGV $$\n");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  setenv("LIMEN_IFC_HELPER", path.c_str(), 1);
  const BimModel model = model_of(text_of({}));
  unsetenv("LIMEN_IFC_HELPER");
  EXPECT_EQ(model.elements.size(), 3U);
  EXPECT_NEAR(area_of(model, 0), wall_area(), 2e-3);
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_NE(model.warnings[0].find("#102 is left out"), std::string::npos) << model.warnings[0];
}

TEST_F(ReadIfc, SilenceAndCancelEndTheHelper) {
  const TemporaryFolder folder;
  const auto path = folder.write("fake", "#!/bin/sh\nexec sleep 100\n");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  setenv("LIMEN_IFC_HELPER", path.c_str(), 1);
  IfcProcessOptions impatient;
  impatient.silence_s = 0.2;
  const IfcRun run = run_ifc_helper("x", {}, impatient);
  EXPECT_FALSE(run.finished);
  EXPECT_NE(run.ended_how.find("without progress"), std::string::npos);
  Monitor monitor;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    monitor.cancel();
  });
  EXPECT_THROW(run_ifc_helper("x", {}, {}, monitor), Error);
  canceller.join();
  unsetenv("LIMEN_IFC_HELPER");
}

}  // namespace
}  // namespace limen
