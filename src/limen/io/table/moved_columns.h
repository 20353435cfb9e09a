// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/geometry/spline_motion.h"
#include "limen/io/table/record_table.h"

namespace limen {

/// Makes a table of chosen columns of another one, moved: x y z and x_origin y_origin z_origin by the motion,
/// nx ny nz by its turn, the others as they are. `bend` (none: nullptr) moves each point, after the motion,
/// by what it is at the point's own time; it must outlive what is made, and the table must have times. All in
/// this machine's order of bytes. What is made may point into the source.
class ColumnMover {
 public:
  ColumnMover(const RecordTable& source, const Rigid3& motion, const SplineMotion* bend = nullptr);

  /// The column of this name.
  void add(const std::string& name);
  /// A column with the same value in every row.
  void add_constant(const std::string& name, double value);
  [[nodiscard]] RecordTable table() const { return table_; }

 private:
  struct Memory;
  [[nodiscard]] Field swapped_copy(const Field& field);

  const RecordTable& source_;
  Rigid3 motion_;
  const SplineMotion* bend_;
  RecordTable table_;
  std::shared_ptr<Memory> memory_;
};

}  // namespace limen
