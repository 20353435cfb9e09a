// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "limen/cli/serve/jobs.h"

namespace limen {

/// The work that the page asks for, by "kind":
///   register  source, target; source_units, target_units; no_repeats
///   project   files; control and poses: CSV files; sphere, board: sizes of targets in tenths of a
///   millimetre;
///             no_repeats
///   view      files, or of: a job, with alternative where one of its poses is meant
///   place     of: a job, with alternative where one of its poses is meant
///   deviation of: a job of scans in a model
///   decide    of: a project, answer: one of those that its questions name; or link: the number of a link,
///             which is then a start of its two scans in the project
///   plan      scan: thinned for a plan of it
///   link      source, target, points: [[x, y, z, x, y, z], ...], places shown in both
/// Every file is one of files/, every answer one that was offered: no word of the page reaches the command
/// line unseen. `id` names the folder of its results. Throws HttpFault that tells what is wrong.
PageJob job_from_request(const Json& asked, const std::filesystem::path& folder, const JobBoard& board,
                         int id);

}  // namespace limen
