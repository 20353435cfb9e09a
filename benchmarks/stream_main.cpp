// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// How fast a large cloud is thinned while it streams, and in how much memory: writes points of a building by
// formula through limen's own writers, then runs `limen thin` on them as a process of its own.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "limen/base/parallel.h"
#include "limen/io/cloud/write_clouds.h"

namespace {

using limen::CloudPlan;
using limen::RecordTable;
using limen::Scalar;
using limen::Vector3d;

struct Options {
  std::uint64_t points = 10000000;
  std::uint64_t kept = 2000000;
  std::string file = "stream.las";
  std::string program = "limen";
  bool write = true;
  bool thin = true;
};

/// A point of a hall of 120 x 80 x 25 m with columns, walked past in scan lines of 2 000 points from floor to
/// ceiling, with a noise of 3 mm; `k` numbers the points.
Vector3d point_of(std::uint64_t k) {
  const std::uint64_t line = k / 2000;
  const double height = 25.0 * static_cast<double>(k % 2000) / 2000.0;
  const double way = std::fmod(static_cast<double>(line) * 0.00317, 400.0);
  const double noise = 0.003 * std::sin(static_cast<double>(k * 2654435761ULL % 1000003ULL));
  const double bay = 0.4 * std::floor(0.5 + 0.5 * std::sin(way));
  if (way < 120.0) return {way, bay + noise, height};
  if (way < 200.0) return {120.0 - bay + noise, way - 120.0, height};
  if (way < 320.0) return {320.0 - way, 80.0 - bay + noise, height};
  return {bay + noise, 400.0 - way, height};
}

/// One row as it lies in memory.
struct Row {
  Vector3d x;
  double time;
  std::uint16_t intensity;
  std::uint8_t class_number;
};

template <typename Value>
limen::Field field_of(const char* name, Scalar type, const Value* first) {
  return {name, type, reinterpret_cast<const char*>(first), sizeof(Row)};
}

RecordTable table_of(const std::vector<Row>& rows) {
  RecordTable table;
  table.rows = rows.size();
  const Row& first = rows.front();
  table.fields = {field_of("x", Scalar::float64, first.x.data()),
                  field_of("y", Scalar::float64, first.x.data() + 1),
                  field_of("z", Scalar::float64, first.x.data() + 2),
                  field_of("intensity", Scalar::uint16, &first.intensity),
                  field_of("classification", Scalar::uint8, &first.class_number),
                  field_of("gps_time", Scalar::float64, &first.time)};
  return table;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void write_cloud(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  CloudPlan plan;
  plan.name = "hall";
  plan.columns = {{"x", Scalar::float64},
                  {"y", Scalar::float64},
                  {"z", Scalar::float64},
                  {"intensity", Scalar::uint16},
                  {"classification", Scalar::uint8},
                  {"gps_time", Scalar::float64}};
  plan.most_points = options.points;
  plan.near = {60.0, 40.0, 10.0};
  plan.resolution_m = 0.0001;
  const auto writer = limen::make_cloud_writer(options.file, plan);
  constexpr std::uint64_t kPiece = 1000000;
  for (std::uint64_t begin = 0; begin < options.points; begin += kPiece) {
    std::vector<Row> rows(std::min(kPiece, options.points - begin));
    limen::parallel_for(rows.size(), 16384, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        const std::uint64_t k = begin + i;
        rows[i] = {point_of(k), 1e5 + 1e-6 * static_cast<double>(k), static_cast<std::uint16_t>(k % 60000),
                   static_cast<std::uint8_t>(k % 7)};
      }
    });
    writer->write(table_of(rows));
  }
  writer->finish();
  const double seconds = seconds_since(start);
  fmt::print("written: {} points, {:.2f} GB, {:.1f} s, {:.1f} M points/s\n", options.points,
             static_cast<double>(std::filesystem::file_size(options.file)) / 1e9, seconds,
             1e-6 * static_cast<double>(options.points) / seconds);
}

int thin_cloud(const Options& options) {
  const std::string output = options.file + ".thin.las";
  const std::string kept = std::to_string(options.kept);
  std::vector<std::string> words{options.program, "thin", options.file, output, "--points", kept};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  if (posix_spawnp(&child, options.program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
    return 1;
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return 1;
  const double seconds = seconds_since(start);
  fmt::print("thinned: {:.1f} s, {:.1f} M points/s, {:.0f} MB at most, {:.1f} s of processor\n", seconds,
             1e-6 * static_cast<double>(options.points) / seconds,
             static_cast<double>(usage.ru_maxrss) / 1024,
             static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec));
  std::filesystem::remove(output);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Writes a large cloud and thins it");
  app.add_option("--points", options.points, "Points to write");
  app.add_option("--kept", options.kept, "Points to keep");
  app.add_option("--file", options.file, "Where: .las, .e57 or .ply; several GB");
  app.add_option("--program", options.program, "The limen to measure");
  app.add_flag("!--no-write", options.write, "The file is there already");
  app.add_flag("!--no-thin", options.thin, "Only write");
  CLI11_PARSE(app, argc, argv);
  if (options.write) write_cloud(options);
  return options.thin ? thin_cloud(options) : 0;
}
