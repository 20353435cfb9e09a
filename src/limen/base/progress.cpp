// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/progress.h"

#include "limen/base/error.h"

namespace limen {

void Monitor::throw_if_cancelled() const {
  if (cancelled()) throw Error("interrupted", "", "nothing was written", Fault::cancelled);
}

Monitor& silent_monitor() {
  static Monitor monitor;
  return monitor;
}

}  // namespace limen
