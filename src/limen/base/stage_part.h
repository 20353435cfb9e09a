// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"

namespace limen {

/// One part of a stage, for work that counts its own progress from nothing to all: tells it to `whole` as the
/// piece from `begin` to `end` of 1. Stages that begin within it are not shown. A cancelled `whole` cancels
/// it at its next advance(); use it within a CancelScope of `whole`, which can be cancelled at any time.
class StagePart : public Monitor {
 public:
  StagePart(Monitor& whole, double begin, double end) : whole_(whole), begin_(begin), end_(end) {
    advance(0.0, 1.0);
  }

  void advance(double done, double total) override {
    if (whole_.cancelled()) cancel();
    if (total > 0.0) whole_.advance(begin_ + (end_ - begin_) * done / total, 1.0);
  }

 private:
  Monitor& whole_;
  double begin_;
  double end_;
};

}  // namespace limen
