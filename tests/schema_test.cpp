// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Files that the program writes hold what `limen schema` promises of them.
#include <string>
#include <vector>

#include "run_program.h"
#include "support/json_schema.h"
#include <gtest/gtest.h>

namespace limen {
namespace {

using SchemaJson = testing_schema::json;
using testing_schema::Validator;

class SchemaTest : public ProgramTest {
 protected:
  /// What is wrong with a file by the schema; nothing where it is as promised.
  [[nodiscard]] std::string fault(const std::string& schema, const std::string& text) const {
    const ProgramRun printed = run({"schema", schema});
    EXPECT_EQ(printed.status, 0) << printed.err;
    return Validator(SchemaJson::parse(printed.out)).fault(SchemaJson::parse(text));
  }
  [[nodiscard]] std::string file_fault(const std::string& schema, const std::string& path) const {
    return fault(schema, read_whole(work() / path));
  }
  void must_run(const std::vector<std::string>& arguments) const {
    const ProgramRun done = run(arguments);
    ASSERT_EQ(done.status, 0) << done.err;
  }
};

TEST_F(SchemaTest, FilesOfOneScan) {
  must_run({"simulate", "room", "--points-indoor", "60000", "-o", "."});
  for (const std::string kind : {"planes", "openings", "segments"}) {
    must_run({kind, "indoor_00.ply", "-o", kind + ".json"});
    const SchemaJson written = SchemaJson::parse(read_whole(work() / (kind + ".json")));
    EXPECT_GT(written[kind].size(), 0U) << kind;
    EXPECT_EQ(file_fault(kind, kind + ".json"), "");
  }
  EXPECT_EQ(file_fault("planes", "openings.json"), "$.openings is not in the schema");
  SchemaJson bad = SchemaJson::parse(read_whole(work() / "planes.json"));
  bad["planes"][0]["normal"].erase(0);
  EXPECT_EQ(fault("planes", bad.dump()), "$.planes[0].normal has another length");
}

TEST_F(SchemaTest, FilesOfAPairAndOfAProject) {
  must_run({"simulate", "room", "--points-indoor", "60000", "-o", "."});
  must_run({"register", "indoor_00.ply", "indoor_01.ply", "-o", "out"});
  EXPECT_EQ(file_fault("result", "out/result.json"), "");
  const ProgramRun stated = run({"evaluate", "out/result.json", "truth/truth.json", "--json"});
  ASSERT_EQ(stated.status, 0) << stated.err;
  EXPECT_EQ(fault("evaluation", stated.out), "");
  write_whole(work() / "control.csv", "name,x,y,z,sigma\nA,0.5,0.5,0.3,0.01\nB,4.5,0.5,2.2,0.01\n");
  write_whole(work() / "targets.csv", "name,scan,x,y,z,sigma\nA,indoor_00.ply,0.1,0.2,0.3,0.01\n");
  must_run({"project", "indoor_00.ply", "indoor_01.ply", "-o", "building", "--control", "control.csv",
            "--targets", "targets.csv"});
  const SchemaJson project = SchemaJson::parse(read_whole(work() / "building/project.json"));
  EXPECT_EQ(project["links"].size(), 1U);
  EXPECT_EQ(project["points"].size(), 2U);
  EXPECT_EQ(file_fault("project", "building/project.json"), "");
  const ProgramRun held = run({"evaluate", "building/project.json", "truth/truth.json", "--json"});
  ASSERT_EQ(held.status, 0) << held.err;
  EXPECT_EQ(fault("project-evaluation", held.out), "");
}

TEST_F(SchemaTest, WhatIsSaidOfAProjectWithoutARegisteredScan) {
  write_whole(work() / "project.json", R"({"links": [], "scans": [{"file": "a.ply", "index": 0,
    "kind": "scan", "state": "floating", "frame_from_scan": null}]})");
  write_whole(work() / "truth.json", R"({"scans": []})");
  const ProgramRun held = run({"evaluate", "project.json", "truth.json", "--json"});
  ASSERT_EQ(held.status, 0) << held.err;
  const SchemaJson stated = SchemaJson::parse(held.out);
  EXPECT_TRUE(stated["translation_error_median_m"].is_null());
  EXPECT_TRUE(stated["translation_error_largest_m"].is_null());
  EXPECT_EQ(fault("project-evaluation", held.out), "");
}

TEST_F(SchemaTest, FilesAboutAModel) {
  must_run({"simulate", "office", "--points-indoor", "60000", "-o", "."});
  const SchemaJson truth = SchemaJson::parse(read_whole(work() / "truth/truth.json"));
  write_whole(work() / "pose.json",
              SchemaJson{{"target_from_source", truth["scans"][0]["target_from_source"]}}.dump());
  must_run({"deviation", "scan_01.ply", "model.ifc", "--result", "pose.json", "-o", "out"});
  EXPECT_EQ(file_fault("deviation", "out/deviation.json"), "");
  for (const std::string kind : {"planes", "openings"}) {
    must_run({kind, "model.ifc", "-o", kind + ".json"});
    EXPECT_EQ(file_fault(kind, kind + ".json"), "");
  }
}

TEST_F(SchemaTest, AnUnknownFileIsStatedWithThoseThereAre) {
  const ProgramRun done = run({"schema", "report"});
  EXPECT_EQ(done.status, 2);
  EXPECT_NE(done.err.find("planes"), std::string::npos) << done.err;
}

}  // namespace
}  // namespace limen
