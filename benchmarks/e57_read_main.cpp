// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Reads E57 files piece by piece and prints, for each scan and field, how many values are numbers, their sum
// and extremes; then how long it took.
//   bench_e57_read [--rows N] [--raw] [--one-thread] FILE.e57...
//   --rows: of each piece; --raw: in the scans' own frames
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/parallel.h"
#include "limen/files/mapped_file.h"
#include "limen/io/e57/e57.h"

namespace {

using namespace limen;

struct Sums {
  std::uint64_t numbers = 0;
  double sum = 0.0;
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Sums joined(const Sums& a, const Sums& b) {
  return {a.numbers + b.numbers, a.sum + b.sum, std::min(a.low, b.low), std::max(a.high, b.high)};
}

void add(Sums& sums, double value) {
  if (!std::isfinite(value)) return;
  ++sums.numbers;
  sums.sum += value;
  sums.low = std::min(sums.low, value);
  sums.high = std::max(sums.high, value);
}

/// Sums of all fields; the first three are turned to the frame of the file where a pose is given.
std::vector<Sums> sums_of(const RecordTable& table, const std::optional<Rigid3>& pose) {
  constexpr std::size_t kGrain = 65536;
  const std::vector<Sums> none(table.fields.size());
  return parallel_reduce(
      table.rows, kGrain, none,
      [&](std::size_t begin, std::size_t end) {
        std::vector<Sums> part = none;
        std::vector<std::vector<double>> columns(table.fields.size(), std::vector<double>(end - begin));
        for (std::size_t k = 0; k < table.fields.size(); ++k)
          load_numbers(table, table.fields[k], {begin, end}, columns[k].data());
        for (std::size_t i = 0; pose && columns.size() >= 3 && i < end - begin; ++i) {
          const Vector3d x = *pose * Vector3d(columns[0][i], columns[1][i], columns[2][i]);
          for (int k = 0; k < 3; ++k) columns[static_cast<std::size_t>(k)][i] = x[k];
        }
        for (std::size_t k = 0; k < table.fields.size(); ++k) {
          for (const double value : columns[k]) add(part[k], value);
        }
        return part;
      },
      [](std::vector<Sums> a, const std::vector<Sums>& b) {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] = joined(a[k], b[k]);
        return a;
      });
}

double processor_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Options {
  std::size_t rows = std::size_t{1} << 20U;
  bool raw = false;
};

void read_file(const std::string& path, const Options& options) {
  const MappedFile file(path);
  const auto start = std::chrono::steady_clock::now();
  const auto points = open_e57(file.bytes(), path);
  double decoding_s = 0.0;
  double busy_s = 0.0;
  std::uint64_t rows = 0;
  for (std::size_t k = 0; k < points->clouds().size(); ++k) {
    const CloudFacts& facts = points->clouds()[k];
    const auto stream = points->read(k);
    std::vector<Sums> all(facts.fields.size());
    for (;;) {
      const auto before = std::chrono::steady_clock::now();
      const double busy_before = processor_s();
      const auto table = stream->next(options.rows);
      busy_s += processor_s() - busy_before;
      decoding_s += seconds_since(before);
      if (!table) break;
      rows += table->rows;
      const std::vector<Sums> part = sums_of(*table, options.raw ? std::nullopt : facts.table.pose);
      for (std::size_t f = 0; f < all.size(); ++f) all[f] = joined(all[f], part[f]);
    }
    fmt::print("scan {} points {}\n", k + 1, facts.points);
    for (std::size_t f = 0; f < all.size(); ++f)
      fmt::print("  {} {} sum {:.12g} from {:.12g} to {:.12g}\n", facts.fields[f], all[f].numbers, all[f].sum,
                 all[f].low, all[f].high);
    for (const std::string& note : facts.notes) fmt::print("  note: {}\n", note);
  }
  const double mb = static_cast<double>(file.bytes().size()) / 1e6;
  fmt::print(
      "{}: {} points, {:.1f} MB; decoded in {:.3f} s ({:.0f} MB/s), {:.3f} s of processor time ({:.0f} "
      "MB/s); all in "
      "{:.3f} s\n",
      path, rows, mb, decoding_s, mb / decoding_s, busy_s, mb / busy_s, seconds_since(start));
}

}  // namespace

int main(int count, char** arguments) {
  Options options;
  int status = 0;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    try {
      if (word == "--raw") {
        options.raw = true;
      } else if (word == "--one-thread") {
        set_thread_count(1);
      } else if (word == "--rows" && i + 1 < count) {
        options.rows = std::stoul(arguments[++i]);
      } else {
        read_file(word, options);
      }
    } catch (const std::exception& error) {
      fmt::print("error: {}\n", error.what());
      status = 2;
    }
  }
  return status;
}
