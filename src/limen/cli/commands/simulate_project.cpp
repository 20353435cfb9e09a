// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/simulate_project.h"

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/cli/commands/case_files.h"
#include "limen/geometry/random_vectors.h"
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

/// The targets as a surveyor measures them, or exactly, in the format of limen project --control.
std::string control_text(const ProjectTruth& truth, double sigma_m) {
  std::string text = "name,x,y,z,sigma\n";
  for (std::size_t k = 0; k < truth.targets.size(); ++k) {
    RandomStream random(truth.seed, 600000 + k);
    const Vector3d x = truth.local_origin + truth.targets[k].centre + sigma_m * normal_vector(random);
    text += fmt::format("{},{:.5f},{:.5f},{:.5f},{}\n", truth.targets[k].name, x.x(), x.y(), x.z(),
                        sigma_m > 0.0 ? sigma_m : 1e-5);
  }
  return text;
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
  if (!truth.targets.empty()) {
    constexpr double kSurveyedM = 0.001;
    write_file(files.add(folder.path() / "control.csv"), control_text(truth, kSurveyedM));
    write_file(files.add(truth_folder.path() / "control.csv"), control_text(truth, 0.0));
  }
  files.keep();
  session.say(summary(truth, output));
  session.answer(task);
  return kExitOk;
}

}  // namespace limen
