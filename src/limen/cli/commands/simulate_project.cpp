// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/simulate_project.h"

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/cli/commands/case_files.h"
#include "limen/io/ply/write_ply.h"
#include "limen/report/json/project_truth_json.h"

namespace limen {
namespace {

std::string summary(const ProjectTruth& truth, const std::string& folder) {
  std::size_t points = 0;
  std::size_t passes = 0;
  for (const SimulatedScan& scan : truth.scans) {
    points += scan.points;
    passes += scan.mobile ? 1U : 0U;
  }
  return fmt::format(
      "{} stations and {} passes, {} points\nwritten to {} with task.json; the truth is in "
      "truth/project.json\n",
      truth.scans.size() - passes, passes, points, folder);
}

}  // namespace

int run_simulate_project(const ProjectSceneOptions& options, const std::string& output,
                         const Session& session) {
  options.check();
  const OutputFolder folder(output);
  const OutputFolder truth_folder(folder.path() / "truth");
  CaseFiles files;
  const auto keep = [&](const Scan& scan) {
    write_ply(files.add(folder.path() / (scan.name + ".ply")), scan);
  };
  const ProjectTruth truth = simulate_project(options, keep, *session.monitor);
  const std::string task = project_task_json(truth);
  write_file(files.add(truth_folder.path() / "project.json"), project_truth_json(truth));
  write_file(files.add(folder.path() / "task.json"), task);
  files.keep();
  session.say(summary(truth, output));
  session.answer(task);
  return kExitOk;
}

}  // namespace limen
