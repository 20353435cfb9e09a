// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/bcf/bcf_file.h"

#include <string>

#include "support/bcf_check.h"
#include <gtest/gtest.h>

#include "limen/files/zip.h"

namespace limen {
namespace {

std::vector<BcfTopic> two_topics() {
  BcfTopic wall;
  wall.key = "wall";
  wall.title = "Moved by 23 mm: Wall <A> & \"B\"";
  wall.description = "It stands\nelsewhere.\x01";
  wall.label = "moved";
  wall.priority = "medium";
  wall.model = "house.ifc";
  wall.ifc_guid = "2O2Fr$t4X7Zf8NOew3FNbT";
  wall.colour = "E07000";
  wall.camera = looking_at({1, 2, 3}, {4, 2, 2});
  BcfTopic object;
  object.key = "matter";
  object.title = "Not in the model";
  object.lines = edges_of({0, 0, 0}, {1, 2, 3});
  object.camera = looking_at({0, 0, 5}, {0, 0, 0});
  return {wall, object};
}

constexpr const char* kDate = "2026-03-01T12:00:00Z";

std::string joined(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += fault + "\n";
  return text;
}

/// The archive with one of its texts changed.
std::string with_change(const std::string& member, const std::string& from, const std::string& to) {
  std::vector<ZipFile> files;
  for (const auto& [name, text] : bcf_members(bcf_file(two_topics(), kDate))) {
    std::string changed = text;
    const std::size_t at = name.ends_with(member) ? changed.find(from) : std::string::npos;
    if (at != std::string::npos) changed.replace(at, from.size(), to);
    files.push_back({name, changed});
  }
  return zipped(files);
}

TEST(BcfFile, IsWhatTheStandardAsksFor) {
  const std::string bytes = bcf_file(two_topics(), kDate);
  EXPECT_EQ(joined(bcf_faults(bytes)), "");
  EXPECT_EQ(bcf_members(bytes).size(), 5U);
  EXPECT_EQ(bcf_file(two_topics(), kDate), bytes);
  EXPECT_EQ(joined(bcf_faults(bcf_file({}, kDate))), "");
}

TEST(BcfFile, WhatIsSaidComesThrough) {
  std::string markup;
  std::string view;
  for (const auto& [name, text] : bcf_members(bcf_file({two_topics().front()}, kDate))) {
    if (name.ends_with("markup.bcf")) markup = text;
    if (name.ends_with("viewpoint.bcfv")) view = text;
  }
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(markup.c_str()));
  const pugi::xml_node topic = document.child("Markup").child("Topic");
  EXPECT_STREQ(topic.child("Title").text().get(), "Moved by 23 mm: Wall <A> & \"B\"");
  EXPECT_STREQ(topic.child("Description").text().get(), "It stands\nelsewhere. ");
  EXPECT_STREQ(topic.child("CreationDate").text().get(), kDate);
  EXPECT_STREQ(document.child("Markup").child("Header").child("File").child("Filename").text().get(),
               "house.ifc");
  ASSERT_TRUE(document.load_string(view.c_str()));
  const pugi::xml_node info = document.child("VisualizationInfo");
  EXPECT_STREQ(info.child("Components").child("Selection").child("Component").attribute("IfcGuid").value(),
               "2O2Fr$t4X7Zf8NOew3FNbT");
  EXPECT_EQ(info.child("PerspectiveCamera").child("CameraViewPoint").child("Y").text().as_double(), 2.0);
}

TEST(BcfFile, TheChecksFindWhatIsWrong) {
  EXPECT_NE(joined(bcf_faults(with_change("bcf.version", "2.1", "3.0"))), "");
  EXPECT_NE(joined(bcf_faults(with_change("markup.bcf", "<Title>", "<Titel>"))), "");
  EXPECT_NE(joined(bcf_faults(with_change("markup.bcf", kDate, "1 March"))), "");
  EXPECT_NE(joined(bcf_faults(with_change("viewpoint.bcfv", ">60<", ">90<"))), "");
  EXPECT_NE(joined(bcf_faults(with_change("viewpoint.bcfv", "2O2Fr$t4X7", "2O2Fr$t4X"))), "");
  EXPECT_NE(joined(bcf_faults(with_change("viewpoint.bcfv", "Guid=\"", "Guid=\"0"))), "");
  EXPECT_NE(joined(bcf_faults(with_change("markup.bcf", "TopicStatus", "Status"))), "");
  EXPECT_NE(joined(bcf_faults(zipped({{"readme", ""}}))), "");
}

TEST(BcfFile, CamerasStandAcrossTheirView) {
  for (const Vector3d& place : {Vector3d(1, 2, 3), Vector3d(4, 2, 2), Vector3d(4, 2, 9)}) {
    const BcfCamera camera = looking_at(place, {4, 2, 2});
    EXPECT_NEAR(camera.direction.norm(), 1.0, 1e-12);
    EXPECT_NEAR(camera.up.norm(), 1.0, 1e-12);
    EXPECT_NEAR(camera.up.dot(camera.direction), 0.0, 1e-12);
    EXPECT_GT(camera.direction.dot(Vector3d(4, 2, 2) - camera.place), 0.2);
  }
  EXPECT_EQ(edges_of({0, 0, 0}, {1, 2, 3}).size(), 12U);
}

}  // namespace
}  // namespace limen
