// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace limen {

inline std::string read_whole(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline void write_whole(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// What one call of the program did.
struct ProgramRun {
  int status = -1;  ///< exit status; 128 + signal where it was killed
  std::string out;
  std::string err;
};

/// A test with a folder of its own, in which the program under test runs.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "-" + info->name();
    for (char& c : name) c = c == '/' ? '-' : c;
    folder_ = std::filesystem::temp_directory_path() /
              ("limen-" + name + "-" + std::to_string(static_cast<long>(getpid())));
    std::filesystem::create_directories(folder_ / "work");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs limen in work() with the arguments as they are, without a shell's interpretation.
  [[nodiscard]] ProgramRun run(const std::vector<std::string>& arguments) const {
    std::string command = "cd " + quoted(work()) + " && " + quoted(LIMEN_PROGRAM);
    for (const std::string& argument : arguments) command += " " + quoted(argument);
    command += " > ../out 2> ../err < /dev/null";
    const int status = std::system(command.c_str());
    ProgramRun done;
    done.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    done.out = read_whole(folder_ / "out");
    done.err = read_whole(folder_ / "err");
    return done;
  }

  [[nodiscard]] std::filesystem::path work() const { return folder_ / "work"; }

 private:
  static std::string quoted(const std::string& text) {
    std::string safe = "'";
    for (const char c : text) {
      if (c == '\'') {
        safe += "'\\''";
      } else {
        safe += c;
      }
    }
    safe += "'";
    return safe;
  }

  std::filesystem::path folder_;
};

}  // namespace limen
