// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/print_pdf.h"

#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/scratch_folder.h"
#include "limen/base/start_program.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kLongestPrinting{120};
constexpr std::chrono::milliseconds kPrintingTick{20};
constexpr const char* kPrintRemedy = "print report.html from a browser yourself, or leave --pdf out";

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

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
  if (geteuid() == 0) words.emplace_back("--no-sandbox");
  words.push_back(file_url(page));
  return words;
}

/// Starts it in a group of processes of its own, silent.
pid_t start_browser(std::vector<std::string> words) {
  const std::vector<char*> pointers = exec_pointers(words);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t id = -1;
  const int fault = posix_spawn(&id, pointers[0], &actions, &attributes, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (fault != 0)
    throw Error(fmt::format("could not be started: {}", std::strerror(fault)), words.front(), kPrintRemedy);
  return id;
}

/// A child that never outlives this object, nor do its own children.
class RunningBrowser {
 public:
  explicit RunningBrowser(pid_t id) : id_(id) {}
  ~RunningBrowser() {
    kill(-id_, SIGKILL);
    int status = 0;
    while (!ended_ && waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  RunningBrowser(const RunningBrowser&) = delete;
  RunningBrowser& operator=(const RunningBrowser&) = delete;

  /// Whether it has ended; then its status.
  bool ended(int& status) {
    ended_ = ended_ || waitpid(id_, &status, WNOHANG) == id_;
    return ended_;
  }

 private:
  pid_t id_;
  bool ended_ = false;
};

void run_browser(const std::vector<std::string>& words, Monitor& monitor) {
  RunningBrowser browser(start_browser(words));
  const auto begin = std::chrono::steady_clock::now();
  int status = 0;
  while (!browser.ended(status)) {
    monitor.throw_if_cancelled();
    if (std::chrono::steady_clock::now() - begin > kLongestPrinting)
      throw Error("took longer than two minutes to print", words.front(), kPrintRemedy);
    std::this_thread::sleep_for(kPrintingTick);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw Error(WIFEXITED(status) ? fmt::format("ended with status {}", WEXITSTATUS(status))
                                : fmt::format("was ended by signal {}", WTERMSIG(status)),
              words.front(), kPrintRemedy);
}

}  // namespace

fs::path find_chromium() {
  const char* named = std::getenv("LIMEN_CHROMIUM");
  if (named != nullptr && *named != '\0') {
    if (is_program(named)) return named;
    throw Error("there is no such program", fmt::format("LIMEN_CHROMIUM={}", named),
                "name a Chromium, or unset the variable");
  }
  constexpr std::array<const char*, 6> kNames{
      "chromium",      "chromium-browser", "google-chrome", "google-chrome-stable", "chromium-headless-shell",
      "microsoft-edge"};
  const char* path = std::getenv("PATH");
  for (const char* name : kNames) {
    const std::string all = path == nullptr ? "/usr/bin:/bin" : path;
    for (std::size_t at = 0; at <= all.size();) {
      const std::size_t end = std::min(all.find(':', at), all.size());
      const fs::path folder = all.substr(at, end - at);
      if (folder.is_absolute() && is_program(folder / name)) return folder / name;
      at = end + 1;
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
