// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/sheet/sheet.h"

#include <limits>

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "limen/files/zip.h"

namespace limen {
namespace {

Sheet two_rows() {
  return {"Stations",
          {"file", "radius_95_m"},
          {{text_cell("=a, \"b\".ply"), number_cell(0.00251, 4)}, {text_cell("R\x01 <&>"), SheetCell{}}}};
}

TEST(Sheet, CsvQuotesTextsAndLeavesNumbers) {
  EXPECT_EQ(csv_of(two_rows()), "file,radius_95_m\r\n\"'=a, \"\"b\"\".ply\",0.0025\r\nR\x01 <&>,\r\n");
}

TEST(Sheet, TextsAreUtf8WhateverTheFilesSay) {
  EXPECT_EQ(csv_line({text_cell("Au\xDF"
                                "enwand")}),
            "Au\uFFFDenwand");
}

TEST(Sheet, WhatIsNotFiniteIsAnEmptyCell) {
  EXPECT_TRUE(number_cell(std::numeric_limits<double>::infinity(), 3).text.empty());
  EXPECT_TRUE(short_number_cell(std::numeric_limits<double>::quiet_NaN()).text.empty());
  EXPECT_EQ(short_number_cell(-0.00012345).text, "-0.000123");
}

/// A member of a workbook, as XML.
pugi::xml_document part(const std::string& bytes, const std::string& name) {
  pugi::xml_document document;
  for (const ZipMember& member : zip_members(bytes)) {
    if (member.name == name) document.load_string(unpacked(bytes, member, "tables.xlsx", 1 << 20).c_str());
  }
  return document;
}

TEST(Sheet, AWorkbookHasEachSheetWithItsNumbersAsNumbers) {
  Sheet wide{"Wide", {}, {}};
  for (int k = 0; k < 28; ++k) wide.columns.push_back("c");
  wide.rows.emplace_back(28, count_cell(7));
  const std::string bytes = workbook_of({two_rows(), wide});
  EXPECT_EQ(workbook_of({two_rows(), wide}), bytes);
  const pugi::xml_document book = part(bytes, "xl/workbook.xml");
  EXPECT_STREQ(book.select_node("//sheet[1]/@name").attribute().value(), "Stations");
  const pugi::xml_document first = part(bytes, "xl/worksheets/sheet1.xml");
  EXPECT_STREQ(first.select_node("//c[@r='A2']/is/t").node().text().get(), "=a, \"b\".ply");
  EXPECT_STREQ(first.select_node("//c[@r='A3']/is/t").node().text().get(), "R  <&>");
  EXPECT_EQ(first.select_node("//c[@r='B2']/v").node().text().as_double(), 0.0025);
  EXPECT_FALSE(first.select_node("//c[@r='B3']"));
  const pugi::xml_document second = part(bytes, "xl/worksheets/sheet2.xml");
  EXPECT_EQ(second.select_node("//c[@r='AB2']/v").node().text().as_int(), 7);
  EXPECT_STREQ(second.select_node("//autoFilter/@ref").attribute().value(), "A1:AB2");
}

}  // namespace
}  // namespace limen
