// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/print_pdf.h"

#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/child_process.h"
#include "limen/base/error.h"
#include "limen/base/scratch_folder.h"
#include "limen/base/system.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kLongestPrinting{120};
constexpr std::chrono::milliseconds kPrintingTick{20};
constexpr const char* kPrintRemedy = "print report.html from a browser yourself, or leave --pdf out";

std::string file_url(const fs::path& path) {
  std::string url = "file://";
  for (const char c : fs::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::strchr("/-._~", c) != nullptr) {
      url += c;
    } else {
      url += fmt::format("%{:02X}", byte);
    }
  }
  return url;
}

std::vector<std::string> words_for(const fs::path& browser, const fs::path& page, const fs::path& folder) {
  std::vector<std::string> words{browser.string(),
                                 "--headless",
                                 "--disable-gpu",
                                 "--no-first-run",
                                 "--no-default-browser-check",
                                 "--disable-background-networking",
                                 "--disable-extensions",
                                 "--disable-3d-apis",  // the sheet has no view in space
                                 "--user-data-dir=" + (folder / "profile").string(),
                                 "--no-pdf-header-footer",
                                 "--print-to-pdf=" + (folder / "page.pdf").string()};
  // Chromium does not start for root otherwise; the page is limen's own and asks nothing of a network.
  if (is_administrator()) words.emplace_back("--no-sandbox");
  words.push_back(file_url(page));
  return words;
}

void run_browser(const std::vector<std::string>& words, Monitor& monitor) {
  ChildProcess browser(words, {});
  if (!browser.problem().empty())
    throw Error("could not be started: " + browser.problem(), words.front(), kPrintRemedy);
  const auto begin = std::chrono::steady_clock::now();
  while (!browser.ended()) {
    monitor.throw_if_cancelled();
    if (std::chrono::steady_clock::now() - begin > kLongestPrinting)
      throw Error("took longer than two minutes to print", words.front(), kPrintRemedy);
    std::this_thread::sleep_for(kPrintingTick);
  }
  const ChildEnd end = browser.wait();
  if (!end.by_itself || end.status != 0) throw Error(end.how, words.front(), kPrintRemedy);
}

}  // namespace

fs::path find_chromium() {
  const char* named = std::getenv("LIMEN_CHROMIUM");
  if (named != nullptr && *named != '\0') {
    if (may_run(named)) return named;
    throw Error("there is no such program", fmt::format("LIMEN_CHROMIUM={}", named),
                "name a Chromium, or unset the variable");
  }
  constexpr std::array<const char*, 8> kNames{"chromium",
                                              "chromium-browser",
                                              "google-chrome",
                                              "google-chrome-stable",
                                              "chromium-headless-shell",
                                              "microsoft-edge",
                                              "chrome",
                                              "msedge"};
  for (const char* name : kNames) {
    for (const fs::path& folder : program_folders()) {
      const fs::path program = folder / fmt::format("{}{}", name, program_ending());
      if (folder.is_absolute() && may_run(program)) return program;
    }
  }
  throw Error("there is no Chromium or Chrome that could print", "--pdf",
              "install one, name it in LIMEN_CHROMIUM, or print report.html from any browser");
}

void print_pdf(const fs::path& browser, const fs::path& page, const fs::path& pdf, Monitor& monitor) {
  // Beside the page: a browser that is kept in a box of its own may not see /tmp.
  const ScratchFolder folder(fs::absolute(page).parent_path(), "limen-print");
  run_browser(words_for(browser, page, folder.path()), monitor);
  std::ifstream stream(folder.path() / "page.pdf", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (bytes.compare(0, 5, "%PDF-") != 0) throw Error("printed nothing", browser.string(), kPrintRemedy);
  write_file(pdf, bytes);
}

}  // namespace limen
