// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "limen/base/progress.h"
#include "limen/geometry/rigid.h"
#include "limen/io/table/cloud_writer.h"
#include "limen/io/table/point_file.h"
#include "limen/model/scan.h"

namespace limen {

/// Writes one cloud as an E57 file of one scan. Points are stored about the scan's pose, a shift to the
/// scanner position where the plan has one, else to CloudPlan::near: as doubles, or as integers of an eighth
/// of CloudPlan::resolution_m. Standard columns (intensity, colour, time, row and column, normals) become
/// what other programs read; all others become columns of an extension, so that nothing is lost. Points whose
/// coordinates are not numbers are marked invalid.
/// Throws Error where the plan lacks x, y, z or the file cannot be written, in write() where a row does not
/// fit.
std::unique_ptr<CloudWriter> make_e57_writer(const std::filesystem::path& path, const CloudPlan& plan);

/// Writes a static scan as an E57 file of one scan: points, intensities, and these as a panorama, as scanners
/// with a camera add one. Throws Error where the file cannot be written.
void write_e57(const std::filesystem::path& path, const Scan& scan);

class E57PageWriter;
class E57Section;
struct E57Panorama;
class E57Original;
struct E57Entry;

/// Writes several clouds to one E57 file, each as a scan of its own with its own pose and columns, in the way
/// of make_e57_writer.
class E57StationsWriter {
 public:
  explicit E57StationsWriter(const std::filesystem::path& path);
  E57StationsWriter(const E57StationsWriter&) = delete;
  E57StationsWriter& operator=(const E57StationsWriter&) = delete;
  ~E57StationsWriter();

  /// The rows that follow are of this cloud.
  void begin_station(const CloudPlan& plan);
  /// The next rows, with the columns of the station's plan.
  void write(const RecordTable& rows);
  /// A picture of what is round the station.
  void add(E57Panorama panorama);
  /// A scan of another E57 file as it is (e57_copy.h), moved; `wkt`: the coordinate system, in the place of
  /// its own where it is not empty.
  void copy(const E57Original& from, std::size_t scan, const Rigid3& target_from_source,
            const std::string& wkt = {}, Monitor& monitor = silent_monitor());
  /// The end: brings the file to its name. There must be a station.
  void finish();

 private:
  void end_station();

  std::string name_;
  std::unique_ptr<E57PageWriter> file_;
  std::unique_ptr<E57Section> station_;
  std::unique_ptr<E57Panorama> panorama_;  ///< of the station
  std::vector<E57Entry> stations_;
};

/// True where the bytes begin like an E57 file.
bool looks_like_e57(std::string_view bytes);

/// Opens an E57 file (ASTM E2807, version 1) in memory: one cloud per scan (Data3D), with its pose as
/// TableFacts::pose. Columns are named as scan_builder knows them: x y z (spherical ones become Cartesian),
/// intensity, red green blue, gps_time (start of the acquisition added), row_index, column_index, nx ny nz;
/// all others keep their names in lower case, those that limen wrote without their namespace. Rows that the
/// file marks invalid have coordinates that are not numbers. Images are passed over.
///
/// `bytes` must outlive what is returned; `name` is for messages. The check sums of all pages that are read
/// are verified. Throws Error that names the file, the place and what can be done, here for the head and the
/// description, in PointStream::next for the points.
std::unique_ptr<PointFile> open_e57(std::string_view bytes, const std::string& name);

/// The coordinate system that an E57 file names (usually WKT), or nothing. Throws Error as open_e57.
std::vector<std::string> e57_coordinate_systems(std::string_view bytes, const std::string& name);

}  // namespace limen
