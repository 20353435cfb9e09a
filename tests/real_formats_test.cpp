// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A building in the files that surveyors have: stations in E57, street passes in LAS with their trajectories
// apart, a model, control points. One project, one report, one E57 that keeps every station.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "run_program.h"
#include "support/bcf_check.h"
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/io/crs/proj_library.h"
#include "limen/io/trajectory/write_sbet.h"
#include "limen/simulate/recipes.h"

namespace limen {
namespace {

using RealJson = nlohmann::json;

constexpr const char* kSite = "LOCAL_CS[\"site\",UNIT[\"metre\",1]]";

Rigid3 pose_from_rows(const RealJson& rows) {
  Matrix4d matrix;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j].get<double>();
  }
  return from_matrix(matrix);
}

class RealFormats : public ProgramTest {
 protected:
  /// The coordinate system of the site: of the map where PROJ is there, else one that has but a name.
  [[nodiscard]] static std::string system() { return proj_library() != nullptr ? "EPSG:2154" : kSite; }

  void make_case() {
    ASSERT_EQ(run({"simulate", "townhouse", "--points-indoor", "60000", "--points-outdoor", "160000",
                   "--stations", "2", "--seed", "2", "-o", "case", "--quiet"})
                  .status,
              0);
    const RealJson truth = RealJson::parse(read_whole(work() / "case/truth/truth.json"));
    write_whole(work() / "stay.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    for (const RealJson& scan : truth["scans"]) {
      const Rigid3 pose = pose_from_rows(scan["world_from_scan"]);
      const std::string name = scan["name"];
      if (scan["kind"] == "mobile") {
        write_passes("case/" + scan["file"].get<std::string>());
        poses_["pass_0.las"] = poses_["pass_1.las"] = pose;
        continue;
      }
      ASSERT_EQ(
          run({"transform", "stay.txt", "case/" + scan["file"].get<std::string>(), name + ".e57"}).status, 0);
      poses_[name + ".e57"] = pose;
    }
    write_model();
    write_points();
  }

