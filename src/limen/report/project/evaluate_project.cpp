// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/evaluate_project.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/ranked.h"

namespace limen {
namespace {

/// A registered scan: where it is, and where it should be.
struct Placed {
  std::string file;
  Rigid3 frame_from_scan;
  Rigid3 world_from_scan;
  Vector3d at = Vector3d::Zero();  ///< where errors are measured, its own frame
};

const std::string& name_in_truth(const TrueScan& scan) {
  return scan.file.empty() ? scan.name : scan.file;
}

/// Models have no truth, and copies no place of their own.
bool counts(const ProjectEntry& entry) {
  return !entry.model && entry.copy_of.empty();
}

std::string called(const ProjectEntry& entry) {
  return entry.file + (entry.index > 0 ? fmt::format(", index {}", entry.index) : "");
}

int names_shared(const TrueScan& scan, const ProjectEntry& entry) {
  return scan.index == entry.index ? scan.names_shared_with(entry.file) : 0;
}

[[noreturn]] void throw_several(const std::string& problem, const std::filesystem::path& path) {
  throw Error(problem, path.string(), "name the scans in the truth with the folders that distinguish them");
}

/// The truth of a scan: that whose path ends with the most names of its own. Of several scans of the project
/// that are called alike it is the one's that shares most of them.
const TrueScan& truth_of(const ProjectEntry& entry, const std::vector<ProjectEntry>& project,
                         const std::vector<TrueScan>& truth, const std::filesystem::path& path) {
  const TrueScan* best = nullptr;
  const TrueScan* second = nullptr;
  int most = 0;
  for (const TrueScan& scan : truth) {
    const int shared = names_shared(scan, entry);
    if (shared == 0 || shared < most) continue;
    second = shared == most ? &scan : nullptr;
    if (shared > most) best = &scan;
    most = shared;
  }
  if (second != nullptr)
    throw_several(fmt::format("cannot tell which of {} and {} the scan {} is", name_in_truth(*best),
                              name_in_truth(*second), called(entry)),
                  path);
  bool lent = false;
  for (const ProjectEntry& other : project) {
    if (best == nullptr || &other == &entry || !counts(other)) continue;
    const int shared = names_shared(*best, other);
    lent = lent || shared > most;
    if (shared == most)
      throw_several(fmt::format("cannot tell which of the scans {} and {} its {} is", called(entry),
                                called(other), name_in_truth(*best)),
                    path);
  }
  if (best != nullptr && !lent) return *best;
  throw Error("holds no pose of the scan " + called(entry), path.string(),
              "give the truth of the scans of this project");
}

/// The middle of where the scanners stood; nothing where no scanner's place is known.
std::optional<Vector3d> middle_of(const std::vector<TrueScan>& truth) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const TrueScan& scan : truth) {
    if (!scan.scanner) continue;
    sum += scan.world_from_scan * *scan.scanner;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::vector<Placed> placed_of(const std::vector<ProjectEntry>& project, const std::vector<TrueScan>& truth,
                              const std::filesystem::path& path) {
  const std::optional<Vector3d> middle = middle_of(truth);
  std::vector<Placed> placed;
  for (const ProjectEntry& entry : project) {
    if (!counts(entry) || !entry.frame_from_scan || entry.state != "registered") continue;
    const TrueScan& scan = truth_of(entry, project, truth, path);
    Placed made{entry.file, *entry.frame_from_scan, scan.world_from_scan};
    if (scan.scanner)
      made.at = *scan.scanner;
    else if (middle)
      made.at = inverse(scan.world_from_scan) * *middle;
    placed.push_back(made);
  }
  return placed;
}

PlaceError error_against(const Placed& reference, const Placed& scan) {
  const Rigid3 found = reference.world_from_scan * inverse(reference.frame_from_scan) * scan.frame_from_scan;
  return {scan.file, (found * scan.at - scan.world_from_scan * scan.at).norm(),
          rotation_angle(found.rotation.transpose() * scan.world_from_scan.rotation)};
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  return ranked(values,
                static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1))));
}

double ProjectErrors::shift_of(double share) const {
  std::vector<double> shifts;
  for (const PlaceError& error : each) {
    if (&error != &each[reference]) shifts.push_back(error.shift_m);
  }
  return quantile(std::move(shifts), share);
}

ProjectErrors evaluate_project(const std::vector<ProjectEntry>& project, const std::vector<TrueScan>& truth,
                               const std::filesystem::path& truth_path) {
  const std::vector<Placed> placed = placed_of(project, truth, truth_path);
  ProjectErrors best;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    ProjectErrors errors;
    errors.reference = k;
    for (const Placed& scan : placed) errors.each.push_back(error_against(placed[k], scan));
    if (best.each.empty() || errors.shift_of(0.5) < best.shift_of(0.5)) best = std::move(errors);
  }
  best.scans = static_cast<std::size_t>(std::count_if(project.begin(), project.end(), counts));
  return best;
}

}  // namespace limen
