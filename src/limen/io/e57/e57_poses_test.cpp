// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_poses.h"

#include <cmath>

#include "support/synthetic_e57.h"
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_document.h"

namespace limen {
namespace {

using namespace testing_e57;
using testing_io::slurp;
using testing_io::TemporaryFolder;

const char* const kPose =
    "<pose type=\"Structure\"><!-- <pose> --><translation type='a>b'><x type=\"Float\">10</x></translation>"
    "<rotation type=\"Structure\"><w type=\"Float\">1</w><x type=\"Float\"/><z "
    "type=\"Float\">1</z></rotation></pose>";

ScanParts scan(const std::string& before, std::size_t count = 500) {
  ScanParts parts;
  parts.points = count;
  parts.before_points = before;
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"}) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(i) + name[9]);
    parts.columns.push_back(float_column(name, values));
  }
  return parts;
}

Rigid3 motion() {
  return {rotation_exp({0.3, -0.2, 1.1}), {1051234.25, 6841999.5, -3.125}};
}

struct Moved {
  std::string bytes;
  MovedE57 about;
};

Moved moved(const std::string& bytes, const Rigid3& target_from_source) {
  const TemporaryFolder folder;
  Moved result;
  result.about = replace_e57_poses(bytes, "in.e57", target_from_source, folder / "out.e57");
  result.bytes = slurp(folder / "out.e57");
  return result;
}

std::string xml_in(const std::string& bytes) {
  return e57_xml(E57Pages(bytes, "it"));
}

/// The description without its poses.
std::string without_poses(std::string xml) {
  for (std::size_t at = 0; (at = xml.find("<pose ")) != std::string::npos;) {
    const std::size_t end = xml.find("</pose>", at) + 7;
    xml.erase(at, end - at + (xml[end] == '\n' ? 1 : 0));
  }
  return xml;
}

std::string payloads(const std::string& bytes, std::size_t page_bytes) {
  std::string logical;
  for (std::size_t at = 0; at < bytes.size(); at += page_bytes) logical += bytes.substr(at, page_bytes - 4);
  return logical;
}

void expect_moved(const std::string& before, const Moved& after) {
  const auto old_file = open_e57(before, "in.e57");
  const auto new_file = open_e57(after.bytes, "out.e57");
  ASSERT_EQ(new_file->clouds().size(), old_file->clouds().size());
  EXPECT_EQ(after.about.scans, old_file->clouds().size());
  for (std::size_t k = 0; k < old_file->clouds().size(); ++k) {
    EXPECT_EQ(read_all(*old_file, k), read_all(*new_file, k));
    const Rigid3 expected = motion() * old_file->clouds()[k].table.pose.value_or(Rigid3{});
    const Rigid3 found = new_file->clouds()[k].table.pose.value();
    EXPECT_LT((found.rotation - expected.rotation).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(found.translation, expected.translation);
  }
}

TEST(E57Poses, OnlyThePosesDiffer) {
  for (const std::size_t page_bytes : {64UL, 1024UL}) {
    Layout layout;
    layout.page_bytes = page_bytes;
    layout.root = "<odd a='1' b=\"&amp;\"><![CDATA[<pose>]]></odd>\n";
    const std::string before =
        file_of({scan(kPose), scan(""), scan("<name type=\"String\">c</name>")}, layout);
    const Moved after = moved(before, motion());
    expect_moved(before, after);
    EXPECT_EQ(after.about.points, 1500U);
    EXPECT_EQ(without_poses(xml_in(after.bytes)), without_poses(xml_in(before)));
    // All up to the description is the same, but for the head.
    const E57Head head = E57Pages(before, "it").head();
    EXPECT_EQ(after.bytes.substr(page_bytes, head.xml_offset - page_bytes),
              before.substr(page_bytes, head.xml_offset - page_bytes));
    EXPECT_EQ(after.bytes.substr(48, page_bytes - 52), before.substr(48, page_bytes - 52));
  }
}

TEST(E57Poses, DescriptionsBeforeThePoints) {
  Layout layout;
  layout.xml_first = true;
  // No room for a pose: the new description goes behind all.
  std::string before = file_of({scan(""), scan(kPose)}, layout);
  Moved after = moved(before, motion());
  expect_moved(before, after);
  EXPECT_EQ(after.bytes.substr(1024, before.size() - 1024), before.substr(1024));
  EXPECT_EQ(E57Pages(after.bytes, "it").head().xml_offset, before.size());
  // Room enough: it stays where it was.
  const std::string comment = "<!--" + std::string(600, 'x') + "-->";
  std::string pose = kPose;
  pose.insert(pose.find("</pose>"), comment);
  before = file_of({scan(pose)}, layout);
  after = moved(before, motion());
  expect_moved(before, after);
  EXPECT_EQ(after.bytes.size(), before.size());
  const std::size_t xml_end = 48 + E57Pages(before, "it").head().xml_bytes;
  EXPECT_EQ(payloads(after.bytes, 1024).substr(xml_end), payloads(before, 1024).substr(xml_end));
}

TEST(E57Poses, ByteOrderMarksStay) {
  Layout layout;
  layout.marked = true;
  const std::string before = file_of({scan(kPose), scan("")}, layout);
  const Moved after = moved(before, motion());
  expect_moved(before, after);
  EXPECT_EQ(without_poses(xml_in(after.bytes)), without_poses(xml_in(before)));
  EXPECT_EQ(xml_in(after.bytes).substr(0, 4), "\xEF\xBB\xBF<");
}

TEST(E57Poses, ImagesMoveToo) {
  Layout layout;
  layout.images =
      "<vectorChild type=\"Structure\"><guid/><pinholeRepresentation/></vectorChild>"
      "<vectorChild type=\"Structure\"><guid/>" +
      std::string(kPose) +
      "</vectorChild>"
      "<vectorChild type=\"Structure\"><visualReferenceRepresentation/></vectorChild>"
      "<vectorChild type=\"Structure\"/>";
  const std::string before = file_of({scan(kPose)}, layout);
  const Moved after = moved(before, motion());
  EXPECT_EQ(after.about.images, 4U);
  const E57Document document = parse_e57_document(xml_in(after.bytes), "it");
  ASSERT_EQ(document.images.size(), 4U);
  EXPECT_EQ(document.images[0].pose->translation, motion().translation);
  EXPECT_EQ(document.images[1].pose->translation, (motion() * Vector3d(10, 0, 0)));
  EXPECT_FALSE(document.images[2].pose.has_value());
  EXPECT_FALSE(document.images[3].pose.has_value());
}

TEST(E57Poses, ThereAndBack) {
  const std::string before = file_of({scan(kPose)});
  const Moved there = moved(before, motion());
  const Moved back = moved(there.bytes, inverse(motion()));
  const auto file = open_e57(back.bytes, "it");
  const Rigid3 pose = file->clouds()[0].table.pose.value();
  EXPECT_LT((pose.translation - Vector3d(10, 0, 0)).norm(), 1e-8);
  EXPECT_LT((pose.rotation - rotation_exp({0, 0, std::acos(0.0)})).norm(), 1e-14);
}

TEST(E57Poses, ACoordinateSystemIsNamed) {
  const TemporaryFolder folder;
  const std::string source = file_of({scan(kPose)});
  const std::string wkt = "PROJCS[\"a <b> & c\",UNIT[\"metre\",1]]";
  (void)replace_e57_poses(source, "in.e57", motion(), folder / "out.e57", silent_monitor(), wkt);
  const std::string once = testing_io::slurp(folder / "out.e57");
  EXPECT_EQ(e57_coordinate_systems(once, "out.e57"), std::vector<std::string>{wkt});
  // Another one takes its place, and without one it stays.
  (void)replace_e57_poses(once, "in.e57", motion(), folder / "again.e57", silent_monitor(), "PROJCS[\"d\"]");
  EXPECT_EQ(e57_coordinate_systems(testing_io::slurp(folder / "again.e57"), "again.e57"),
            std::vector<std::string>{"PROJCS[\"d\"]"});
  (void)replace_e57_poses(once, "in.e57", motion(), folder / "kept.e57");
  EXPECT_EQ(e57_coordinate_systems(testing_io::slurp(folder / "kept.e57"), "kept.e57"),
            std::vector<std::string>{wkt});
  // XML has no other bytes than those of UTF-8.
  (void)replace_e57_poses(source, "in.e57", motion(), folder / "latin.e57", silent_monitor(),
                          "PROJCS[\"S\xfc"
                          "d\"]");
  EXPECT_EQ(e57_coordinate_systems(testing_io::slurp(folder / "latin.e57"), "latin.e57"),
            std::vector<std::string>{"PROJCS[\"S\xEF\xBF\xBD"
                                     "d\"]"});
  EXPECT_EQ(
      with_coordinate_system("<e57Root><coordinateMetadata type=\"String\"/><data3D/></e57Root>", "W"),
      "<e57Root><coordinateMetadata type=\"String\"><![CDATA[W]]></coordinateMetadata><data3D/></e57Root>");
}

TEST(E57Poses, DamageIsNamedAndNothingIsLeft) {
  const TemporaryFolder folder;
  const std::string sound = file_of({scan(kPose)});
  for (const std::size_t page : {std::size_t{0}, std::size_t{5}, sound.size() / 1024 - 1}) {
    std::string bytes = sound;
    bytes[1024 * page + 400] ^= 1;
    try {
      (void)replace_e57_poses(bytes, "in.e57", motion(), folder / "out.e57");
      ADD_FAILURE() << page;
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find(fmt::format("page {} of", page)), std::string::npos) << error.what();
    }
  }
  for (std::size_t size = 0; size < sound.size(); size += 370) {
    EXPECT_THROW((void)replace_e57_poses(sound.substr(0, size), "in.e57", motion(), folder / "out.e57"),
                 Error);
  }
  EXPECT_EQ(folder.files(), 0U);
}

}  // namespace
}  // namespace limen
