// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/language.h"

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "limen/report/html/report_page.h"

namespace limen {
namespace {

std::map<std::string, std::string> language_table(std::string_view text) {
  std::map<std::string, std::string> table;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = line.find('\t');
    EXPECT_NE(tab, std::string::npos) << line;
    EXPECT_TRUE(table.emplace(line.substr(0, tab), line.substr(tab + 1)).second) << "twice: " << line;
  }
  return table;
}

std::size_t values_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '{'));
}

TEST(Language, EveryTextIsInBothTablesWithItsValues) {
  const auto french = language_table(french_texts());
  const auto german = language_table(german_texts());
  EXPECT_GT(french.size(), 100U);
  for (const auto& [english, other] : french) EXPECT_EQ(german.count(english), 1U) << english;
  for (const auto* table : {&french, &german}) {
    EXPECT_EQ(table->size(), french.size());
    for (const auto& [english, other] : *table) {
      EXPECT_FALSE(other.empty()) << english;
      EXPECT_EQ(values_of(english), values_of(other)) << english;
      EXPECT_EQ(english.find("{}{}"), std::string::npos) << english;
    }
  }
}

TEST(Language, EveryTextOfTheScriptsIsInTheTables) {
  const auto german = language_table(german_texts());
  const std::string script = std::string(project_script()) + std::string(report_script());
  const std::regex text("\\bt`([^`]*)`");
  std::size_t count = 0;
  for (std::sregex_iterator it(script.begin(), script.end(), text), end; it != end; ++it) {
    const std::string english = std::regex_replace((*it)[1].str(), std::regex("\\$\\{[^}]*\\}+"), "{}");
    if (std::regex_match(english, std::regex("(\\{\\}|mm|cm|m(²)?|[ ,°+])*"))) continue;
    EXPECT_EQ(german.count(english), 1U) << english;
    ++count;
  }
  EXPECT_GT(count, 100U);
}

/// Literals that read like words for people, of a line of a script.
std::set<std::string> plain_words_in(const std::string& line) {
  static const std::regex quoted("'([^']*)'");
  static const std::regex words("[A-Z][a-z]+( .*)?|.*[a-z]{2,} [a-z]{2,}.*");
  static const std::regex pattern("(^|[^t])`([A-Z][a-z]+ [^`]*|[^`]*\\}[,:]? [a-z]{3,}[^a-z(][^`]*)`");
  std::set<std::string> found;
  for (std::sregex_iterator it(line.begin(), line.end(), quoted), end; it != end; ++it) {
    if (std::regex_match((*it)[1].str(), words)) found.insert(it->str());
  }
  for (std::sregex_iterator it(line.begin(), line.end(), pattern), end; it != end; ++it)
    found.insert(it->str());
  return found;
}

TEST(Language, NoTextOfTheScriptsIsEnglishAlone) {
  for (const char* plain : {"f('Click a point.')", "x = 'Best';", "push(`${k} segments in common`)",
                            "say(`Alternative ${k}`)", "['a few words']"})
    EXPECT_EQ(plain_words_in(plain).size(), 1U) << plain;
  EXPECT_TRUE(plain_words_in("push(t`${k} segments in common`, `chip ${name}`, 'points')").empty());
  std::istringstream script(std::string(project_script()) + std::string(report_script()));
  std::set<std::string> found;
  for (std::string line; std::getline(script, line);) {
    const std::size_t from = line.find_first_not_of(' ');
    if (from == std::string::npos || line[from] == '*' || line[from] == '/') continue;  // a comment
    found.merge(plain_words_in(line.substr(0, line.find(" // "))));
  }
  EXPECT_EQ(found, std::set<std::string>({"'Enter'", "'use strict'"})) << "a key and a word for the browser";
}

TEST(Language, ValuesAndNumbersFollow) {
  EXPECT_EQ(in_language("12.5 mm", Language::german), "12,5 mm");
  EXPECT_EQ(in_language("1.0 -2.5 0.0", Language::french), "1,0 -2,5 0,0");
  EXPECT_EQ(in_language("limen 1.2.3", Language::german), "limen 1.2.3");
  EXPECT_EQ(in_language("hall_1.5.ply", Language::german), "hall_1.5.ply");
  EXPECT_EQ(in_language("The frame is that of hall.ply.", Language::german),
            "Das Koordinatensystem ist das von hall.ply.");
  // The order of values is the language's own.
  EXPECT_EQ(in_language("control point P1: left_out, residual 50.0 mm", Language::french),
            "point P1 (contrôle) : écarté, résidu 50,0 mm");
  EXPECT_EQ(in_language("never written", Language::french), "never written");
  // A sentence that was made of a reason, and square metres as they are written on paper.
  EXPECT_EQ(in_language("no planes of the two scans match", Language::german),
            "keine Ebenen der beiden Scans stimmen überein");
  EXPECT_EQ(in_language("No planes of the two scans match.", Language::german),
            "Keine Ebenen der beiden Scans stimmen überein.");
  EXPECT_EQ(in_language("Shift along (0.00, -1.00, 0.00) is not determined by the data.", Language::french),
            "Déplacement selon (0,00; -1,00; 0,00) n'est pas déterminé par les données.");
  EXPECT_EQ(in_language("the segments in common do not fix the turn about the vertical", Language::french),
            "les segments en commun ne fixent pas : rotation autour de la verticale");
  EXPECT_EQ(in_language("1.5 m² agree", Language::french), "1,5 m² concordent");
}

TEST(Language, OfAPageTextsAndLabelsAreChangedAndNothingElse) {
  const std::string page =
      "<html lang=\"en\"><style>p { margin: 0.5px }</style><h2>\n Links </h2><b aria-label=\"Scans\">1.5</b>"
      "<td translate=\"no\">links</td><td>a &lt; b</td><script>x = 'links' < 1.5</script>links";
  std::set<std::string> missing;
  EXPECT_EQ(
      page_in_language(page, Language::german, &missing),
      "<html lang=\"de\"><style>p { margin: 0.5px }</style><h2>\n Verbindungen </h2><b "
      "aria-label=\"Scans\">1,5</b><td translate=\"no\">links</td><td>a &lt; b</td><script>x = 'links' < "
      "1.5</script>Verbindungen");
  EXPECT_EQ(missing, std::set<std::string>({"a < b"}));
  EXPECT_EQ(page_in_language(page, Language::english), page);
}

}  // namespace
}  // namespace limen
