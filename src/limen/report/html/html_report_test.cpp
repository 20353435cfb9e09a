// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_report.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/spread_evenly.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_residuals.h"
#include "limen/report/html/html_tables.h"
#include "limen/report/html/section_svg.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

/// A rectangle of a wall or a floor with a normal that was seen.
PlanarPolygon rectangle(const Plane& plane, const Vector3d& middle, double width, double height) {
  PlanarPolygon polygon;
  polygon.plane = plane;
  polygon.frame = make_frame(plane, middle);
  const double w = 0.5 * width;
  const double h = 0.5 * height;
  polygon.parts = {{{{-w, -h}, {w, -h}, {w, h}, {-w, h}}, {}}};
  polygon.area_m2 = width * height;
  polygon.oriented = true;
  return polygon;
}

/// A room of 4 x 3 x 2.5 m with `count` points on its floor and one wall.
SceneSide room(std::size_t count, const Vector3d& origin) {
  SceneSide side;
  side.origin = origin;
  side.pictured.upright = true;
  Features& features = side.pictured.features;
  features.local_origin = origin;
  features.planes = {rectangle({Vector3d::UnitZ(), 0.0}, {2, 1.5, 0}, 4, 3),
                     rectangle({Vector3d::UnitX(), 0.0}, {0, 1.5, 1.25}, 3, 2.5)};
  RandomStream random(1);
  for (std::size_t i = 0; i < count; ++i) {
    side.points.push_back(i % 2 == 0 ? Vector3d(random.uniform(0, 4), random.uniform(0, 3), 0.0)
                                     : Vector3d(0.0, random.uniform(0, 3), random.uniform(0, 2.5)));
    for (int c = 0; c < 3; ++c) side.colours.push_back(static_cast<std::uint8_t>(random.below(256)));
    side.intensities.push_back(static_cast<float>(random.uniform()));
  }
  return side;
}

ReportScene two_rooms(std::size_t count) {
  return {room(count, Vector3d::Zero()), room(count, {1050000, 6840000, 150})};
}

RegistrationReport report_of(Outcome outcome) {
  RegistrationReport report;
  report.result.outcome = outcome;
  report.result.reason = "a reason of 2.5 m2";
  report.result.best.target_from_source.translation = Vector3d(1050000, 6840000, 150.001);
  report.result.best.agreeing_m2 = 19.5;
  report.result.best.rms_m = 0.002;
  PoseSigma& sigma = report.result.best.sigma;
  sigma.translation_m = Vector3d(0.0003, 0.0002, 0.0001);
  sigma.rotation_rad = Vector3d(1e-5, 1e-5, 1e-5);
  sigma.covariance.diagonal() << 1e-10, 1e-10, 1e-10, 9e-8, 4e-8, 1e-8;
  sigma.centre = report.result.best.target_from_source.translation;
  report.source.inner_low = Vector3d(-30, 0, 0);
  report.source.inner_high = Vector3d(30, 0, 0);
  report.result.sigma = sigma;
  report.result.matches = {{0, 0, 0.001, 0.0, 12.0}, {1, 1, 0.0, 0.0, 7.5}};
  report.source.path = "room.ply";
  report.target.path = "street.ply";
  return report;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Every tag is closed in its order, and nothing is unescaped.
bool is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  static const std::regex tag("<(/?)([a-zA-Z]+)((?:\\s+[a-zA-Z:-]+=\"[^\"<]*\")*)\\s*(/?)>");
  std::size_t at = 0;
  while (at < xml.size()) {
    if (xml[at] == '>') return false;
    if (xml[at] != '<') {
      ++at;
      continue;
    }
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string one = xml.substr(at, end - at + 1);
    const std::size_t name_end = one.find_first_of(" />\n", 2);
    if (count_of(one, "\"") % 2 != 0 || one.find('<', 1) != std::string::npos) return false;
    if (one[1] == '/') {
      if (open.empty() || open.back() != one.substr(2, one.size() - 3)) return false;
      open.pop_back();
    } else if (one[one.size() - 2] != '/') {
      open.push_back(one.substr(1, name_end - 1));
    }
    at = end + 1;
  }
  return open.empty();
}

