// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/time_column.h"

namespace limen {

const Field* find_times(const RecordTable& table) {
  return table.find(
      {"gps_time", "gpstime", "time", "t", "timestamp", "scalar_gps_time", "scalar_gpstime", "scalar_time"});
}

}  // namespace limen
