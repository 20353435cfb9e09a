// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limen/base/progress.h"

namespace limen {

/// Bounds within which limen_ifc works. Those of memory and computing hold from its first instruction on.
struct IfcProcessOptions {
  double silence_s = 15.0;          ///< it is stopped where it says nothing for so long, > 0
  double silence_s_per_mb = 0.5;    ///< and so much longer for each megabyte of the file, >= 0
  double cpu_s = 120.0;             ///< seconds it may compute altogether, > 0
  double cpu_s_per_mb = 20.0;       ///< and so much more for each megabyte of the file, >= 0
  double output_mb = 64.0;          ///< it is stopped where it writes more than this, > 0
  double output_mb_per_mb = 200.0;  ///< and so much for each megabyte of the file, >= 0
  double most_output_mb = 2000.0;   ///< but never more than this, > 0
  double memory_mb = 3000.0;        ///< address space it may take, > 0
  double memory_mb_per_mb = 100.0;  ///< and so much more for each megabyte of the file, >= 0

  void check() const;
};

/// How a run of limen_ifc ended.
struct IfcRun {
  std::string output;     ///< all it wrote, whole or not
  bool finished = false;  ///< it ended by itself
  std::string ended_how;  ///< "stopped by signal 11 (Segmentation fault)", for messages
};

/// Where limen_ifc is: what the environment's LIMEN_IFC_HELPER says, else beside this program or library, in
/// ../libexec/limen of it, or where it was installed. Throws Error where it is nowhere.
std::filesystem::path find_ifc_helper();

/// Runs limen_ifc on the bytes of an IFC file; entities in `skip` are left out. It is killed when it is
/// silent too long, computes too long, writes or takes too much, when the monitor is cancelled (then Error),
/// and when this process ends, however it does. Throws Error where it cannot be started.
IfcRun run_ifc_helper(std::string_view bytes, const std::vector<std::int64_t>& skip,
                      const IfcProcessOptions& options = {}, Monitor& monitor = silent_monitor());

}  // namespace limen
