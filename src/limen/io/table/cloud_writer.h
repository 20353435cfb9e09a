// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/io/table/record_table.h"

namespace limen {

/// One column of a cloud that is to be written.
struct ColumnPlan {
  std::string name;  ///< as the source had it ("GPS_time"); lower case it is what readers understand
  Scalar type = Scalar::float64;
  std::optional<double> largest = {};  ///< of its finite values, where that is known before they come
};

/// A cloud that is to be written, before its rows are there.
struct CloudPlan {
  std::string name;
  /// x, y and z come first, as float64 in the frame of the output; all others as they are to be kept.
  std::vector<ColumnPlan> columns;
  std::uint64_t most_points = 0;          ///< no more rows than these will come
  Vector3d near = Vector3d::Zero();       ///< a point of the cloud, metres: for formats that store integers
  double resolution_m = 0.0;              ///< of the source's coordinates where they were integers, else 0
  std::optional<Vector3d> centre;         ///< scanner position of a static scan, frame of the output
  std::vector<std::string> georeference;  ///< of the source: texts of its coordinate system (WKT), if any
};

/// Writes one cloud piece by piece; the file appears whole on finish(), or not at all.
class CloudWriter {
 public:
  CloudWriter() = default;
  CloudWriter(const CloudWriter&) = delete;
  CloudWriter& operator=(const CloudWriter&) = delete;
  virtual ~CloudWriter() = default;

  /// The next rows; the table has the columns of the plan, in their order, of any number type and stride.
  virtual void write(const RecordTable& rows) = 0;
  /// The end: brings the file to its name.
  virtual void finish() = 0;
};

}  // namespace limen
