// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limen/project/run/store_jobs.h"

namespace limen {

/// What came of a file: its record, or why there is none. Neither for a file that was at fault already, or is
/// a copy.
struct FileOutcome {
  std::optional<FileRecord> record;
  std::string fault;
};

/// Makes the features of the files, two at a time: one alone leaves threads idle while it is read. For their
/// memory no two are large ones; where a bound of memory is stated every file counts as large. `on_done` gets
/// the outcomes in the order of the files, one after the other. Throws what make_features() throws, bad input
/// excepted.
void prepare_files(const std::vector<ProjectFile>& files, const ProjectOptions& options, const Store& store,
                   Monitor& monitor, const std::function<void(std::size_t, FileOutcome)>& on_done);

}  // namespace limen
