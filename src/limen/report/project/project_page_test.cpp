// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_page.h"

#include <cmath>

#include "support/test_support.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limen/base/angles.h"
#include "limen/report/project/project_json.h"
#include "limen/report/project/question_pictures.h"
#include "limen/report/project/read_project.h"

namespace limen {
namespace {

/// Two scans, a control point that is left out, a check point, a question and a decision.
ProjectResult some_result() {
  ProjectResult result;
  result.outcome = ProjectOutcome::partial;
  result.frame_kind = "control";
  result.control_file = "control.csv";
  result.control_words = "2 control points are seen by 1 scan";
  for (const char* name : {"hall.ply", "o'clock.ply"}) {
    ProjectScan scan;
    scan.file = name;
    scan.component = 0;
    scan.frame_from_scan = Rigid3{};
    scan.stations = {Vector3d(result.scans.empty() ? 0 : 3, 2, 1.6)};
    result.scans.push_back(scan);
  }
  ProjectPoint point;
  point.name = "P<1>";
  point.state = PointState::left_out;
  point.given = Vector3d(652345.6781, 6862123.4562, 35.25);
  point.found = Vector3d(1, 1, 1);
  point.test.residual = {0.05, 0, 0};
  point.reason = "contradicts all other observations";
  point.sights.push_back({1, true, 0.001});
  result.points.push_back(point);
  ProjectQuestion question;
  question.text = "where is it?";
  question.answers = {{DecisionKind::choose, {"hall.ply", "o'clock.ply"}, 2}};
  result.questions.push_back(question);
  result.decisions.push_back(
      {{DecisionKind::level, {"hall.ply"}, 0}, DecisionState::contradicted, "the pair has no link"});
  return result;
}

TEST(ProjectPage, AnswersAreLinesForAShellAndPointsStandInTableAndPlan) {
  const std::string page = project_page(some_result());
  const auto holds = [&](const char* text) { return page.find(text) != std::string::npos; };
  // The quote of the name is closed, written and opened again, as HTML has it.
  EXPECT_TRUE(
      holds("data-line=\"limen project decide DIR choose hall.ply &#39;o&#39;\\&#39;&#39;clock.ply&#39; 2\""))
      << page.substr(page.find("data-line"), 200);
  EXPECT_TRUE(holds("class=\"answer\""));
  EXPECT_TRUE(holds("level hall.ply"));
  EXPECT_TRUE(holds("contradicted"));
  EXPECT_TRUE(holds("P&lt;1&gt;"));
  EXPECT_FALSE(holds("P<1>"));
  EXPECT_TRUE(holds("control point P&lt;1&gt;: left_out, residual 50.0 mm"));
  EXPECT_TRUE(holds("The frame is that of the control points in control.csv."));
}

TEST(ProjectJson, PointsDecisionsAndAnswersAreStated) {
  const nlohmann::json stated = nlohmann::json::parse(project_json(some_result(), {}));
  EXPECT_EQ(stated["frame"]["file"], "control.csv");
  EXPECT_TRUE(stated["frame"]["scan"].is_null());
  EXPECT_EQ(stated["questions"][0]["answers"][0], R"(choose hall.ply 'o'\''clock.ply' 2)");
  EXPECT_EQ(stated["decisions"][0]["state"], "contradicted");
  const nlohmann::json& point = stated["points"][0];
  EXPECT_EQ(point["state"], "left_out");
  EXPECT_EQ(point["given"][1].get<double>(), 6862123.4562);
  EXPECT_EQ(point["seen_by"][0]["scan"], 1);
  // What was left out was not tested together with the rest.
  EXPECT_FALSE(point.contains("detectable_m"));
}

TEST(ProjectJson, WithoutSurveyAndDecisionsNothingIsSaidOfThem) {
  const nlohmann::json stated = nlohmann::json::parse(project_json(ProjectResult{}, {}));
  EXPECT_FALSE(stated.contains("points"));
  EXPECT_FALSE(stated.contains("control"));
  EXPECT_FALSE(stated.contains("decisions"));
}

/// The same with a pass that was bent, and one that was not.
ProjectResult drifted_result() {
  ProjectResult result = some_result();
  for (ProjectScan& scan : result.scans) scan.mobile = true;
  PassCorrection correction;
  correction.pivot = {652300.0, 6862100.0, 30.0};
  for (int k = 0; k < 4; ++k) {
    PassKnot knot;
    knot.time_s = 381000.0 + 1.5 * k;
    knot.distance_m = 5.0 * k;
    knot.turn_rad = {0.0, 1e-5 * k, 2e-4};
    knot.shift_m = {0.004 * k, -0.01, 0.0};
    knot.moved_m = knot.shift_m;
    knot.moved_sigma_m = Vector3d::Constant(0.001);
    correction.knots.push_back(knot);
  }
  result.scans[0].correction = correction;
  result.scans[1].rigid = "its points have no times, or its path is short: it is treated as rigid";
  return result;
}

/// A room that is turned by 20 degrees, and its first storey; the picture of a scan holds three points.
ProjectResult two_floors() {
  ProjectResult result;
  result.outcome = ProjectOutcome::registered;
  const double turn = radians(20.0);
  const Vector3d along(std::cos(turn), std::sin(turn), 0);
  for (const double height : {1.5, 4.7}) {
    ProjectScan scan;
    scan.file = height < 2 ? "/a/folder/hall.ply" : "/a/folder/above.ply";
    scan.component = 0;
    scan.state = NodeState::registered;
    Rigid3 pose;
    pose.translation = {10.0, 0.0, height};
    scan.frame_from_scan = pose;
    scan.stations = {pose.translation};
    scan.sigma.centre = pose.translation;
    scan.patches.push_back({pose.translation + along, 2.0 * along, 1.2 * Vector3d::UnitZ(), true});
    result.scans.push_back(scan);
  }
  ProjectLink link;
  link.source = 1;
  link.target = 0;
  link.solved.state = LinkState::bridge;
  link.target_from_source.translation = {0, 0, 3.2};
  link.matches.push_back({4, 7, 0.001, 0.002, 3.5});
  result.links.push_back(link);
  return result;
}

nlohmann::json scene_of(const std::string& page) {
  const std::size_t begin = page.find('{', page.find("id=\"scene\""));
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(ProjectPage, ShowsScansWhereTheyStandAlongTheBuildingsWalls) {
  const ProjectResult result = two_floors();
  std::vector<ProjectPicture> pictures(2);
  pictures[0].points.points = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  pictures[0].points.local_origin = {100.0, 0.0, 0.0};
  const std::string page = project_page(result, pictures);
  EXPECT_EQ(page.find("<g class=\"north\""), std::string::npos) << "a scanner's own frame has no north";
  EXPECT_NE(project_page(result, {}, true).find("<g class=\"north\""), std::string::npos);
  const nlohmann::json scene = scene_of(page);
  EXPECT_NEAR(scene["axes"][0][0].get<double>(), std::cos(radians(20.0)), 1e-9);
  EXPECT_NEAR(scene["axes"][0][1].get<double>(), std::sin(radians(20.0)), 1e-9);
  EXPECT_EQ(scene["side-0"]["name"], "hall.ply");
  EXPECT_EQ(scene["side-0"]["count"], 3);
  EXPECT_EQ(scene["side-1"]["shape"], "none");
  EXPECT_EQ(page.find("/a/folder"), std::string::npos);
  // A point's place in the frame is computed again from the page's own numbers.
  const auto number = [](const nlohmann::json& value) { return value.get<double>(); };
  Vector3d in_frame = Vector3d::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (std::size_t c = 0; c < 3; ++c)
      in_frame[static_cast<Eigen::Index>(c)] +=
          number(scene["axes"][row][c]) * number(scene["side-0"]["place"][row][3]);
  }
  for (std::size_t c = 0; c < 3; ++c) in_frame[static_cast<Eigen::Index>(c)] += number(scene["origin"][c]);
  EXPECT_LT((in_frame - Vector3d(110.0, 0.0, 1.5)).norm(), 1e-9);
  ASSERT_EQ(scene["floors"].size(), 2U);
  EXPECT_EQ(scene["floors"][1]["scans"], nlohmann::json({1}));
  EXPECT_EQ(scene["links"][0]["matches"][0][1], 7);
  // The link's pose is between the sides' own origins.
  EXPECT_NEAR(number(scene["links"][0]["pose"][0][3]), -100.0, 1e-9);
  EXPECT_NE(page.find("Plan of floor 2, stations at 4.7 m"), std::string::npos);
  EXPECT_NE(page.find("Section from the side"), std::string::npos);
}

/// Whatever a page may say.
ProjectResult talkative_result() {
  ProjectResult result = drifted_result();
  result.tolerance_m = 0.006;
  result.reason = "1 of 3 scans are registered in one frame, 1 more is probable; 2 questions are open";
  result.frame_scan = 0;
  result.sigma_scan = 0;
  for (ProjectScan& scan : result.scans) scan.reason = "the only scan";
  for (const NodeState state : {NodeState::registered, NodeState::probable, NodeState::ambiguous,
                                NodeState::under_constrained, NodeState::floating}) {
    ProjectScan scan = two_floors().scans[0];
    scan.state = state;
    scan.file = std::string(to_string(state)) + ".ply";
    scan.sigma.translation_m = Vector3d::Constant(0.002);
    scan.reason = "registered by 2 links checked by loops";
    result.scans.push_back(scan);
  }
  result.scans.back().readable = false;
  for (const LinkState state :
       {LinkState::verified, LinkState::bridge, LinkState::ambiguous, LinkState::rejected, LinkState::weak}) {
    ProjectLink link = two_floors().links[0];
    link.source = 2 + static_cast<int>(result.links.size());
    link.target = 1;
    link.solved.state = state;
    link.adjusted = link.matches;
    link.reason = "the overlap is so small that it may be chance (12.5 %)";
    result.links.push_back(link);
  }
  result.loops.push_back({{0, 1}, 0.001, 0.0001, 2.5, true});
  result.notes = {"hall.ply was given more than once; it counts once"};
  ProjectQuestion question;
  question.text =
      "Where is hall.ply? Its present place follows from: hall.ply with b.ply. Another place follows from: "
      "no "
      "link. Which of these links is right?";
  for (const DecisionKind kind : {DecisionKind::accept, DecisionKind::reject, DecisionKind::forget})
    question.answers.push_back({kind, {"hall.ply", "b.ply"}, 0});
  result.questions = {question};
  return result;
}

TEST(ProjectPage, LacksNoTextInAnyLanguage) {
  ReportCover cover{"A title of mine", "a project", "an operator", "May 3rd"};
  const std::string page = project_page(talkative_result(), std::vector<ProjectPicture>(7), true, cover);
  for (const Language language : {Language::french, Language::german}) {
    std::set<std::string> missing;
    static_cast<void>(page_in_language(page, language, &missing));
    EXPECT_EQ(missing, std::set<std::string>());
    cover.language = language;
    EXPECT_EQ(project_page(talkative_result(), {}, true, cover).find("html lang=\"en\""), std::string::npos);
  }
}

TEST(ProjectPage, InGermanItSaysTheSame) {
  const std::string page = project_page(talkative_result(), {}, false, {"", "", "", "", Language::german});
  const auto holds = [&](const char* text) { return page.find(text) != std::string::npos; };
  EXPECT_TRUE(
      holds("1 von 3 Scans sind in einem Koordinatensystem registriert, 1 weiterer ist wahrscheinlich; 2 "
            "Fragen sind offen"));
  EXPECT_TRUE(holds("<td class=\"state bridge\">ungeprüft</td>"));
  EXPECT_TRUE(holds("das von hall.ply") || holds("Passpunkte in control.csv"));
  EXPECT_TRUE(holds("\"By state\":\"Nach Zustand\"")) << "the script has its texts";
  EXPECT_TRUE(holds("Ist dies derselbe Ort, so zusammengefügt wie gezeigt? hall.ply und b.ply"));
  EXPECT_TRUE(holds(">Weiß nicht</button>"));
}

/// Three points at the height of windows.
ProjectPicture some_picture() {
  ProjectPicture picture;
  picture.points.points = {{0, 0, 0}, {4, 0, 1}, {0, 3, 1}, {2, 3, 1}};
  return picture;
}

TEST(ProjectPage, AQuestionShowsBothScansAndOneAnswerForEachChoice) {
  ProjectResult result = two_floors();
  ProjectQuestion question;
  question.text = "Which?";
  for (const DecisionKind kind : {DecisionKind::accept, DecisionKind::reject, DecisionKind::forget})
    question.answers.push_back({kind, {"/a/folder/above.ply", "/a/folder/hall.ply"}, 0});
  result.questions = {question};
  const std::vector<std::string> drawn = question_pictures(result, {some_picture(), some_picture()});
  ASSERT_EQ(drawn.size(), 1U);
  EXPECT_LT(drawn[0].find("above.ply</text>"), drawn[0].find("hall.ply</text>"));
  const std::string page = project_page(result, {some_picture(), some_picture()});
  EXPECT_NE(page.find(drawn[0]), std::string::npos);
  for (const char* answer : {"accept /a/folder/above.ply /a/folder/hall.ply\">Yes<",
                             "reject /a/folder/above.ply /a/folder/hall.ply\">No<",
                             "forget /a/folder/above.ply /a/folder/hall.ply\">Don't know<"})
    EXPECT_NE(page.find(answer), std::string::npos) << answer;
  EXPECT_EQ(question_pictures(result, std::vector<ProjectPicture>(2)), std::vector<std::string>({""}));
}

TEST(ProjectPage, DrawsHowPassesDriftedAndTellsWhyOthersStayRigid) {
  const std::string page = project_page(drifted_result());
  EXPECT_NE(page.find("drift corrected along 15 m"), std::string::npos);
  EXPECT_NE(page.find("<polyline points=\"56.0,"), std::string::npos);
  EXPECT_NE(page.find("its points have no times"), std::string::npos);
  EXPECT_EQ(project_page(some_result()).find("Drift of the passes"), std::string::npos);
}

TEST(ProjectPage, ABendIsReadBackAsItWasWritten) {
  const ProjectResult result = drifted_result();
  const testing_io::TemporaryFolder folder;
  const std::vector<ProjectEntry> entries = read_project(folder.write("p.json", project_json(result, {})));
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[1].bend, nullptr);
  ASSERT_NE(entries[0].bend, nullptr);
  for (const PassKnot& knot : result.scans[0].correction->knots) {
    Vector6d value;
    value << knot.turn_rad, knot.shift_m;
    EXPECT_LT((entries[0].bend->value(knot.time_s) - value).norm(), 1e-15);
  }
  const Vector3d pivot = result.scans[0].correction->pivot;
  EXPECT_LT((entries[0].bend->moved(pivot, 381000.0) - pivot - Vector3d(0.0, -0.01, 0.0)).norm(), 1e-9);
}

}  // namespace
}  // namespace limen
