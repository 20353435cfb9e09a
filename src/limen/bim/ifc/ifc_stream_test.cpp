// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_stream.h"

#include <string>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/bim/ifc/ifc_stream_format.h"

namespace limen {
namespace {

TEST(IfcStream, CutAndFlippedStreamsNeverHarm) {
  // A product with a nested operation, then every prefix of it and many single flips.
  const auto count = [](std::uint32_t n) { return testing_io::bytes_of(n); };
  const auto number = [](double x) { return testing_io::bytes_of(x); };
  std::string mesh(1, '\0');
  mesh += count(3);
  for (int k = 0; k < 9; ++k) mesh += number(k);
  mesh += count(1) + count(3) + count(0) + count(1) + count(2);
  const std::string node = std::string(1, '\3') + count(2) + mesh + mesh;
  const std::string product = testing_io::bytes_of<std::int64_t>(7) + count(7) + "IfcWall" + count(1) + node;
  std::string stream(kIfcStreamMagic);
  stream.append("L").append(count(8)).append(number(1.0));
  stream.append("P").append(count(static_cast<std::uint32_t>(product.size()))).append(product);
  stream.append("Z").append(count(4)).append(count(1));
  const IfcShapes whole = parse_ifc_stream(stream);
  ASSERT_TRUE(whole.complete);
  ASSERT_EQ(whole.products.size(), 1U);
  EXPECT_EQ(whole.products[0].shapes[0].children.size(), 2U);
  for (std::size_t size = 0; size < stream.size(); ++size)
    EXPECT_FALSE(parse_ifc_stream(std::string_view(stream).substr(0, size)).complete);
  RandomStream random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string flipped = stream;
    flipped[random.below(static_cast<std::uint32_t>(stream.size()))] = static_cast<char>(random.below(256));
    for (const IfcProductShapes& made : parse_ifc_stream(flipped).products)
      for (const Solid& shape : made.shapes)
        for (const std::uint32_t corner : shape.mesh.corners) EXPECT_LT(corner, shape.mesh.points.size());
  }
}

}  // namespace
}  // namespace limen
