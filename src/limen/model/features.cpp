// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/features.h"

#include "limen/base/named.h"

namespace limen {

const char* to_string(OpeningView view) {
  static constexpr Named<OpeningView> names[] = {
      {OpeningView::through, "through"}, {OpeningView::recess, "recess"}, {OpeningView::hole, "hole"}};
  return name_of(names, view);
}

}  // namespace limen
