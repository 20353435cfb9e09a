// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/registered_file.h"

#include <filesystem>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/bim/read_bim.h"
#include "limen/files/file_hash.h"
#include "limen/files/mapped_file.h"
#include "limen/files/scan_in_file.h"
#include "limen/report/summary/words.h"

namespace limen {

void warn_of_doubt(const PoseFile& file, const std::string& path, const Session& session) {
  if (!file.outcome || *file.outcome == Outcome::registered) return;
  if (*file.outcome == Outcome::probable && file.probability)
    return session.warn(fmt::format("the pose in {} is only probable; the probability that it is right is {}",
                                    path, probability_words(*file.probability)));
  session.note(fmt::format("the pose in {} is {}: check it", path, to_string(*file.outcome)));
}

void note_other_scan(const std::string& registered, const std::string& given, const Session& session) {
  const ScanInFile found = split_scan_name(registered);
  const ScanInFile moved = split_scan_name(given);
  const auto name = [](const ScanInFile& scan) { return std::filesystem::path(scan.file).filename(); };
  if (!found.index || found.index == moved.index || name(found) != name(moved)) return;
  session.note(fmt::format(
      "the pose was found for scan #{} of {}: it holds for others only where the file's own poses join them",
      *found.index, name(found).string()));
}

std::optional<double> unit_to_read(const std::string& path, std::optional<double> stated) {
  return stated == 1.0 && is_bim_file(path) ? std::nullopt : stated;
}

void require_registered_file(const ProjectEntry& entry, const std::string& project, bool force) {
  require_readable(
      file_of_scan(entry.file),
      fmt::format("run limen in the folder from which {} found it, or restore the file", project));
  if (force || entry.sha256.empty() || sha256_of_file(file_of_scan(entry.file)) == entry.sha256) return;
  throw Error(fmt::format("is not the file registered in {}: its SHA-256 is different", project), entry.file,
              "give the registered file, or add --force if this file is in the same frame");
}

}  // namespace limen