TEST(HtmlBytes, QuantisingLosesAtMostHalfAStep) {
  RandomStream random(3);
  std::vector<Vector3d> points;
  for (int i = 0; i < 5000; ++i)
    points.push_back({random.uniform(-40, 60), random.uniform(100, 130), random.uniform(0, 12)});
  const QuantisedPoints quantised = quantise(points);
  ASSERT_EQ(quantised.numbers.size(), 3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double number = quantised.numbers[3 * i + static_cast<std::size_t>(axis)];
      const double back = quantised.low[axis] + quantised.step[axis] * number;
      EXPECT_LE(std::abs(back - points[i][axis]), 0.5 * quantised.step[axis] + 1e-12);
    }
  }
  EXPECT_LT(quantised.step.x(), 100.0 / 65535 + 1e-9);
}

TEST(HtmlBytes, QuantisingTakesFlatAndEmptyClouds) {
  EXPECT_TRUE(quantise(std::vector<Vector3d>{}).numbers.empty());
  const QuantisedPoints flat = quantise(std::vector<Vector3d>{{1, 2, 3}, {1, 2, 3}});
  EXPECT_EQ(flat.numbers, std::vector<std::uint16_t>(6, 0));
  EXPECT_EQ(flat.low, Vector3d(1, 2, 3));
}

TEST(HtmlBytes, Base64IsThatOfTheStandard) {
  const auto of = [](const std::string& text) { return base64({text.begin(), text.end()}); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64({0xff, 0xfe}), "//4=");
}

