// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_columns.h"
#include "limen/io/e57/e57_document.h"
#include "limen/io/e57/e57_pages.h"
#include "limen/io/e57/e57_streams.h"

namespace limen {
namespace {

/// What several streams of one file share; lives as long as the last of them.
struct E57Source {
  E57Pages pages;
  E57Document document;
  std::vector<CloudFacts> clouds;
};

class E57Stream : public PointStream {
 public:
  E57Stream(std::shared_ptr<const E57Source> source, std::size_t index)
      : source_(std::move(source)),
        fields_(source_->document.scans[index]),
        streams_(source_->pages, source_->document.scans[index], source_->clouds[index].table.name) {}

  std::optional<RecordTable> next(std::size_t most_rows) override {
    const std::size_t rows = streams_.advance(most_rows);
    if (rows == 0) return {};
    return fields_.decode(streams_, rows);
  }

 private:
  std::shared_ptr<const E57Source> source_;
  E57Fields fields_;
  E57Streams streams_;
};

class E57File : public PointFile {
 public:
  explicit E57File(std::shared_ptr<const E57Source> source) : source_(std::move(source)) {}

  [[nodiscard]] std::string format() const override {
    const E57Head& head = source_->pages.head();
    return fmt::format("E57 {}.{}", head.major, head.minor);
  }
  [[nodiscard]] const std::vector<CloudFacts>& clouds() const override { return source_->clouds; }
  [[nodiscard]] std::unique_ptr<PointStream> read(std::size_t index) const override {
    if (index >= source_->clouds.size()) {
      throw Error(fmt::format("there is no scan {}", index + 1), source_->pages.name(), "", Fault::internal);
    }
    return std::make_unique<E57Stream>(source_, index);
  }

 private:
  std::shared_ptr<const E57Source> source_;
};

/// The name without control characters, for messages.
std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  }
  return text;
}

bool has_column(const E57Scan& scan, const char* name) {
  return std::any_of(scan.columns.begin(), scan.columns.end(),
                     [&](const E57Column& column) { return column.name == name; });
}

/// A scan with a pose was measured from the origin of its own frame, surely so where the points are
/// directions and ranges or stand in rows and columns; else the shift may as well be an offset of a merged
/// cloud.
void settle_centre(const E57Scan& scan, bool spherical, TableFacts& table) {
  if (scan.centre_word == "unknown") {
    table.centre_unknown = true;
    return;
  }
  const Vector3d zero = scan.pose ? scan.pose->translation : Vector3d::Zero();
  const bool raster = scan.pose && has_column(scan, "rowIndex") && has_column(scan, "columnIndex");
  if (spherical || raster || scan.centre_word == "known") {
    table.centre = zero;
  } else if (scan.pose) {
    table.possible_centre = zero;
  }
}

std::vector<std::string> notes_of(const E57Scan& scan) {
  std::vector<std::string> notes;
  if (scan.points == 0) notes.emplace_back("the scan holds no points");
  if (std::abs(scan.quaternion_length - 1.0) > 1e-6) {
    notes.push_back(fmt::format("the quaternion of the pose has the length {:.9g}; it was brought to one",
                                scan.quaternion_length));
  }
  if (scan.acquisition_start_s != 0.0 && has_column(scan, "timeStamp")) {
    notes.push_back(
        fmt::format("times count from the start of the acquisition, GPS time {:.3f} s, which is added",
                    scan.acquisition_start_s));
  }
  for (const E57Column& column : scan.columns) {
    if (column.storage == E57Storage::text)
      notes.push_back(fmt::format("the texts \"{}\" are left out", printable(column.name)));
  }
  return notes;
}

CloudFacts facts_of(const E57Scan& scan, std::string name) {
  const E57Fields fields(scan);
  CloudFacts facts;
  facts.table.name = std::move(name);
  facts.table.pose = scan.pose;
  facts.table.has_offset = scan.pose && !scan.pose->translation.isZero(0.0);
  settle_centre(scan, fields.spherical(), facts.table);
  facts.points = scan.points;
  facts.fields = fields.names();
  facts.notes = notes_of(scan);
  return facts;
}

std::string cloud_name(const E57Source& source, std::size_t k) {
  if (source.document.scans.size() == 1) return source.pages.name();
  const std::string own = printable(source.document.scans[k].name);
  return fmt::format("{}, scan {}{}", source.pages.name(), k + 1, own.empty() ? "" : " (" + own + ")");
}

}  // namespace

bool looks_like_e57(std::string_view bytes) {
  return bytes.substr(0, 8) == "ASTM-E57";
}

std::unique_ptr<PointFile> open_e57(std::string_view bytes, const std::string& name) {
  E57Pages pages(bytes, name);
  E57Document document = parse_e57_document(e57_xml(pages), name);
  auto source = std::make_shared<E57Source>(E57Source{std::move(pages), std::move(document), {}});
  if (source->document.scans.empty()) {
    const std::size_t images = source->document.images.size();
    throw Error(images == 0 ? "the file holds no scans"
                            : fmt::format("the file holds {} images but no scans", images),
                name, "export the scans");
  }
  for (std::size_t k = 0; k < source->document.scans.size(); ++k) {
    source->clouds.push_back(facts_of(source->document.scans[k], cloud_name(*source, k)));
  }
  std::vector<std::string>& notes = source->clouds.front().notes;
  if (source->pages.surplus() > 0)
    notes.push_back(
        fmt::format("{} bytes after the stated end of the file are skipped", source->pages.surplus()));
  return std::make_unique<E57File>(std::move(source));
}

std::vector<std::string> e57_coordinate_systems(std::string_view bytes, const std::string& name) {
  const E57Pages pages(bytes, name);
  E57Document document = parse_e57_document(e57_xml(pages), name);
  if (document.coordinates.empty()) return {};
  return {std::move(document.coordinates)};
}

}  // namespace limen
