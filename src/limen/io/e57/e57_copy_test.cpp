// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_copy.h"

#include "support/synthetic_e57.h"
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/io/e57/e57.h"

namespace limen {
namespace {

using namespace testing_e57;
using testing_io::slurp;
using testing_io::TemporaryFolder;

std::string pose_at(int x) {
  return fmt::format(
      "<pose type=\"Structure\"><translation type=\"Structure\"><x "
      "type=\"Float\">{}</x></translation></pose>",
      x);
}

/// A grid of spherical points, some of them invalid, with texts and a column of an extension.
ScanParts grid(const std::string& guid, int x, std::size_t count) {
  ScanParts parts;
  parts.points = count;
  parts.before_points = "<guid type=\"String\"><![CDATA[" + guid +
                        "]]></guid><name type=\"String\">Set-up &amp; " + guid +
                        "</name><sensorVendor type=\"String\">V</sensorVendor>" + pose_at(x);
  std::vector<double> ranges;
  std::vector<double> angles;
  std::vector<std::int64_t> rows;
  std::vector<std::int64_t> states;
  for (std::size_t i = 0; i < count; ++i) {
    ranges.push_back(1.0 + 0.01 * static_cast<double>(i));
    angles.push_back(0.001 * static_cast<double>(i));
    rows.push_back(static_cast<std::int64_t>(i % 7));
    states.push_back(i % 3 == 0 ? 2 : 0);
  }
  parts.columns = {float_column("sphericalRange", ranges),
                   float_column("sphericalAzimuth", angles),
                   float_column("sphericalElevation", angles),
                   integer_column("rowIndex", 0, 3, rows),
                   integer_column("columnIndex", 0, 3, rows),
                   integer_column("ext:quality", -3, 3, rows),
                   integer_column("sphericalInvalidState", 0, 2, states),
                   {"label type=\"String\"", std::string(count, 'a')}};
  return parts;
}

std::string image(const std::string& guid, int blob, std::size_t bytes, const std::string& inside) {
  return fmt::format(
      "<vectorChild type=\"Structure\"><guid type=\"String\">image {0}</guid>{2}<sphericalRepresentation "
      "type=\"Structure\"><jpegImage type=\"Blob\" fileOffset=\"BLOB{0}\" length=\"{1}\"/>"
      "</sphericalRepresentation>{3}</vectorChild>",
      blob, bytes,
      guid.empty() ? "" : "<associatedData3DGuid type=\"String\">" + guid + "</associatedData3DGuid>",
      inside);
}

/// Two stations with an image each that names it, and one that only lies near the second.
std::string two_stations() {
  Layout layout;
  layout.packet_seed = 7;
  layout.blobs = {std::string(5000, 'p'), std::string(2'500'001, 'q'), "r"};
  layout.images =
      image("{B}", 0, 5000, pose_at(21)) + image("{A}", 1, 2'500'001, "") + image("", 2, 1, pose_at(17));
  return file_of({grid("{A}", 10, 500), grid("{B}", 20, 300)}, layout);
}

Rigid3 copy_motion() {
  return {rotation_exp({0.0, 0.0, 1.1}), {1051234.25, 6841999.5, -3.125}};
}

/// What an image holds, by its number in the description.
std::string blob_of(const std::string& bytes, std::size_t number) {
  const E57Pages pages(bytes, "it");
  const std::string xml = e57_xml(pages);
  std::size_t at = xml.find("<images2D");
  for (std::size_t k = 0; k <= number; ++k) at = xml.find("fileOffset=\"", at + 1);
  const std::uint64_t begin = pages.logical_of(std::stoull(xml.substr(at + 12)), "image");
  std::string blob(std::stoull(xml.substr(xml.find("length=\"", at) + 8)), '\0');
  pages.copy(begin + 16, blob.size(), blob.data());
  return blob;
}

void expect_same_scan(const PointFile& before, std::size_t k, const PointFile& after, std::size_t j) {
  const auto numbers = [](const PointFile& file, std::size_t cloud) {
    return fmt::format("{}", fmt::join(read_all(file, cloud).front(), " "));  // "nan" equals itself
  };
  EXPECT_EQ(after.clouds()[j].fields, before.clouds()[k].fields);
  EXPECT_EQ(numbers(after, j), numbers(before, k));
  const auto was = read_all(before, k);
  const auto is = read_all(after, j);
  for (std::size_t column = 3; column < was.size(); ++column) EXPECT_EQ(is[column], was[column]);
  const Rigid3 expected = copy_motion() * before.clouds()[k].table.pose.value();
  EXPECT_EQ(after.clouds()[j].table.pose->translation, expected.translation);
  EXPECT_LT((after.clouds()[j].table.pose->rotation - expected.rotation).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(E57Copy, AStationAloneKeepsItsGridItsNamesAndItsImages) {
  const TemporaryFolder folder;
  const std::string source = two_stations();
  const auto in = folder.write("all.e57", source);
  move_stations({{in, 1, copy_motion()}}, folder / "b.e57");
  const std::string bytes = slurp(folder / "b.e57");
  E57Pages(bytes, "b").check(0, E57Pages(bytes, "b").page_count());
  const auto before = open_e57(source, "all.e57");
  const auto after = open_e57(bytes, "b.e57");
  ASSERT_EQ(after->clouds().size(), 1U);
  expect_same_scan(*before, 1, *after, 0);
  const std::string xml = e57_xml(E57Pages(bytes, "b"));
  for (const char* kept :
       {"[{B}]", "Set-up &amp; {B}", "sensorVendor", "image 0", "image 2", "label type=\"String\""})
    EXPECT_NE(xml.find(kept), std::string::npos) << kept;
  EXPECT_EQ(xml.find("image 1"), std::string::npos);
  const E57Document document = parse_e57_document(xml, "it");
  ASSERT_EQ(document.images.size(), 2U);
  EXPECT_EQ(document.images[0].pose->translation, (copy_motion() * Vector3d(21, 0, 0)));
  EXPECT_EQ(document.images[1].pose->translation, (copy_motion() * Vector3d(17, 0, 0)));
  EXPECT_EQ(blob_of(bytes, 0), std::string(5000, 'p'));
  EXPECT_EQ(blob_of(bytes, 1), "r");
}

TEST(E57Copy, AMergeKeepsAllAndTheNextOnesAreWrittenBesideThem) {
  const TemporaryFolder folder;
  const std::string source = two_stations();
  const auto in = folder.write("all.e57", source);
  const auto other = folder.write("b.xyz", "1 2 3 0.5\n4 5 6 0.75\n7 8 9 0.25\n");
  const TransformedCloud merged =
      merge_clouds({in, copy_motion()}, {other.string(), in.string()}, folder / "out.e57");
  EXPECT_EQ(merged.points, 2U * 800U + 3U);
  const std::string bytes = slurp(folder / "out.e57");
  E57Pages(bytes, "out").check(0, E57Pages(bytes, "out").page_count());
  const auto before = open_e57(source, "all.e57");
  const auto after = open_e57(bytes, "out.e57");
  ASSERT_EQ(after->clouds().size(), 5U);
  expect_same_scan(*before, 0, *after, 0);
  expect_same_scan(*before, 1, *after, 1);
  EXPECT_EQ(read_all(*after, 2)[0].size(), 3U);
  EXPECT_EQ(after->clouds()[4].table.pose->translation, Vector3d(20, 0, 0));
  EXPECT_EQ(blob_of(bytes, 0), std::string(2'500'001, 'q')) << "the first station's image comes first";
  EXPECT_EQ(blob_of(bytes, 5), "r");
}

TEST(E57Copy, ImagesThatAnotherFormatCannotKeepAreCounted) {
  const TemporaryFolder folder;
  const auto in = folder.write("all.e57", two_stations());
  const TransformedCloud moved = transform_cloud(in, copy_motion(), folder / "out.ply");
  ASSERT_EQ(moved.notes.size(), 2U) << fmt::format("{}", fmt::join(moved.notes, "; "));
  EXPECT_NE(moved.notes[1].find("its 3 images are left out"), std::string::npos);
}

TEST(E57Copy, DamageIsNamedAndNothingIsLeft) {
  const TemporaryFolder folder;
  const std::string sound = two_stations();
  for (const std::size_t page : {std::size_t{3}, sound.size() / 2048}) {
    std::string bytes = sound;
    bytes[1024 * page + 400] ^= 1;
    const auto in = folder.write("in.e57", bytes);
    try {
      move_stations({{in, 0, copy_motion()}}, folder / "out.e57");
      ADD_FAILURE() << page;
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find(fmt::format("page {} of", page)), std::string::npos) << error.what();
    }
    EXPECT_EQ(folder.files(), 1U);
  }
  Layout layout;
  layout.images =
      "<vectorChild><a><jpegImage type=\"Blob\" fileOffset=\"400\" length=\"9\"/></a></vectorChild>";
  const auto in = folder.write("in.e57", file_of({grid("{A}", 1, 50), grid("{B}", 2, 50)}, layout));
  EXPECT_THROW(move_stations({{in, 0, copy_motion()}}, folder / "out.e57"), Error);
  EXPECT_EQ(folder.files(), 1U);
}

}  // namespace
}  // namespace limen
