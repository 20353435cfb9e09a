// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// How fast LAS and LAZ files are read, and what is in them: one line per file with the number of points, a
// hash of the decoded records, sums and extremes of the stored integers x y z, and the times of
//   records   decoding the records (for LAS: touching them), all threads
//   scan      all the way to a Scan
// `--records-only` leaves out the scan, `--brief` the times (then two runs can be compared), `--one-thread`
// uses one thread.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/parallel.h"
#include "limen/files/mapped_file.h"
#include "limen/io/las/las.h"
#include "limen/io/las/las_records.h"
#include "limen/io/table/scan_builder.h"

namespace {

using namespace limen;

struct Options {
  bool scan = true;
  bool brief = false;
  std::vector<std::string> files;
};

/// A moment, and what the processors have worked until then.
struct Moment {
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  std::clock_t work = std::clock();
};

/// Seconds since a moment.
struct Times {
  double wall = 0.0;
  double work = 0.0;
};

Times since(const Moment& start) {
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start.wall).count(),
          static_cast<double>(std::clock() - start.work) / CLOCKS_PER_SEC};
}

/// What the records of a file hold.
struct Content {
  std::uint64_t points = 0;
  std::uint64_t hash = 14695981039346656037ULL;  ///< FNV-1a, bytes
  std::array<std::int64_t, 3> sum{};
  std::array<std::int32_t, 3> low{};
  std::array<std::int32_t, 3> high{};

  void add(const char* record, std::size_t bytes) {
    for (std::size_t k = 0; k < bytes; ++k)
      hash = (hash ^ static_cast<unsigned char>(record[k])) * 1099511628211ULL;
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t value = 0;
      std::memcpy(&value, record + 4 * k, sizeof value);
      sum[k] += value;
      low[k] = points == 0 ? value : std::min(low[k], value);
      high[k] = points == 0 ? value : std::max(high[k], value);
    }
    ++points;
  }
};

constexpr std::size_t kPiece = 1000000;

Content content_of(std::string_view bytes, const std::string& name, const LasHeader& header) {
  Content content;
  const auto records = open_las_records(bytes, name, header);
  for (LasPiece piece = records->next(kPiece); piece.count > 0; piece = records->next(kPiece)) {
    for (std::size_t i = 0; i < piece.count; ++i)
      content.add(piece.data + i * header.point_bytes, header.point_bytes);
  }
  return content;
}

/// Decodes all records and looks at one byte of each.
Times time_of_records(std::string_view bytes, const std::string& name, const LasHeader& header) {
  const Moment start;
  unsigned seen = 0;
  const auto records = open_las_records(bytes, name, header);
  for (LasPiece piece = records->next(kPiece); piece.count > 0; piece = records->next(kPiece)) {
    for (std::size_t i = 0; i < piece.count; ++i)
      seen += static_cast<unsigned char>(piece.data[i * header.point_bytes]);
  }
  if (seen == 0x80000000U) fmt::print(" ");  // the loop must not be left out
  return since(start);
}

/// Reads the file in one piece and makes a scan of it.
Times time_of_scan(std::string_view bytes, const std::string& name) {
  const Moment start;
  const auto file = open_las(bytes, name);
  const auto stream = file->read(0);
  const auto table = stream->next(file->clouds()[0].points);
  if (!table) return {};
  const ScanFile read = with_scan({}, *table, file->clouds()[0].table, {});
  return read.scans.empty() ? Times{} : since(start);
}

void tell(const std::string& name, const Options& options) {
  const MappedFile file(name);
  const LasHeader header = parse_las_header(file.bytes(), name);
  const Content content = content_of(file.bytes(), name, header);
  fmt::print("{} format {} points {} hash {:016x} sum {} {} {} low {} {} {} high {} {} {}", name,
             header.point_format, content.points, content.hash, content.sum[0], content.sum[1],
             content.sum[2], content.low[0], content.low[1], content.low[2], content.high[0], content.high[1],
             content.high[2]);
  if (!options.brief) {
    const double megabytes = static_cast<double>(header.point_bytes * content.points) / 1e6;
    const double millions = static_cast<double>(content.points) / 1e6;
    const auto rates = [&](const char* what, const Times& times) {
      if (times.wall <= 0.0) return;
      fmt::print(" {} {:.2f} M points/s {:.0f} MB/s, per core {:.2f} M points/s {:.0f} MB/s", what,
                 millions / times.wall, megabytes / times.wall, millions / times.work,
                 megabytes / times.work);
    };
    rates("records", time_of_records(file.bytes(), name, header));
    if (options.scan) rates("scan", time_of_scan(file.bytes(), name));
  }
  fmt::print("\n");
}

}  // namespace

int main(int count, char** arguments) {
  Options options;
  for (int k = 1; k < count; ++k) {
    const std::string argument = arguments[k];
    if (argument == "--brief") {
      options.brief = true;
    } else if (argument == "--records-only") {
      options.scan = false;
    } else if (argument == "--one-thread") {
      set_thread_count(1);
    } else {
      options.files.push_back(argument);
    }
  }
  int failed = 0;
  for (const std::string& name : options.files) {
    try {
      tell(name, options);
    } catch (const std::exception& error) {
      fmt::print("{} error {}\n", name, error.what());
      failed = 1;
    }
  }
  return failed;
}
