// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/scanner_place.h"

namespace limen {

const char* to_string(PlaceSource source) {
  switch (source) {
    case PlaceSource::unknown:
      return "unknown";
    case PlaceSource::assumed:
      return "assumed";
    case PlaceSource::stated_by_file:
      return "file";
    case PlaceSource::stated_by_user:
      return "user";
    case PlaceSource::estimated:
      return "estimated";
    case PlaceSource::per_point:
      return "per point";
  }
  return "";
}

}  // namespace limen
