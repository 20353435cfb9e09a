// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Wall time, processor time and peak memory of whole runs of the program, reading and writing included.
//   bench_whole_process build/release/limen [FOLDER]
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

struct Usage {
  int status = -1;
  double wall_s = 0.0;
  double processor_s = 0.0;
  double peak_mb = 0.0;
};

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

Usage run(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, wall.count(),
          seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) / 1024.0};
}

void report(const std::string& name, const Usage& usage) {
  fmt::print("{:<44} exit {}  {:6.2f} s wall  {:6.2f} s processor  {:6.0f} MB\n", name, usage.status,
             usage.wall_s, usage.processor_s, usage.peak_mb);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_whole_process PROGRAM [FOLDER]\n");
    return 2;
  }
  const std::string limen = argv[1];
  const std::filesystem::path folder =
      argc > 2 ? argv[2] : std::filesystem::temp_directory_path() / "limen-bench";
  const std::string room = folder / "room";
  const std::string museum = folder / "museum";
  const std::string out = folder / "result";
  run({limen, "simulate", "room", "-q", "-o", room});
  report("register room, 2 x 260 k points",
         run({limen, "register", room + "/indoor_00.ply", room + "/indoor_01.ply", "-q", "-o", out}));
  report("the same, any orientation",
         run({limen, "register", room + "/indoor_00.ply", room + "/indoor_01.ply", "-q", "--gravity",
              "unknown", "-o", out}));
  run({limen, "simulate", "museum", "-q", "--points-indoor", "2000000", "--points-outdoor", "3000000",
       "--stations", "1", "--facades", "2", "-o", museum});
  report("planes of an indoor scan of 2 M points",
         run({limen, "planes", museum + "/indoor_00.ply", "-q", "-o", (folder / "planes.json").string()}));
  report("register indoor 2 M, outdoor 3 M points",
         run({limen, "register", museum + "/indoor_00.ply", museum + "/outdoor.ply", "-q", "-o", out}));
  return 0;
}
