// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/features.h"

namespace limen {

const char* to_string(OpeningView view) {
  switch (view) {
    case OpeningView::through:
      return "through";
    case OpeningView::recess:
      return "recess";
    case OpeningView::hole:
      return "hole";
  }
  return "hole";
}

}  // namespace limen
