// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/table_cells.h"

#include <string>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

/// What is wrong with a table, and with which line; nothing where it is as wide as it says.
std::string fault_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.csv", text);
  try {
    read_text_table(path);
    return {};
  } catch (const Error& error) {
    return error.where().substr(path.parent_path().string().size() + 1) + ": " + error.problem() + " (" +
           error.remedy() + ")";
  }
}

TEST(TableCells, ACellInQuotesMayHoldTheMark) {
  EXPECT_EQ(table_cells(" a ,\"b, c\",", ','), (std::vector<std::string>{"a", "b, c", ""}));
  EXPECT_EQ(table_mark("name;x;y"), ';');
  EXPECT_EQ(table_mark("name\tx,y"), '\t');
  EXPECT_EQ(table_mark("name,x"), ',');
}

TEST(TableCells, AFieldIsQuotedAndNoFormula) {
  EXPECT_EQ(csv_field("Wall-3"), "Wall-3");
  EXPECT_EQ(csv_field("a, \"b\""), "\"a, \"\"b\"\"\"");
  for (const std::string name : {"=cmd|'/c calc'!A1", "+1", "-1", "@SUM(A1)"})
    EXPECT_EQ(csv_field(name), "'" + name);
  EXPECT_EQ(csv_field("=1,2"), "\"'=1,2\"");
  EXPECT_EQ(csv_field("\t=1"), "'\t=1");
  EXPECT_EQ(csv_field("\r=1"), "\"'\r=1\"");
}

TEST(TableCells, ALineWithMoreFieldsThanColumnsIsStatedWithBoth) {
  const std::string stated = fault_of("name,x,y,z,sigma\n# 1,2,3,4,5,6\nA,1,5,2,5,3,5,0,002\n");
  EXPECT_EQ(stated.substr(0, 43), "a.csv, line 3: 9 fields, 5 columns (write d") << stated;
  EXPECT_NE(stated.find("decimal commas"), std::string::npos) << stated;
  EXPECT_NE(fault_of("name;x\nA;1;2\n").find("line 2: 3 fields, 2 columns"), std::string::npos);
}

TEST(TableCells, EmptyCellsAtTheEndAndShortLinesAreNoFault) {
  EXPECT_EQ(fault_of("name,x,y\nA,1,2,,\nB,1\n\n"), "");
  EXPECT_EQ(fault_of("\xEF\xBB\xBFname;x;y\nA;1,5;2,5\n"), "");
  EXPECT_EQ(fault_of(""), "");
}

TEST(TableCells, BytesOfAnotherEncodingAreStatedWithTheirLine) {
  EXPECT_EQ(fault_of("name,x\nA,1\nP\xE9,2\n"), "a.csv, line 3: is not UTF-8 text (save it as CSV UTF-8)");
}

TEST(TableCells, WhatIsNoFileIsStated) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.csv", "name\n");
  try {
    read_text_table(path.parent_path());
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.problem(), "is a folder, not a table");
  }
  EXPECT_THROW(read_text_table(path.parent_path() / "b.csv"), Error);
}

}  // namespace
}  // namespace limen
