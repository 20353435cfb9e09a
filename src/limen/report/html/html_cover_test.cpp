// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_cover.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace limen {
namespace {

RegistrationReport found() {
  RegistrationReport report;
  report.result.outcome = Outcome::registered;
  report.result.best.probability = 0.99996;
  report.result.best.rms_m = 0.0021;
  report.result.best.sigma.covariance.diagonal() << 1e-10, 1e-10, 1e-10, 1e-8, 1e-8, 1e-8;
  report.source.path = "scans/room.ply";
  report.source.inner_high = Vector3d(20, 0, 0);
  return report;
}

TEST(ReportCover, SaysTheSameInThreeLanguages) {
  const std::vector<std::string> english = cover_summary(found(), Language::english);
  ASSERT_EQ(english.size(), 4U);
  EXPECT_EQ(english[1], "The probability that this is the right place is more than 99.99 %.");
  EXPECT_EQ(
      english[2],
      "Accuracy of room.ply (95 %): 0.3 mm at the centre, 0.6 mm at the far end, 20 m from the centre.");
  const std::vector<std::string> french = cover_summary(found(), Language::french);
  EXPECT_EQ(french[1], "La probabilité que ce soit la bonne position est de plus de 99,99 %.");
  EXPECT_EQ(french[2],
            "Exactitude de room.ply (95 %) : 0,3 mm au centre, 0,6 mm à l'extrémité, à 20 m du centre.");
  const std::vector<std::string> german = cover_summary(found(), Language::german);
  EXPECT_EQ(german[1], "Die Wahrscheinlichkeit, dass dies die richtige Lage ist, beträgt mehr als 99,99 %.");
  EXPECT_EQ(german[2],
            "Genauigkeit von room.ply (95 %): 0,3 mm in der Mitte und, 20 m davon entfernt, 0,6 mm am fernen "
            "Ende.");
  EXPECT_EQ(german.size(), english.size());
  EXPECT_EQ(french.size(), english.size());
}

TEST(ReportCover, EveryOutcomeHasItsSentence) {
  for (const Language language : {Language::english, Language::french, Language::german}) {
    std::vector<std::string> stated;
    for (const Outcome outcome : {Outcome::registered, Outcome::probable, Outcome::ambiguous,
                                  Outcome::under_constrained, Outcome::no_match}) {
      RegistrationReport report = found();
      report.result.outcome = outcome;
      stated.push_back(cover_summary(report, language).front());
    }
    std::sort(stated.begin(), stated.end());
    EXPECT_EQ(std::unique(stated.begin(), stated.end()), stated.end());
  }
}

TEST(ReportCover, IsEscapedAndLeftOutWhereNothingIsSaid) {
  EXPECT_EQ(cover_html(found(), {}), "");
  const std::string html = cover_html(found(), {"<b>Title</b>", "A & B", "", "", Language::german});
  EXPECT_EQ(html.find("<b>Title"), std::string::npos);
  EXPECT_NE(html.find("A &amp; B"), std::string::npos);
  EXPECT_NE(html.find("lang=\"de\""), std::string::npos);
  EXPECT_EQ(html.find("Bearbeiter"), std::string::npos);
}

}  // namespace
}  // namespace limen
