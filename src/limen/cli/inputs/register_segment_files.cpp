// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/register_segment_files.h"

#include <chrono>
#include <filesystem>

#include "limen/base/error.h"
#include "limen/files/file_hash.h"
#include "limen/io/text/read_segments.h"
#include "limen/register/register_segments.h"

namespace limen {
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
  SegmentRegisterOptions options;
  options.gravity = gravity;
  RegistrationReport report;
  report.result = register_segments(from, to, options, *session.monitor);
  report.result.stages.insert(report.result.stages.begin(), {"reading", reading.count()});
  report.result.picture =
      std::make_shared<const RegistrationPicture>(RegistrationPicture{pictured(from), pictured(to)});
  report.source = summary_of(source, from);
  report.target = summary_of(target, to);
  report.seed = session.common.seed;
  return report;
}

}  // namespace limen
