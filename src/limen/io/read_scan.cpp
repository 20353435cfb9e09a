// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/read_scan.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/join_scans.h"
#include "limen/io/mapped_file.h"
#include "limen/io/read_pcd.h"
#include "limen/io/read_ply.h"
#include "limen/io/read_ptx.h"
#include "limen/io/read_xyz.h"
#include "limen/io/record_table.h"

namespace limen {
namespace {

/// A format that is read: how it is told by its bytes, and the endings that are asked where bytes do not
/// tell.
struct Format {
  bool (*matches)(std::string_view bytes);
  ScanFile (*read)(std::string_view bytes, const std::string& name, const ReadOptions& options);
  std::string_view endings;
};

constexpr std::array<Format, 4> kFormats{{
    {looks_like_ply, read_ply, ".ply "},
    {looks_like_pcd, read_pcd, ".pcd "},
    {looks_like_ptx, read_ptx, ".ptx "},
    {looks_like_xyz, read_xyz, ".pts .xyz .txt .csv .asc "},
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

bool is_stranger(std::string_view bytes) {
  return std::any_of(kStrangers.begin(), kStrangers.end(), [&](const Stranger& stranger) {
    return bytes.substr(0, stranger.begins.size()) == stranger.begins;
  });
}

/// By what the bytes say, then by the ending, so that a damaged file is named for what it wants to be. Plain
/// text comes last: a damaged PTX looks like it.
const Format& format_of(std::string_view bytes, const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string()) + " ";
  for (const Format& format : kFormats) {
    const bool text = &format == &kFormats.back();
    if (!text && format.matches(bytes)) return format;
  }
  if (!is_stranger(bytes)) {
    for (const Format& format : kFormats) {
      if (ending != " " && format.endings.find(ending) != std::string_view::npos) return format;
    }
    if (kFormats.back().matches(bytes)) return kFormats.back();
  }
  unknown_format(bytes, path.string());
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
  const Format& format = format_of(file.bytes(), path);
  ScanFile read = format.read(file.bytes(), name, options);
  monitor.throw_if_cancelled();
  return read;
}

std::vector<Scan> read_scans(const std::filesystem::path& path, const ReadOptions& options,
                             Monitor& monitor) {
  return read_scan_file(path, options, monitor).scans;
}

Scan read_scan(const std::filesystem::path& path, const ReadOptions& options, Monitor& monitor) {
  std::vector<Scan> scans = read_scans(path, options, monitor);
  if (scans.size() == 1) return std::move(scans.front());
  Scan joined = join_scans(scans);
  joined.name = path.string();
  return joined;
}

}  // namespace limen
