// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/open_points.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/files/mapped_file.h"
#include "limen/io/e57/e57.h"
#include "limen/io/las/las.h"
#include "limen/io/las/las_header.h"
#include "limen/io/pcd/pcd.h"
#include "limen/io/ply/ply.h"
#include "limen/io/ptx/ptx.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

/// How a format is recognised by its bytes, and the endings that are asked where bytes do not tell.
struct KnownFormat {
  PointFormat format;
  bool (*matches)(std::string_view bytes);
  std::string_view endings;
};

/// Plain text comes last: a damaged PTX looks like it.
constexpr std::array<KnownFormat, 6> kKnown{{
    {PointFormat::e57, looks_like_e57, ".e57 "},
    {PointFormat::las, looks_like_las, ".las .laz "},
    {PointFormat::ply, looks_like_ply, ".ply "},
    {PointFormat::pcd, looks_like_pcd, ".pcd "},
    {PointFormat::ptx, looks_like_ptx, ".ptx "},
    {PointFormat::text, looks_like_xyz, ".pts .xyz .txt .csv .asc "},
}};

/// Formats that are known but not read: the error names the way round.
struct Stranger {
  std::string_view begins;
  const char* name;
  const char* remedy;
};
constexpr const char* kExport = "export the scan as E57, LAS, LAZ, PLY, PCD, PTX, PTS or XYZ text";
constexpr std::array<Stranger, 4> kStrangers{{
    {"ISO-10303-21", "IFC or STEP", kExport},
    {"PK\x03\x04", "a ZIP archive in which no IFC file is found", "unpack it and give the file in it"},
    {"\x1f\x8b", "a gzip archive", "unpack it and give the file in it"},
    {"{", "JSON", kExport},
}};

[[noreturn]] void unknown_format(std::string_view bytes, const std::string& name) {
  std::string what = "unknown format";
  const char* remedy = kExport;
  for (const Stranger& stranger : kStrangers) {
    if (bytes.substr(0, stranger.begins.size()) == stranger.begins) {
      what = fmt::format("this is {}, which is not read as a scan", stranger.name);
      remedy = stranger.remedy;
    }
  }
  throw Error(what, name, remedy);
}

bool is_stranger(std::string_view bytes) {
  return std::any_of(kStrangers.begin(), kStrangers.end(), [&](const Stranger& stranger) {
    return bytes.substr(0, stranger.begins.size()) == stranger.begins;
  });
}

std::unique_ptr<PointFile> open_as(PointFormat format, std::string_view bytes, const std::string& name) {
  switch (format) {
    case PointFormat::ply:
      return open_ply(bytes, name);
    case PointFormat::pcd:
      return open_pcd(bytes, name);
    case PointFormat::ptx:
      return open_ptx(bytes, name);
    case PointFormat::e57:
      return open_e57(bytes, name);
    case PointFormat::las:
      return open_las(bytes, name);
    case PointFormat::text:
      break;
  }
  return open_xyz(bytes, name);
}

/// Throws Error where a file says that it has more points than any format gets into its bytes. LAZ is not
/// asked: its chunks say how many points each holds, and a chunk is refused while it is unpacked.
void require_room(PointFormat format, const PointFile& file, std::string_view bytes,
                  const std::string& name) {
  constexpr std::uint64_t kMostPerByte = 132;                       // LZF in a PCD: three bytes become 264
  constexpr std::uint64_t kMostConstant = std::uint64_t{1} << 20U;  // of an E57 that writes nothing per point
  if (format == PointFormat::las) return;
  const std::uint64_t most = std::max(kMostConstant, kMostPerByte * bytes.size());
  for (const CloudFacts& cloud : file.clouds()) {
    if (cloud.points <= most) continue;
    throw Error(fmt::format("the file promises {} points, and has {} bytes", cloud.points, bytes.size()),
                name, "get the whole file, or correct the count");
  }
}

/// One cloud of a file as a file of its own.
class OneCloud : public PointFile {
 public:
  OneCloud(std::unique_ptr<PointFile> file, std::size_t cloud)
      : file_(std::move(file)), cloud_(cloud), clouds_{file_->clouds()[cloud]} {}

  [[nodiscard]] std::string format() const override { return file_->format(); }
  [[nodiscard]] const std::vector<CloudFacts>& clouds() const override { return clouds_; }
  [[nodiscard]] std::unique_ptr<PointStream> read(std::size_t /*index*/) const override {
    return file_->read(cloud_);
  }

 private:
  std::unique_ptr<PointFile> file_;
  std::size_t cloud_;
  std::vector<CloudFacts> clouds_;
};

}  // namespace

std::vector<std::size_t> scans_with_points(const PointFile& file) {
  std::vector<std::size_t> scans;
  for (std::size_t k = 0; k < file.clouds().size(); ++k) {
    if (file.clouds()[k].points > 0 || file.clouds().size() == 1) scans.push_back(k);
  }
  return scans;
}

PointFormat point_format_of(std::string_view bytes, const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string()) + " ";
  const KnownFormat& text = kKnown.back();
  for (const KnownFormat& known : kKnown) {
    if (&known != &text && known.matches(bytes)) return known.format;
  }
  if (!is_stranger(bytes)) {
    for (const KnownFormat& known : kKnown) {
      if (ending != " " && known.endings.find(ending) != std::string_view::npos) return known.format;
    }
    if (text.matches(bytes)) return text.format;
  }
  refuse_vendor_format(bytes, path);
  unknown_format(bytes, path.string());
}

OpenPoints::OpenPoints(const std::filesystem::path& path) : OpenPoints(path, scan_in_file(path.string())) {}

OpenPoints::OpenPoints(const std::filesystem::path& path, std::size_t scan)
    : OpenPoints(path, ScanInFile{path.string(), scan}) {}

OpenPoints::OpenPoints(const std::filesystem::path& path, const ScanInFile& named)
    : path_(path),
      bytes_(std::make_unique<MappedFile>(named.file)),
      format_(point_format_of(bytes_->bytes(), named.file)),
      file_(open_as(format_, bytes_->bytes(), path.string())) {
  require_room(format_, *file_, bytes_->bytes(), path.string());
  if (named.index) {
    const std::vector<std::size_t> scans = scans_with_points(*file_);
    if (*named.index >= scans.size())
      throw Error(fmt::format("has no scan {}", *named.index), named.file,
                  scans.empty() ? "give a file with points"
                                : fmt::format("its scans are #0 to #{}", scans.size() - 1));
    if (file_->clouds().size() > 1) {
      chosen_ = named.index;
      first_ = scans[*named.index];
      file_ = std::make_unique<OneCloud>(std::move(file_), first_);
    }
  }
  if (format_ == PointFormat::las)
    georeference_ = las_coordinate_systems(parse_las_header(bytes_->bytes(), path.string()));
  if (format_ == PointFormat::e57) georeference_ = e57_coordinate_systems(bytes_->bytes(), path.string());
}

void OpenPoints::prove(std::size_t cloud) const {
  const std::unique_ptr<PointStream> stream = file_->read(cloud);
  while (stream->next(kPointsAtOnce)) {
    CancelScope::check();
    forget();
  }
}

std::uint64_t OpenPoints::points() const {
  std::uint64_t points = 0;
  for (const CloudFacts& cloud : file_->clouds()) points += cloud.points;
  return points;
}

}  // namespace limen
