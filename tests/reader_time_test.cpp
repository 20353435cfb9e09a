// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Every reader takes time linear in the length of its file: beginnings of sound files are followed by very
// many of what a reader could stumble over each time again.
#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/readers.h"
#include "run_program.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/bim/ifc/ifc4x3.h"
#include "limen/bim/ifc/ifc_structure.h"
#include "limen/bim/ifc/step_file.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBytes = 96 * 1024;

std::string filled_with(std::string_view word, std::size_t bytes) {
  std::string text;
  while (text.size() < bytes) text += word;
  return text;
}

std::vector<std::string_view> stumbling_blocks() {
  return {"/*",
          "/* ",
          "*/",
          "/",
          "'",
          "''",
          "\"",
          "(",
          ")",
          "#",
          "#1=IFCWALL(",
          "\n#1=",
          "\n#1",
          "\n",
          "\r",
          "\r\n",
          " ",
          ",",
          ";",
          "0 ",
          "1 2 3\n",
          "1 2 3 4\n",
          "{",
          "[",
          "{\"a\":",
          "<",
          "<a>",
          "&#1;",
          "<!--",
          "<![CDATA[",
          "\\",
          "\\\n",
          "\\X2\\",
          "f 1 2 3\n",
          "f -1 -1 -1 ",
          "v 0 0 0\n",
          "g a\n",
          "g ",
          "o a\nf 1\n",
          "comment ",
          "property float x\n",
          "P",
          "PK\1\2",
          "PK\3\4",
          "-",
          "1e",
          "// ",
          "# \n",
          "element a 1\n",
          std::string_view("\0", 1),
          "\xff"};
}

/// Some files of the corpus, evenly chosen, and what of each is kept.
std::vector<std::string> beginnings(std::string_view reader) {
  constexpr std::size_t kMost = 4;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(LIMEN_CORPUS) / reader))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> begins;
  for (std::size_t k = 0; k < std::min(kMost, files.size()); ++k) {
    const std::string whole = read_whole(files[k * files.size() / std::min(kMost, files.size())]);
    begins.push_back(whole.substr(0, kBytes));
    begins.push_back(whole.substr(0, std::min(whole.size() / 2, kBytes)));
  }
  return begins;
}

class ReaderTime : public testing::TestWithParam<FuzzedReader> {};

TEST_P(ReaderTime, IsLinearInTheFile) {
  for (const std::string& begin : beginnings(GetParam().name)) {
    for (const std::string_view block : stumbling_blocks()) {
      EXPECT_NO_THROW(read_strange(GetParam(), begin + filled_with(block, kBytes)))
          << "after " << begin.size() << " bytes: " << block;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryReader, ReaderTime, testing::ValuesIn(fuzzed_readers()),
                         [](const auto& reader) { return std::string(reader.param.name); });

const FuzzedReader& step_reader() {
  for (const FuzzedReader& reader : fuzzed_readers()) {
    if (reader.name == "step") return reader;
  }
  throw std::logic_error("there is no reader of STEP files");
}

std::string step_file(const std::string& statements) {
  return "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n" + statements +
         "ENDSEC;\nEND-ISO-10303-21;\n";
}

TEST(StepTime, CommentsThatNeverClose) {
  const std::string comments =
      filled_with("/* ", 512 * 1024);  // without the blank each would close the one before
  EXPECT_NO_THROW(read_strange(step_reader(), comments));
  EXPECT_NO_THROW(read_strange(step_reader(), step_file("#1=IFCWALL(" + comments + ");\n")));
  EXPECT_NO_THROW(read_strange(step_reader(), step_file("#1=IFCWALL('a'" + comments + "'*/');\n")));
}

/// #1 holds #2, that holds #3, and so on; every element has its opening.
TEST(StepTime, AChainOfParts) {
  std::string text;
  constexpr int kElements = 20000;
  for (int i = 1; i <= kElements; ++i) {
    text += "#" + std::to_string(i) + "=IFCWALL('',$,'',$,$,$,$,$);\n";
    text += "#" + std::to_string(i + 100000) + "=IFCRELAGGREGATES('',$,$,$,#" + std::to_string(i) + ",(#" +
            std::to_string(i + 1) + "));\n";
    text += "#" + std::to_string(i + 200000) + "=IFCRELVOIDSELEMENT('',$,$,$,#" + std::to_string(i) + ",#" +
            std::to_string(i + 300000) + ");\n";
  }
  const std::string file = step_file(text);
  EXPECT_NO_THROW(read_strange(step_reader(), file.substr(0, file.size())));
}

/// Every element is in one storey, the description of which is as long as all of them.
TEST(StepTime, ALongStoreyAskedForOften) {
  std::string text = "#1=IFCBUILDINGSTOREY('',$,'" + std::string(500000, 'x') + "',$,$,$,$,$,$,0.);\n";
  std::string all;
  for (int i = 2; i < 10000; ++i) {
    text += "#" + std::to_string(i) + "=IFCFOOTING('',$,'',$,$,$,$,$);\n";
    all += (all.empty() ? "#" : ",#") + std::to_string(i);
  }
  text += "#99999=IFCRELCONTAINEDINSPATIALSTRUCTURE('',$,$,$,(" + all + "),#1);\n";
  EXPECT_NO_THROW(read_strange(step_reader(), step_file(text)));
}

/// Work that begins when it is cancelled already ends at its first look.
TEST(StepTime, ACancelIsHeard) {
  Monitor monitor;
  monitor.cancel();
  const CancelScope scope(monitor);
  const std::string text = step_file("#1=IFCWALL('',$,'',$,$,$,$,$);\n");
  try {
    const StepFile file(text);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::cancelled);
  }
}

}  // namespace
}  // namespace limen