  /// The points of a pass and a half each in a LAS of its own, with nothing but times; the way beside it.
  void write_passes(const std::string& path) {
    const Scan all = read_scan(work() / path);
    const auto [first, last] = std::minmax_element(all.times_s.begin(), all.times_s.end());
    const double middle = 0.5 * (*first + *last);
    for (int half = 0; half < 2; ++half) {
      auto numbers = std::make_shared<std::vector<double>>();
      std::map<double, Vector3d> way;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const double time = all.times_s[i];
        if ((time < middle) != (half == 0)) continue;
        const Vector3d x = all.local_origin + all.points[i];
        numbers->insert(numbers->end(), {x.x(), x.y(), x.z(), time});
        way.emplace(std::floor(200.0 * time), Vector3d::Zero());
      }
      CloudPlan plan;
      plan.columns = {{"x"}, {"y"}, {"z"}, {"gps_time"}};
      plan.most_points = numbers->size() / 4;
      plan.near = all.local_origin + all.points.front();
      const auto writer = make_cloud_writer(work() / ("pass_" + std::to_string(half) + ".las"), plan);
      writer->write(table_of_numbers(numbers, {"x", "y", "z", "gps_time"}));
      writer->finish();
      write_way(all, half == 0 ? *first : middle, half == 0 ? middle : *last, half);
    }
  }

  /// A trajectory between two times: SBET where PROJ is there, else text.
  void write_way(const Scan& scan, double from_s, double to_s, int half) {
    std::map<double, Vector3d> by_time;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.times_s[i] >= from_s && scan.times_s[i] <= to_s)
        by_time.emplace(scan.times_s[i], scan.local_origin + scan.centre(i));
    }
    std::vector<TimedPlace> places;
    for (const auto& [time_s, x] : by_time) {
      if (places.empty() || time_s - places.back().time_s > 0.005 || time_s == by_time.rbegin()->first)
        places.push_back({time_s, x});
    }
    const std::string name = "way_" + std::to_string(half);
    if (proj_library() != nullptr) {
      write_whole(work() / (name + ".sbet"),
                  sbet_bytes(records_of_places(places, MapProjection("EPSG:2154", ""))));
      ways_.push_back(name + ".sbet");
      return;
    }
    std::string text = "time,x,y,z\n";
    for (const TimedPlace& it : places)
      text += fmt::format("{:.6f},{:.5f},{:.5f},{:.5f}\n", it.time_s, it.x.x(), it.x.y(), it.x.z());
    write_whole(work() / (name + ".csv"), text);
    ways_.push_back(name + ".csv");
  }

  /// What is built of the building and stays, in a frame of its own.
  void write_model() {
    SceneOptions options;
    options.name = "townhouse";
    options.seed = 2;
    options.stations = 2;
    const Recipe recipe = make_recipe(options);
    const Mesh& mesh = recipe.world.mesh;
    std::string text;
    for (const Vector3d& x : mesh.vertices())
      text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", x.x(), x.y(), x.z());
    const std::map<Element, std::string> groups = {{Element::wall, "IfcWall"},
                                                   {Element::reveal, "IfcWall_reveals"},
                                                   {Element::floor, "IfcSlab_floors"},
                                                   {Element::ceiling, "IfcSlab_ceilings"},
                                                   {Element::roof, "IfcRoof"}};
    for (const auto& [element, group] : groups) {
      text += "g " + group + "\n";
      for (std::size_t k = 0; k < mesh.triangles().size(); ++k) {
        const auto surface = static_cast<std::size_t>(mesh.surface_of_triangle()[k]);
        if (mesh.surfaces()[surface].element != element) continue;
        const auto& corners = mesh.triangles()[k];
        text += fmt::format("f {} {} {}\n", corners[0] + 1, corners[1] + 1, corners[2] + 1);
      }
    }
    write_whole(work() / "house.obj", text);
  }

  /// Targets that every scan sees, measured to 2 mm.
  void write_points() const {
    RandomStream random(5, 8);
    const auto noise = [&]() -> Vector3d { return 0.002 * normal_vector(random); };
    const Vector3d middle = poses_.begin()->second.translation;
    std::string control = "name,x,y,z,sigma\n";
    std::string targets = "name,scan,x,y,z,sigma\n";
    const std::array<Vector3d, 5> places = {Vector3d(4, 0, 0.5), Vector3d(-4, 1, 2), Vector3d(0, 5, 1),
                                            Vector3d(1, -5, -0.5), Vector3d(3, 3, 3)};
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Vector3d x = middle + places[k];
      const Vector3d stated = x + noise();
      control += fmt::format("P{},{:.4f},{:.4f},{:.4f},0.002\n", k, stated.x(), stated.y(), stated.z());
      for (const auto& [file, pose] : poses_) {
        const Vector3d seen = inverse(pose) * x + noise();
        targets += fmt::format("P{},{},{:.4f},{:.4f},{:.4f},0.002\n", k, file, seen.x(), seen.y(), seen.z());
      }
    }
    write_whole(work() / "control.csv", control);
    write_whole(work() / "targets.csv", targets);
  }

  [[nodiscard]] RealJson info(const std::string& path) const {
    const ProgramRun stated = run({"info", path, "--json"});
    EXPECT_EQ(stated.status, 0) << stated.err;
    return RealJson::parse(stated.out);
  }

  std::map<std::string, Rigid3> poses_;  ///< of each file
  std::vector<std::string> ways_;
};

