// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/read_scan.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/mapped_file.h"
#include "limen/io/read_ply.h"
#include "limen/io/record_table.h"

namespace limen {
namespace {

/// A format that is read: how it is told by its bytes, the ending that is asked where bytes do not tell, and
/// its reader.
struct Format {
  const char* name;
  bool (*matches)(std::string_view bytes);
  ScanFile (*read)(std::string_view bytes, const std::string& name, const ReadOptions& options);
};

constexpr std::array<Format, 1> kFormats{{
    {"PLY", looks_like_ply, read_ply},
}};

/// Formats that are known but not read: the user is told the way round.
struct Stranger {
  std::string_view begins;
  const char* name;
};
constexpr std::array<Stranger, 6> kStrangers{{
    {"ASTM-E57", "E57"},
    {"LASF", "LAS or LAZ"},
    {"ISO-10303-21", "IFC or STEP"},
    {"PK\x03\x04", "a ZIP archive"},
    {"\x1f\x8b", "a gzip archive"},
    {"{", "JSON"},
}};

[[noreturn]] void unknown_format(std::string_view bytes, const std::string& name) {
  std::string what = "unknown format";
  for (const Stranger& stranger : kStrangers) {
    if (bytes.substr(0, stranger.begins.size()) == stranger.begins) {
      what = fmt::format("this is {}, which is not read as a scan", stranger.name);
    }
  }
  throw Error(what, name, "export the scan as PLY, PCD, PTX, PTS or XYZ text");
}

}  // namespace

void ReadOptions::check() const {
  if (!origin) return;
  for (int k = 0; k < 3; ++k) {
    const double value = (*origin)[k];
    if (!(value > -1e8 && value < 1e8)) throw_bad_option("origin", value, "a finite coordinate in metres");
  }
}

ScanFile read_scan_file(const std::filesystem::path& path, const ReadOptions& options, Monitor& monitor) {
  options.check();
  const std::string name = path.string();
  monitor.throw_if_cancelled();
  const MappedFile file(path);
  for (const Format& format : kFormats) {
    if (!format.matches(file.bytes())) continue;
    ScanFile read = format.read(file.bytes(), name, options);
    monitor.throw_if_cancelled();
    return read;
  }
  unknown_format(file.bytes(), name);
}

std::vector<Scan> read_scans(const std::filesystem::path& path, const ReadOptions& options,
                             Monitor& monitor) {
  return read_scan_file(path, options, monitor).scans;
}

Scan read_scan(const std::filesystem::path& path, const ReadOptions& options, Monitor& monitor) {
  std::vector<Scan> scans = read_scans(path, options, monitor);
  return std::move(scans.front());
}

}  // namespace limen