TEST(HtmlBytes, EscapesWhatHtmlWouldTakeForItself) {
  EXPECT_EQ(escaped("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
  EXPECT_EQ(escaped("Zürich €"), "Zürich €");
  EXPECT_EQ(escaped("bad\xff"), "bad\xef\xbf\xbd");
  EXPECT_EQ(escaped("a\xe2\x80\xae<b\nc"), "a\\u202E&lt;b\nc");
}

TEST(HtmlScene, ThinsEvenlyAndNoMoreThanAsked) {
  const SceneSide side = room(40000, Vector3d::Zero());
  const std::vector<std::uint32_t> kept = spread_evenly(side.points, 5000);
  EXPECT_LE(kept.size(), 5000U);
  EXPECT_GT(kept.size(), 2500U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(spread_evenly(side.points, 40000).size(), 40000U);
}

TEST(HtmlResiduals, PointsFindTheirPlaneAndItsPartner) {
  const ReportScene scene = two_rooms(2000);
  const RegistrationReport report = report_of(Outcome::registered);
  const std::vector<std::uint8_t> planes = plane_of_points(scene.source);
  const PointResiduals residuals = point_residuals(scene, report.result, planes);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Vector3d& x = scene.source.points[i];
    if (x.x() < 0.02 && x.z() < 0.02) continue;  // the corner belongs to both
    ASSERT_EQ(planes[i], x.z() > 0 ? 2 : 1) << x.transpose();
    const double distance = (residuals.values[i] - 128) / 127.0 * residuals.range_m;
    EXPECT_NEAR(distance, x.z() > 0 ? 0.0 : 0.001, residuals.range_m / 200);
  }
}

TEST(SectionSvg, CutsAWallWithAWindowIntoTwoPieces) {
  PlanarPolygon wall = rectangle({Vector3d::UnitX(), 0.0}, {0, 0, 0}, 6, 3);
  wall.parts[0].holes = {{{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}};
  const std::vector<Segment> pieces = cut_polygon(wall, {Vector3d::UnitZ(), 0.5});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(pieces[0].length() + pieces[1].length(), 4.0, 1e-12);
  EXPECT_EQ(cut_polygon(wall, {Vector3d::UnitZ(), 1.2}).size(), 1U);
  EXPECT_TRUE(cut_polygon(wall, {Vector3d::UnitZ(), 2.0}).empty());
  EXPECT_TRUE(cut_polygon(wall, {Vector3d::UnitX(), 0.0}).empty());
}

TEST(ReportPage, EveryOutcomeHasItsPage) {
  const ReportScene scene = two_rooms(3000);
  for (const auto& [outcome, words] : std::vector<std::pair<Outcome, std::string>>{
           {Outcome::registered, "Registered: the two scans fit in one way only"},
           {Outcome::probable, "Probable: a pose was found, but it is less certain than registered requires"},
           {Outcome::ambiguous, "Not decided: 3 ways fit about equally well"},
           {Outcome::under_constrained, "Shift along (0.00, 1.00, 0.00) is not determined by the data."},
           {Outcome::no_match, "No match: the two scans have no reliable overlap"}}) {
    RegistrationReport report = report_of(outcome);
    if (outcome == Outcome::ambiguous) {
      report.result.rivals = 2;
      report.result.alternatives.resize(3);
    }
    if (outcome == Outcome::under_constrained)
      report.result.unobserved = {{false, Vector3d::UnitY(), "shift along (0.00, 1.00, 0.00)"}};
    const ReportPages pages = report_pages(report, scene);
    EXPECT_NE(pages.page.find(words), std::string::npos) << words;
    EXPECT_NE(pages.page.find(std::string("<body data-outcome=\"") + to_string(outcome) + "\">"),
              std::string::npos);
    EXPECT_EQ(pages.page.find("Registered:") == std::string::npos, outcome != Outcome::registered);
    EXPECT_EQ(pages.page.find("{{"), std::string::npos);
    EXPECT_EQ(count_of(pages.page, "<svg xmlns"), 3U);
    EXPECT_EQ(pages.page.find("id=\"matrix\"") == std::string::npos, outcome == Outcome::no_match);
    for (const std::string& svg : {pages.top, pages.front, pages.side}) EXPECT_TRUE(is_well_formed(svg));
  }
}

/// All that a page of this outcome can say.
std::vector<RegistrationReport> talkative_reports(Outcome outcome) {
  RegistrationReport report = report_of(outcome);
  RegistrationResult& result = report.result;
  result.reason = "12.5 m2 of surface agree, 0.5 m2 contradict, and no other pose fits nearly as well";
  result.best.probability = 0.99996;
  result.best.room = "A1";
  result.best.sigma.formal_covariance = 0.25 * result.best.sigma.covariance;
  result.best.explained_share = 0.5;
  result.thickness = {{0, 1, 2, 0.3, 0.001}, {1, 1, 1, 0.3, 0.5}};
  result.openings.resize(1);
  result.alternatives.assign(2, result.best);
  result.alternatives[0].tie = true;
  for (const char* stage :
       {"reading", "source features", "target features", "source features, target features", "hypotheses",
        "scoring", "refinement", "judgement", "published method", "candidates", "verdict"})
    result.stages.push_back({stage, 0.25});
  report.source.with = {"with.ply"};
  report.source.sha256 = "abcd";
  report.options = {{"method", std::string("a method of mine")}};
  if (outcome == Outcome::under_constrained)
    result.unobserved = {{false, Vector3d::UnitY(), "shift along (0.00, 1.00, 0.00)"}};
  std::vector<RegistrationReport> reports = {report};
  const auto add = [&](const auto& change) {
    reports.push_back(report);
    change(reports.back());
  };
  add([](RegistrationReport& it) {
    it.source.kind = "scan";
    it.source.mobile = true;
    it.target.kind = "model";
    it.target.metres_per_unit = 0.001;
    it.result.moved.resize(2);
  });
  add([](RegistrationReport& it) {
    it.source.kind = it.target.kind = "scan";
    it.source.centre_known = it.target.centre_known = true;
    it.result.rivals = 2;
    it.result.others = OtherExplanations{0.01, 0.0, 0.0};
    it.result.unobserved.push_back({false, Vector3d::UnitZ(), "shift along the vertical"});
  });
  add([](RegistrationReport& it) {
    it.source.kind = it.target.kind = "segments";
    it.result.matches.clear();
    it.result.best.matched_segments = 4;
    it.result.best.agreeing_length_m = 12.5;
    it.result.reason = "4 segments, 12.5 m, coincide in one plane, and no other pose fits nearly as well";
  });
  add([](RegistrationReport& it) { it.result.moved = {{0, 0, 0.06, 0.0, 2.0}}; });
  add([](RegistrationReport& it) { it.result.moved = {{0, 0, 0.06, 0.0, 2.0}, {1, 1, -0.02, 0.0, 1.0}}; });
  add([](RegistrationReport& it) {
    it.result.published = PublishedScore{};
    it.result.published->method = "2022";
    it.result.reason =
        "the published method 2022 finds no pose: the planes of the source lie in fewer than "
        "three independent directions";
  });
  return reports;
}

TEST(ReportPage, LacksNoTextInAnyLanguage) {
  const ReportScene scene = two_rooms(100);
  for (const Outcome outcome : {Outcome::registered, Outcome::probable, Outcome::ambiguous,
                                Outcome::under_constrained, Outcome::no_match}) {
    for (const RegistrationReport& report : talkative_reports(outcome)) {
      const ReportPages pages =
          report_pages(report, scene, {"A title of mine", "a project", "an operator", "May 3rd"});
      for (const Language language : {Language::french, Language::german}) {
        std::set<std::string> missing;
        static_cast<void>(page_in_language(pages.page, language, &missing));
        static_cast<void>(
            page_in_language(sigma_table(report, 0) + key_table(report, 0), language, &missing));
        EXPECT_EQ(missing, std::set<std::string>()) << to_string(outcome);
      }
    }
  }
}

TEST(ReportPage, InGermanAndFrenchItSaysTheSame) {
  RegistrationReport report = report_of(Outcome::registered);
  report.result.best.probability = 0.99996;
  report.source.path = "station_1.5.ply";
  report.options = {{"origin", std::string("0.5,0,0")}};
  const ReportPages german = report_pages(report, two_rooms(100), {"", "", "", "", Language::german});
  const auto holds = [&](const char* text) { return german.page.find(text) != std::string::npos; };
  EXPECT_TRUE(holds("<html lang=\"de\">"));
  EXPECT_TRUE(holds("<h1>Registriert: die beiden Scans passen nur auf eine Weise zusammen</h1>"));
  EXPECT_TRUE(holds("<title translate=\"no\">Registriert: die beiden"));
  EXPECT_TRUE(holds("Dies ist die richtige Lage mit einer Wahrscheinlichkeit von mehr als 99,99 %."));
  EXPECT_TRUE(holds("\"probability\":\"mehr als 99,99 %\"")) << "the script's own poses";
  EXPECT_TRUE(holds("\"Copied\":\"Kopiert\"")) << "the script's own texts";
  EXPECT_TRUE(holds("Freiheitsgrad\\u003c/th>")) << "tables of the poses that the script shows";
  EXPECT_TRUE(holds(">station_1.5.ply<") && holds(">0.5,0,0<")) << "names stay";
  EXPECT_TRUE(holds(" 150.001")) << "the matrix is that of transform.txt";
  EXPECT_NE(german.top.find(">Grundriss, 0,3 m dick</text>"), std::string::npos) << german.top.substr(0, 900);
  EXPECT_NE(german.front.find("aria-label=\"Schnitt von vorne"), std::string::npos);
  const ReportPages french = report_pages(report, two_rooms(100), {"", "", "", "", Language::french});
  EXPECT_NE(french.page.find("Recalé : les deux scans ne s&#39;assemblent que d&#39;une seule façon"),
            std::string::npos);
}

TEST(ReportPage, ThePlanTellsNorthOnAGridElseTheAxis) {
  ReportScene scene = two_rooms(100);
  const ReportPages grid = report_pages(report_of(Outcome::registered), scene);
  EXPECT_NE(grid.top.find(">N</text>"), std::string::npos);
  EXPECT_EQ(grid.front.find(">N</text>"), std::string::npos);
  scene.target.origin = Vector3d::Zero();
  EXPECT_NE(report_pages(report_of(Outcome::registered), scene).top.find(">y</text>"), std::string::npos);
}

TEST(ReportPage, OpenFreedomsAreNamedInTheTable) {
  RegistrationReport report = report_of(Outcome::under_constrained);
  report.result.unobserved = {{false, Vector3d::UnitY(), "shift along (0.00, 1.00, 0.00)"}};
  EXPECT_TRUE(is_open(report.result, false, 1));
  EXPECT_FALSE(is_open(report.result, false, 0));
  EXPECT_FALSE(is_open(report.result, true, 1));
  const std::string page = report_pages(report, two_rooms(100)).page;
  EXPECT_EQ(count_of(page, "◇ not determined by the data"), 2U)
      << "in the table, and with the pose that shows it";
}

TEST(ReportPage, NoNameBreaksIt) {
  RegistrationReport report = report_of(Outcome::registered);
  report.source.path = "a/</script><script>alert(1)</script><!-- \" 'ü\xff.ply";
  report.target.path = "{{scene}}.ply";
  report.result.best.room = "<b>Room</b>";
  report.options = {{"origin", std::string("<i>0,0,0</i>")}};
  const std::string page = report_pages(report, two_rooms(100)).page;
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(page.find("<b>Room"), std::string::npos);
  EXPECT_EQ(page.find("<i>"), std::string::npos);
  EXPECT_EQ(count_of(page, "id=\"scene\""), 1U);
  EXPECT_EQ(count_of(page, "<script"), count_of(page, "</script>"));
  EXPECT_NE(page.find("{{scene}}.ply"), std::string::npos);
}

TEST(ReportPage, ForbidsTheNetworkAndKeepsWithinTenMegabytes) {
  const std::string page = report_pages(report_of(Outcome::registered), two_rooms(300000)).page;
  EXPECT_LE(page.size(), 10'000'000U);
  EXPECT_GT(page.size(), 6'000'000U);
  EXPECT_NE(page.find("Content-Security-Policy\" content=\"default-src 'none'"), std::string::npos);
  static const std::regex outside("(src|href)=\"(?!data:|#)");
  EXPECT_FALSE(std::regex_search(page.substr(0, 60000), outside));
  EXPECT_EQ(page.find("https://"), std::string::npos);
}

TEST(ReportPage, IsTheSameForAnyNumberOfThreads) {
  const ReportScene scene = two_rooms(30000);
  set_thread_count(1);
  const ReportPages one = report_pages(report_of(Outcome::registered), scene);
  set_thread_count(4);
  const ReportPages four = report_pages(report_of(Outcome::registered), scene);
  set_thread_count(0);
  EXPECT_EQ(one.page, four.page);
  EXPECT_EQ(one.top, four.top);
}

TEST(ReportPage, TakesSidesWithoutAnything) {
  const ReportPages pages = report_pages(report_of(Outcome::no_match), {});
  EXPECT_NE(pages.page.find("No match"), std::string::npos);
  EXPECT_TRUE(is_well_formed(pages.top));
}

TEST(ReportWords, PromiseNothingOfWhatIsOpen) {
  RegistrationReport report = report_of(Outcome::under_constrained);
  const auto stated = [&report](const std::string& words) {
    const std::vector<std::string> sentences = verdict_words(report).sentences;
    return std::any_of(sentences.begin(), sentences.end(), [&words](const std::string& sentence) {
      return sentence.find(words) != std::string::npos;
    });
  };
  report.result.unobserved = {{false, Vector3d::UnitX(), "shift along x"}};
  EXPECT_TRUE(stated("Shift along x is not determined by the data."));
  EXPECT_TRUE(stated("from the centre, perpendicular to the undetermined direction."));
  report.result.unobserved.push_back({true, Vector3d(1, 1, 1).normalized(), "turn"});
  EXPECT_TRUE(stated("Turn is not determined by the data."));
  EXPECT_FALSE(stated("95 %")) << "where a turn is open no place is known";
}

TEST(ReportWords, HeadlineHoldsAtTheFarEnd) {
  RegistrationReport report = report_of(Outcome::registered);
  report.result.best.probability = 0.9987;
  const std::vector<std::string> sentences = verdict_words(report).sentences;
  ASSERT_EQ(sentences.size(), 3U);
  EXPECT_EQ(sentences[0], "This is the right place with a probability of 99.87 %.");
  EXPECT_EQ(
      sentences[1],
      "Accuracy of room.ply (95 %): 1.2 mm at the centre, 1.8 mm at the far end, 30 m from the centre.");
  EXPECT_EQ(sentences[2],
            "Residuals: 2.0 mm of the points, 0.8 mm between matched planes (root mean square).");
}

TEST(ReportWords, AFreedomBesideAnAmbiguityIsStated) {
  RegistrationReport report = report_of(Outcome::ambiguous);
  report.result.rivals = 1;
  report.result.unobserved = {{false, Vector3d::UnitX(), "shift along x"}};
  EXPECT_EQ(verdict_words(report).sentences.back(), "Shift along x is not determined by the data.");
}

TEST(ReportWords, LengthsAndAngles) {
  EXPECT_EQ(length_words(0.00031), "0.3 mm");
  EXPECT_EQ(length_words(-0.00001), "0.0 mm");
  EXPECT_EQ(length_words(0.0123), "12 mm");
  EXPECT_EQ(length_words(-0.25), "-25.0 cm");
  EXPECT_EQ(length_words(1.5), "1.50 m");
  EXPECT_EQ(length_words(std::nan("")), "—");
  EXPECT_EQ(angle_words(0.00001), "0.0006°");
}

}  // namespace
}  // namespace limen