TEST_F(RealFormats, OneProjectOneReportOneE57) {
  make_case();
  std::vector<std::string> words = {"project",     "--model",   "house.obj",   "--control",
                                    "control.csv", "--targets", "targets.csv", "--crs",
                                    system(),      "-o",        "building"};
  for (const auto& [file, pose] : poses_) words.push_back(file);
  for (const std::string& way : ways_) words.insert(words.end(), {"--trajectory", way});
  const ProgramRun done = run(words);
  ASSERT_TRUE(done.status == 0 || done.status == 3) << done.err << done.out;
  const RealJson project = RealJson::parse(read_whole(work() / "building/project.json"));
  EXPECT_EQ(project["frame"]["kind"], "control");
  ASSERT_TRUE(project["frame"].contains("crs")) << done.err;
  EXPECT_EQ(project["frame"]["crs"]["said_by"], "user");
  EXPECT_EQ(project["trajectories"]["files"].size(), 2U);
  std::set<std::string> standing;
  bool model_stands = false;
  for (const RealJson& scan : project["scans"]) {
    const bool stands = scan["state"] == "registered";
    if (scan["kind"] == "model") {
      model_stands = stands;
      continue;
    }
    EXPECT_TRUE(stands) << scan["file"] << scan["reason"];
    if (!stands) continue;
    const std::string file = scan["file"];
    standing.insert(file);
    // The scanner of a pass is known along its way, though its file says nothing of it.
    EXPECT_EQ(scan["mobile"].get<bool>(), file.rfind("pass", 0) == 0);
    const Rigid3 error = pose_from_rows(scan["frame_from_scan"]) * inverse(poses_[file]);
    const Vector3d middle = poses_.begin()->second.translation;
    EXPECT_LT((error * middle - middle).norm(), 0.006) << file;
    EXPECT_LT(rotation_angle(error.rotation), 0.002) << file;
  }
  EXPECT_EQ(standing.size(), 4U);
  EXPECT_TRUE(model_stands) << done.out;
  EXPECT_NE(read_whole(work() / "building/report.html").find("pass_1.las"), std::string::npos);

  // One E57 with every station as it was, in the frame, which it names.
  ASSERT_EQ(run({"transform", "building/project.json", "-o", "all.e57", "--merge"}).status, 0);
  const RealJson all = info("all.e57");
  ASSERT_EQ(all["scans"].size(), 4U);
  std::size_t points = 0;
  for (const RealJson& scan : all["scans"]) points += scan["points"].get<std::size_t>();
  std::size_t given = 0;
  for (const auto& [file, pose] : poses_) given += info(file)["scans"][0]["points"].get<std::size_t>();
  EXPECT_EQ(points, given);
  ASSERT_TRUE(all.contains("crs"));
  EXPECT_EQ(all["crs"]["name"], project["frame"]["crs"]["name"]);

  // Each in its own format; LAS tells the system too.
  const ProgramRun placed = run({"transform", "building/project.json", "-o", "placed"});
  ASSERT_EQ(placed.status, 0) << placed.err;
  EXPECT_EQ(info("placed/pass_0.las")["crs"]["name"], project["frame"]["crs"]["name"]);

  // Everything against the model, with its issues.
  const ProgramRun checked =
      run({"deviation", "building/project.json", "-o", "checked", "--bcf", "issues.bcf"});
  ASSERT_EQ(checked.status, 0) << checked.err;
  const RealJson deviation = RealJson::parse(read_whole(work() / "checked/deviation.json"));
  EXPECT_EQ(deviation["scans"].size(), 4U);
  EXPECT_GT(deviation["summary"]["points_on_faces"].get<double>(),
            0.3 * deviation["summary"]["points"].get<double>());
  std::string faults;
  for (const std::string& fault : bcf_faults(read_whole(work() / "issues.bcf"))) faults += fault + "\n";
  EXPECT_EQ(faults, "");
}

TEST_F(RealFormats, CoordinateSystemsAreKeptStatedAndComparedWithWhatFilesSay) {
  write_whole(work() / "stay.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  write_whole(work() / "a.xyz", "1 2 3\n2 3 4\n3 4 6\n");
  write_whole(work() / "site.prj", kSite);
  for (const char* name : {"a.las", "a.laz", "a.e57", "a.ply"}) {
    ASSERT_EQ(run({"transform", "stay.txt", "a.xyz", name, "--crs", "site.prj"}).status, 0) << name;
    if (std::string(name) == "a.ply") continue;
    EXPECT_EQ(info(name)["crs"]["name"], "site") << name;
    // From file to file, without being given again; and in its own format.
    const std::string again = std::string("again_") + name;
    ASSERT_EQ(run({"transform", "stay.txt", name, again}).status, 0);
    EXPECT_EQ(info(again)["crs"]["name"], "site") << name;
  }
  EXPECT_NE(read_whole(work() / "a.ply").find("comment crs LOCAL_CS"), std::string::npos);
  ASSERT_EQ(run({"transform", "stay.txt", "a.las", "b.e57"}).status, 0);
  EXPECT_EQ(info("b.e57")["crs"]["name"], "site");
  ASSERT_EQ(
      run({"transform", "stay.txt", "a.las", "other.las", "--crs", "LOCAL_CS[\"other\",UNIT[\"metre\",1]]"})
          .status,
      0);
  EXPECT_EQ(info("other.las")["crs"]["name"], "other");
  const ProgramRun wrong = run({"transform", "stay.txt", "a.las", "none.las", "--crs", "Lambert"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--crs"), std::string::npos);
  if (proj_library() == nullptr) return;
  ASSERT_EQ(run({"transform", "stay.txt", "a.las", "map.las", "--crs", "EPSG:25832"}).status, 0);
  EXPECT_EQ(info("map.las")["crs"]["code"], "EPSG:25832");
  ASSERT_EQ(run({"transform", "stay.txt", "map.las", "map.e57"}).status, 0);
  EXPECT_EQ(info("map.e57")["crs"]["code"], "EPSG:25832");
}

}  // namespace
}  // namespace limen
