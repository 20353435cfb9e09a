// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/known_decision.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/project/state/scan_names.h"
#include "limen/report/project/read_project.h"

namespace limen {
namespace {

class KnownScans {
 public:
  explicit KnownScans(const std::filesystem::path& folder)
      : folder_(folder), scans_(read_project(folder / "project.json")) {}

  /// The number of the scan that is called so, among those of project.json.
  [[nodiscard]] std::size_t called(const std::string& name) const {
    const std::vector<std::size_t> found = among(name, false);
    if (found.size() == 1) return found.front();
    if (found.size() > 1)
      throw Error(fmt::format("has several scans named {}", name), folder_.string(),
                  "name one of them: " + listed(found));
    const std::vector<std::size_t> copies = among(name, true);
    if (copies.empty()) {
      const std::vector<std::size_t> all = places_of(false);
      throw Error(fmt::format("has no scan named {}", name), folder_.string(),
                  fmt::format("name two of its {}: {}", all.size(), listed(all)));
    }
    const ProjectEntry& copy = scans_[copies.front()];
    throw Error(fmt::format("{} is a copy of {} and has the same pose", name, copy.copy_of), folder_.string(),
                "name the original: " + original_of(copy));
  }

  void require(const Decision& decision) const {
    std::set<std::size_t> scans;
    for (const std::string& name : decision.scans) scans.insert(called(name));
    if (scans.size() < decision.scans.size())
      throw Error(fmt::format("{} and {} are the same scan", decision.scans[0], decision.scans[1]),
                  folder_.string(), "name two different scans");
    if (decision.kind == DecisionKind::choose) require_pose(decision);
  }

  void require_pose(const Decision& choice) const {
    const std::size_t a = called(choice.scans[0]);
    const std::size_t b = called(choice.scans[1]);
    std::set<int> numbers;
    for (const ProjectPoses& poses : read_project_poses(folder_ / "project.json")) {
      if (std::minmax(poses.source, poses.target) == std::minmax(a, b))
        numbers.insert(poses.numbers.begin(), poses.numbers.end());
    }
    if (numbers.empty() || numbers.count(choice.pose) > 0) return;
    throw Error(
        fmt::format("the link of {} and {} has no pose {}", choice.scans[0], choice.scans[1], choice.pose),
        folder_.string(), fmt::format("choose one of those in project.json: {}", fmt::join(numbers, ", ")));
  }

  [[nodiscard]] std::string full_name(const std::string& name) const {
    const std::vector<std::size_t> found = among(name, false);
    return found.size() == 1 ? scan_name(scans_[found.front()]) : name;
  }

 private:
  [[nodiscard]] std::vector<std::size_t> places_of(bool copies) const {
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      if (scans_[k].copy_of.empty() != copies) places.push_back(k);
    }
    return places;
  }

  [[nodiscard]] std::vector<std::size_t> among(const std::string& name, bool copies) const {
    const std::vector<std::size_t> places = places_of(copies);
    std::vector<std::size_t> found = scans_called(name, places.size(), [&](std::size_t k) {
      const ProjectEntry& scan = scans_[places[k]];
      return NumberedScan{scan.file, scan.index, scan.several};
    });
    for (std::size_t& k : found) k = places[k];
    return found;
  }

  [[nodiscard]] std::string original_of(const ProjectEntry& copy) const {
    return scan_name(NumberedScan{copy.copy_of, copy.index, copy.several});
  }

  [[nodiscard]] std::string listed(const std::vector<std::size_t>& scans) const {
    constexpr std::size_t kShown = 6;
    std::string names;
    for (std::size_t k = 0; k < std::min(kShown, scans.size()); ++k)
      names += (k == 0 ? "" : ", ") + scan_name(scans_[scans[k]]);
    return names + (scans.size() > kShown ? ", ..." : "");
  }

  std::filesystem::path folder_;
  std::vector<ProjectEntry> scans_;
};

}  // namespace

Decision as_known(Decision decision, const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "project.json", ignored)) return decision;
  const KnownScans known(folder);
  if (decision.kind != DecisionKind::forget) known.require(decision);
  for (std::string& name : decision.scans) name = known.full_name(name);
  return in_order(std::move(decision));
}

std::function<std::string(const std::string&)> full_names(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "project.json", ignored)) return {};
  return [known = KnownScans(folder)](const std::string& name) { return known.full_name(name); };
}

}  // namespace limen
