// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class ModelInfoTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_whole(work() / "box.obj",
                "o IfcWall-A\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\nv 4 0 2\nv 4 3 2\nv 0 3 2\n"
                "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  }
};

TEST_F(ModelInfoTest, TellsElementsAreaAndExtent) {
  const ProgramRun done = run({"info", "--json", "box.obj"});
  ASSERT_EQ(done.status, 0) << done.err;
  const Json model = Json::parse(done.out);
  EXPECT_EQ(model["format"], "OBJ");
  EXPECT_EQ(model["elements"], 1);
  EXPECT_EQ(model["faces"], 6);
  EXPECT_EQ(model["kinds"][0]["kind"], "wall");
  EXPECT_NEAR(model["kinds"][0]["area_m2"].get<double>(), 52.0, 1e-4);
  EXPECT_NEAR(model["high"][0].get<double>(), 4.0, 1e-4);
  EXPECT_TRUE(model["warnings"].empty());
}

TEST_F(ModelInfoTest, TextForReaders) {
  const ProgramRun done = run({"info", "box.obj"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_NE(done.out.find("elements        1 with 6 faces"), std::string::npos) << done.out;
}

TEST_F(ModelInfoTest, DamagedModelsAreErrorsOfTheInput) {
  write_whole(work() / "cut.ifc", "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4X1'));\nENDSEC;\nDATA;\n");
  const ProgramRun newer = run({"info", "cut.ifc"});
  EXPECT_EQ(newer.status, 2);
  EXPECT_NE(newer.err.find("IFC4X1"), std::string::npos) << newer.err;
  EXPECT_NE(newer.err.find("OBJ"), std::string::npos) << newer.err;
  write_whole(work() / "bad.obj", "v 0 0 0\nf 1 2 3\n");
  const ProgramRun index = run({"info", "bad.obj"});
  EXPECT_EQ(index.status, 2);
  EXPECT_NE(index.err.find("line 2"), std::string::npos) << index.err;
}

}  // namespace
}  // namespace limen
