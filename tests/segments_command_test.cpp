// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// `limen segments` as a script meets it.
#include <cmath>
#include <fstream>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class SegmentsCommandTest : public ProgramTest {
 protected:
  /// A room of 5 m x 4 m x 3 m on a national grid: points every 2.5 cm on six faces.
  void write_room(const std::string& name) const {
    std::ofstream file(work() / name);
    file.precision(10);
    const double size[3] = {5.0, 4.0, 3.0};
    const double corner[3] = {1050000.0, 6840000.0, 100.0};
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (double a = 0.0125; a < size[u]; a += 0.025) {
        for (double b = 0.0125; b < size[v]; b += 0.025) {
          for (const double side : {0.0, 1.0}) {
            double x[3];
            x[axis] = corner[axis] + side * size[axis];
            x[u] = corner[u] + a;
            x[v] = corner[v] + b;
            file << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
          }
        }
      }
    }
  }
};

TEST_F(SegmentsCommandTest, TwelveEdgesInWorldCoordinates) {
  write_room("room.xyz");
  const ProgramRun it =
      run({"segments", "room.xyz", "-o", "room.json", "--origin", "1050002,6840002,101.5", "--json"});
  ASSERT_EQ(it.status, 0) << it.err;
  const Json written = Json::parse(it.out);
  ASSERT_EQ(written["segments"].size(), 12U);
  double total = 0.0;
  for (const Json& segment : written["segments"]) {
    double squares = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = segment["b"][k].get<double>() - segment["a"][k].get<double>();
      squares += step * step;
    }
    total += std::sqrt(squares);
    EXPECT_NEAR(segment["a"][1].get<double>(), 6840002.0, 2.05);
  }
  EXPECT_NEAR(total, 48.0, 1.0);
}

TEST_F(SegmentsCommandTest, BadOptionsAreStated) {
  write_room("room.xyz");
  EXPECT_EQ(run({"segments", "room.xyz", "-o", "room.json", "--min-length-m", "0"}).status, 2);
  EXPECT_EQ(run({"segments", "room.xyz", "-o", "room.json", "--min-angle-deg", "95"}).status, 2);
  EXPECT_EQ(run({"segments", "room.xyz", "-o", "room.xyz"}).status, 2);
  EXPECT_EQ(run({"segments", "missing.xyz", "-o", "room.json"}).status, 2);
}

}  // namespace
}  // namespace limen
