// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/register_inputs.h"

#include <chrono>
#include <filesystem>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/files/file_hash.h"
#include "limen/files/scan_in_file.h"
#include "limen/io/text/read_segments.h"
#include "limen/model/plausible_size.h"
#include "limen/register/register_segments.h"
#include "limen/report/pose_file.h"

namespace limen {

bool same_bytes(const std::string& a, const std::string& b) {
  const ScanInFile first = scan_in_file(a);
  const ScanInFile second = scan_in_file(b);
  std::error_code ignored;
  if (first.index != second.index || !std::filesystem::is_regular_file(first.file, ignored) ||
      !std::filesystem::is_regular_file(second.file, ignored))
    return false;
  if (std::filesystem::equivalent(first.file, second.file, ignored)) return true;
  return std::filesystem::file_size(first.file, ignored) ==
             std::filesystem::file_size(second.file, ignored) &&
         sha256_of_file(first.file) == sha256_of_file(second.file);
}

std::string SamePointsWatch::note_on(const RegisterInput& side, bool is_source) {
  if (side.scans.empty()) return {};
  const Scan& scan = side.scans.front().scan;
  if (is_source) {
    of_source_ = print_of(scan);
    if (same_bytes(source_, target_)) return note_ = same_points_note(scan.size());
  } else if (note_.empty()) {
    return note_ = same_points_note(of_source_, print_of(scan));
  }
  return {};
}

namespace {

/// The ends of the segments stand for the points of a scan.
InputSummary summary_of(const std::string& path, const SegmentSet& set) {
  Scan ends;
  ends.local_origin = set.local_origin;
  for (const Segment& segment : set.segments) {
    ends.points.push_back(segment.a);
    ends.points.push_back(segment.b);
  }
  InputSummary summary = summarise(path, ends);
  summary.kind = "segments";
  summary.sha256 = sha256_of_file(path);
  summary.elements = set.segments.size();
  return summary;
}

PicturedSide pictured(const SegmentSet& set) {
  PicturedSide side;
  side.features.local_origin = set.local_origin;
  side.features.segments = set.segments;
  return side;
}

}  // namespace

bool are_segment_files(const std::string& source, const std::string& target) {
  const bool first = is_segment_file(source);
  const bool second = is_segment_file(target);
  if (first != second) {
    const std::string& other = first ? target : source;
    if (!std::filesystem::exists(other)) throw Error("does not exist", other, "check the path");
    throw Error("holds no segments that limen can read, the other file does", other,
                "give two scans, or two files of segments");
  }
  return first;
}

RegistrationReport register_segment_files(const std::string& source, const std::string& target,
                                          Gravity gravity, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  session.monitor->begin_stage("reading");
  const SegmentSet from = read_segments(source);
  const SegmentSet to = read_segments(target);
  const std::chrono::duration<double> reading = std::chrono::steady_clock::now() - start;
  RegistrationReport report;
  report.result = register_segments(from, to, gravity, *session.monitor);
  report.result.stages.insert(report.result.stages.begin(), {"reading", reading.count()});
  report.result.picture =
      std::make_shared<const RegistrationPicture>(RegistrationPicture{pictured(from), pictured(to)});
  report.source = summary_of(source, from);
  report.target = summary_of(target, to);
  report.seed = session.common.seed;
  return report;
}

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

/// The pose of a further scan in the frame of the side's own, `own`. A text is in the unit of its
/// numbers; a registration of the two counts in either direction.
Rigid3 pose_in_group(const std::string& path, const std::string& scan, const InputSummary& own) {
  const PoseFile file = read_pose_file(path);
  if (!file.target_from_source)
    throw Error("holds no pose", path,
                "give four rows of four numbers, or the result.json of a registration");
  Rigid3 pose = *file.target_from_source;
  if (file.of_numbers) pose.translation *= own.metres_per_unit;
  if (file.source_sha256.empty() || file.target_sha256.empty()) return pose;
  const std::string hash = sha256_of_file(file_of_scan(scan));
  if (file.source_sha256 == hash && file.target_sha256 == own.sha256) return pose;
  if (file.source_sha256 == own.sha256 && file.target_sha256 == hash) return inverse(pose);
  throw Error(fmt::format("registers {} in {}, but a pose of {} in {} is wanted", file.source_path,
                          file.target_path, scan, own.path),
              path, "give the result of these two files, or its matrix as a text of 4 x 4 numbers");
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
    const Rigid3 pose = pose_in_group(options.with[k + 1], options.with[k], side.summary);
    side.input.scans.push_back(
        {read_input_scan(options.with[k], reading, session, options.units_option).scan, pose});
    require_plausible_size(side.input.scans.back().scan, options.units_option);
    side.summary.with.push_back(options.with[k]);
    side.summary.points += side.input.scans.back().scan.size();
  }
  return side;
}

}  // namespace limen
