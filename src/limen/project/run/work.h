// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/project/engine/job_engine.h"
#include "limen/project/inputs/project_files.h"
#include "limen/project/run/store_jobs.h"

namespace limen {

/// Writes to the store what workers need to know of a run: its options, its files, and the folder that their
/// names are relative to.
void write_work_order(const std::filesystem::path& folder, const std::vector<ProjectFile>& files,
                      const ProjectOptions& options, const Store& store);

/// The job of a file's features or of a pair: the words after `limen project work`.
Job features_job(const std::filesystem::path& folder, const ProjectFile& file, const Store& store);
Job pair_job(const std::filesystem::path& folder, const std::string& name, const PairKey& pair);

/// What came of one job on a worker.
struct WorkAnswer {
  std::string state;  ///< "done", "bad_input", or "unavailable": it may go better later or elsewhere
  std::string words;  ///< why, where it is not done
};

/// Does one job into the store of the project in `words[0]`, by the code of the local engine: `DIR features
/// KEY` or `DIR pair SOURCE TARGET`. What the store holds already is done. Changes the working folder to that
/// of the run. Throws Error where the words make no sense or limen is at fault.
WorkAnswer do_work(const std::vector<std::string>& words, Monitor& monitor);

}  // namespace limen
