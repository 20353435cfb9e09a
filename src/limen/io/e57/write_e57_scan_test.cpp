// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>

#include "support/synthetic_e57.h"
#include "support/test_support.h"
#include <gtest/gtest.h>
#include <zlib.h>

#include "limen/base/error.h"
#include "limen/geometry/random_vectors.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_copy.h"
#include "limen/io/e57/e57_document.h"
#include "limen/io/e57/e57_pages.h"

namespace limen {
namespace {

std::size_t number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? 0 : std::stoul(text.substr(at + words.size()));
}

std::size_t big_endian(const std::string& bytes, std::size_t at) {
  std::size_t number = 0;
  for (std::size_t k = 0; k < 4; ++k) number = 256 * number + static_cast<unsigned char>(bytes[at + k]);
  return number;
}

/// The grey of each pixel of a PNG of three chunks; the check sums must hold.
std::string pixels_of(const std::string& png, std::size_t width, std::size_t height) {
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(big_endian(png, 16), width);
  EXPECT_EQ(big_endian(png, 20), height);
  const std::size_t length = big_endian(png, 33);
  EXPECT_EQ(png.substr(37, 4), "IDAT");
  EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(png.data()) + 37, static_cast<uInt>(length + 4)),
            big_endian(png, 41 + length));
  std::string rows((width + 1) * height, 'x');
  uLongf size = rows.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size,
                       reinterpret_cast<const Bytef*>(png.data()) + 41, length),
            Z_OK);
  std::string pixels;
  for (std::size_t row = 0; row < height; ++row) pixels += rows.substr(row * (width + 1) + 1, width);
  return pixels;
}

/// Points all round a scanner, dark but for those to the left of its x axis, a little up.
Scan scan_with_a_lamp() {
  Scan scan;
  scan.name = "hall";
  scan.local_origin = {100.0, 200.0, 0.0};
  scan.centres = {{1.0, 2.0, 3.0}};
  const Vector3d lamp = Vector3d(std::cos(0.8), std::sin(0.8), 0.3).normalized();
  RandomStream random(3);
  for (int k = 0; k < 20000; ++k) {
    const Vector3d way = normal_vector(random).normalized();
    scan.points.push_back(scan.centres[0] + 4.0 * way);
    scan.intensities.push_back(way.dot(lamp) > std::cos(0.2) ? 1.0F : 0.25F);
  }
  return scan;
}

TEST(WriteE57Scan, HasThePointsAndAPanoramaOfTheStation) {
  const testing_io::TemporaryFolder folder;
  const Scan scan = scan_with_a_lamp();
  write_e57(folder / "hall.e57", scan);
  const std::string bytes = testing_io::slurp(folder / "hall.e57");
  const E57Pages pages(bytes, "hall");
  pages.check(0, pages.page_count());
  const auto file = open_e57(bytes, "hall.e57");
  ASSERT_EQ(file->clouds().size(), 1U);
  EXPECT_EQ(file->clouds()[0].points, scan.size());
  EXPECT_EQ(file->clouds()[0].table.pose->translation, Vector3d(101.0, 202.0, 3.0));

  const std::string xml = e57_xml(pages);
  const std::string image = xml.substr(xml.find("<images2D"));
  std::smatch guid;
  ASSERT_TRUE(std::regex_search(image, guid, std::regex("associatedData3DGuid[^{]*(\\{[^}]*\\})")));
  EXPECT_LT(xml.find(guid[1].str()), xml.find("<images2D")) << "it names the scan";
  const std::size_t width = number_after(image, "<imageWidth type=\"Integer\">");
  const std::size_t height = number_after(image, "<imageHeight type=\"Integer\">");
  EXPECT_EQ(width, 2 * height);
  std::string png(number_after(image, "length=\""), '\0');
  pages.copy(pages.logical_of(number_after(image, "fileOffset=\""), "image") + 16, png.size(), png.data());
  const std::string pixels = pixels_of(png, width, height);
  const E57Original original(bytes, "hall");
  const std::vector<E57Picture> pictures = original.pictures();
  ASSERT_EQ(pictures.size(), 1U);
  EXPECT_EQ(pictures[0].scan, 0U);
  EXPECT_EQ(pictures[0].type, "image/png");
  EXPECT_EQ(pictures[0].file_from_image.translation, Vector3d(101.0, 202.0, 3.0));
  const std::vector<std::uint8_t> same = original.bytes_of(pictures[0]);
  EXPECT_TRUE(std::equal(same.begin(), same.end(), png.begin(), png.end(),
                         [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }));
  E57Picture cut = pictures[0];
  cut.bytes = bytes.size();
  EXPECT_THROW(original.bytes_of(cut), Error);
  // Columns go from azimuth pi to -pi, rows from the zenith to the nadir.
  const double wide = static_cast<double>(width);
  const auto column = static_cast<std::size_t>((0.5 - 0.8 / (2.0 * std::numbers::pi)) * wide);
  const auto row =
      static_cast<std::size_t>((0.5 - std::atan(0.3) / std::numbers::pi) * static_cast<double>(height));
  EXPECT_EQ(static_cast<unsigned char>(pixels[row * width + column]), 255U);
  EXPECT_EQ(static_cast<unsigned char>(pixels[row * width + width - column]), 64U) << "not its mirror image";
  EXPECT_EQ(pixels.find('\0'), std::string::npos) << "no pixel is empty";
}

}  // namespace
}  // namespace limen
