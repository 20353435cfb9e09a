// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/register_inputs.h"

#include <string>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/run_both.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/files/file_hash.h"
#include "limen/files/scan_in_file.h"
#include "limen/model/plausible_size.h"
#include "limen/report/pose_file.h"

namespace limen {
namespace {

InputSide read_model_side(const SideOptions& options, const Session& session) {
  if (!options.with.empty())
    throw Error("is a building model", options.path, "further scans can only be added to a scan");
  InputSide side;
  side.input.model =
      read_model_input(options.path, session, options.reading.metres_per_unit, options.units_option);
  side.summary = summarise(options.path, *side.input.model);
  side.summary.offset_applied = offset_of_model(options.path, *side.input.model);
  if (options.reading.metres_per_unit) side.summary.metres_per_unit = *options.reading.metres_per_unit;
  side.summary.sha256 = sha256_of_file(options.path);
  return side;
}

Rigid3 pose_in_group(const std::string& path) {
  const PoseFile file = read_pose_file(path);
  if (file.target_from_source) return *file.target_from_source;
  throw Error("holds no pose", path, "give four rows of four numbers, or the result.json of a registration");
}

}  // namespace

InputSide read_side(const SideOptions& options, const Session& session) {
  if (is_bim_file(options.path)) return read_model_side(options, session);
  InputSide side;
  InputScan read;
  std::string hash;
  run_both([&] { read = read_input_scan(options.path, options.reading, session, options.units_option); },
           [&] { hash = sha256_of_file(file_of_scan(options.path)); });
  side.input.scans.push_back({std::move(read.scan), {}});
  require_plausible_size(side.input.scans.front().scan, options.units_option);
  side.summary = summarise(options.path, side.input.scans.front().scan);
  side.summary.metres_per_unit = read.metres_per_unit;
  side.summary.offset_applied = read.offset_applied;
  side.summary.sha256 = std::move(hash);
  // The trajectory is that of the side's own scan.
  ReadOptions reading = options.reading;
  reading.trajectory.reset();
  for (std::size_t k = 0; k + 1 < options.with.size(); k += 2) {
    const Rigid3 pose = pose_in_group(options.with[k + 1]);
    side.input.scans.push_back(
        {read_input_scan(options.with[k], reading, session, options.units_option).scan, pose});
    require_plausible_size(side.input.scans.back().scan, options.units_option);
    side.summary.with.push_back(options.with[k]);
    side.summary.points += side.input.scans.back().scan.size();
  }
  return side;
}

}  // namespace limen
