// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/project_pictures.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/project/run/store_jobs.h"
#include "limen/project/store/store.h"

namespace limen {

std::vector<ProjectPicture> project_pictures(const std::filesystem::path& folder,
                                             const ProjectOptions& options, const ProjectResult& result,
                                             std::size_t most_points) {
  constexpr std::size_t kMostOutlined = 200;  // scans
  const Store store(folder / "store", store_options(options));
  const std::size_t each = most_points / std::max<std::size_t>(1, result.scans.size());
  std::vector<ProjectPicture> pictures(result.scans.size());
  parallel_for(pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const ProjectScan& scan = result.scans[k];
      if (!scan.readable || scan.sha256.empty()) continue;
      const std::string key = store.feature_key({scan.sha256, scan.model}, scan.index);
      if (std::optional<Scan> points = store.load_picture(key, each)) pictures[k].points = std::move(*points);
      if (!scan.model && result.scans.size() > kMostOutlined) continue;
      if (std::optional<PreparedScan> prepared = store.load_features(key))
        pictures[k].features = in_own_frame(std::move(*prepared));
    }
  });
  return pictures;
}

}  // namespace limen
