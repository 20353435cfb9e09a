// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/kept_notes.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(KeptNotes, TellTheNamesOfTheRunThatReadsThem) {
  const std::vector<std::string> notes = {"old/a.ptx: 3 missing returns",
                                          "old/a.ptx, scan 2: 4 missing returns", "no times",
                                          "old/a.ptx was measured along " + name_mark(1)};
  const std::vector<std::string> kept = without_name(notes, "old/a.ptx");
  for (const std::string& note : kept) EXPECT_EQ(note.find("old"), std::string::npos) << note;
  const std::vector<std::string> stated = {"b.ptx: 3 missing returns", "b.ptx, scan 2: 4 missing returns",
                                           "no times", "b.ptx was measured along way.csv"};
  EXPECT_EQ(with_names(kept, {"b.ptx", "way.csv"}), stated);
}

TEST(KeptNotes, AWordThatBeginsAsTheNameStays) {
  const std::vector<std::string> notes = {"points at times that the trajectory does not cover are left out"};
  EXPECT_EQ(with_names(without_name(notes, "po"), {"q"}), notes);
}

}  // namespace
}  // namespace limen
