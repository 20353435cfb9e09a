// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/advice.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limen/report/summary/summary_text.h"

namespace limen {
namespace {

InputSummary scan_of(const std::string& path, const Vector3d& size) {
  InputSummary side;
  side.path = path;
  side.high = size;
  side.inner_high = size;
  side.middle = 0.5 * size;
  side.place.source = PlaceSource::stated_by_file;
  side.place.confirmed = true;
  return side;
}

RegistrationReport pair_of(Outcome outcome) {
  RegistrationReport report;
  report.result.outcome = outcome;
  report.result.reason = "a reason";
  report.result.picture = std::make_shared<const RegistrationPicture>();
  report.source = scan_of("my scans/a.ply", {8, 6, 3});
  report.target = scan_of("b.ply", {9, 7, 3.1});
  return report;
}

bool any_names(const std::vector<std::string>& steps, const std::string& words) {
  return std::any_of(steps.begin(), steps.end(),
                     [&words](const std::string& step) { return step.find(words) != std::string::npos; });
}

TEST(Advice, EveryOutcomeSaysWhatToDoNext) {
  for (const Outcome outcome : {Outcome::registered, Outcome::probable, Outcome::ambiguous,
                                Outcome::under_constrained, Outcome::no_match}) {
    const std::vector<std::string> steps = next_steps(pair_of(outcome), "out");
    EXPECT_GE(steps.size(), 2U) << to_string(outcome);
    EXPECT_TRUE(any_names(steps, "out/report.html")) << to_string(outcome);
    EXPECT_EQ(likely_causes(pair_of(outcome)).empty(), outcome != Outcome::no_match);
  }
  RegistrationReport without = pair_of(Outcome::registered);
  without.result.picture.reset();
  EXPECT_FALSE(any_names(next_steps(without), "report.html"));
}

TEST(Advice, AProbablePoseNamesWhatWouldMakeItSurer) {
  RegistrationReport report = pair_of(Outcome::probable);
  const auto with = [&report](double look_alike, double chance, double elsewhere) {
    report.result.others = OtherExplanations{chance, look_alike, 0.0};
    report.result.best.probability = 1.0 - look_alike - chance - elsewhere;
    EXPECT_EQ(next_steps(report, "out").front(), surer(report));
    return surer(report);
  };
  EXPECT_NE(with(0.02, 0.0, 0.0).find("--repeats none"), std::string::npos);
  EXPECT_NE(with(0.0, 0.0, 0.02).find("sees both sides"), std::string::npos);
  EXPECT_NE(with(0.0, 0.02, 0.0).find("more of the overlap"), std::string::npos);
  // Once that was said it is not asked for again.
  report.options.emplace_back("repeats", std::string("none"));
  EXPECT_NE(with(0.02, 0.0, 0.0).find("the same room"), std::string::npos);
  EXPECT_TRUE(any_names(next_steps(report, "out"), "limen transform out/result.json"));
}

TEST(Advice, PlanesBesideTheirCounterpartsAreToBeLookedInto) {
  for (const Outcome outcome : {Outcome::registered, Outcome::probable, Outcome::under_constrained}) {
    RegistrationReport report = pair_of(outcome);
    EXPECT_FALSE(any_names(next_steps(report, "out"), "rebuilt"));
    report.result.moved = {{0, 0, 0.02, 0.0, 5.0}, {1, 1, -0.06, 0.0, 2.0}};
    EXPECT_TRUE(any_names(next_steps(report, "out"), "2 planes lie up to 60 mm")) << to_string(outcome);
  }
}

TEST(Advice, CommandsCanBeTakenAsTheyStand) {
  const RegistrationReport found = pair_of(Outcome::registered);
  EXPECT_TRUE(
      any_names(next_steps(found, "out"), "limen transform out/result.json 'my scans/a.ply' moved.ply"));
  RegistrationReport model = pair_of(Outcome::registered);
  model.source.kind = "model";
  EXPECT_TRUE(any_names(next_steps(model, "o"), "limen transform o/result.json --invert b.ply moved.ply"));
  EXPECT_TRUE(any_names(next_steps(model, "o"),
                        "limen deviation b.ply 'my scans/a.ply' --result o/result.json --inverse"));
  model.result.moved = {{1, 2, 0.012, 0.0, 9.0}, {1, 3, -0.031, 0.0, 4.0}};
  EXPECT_TRUE(any_names(next_steps(model, "o"), "2 planes of the model are up to 31 mm from where"));
  RegistrationReport ties = pair_of(Outcome::ambiguous);
  ties.result.rivals = 2;
  EXPECT_TRUE(any_names(next_steps(ties, "out"), "--alternative N"));
}

TEST(Advice, CausesTellWhatWasMeasuredTheLikeliestFirst) {
  RegistrationReport report = pair_of(Outcome::no_match);
  report.result.best.agreeing_m2 = 2.2;
  std::vector<LikelyCause> causes = likely_causes(report);
  EXPECT_EQ(causes.front().name, "overlap");
  EXPECT_NE(causes.front().measured.find("2.2 m2"), std::string::npos);
  report.target.place = {PlaceSource::estimated, {1, 2, 3}, true, 0.01, Vector3d::Zero()};
  causes = likely_causes(report);
  EXPECT_EQ(causes.front().name, "place of the scanner");
  EXPECT_NE(causes.front().remedy.find("--target-origin"), std::string::npos);
  report.source = scan_of("a.ply", Vector3d(9, 7, 3.1) * 39.37);
  causes = likely_causes(report);
  EXPECT_EQ(causes.front().name, "units");
  EXPECT_EQ(causes.front().remedy, "give --source-units in");
  report.options = {{"gravity", std::string("up")}};
  causes = likely_causes(report);
  EXPECT_TRUE(std::any_of(causes.begin(), causes.end(), [](const auto& it) { return it.name == "axes"; }));
}

TEST(Advice, UnitsAreGuessedWhereMetresMakeNoBuilding) {
  const InputSummary room = scan_of("a.ply", {8, 6, 3});
  EXPECT_FALSE(likely_unit(room, scan_of("b.ply", {40, 30, 12}))) << "a street is no room in feet";
  EXPECT_FALSE(likely_unit(room, scan_of("b.ply", {20, 20, 9}))) << "nor is a stairwell";
  EXPECT_FALSE(likely_unit(room, scan_of("b.ply", Vector3d(8, 6, 3) * 3.28084)))
      << "nor a house of 10 m, however well its height fits";
  const auto feet =
      likely_unit(scan_of("b.ply", Vector3d(60, 40, 14) * 3.28084), scan_of("a.ply", {60, 40, 14}));
  ASSERT_TRUE(feet) << "46 m in each direction is higher than a church";
  EXPECT_EQ(feet->unit, "ft");
  const auto mm = likely_unit(room, scan_of("b.ply", {9000, 6500, 2900}));
  ASSERT_TRUE(mm);
  EXPECT_EQ(mm->unit, "mm");
  EXPECT_FALSE(mm->source);
  const auto inches = likely_unit(scan_of("b.ply", Vector3d(8, 6, 3) * 39.37), room);
  ASSERT_TRUE(inches);
  EXPECT_EQ(inches->unit, "in");
  EXPECT_TRUE(inches->source);
  InputSummary stated = scan_of("b.ply", {9000, 6500, 2900});
  stated.metres_per_unit = 0.3048;
  EXPECT_FALSE(likely_unit(room, stated)) << "the file states its unit";
}

TEST(Advice, CloudsInTwoUnitsAreNotMovedByTransform) {
  RegistrationReport report = pair_of(Outcome::registered);
  EXPECT_TRUE(any_names(next_steps(report, "out"), "limen transform"));
  report.source.metres_per_unit = 0.001;
  EXPECT_FALSE(any_names(next_steps(report, "out"), "limen transform"));
  EXPECT_TRUE(any_names(next_steps(report, "out"), "out/transform.txt"));
}

TEST(Advice, TwoMetricFilesAreNotAdvisedAUnit) {
  RegistrationReport report = pair_of(Outcome::no_match);
  report.source = scan_of("room.ply", {8, 6, 3});
  report.target = scan_of("house.ply", {26, 20, 9.8});
  for (const LikelyCause& cause : likely_causes(report))
    EXPECT_EQ(cause.remedy.find(" ft"), std::string::npos) << cause.remedy;
  EXPECT_NE(likely_causes(report).front().name, "units");
}

TEST(RawMatrix, MovesTheNumbersAsTheyStandInTheFiles) {
  RegistrationReport report = pair_of(Outcome::registered);
  report.source.offset_applied = {1051200.0, 6841900.0, 12.5};
  report.target.offset_applied = {1051100.0, 6840000.0, 0.0};
  report.target.metres_per_unit = 0.001;
  const Matrix3d turn = rotation_exp(Vector3d(0.3, -1.1, 2.2));
  const Vector3d world = report.target.offset_applied + Vector3d(12, -7, 3);
  const Vector3d raw(4.125, -20.5, 1.75);
  const Vector3d in_source = report.source.offset_applied + raw;
  const Rigid3 pose{turn, world - turn * in_source};
  EXPECT_TRUE(has_offset(report));
  const Matrix4d matrix = raw_matrix(report, pose);
  const Vector3d moved = (matrix * raw.homogeneous()).head<3>();
  EXPECT_LT((moved - Vector3d(12000, -7000, 3000)).norm(), 1e-4) << "millimetres, so a ten-thousandth of one";
  report.source.offset_applied = report.target.offset_applied = Vector3d::Zero();
  EXPECT_FALSE(has_offset(report));
  EXPECT_EQ(raw_matrix(report, pose), file_matrix(report, pose));
}

TEST(SummaryText, ListsWhatThereIsToChoose) {
  RegistrationReport report = pair_of(Outcome::ambiguous);
  report.result.rivals = 1;
  report.result.best.probability = 0.6;
  report.result.alternatives.resize(3);
  report.result.alternatives[1].tie = true;
  report.result.alternatives[1].room = "Room B";
  report.result.alternatives[1].probability = 0.39;
  const std::string text = summary_text(report, "out");
  EXPECT_NE(text.find("others      3 other poses; = cannot be distinguished from the best"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("    2 =             39.0 %"), std::string::npos) << text;
  EXPECT_NE(text.find("Room B"), std::string::npos) << text;
  report.result.alternatives.resize(1);
  report.result.rivals = 0;
  EXPECT_NE(summary_text(report, "out").find("1 other pose tested"), std::string::npos);
}

TEST(SummaryText, SaysThatAScannerOfUnknownPositionMayHaveMoved) {
  RegistrationReport report = pair_of(Outcome::registered);
  report.result.best.sigma.covariance.setIdentity();
  report.result.best.sigma.formal_covariance.setIdentity();
  EXPECT_EQ(summary_text(report, "out").find("may have moved"), std::string::npos);
  EXPECT_FALSE(any_names(next_steps(report, "out"), "-origin"));
  report.target.place.source = PlaceSource::unknown;
  EXPECT_NE(summary_text(report, "out").find("the scanner of b.ply may have moved"), std::string::npos);
  EXPECT_TRUE(any_names(next_steps(report, "out"), "--target-origin x,y,z"));
}

TEST(SummaryText, TellsTheShiftOfTheMiddleAndTheHintForLargeCoordinates) {
  RegistrationReport report = pair_of(Outcome::registered);
  report.result.best.target_from_source.translation = Vector3d(0.003, 0, 0);
  EXPECT_NE(
      summary_text(report, "out").find("shift       0.0030 0.0000 0.0000 m, of the centre of a.ply (3.0 mm)"),
      std::string::npos);
  EXPECT_EQ(summary_text(report, "out").find("CloudCompare"), std::string::npos);
  report.source.middle += Vector3d(1050000, 6840000, 0);
  EXPECT_NE(summary_text(report, "out").find("CloudCompare"), std::string::npos);
}

}  // namespace
}  // namespace limen
