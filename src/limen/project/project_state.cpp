// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/project_state.h"

#include <fstream>
#include <mutex>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/project/scan_cache.h"

namespace limen {
namespace {

constexpr std::size_t kScansInMemory = 16;

std::filesystem::path status_path(const std::filesystem::path& folder) {
  return folder / "store" / "status.json";
}

}  // namespace

void write_status(const std::filesystem::path& folder, const ProjectStatus& status) {
  write_file(
      status_path(folder),
      fmt::format("{{\"stage\": \"{}\", \"scans\": {}, \"ready\": {}, \"pairs\": {}, \"tried\": {}}}\n",
                  status.stage, status.scans, status.ready, status.pairs, status.tried));
}

ProjectStatus project_status(const std::filesystem::path& folder) {
  std::ifstream stream(status_path(folder));
  if (!stream)
    throw Error("holds no project", folder.string(), "give the folder that a project was written to");
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    return {json.at("stage"), json.at("scans"), json.at("ready"), json.at("pairs"), json.at("tried")};
  } catch (const nlohmann::json::exception&) {
    throw Error("the status is damaged", status_path(folder).string(), "run the project again");
  }
}

bool seem_level(const ProjectNode& source, const ProjectNode& target, const RegisterOptions& options) {
  const auto level = [](const ScanDigest& digest) { return digest.upright && !digest.model; };
  return options.gravity == Gravity::automatic && level(source.digest) && level(target.digest);
}

std::vector<TriedPair> try_pairs(const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                 const std::vector<ProjectNode>& nodes, const Store& store,
                                 const RegisterOptions& options, PairSearch search,
                                 const std::filesystem::path& folder, ProjectStatus& status,
                                 Monitor& monitor) {
  monitor.begin_stage("pairs");
  std::vector<TriedPair> tried(pairs.size());
  ScanCache cache(store, kScansInMemory);
  std::mutex mutex;
  std::size_t done = 0;
  status.stage = "pairs";
  parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto [source, target] = pairs[k];
      tried[k] = {source, target, {}};
      const bool level = search == PairSearch::level && seem_level(nodes[source], nodes[target], options);
      const std::string target_key = nodes[target].key + (level ? "-level" : "");
      std::optional<RegistrationResult> kept = store.load_pair(nodes[source].key, target_key);
      if (!kept) {
        RegisterOptions own = options;
        if (level) own.gravity = Gravity::up;
        // Copies, but of little: the views of space are shared.
        const PreparedPair pair{*cache.get(nodes[source].key), *cache.get(nodes[target].key)};
        store.save_pair(nodes[source].key, target_key, register_prepared(pair, own));
        kept = store.load_pair(nodes[source].key, target_key);
      }
      if (!kept) throw Error("the result of a pair cannot be read back", folder.string(), "look at the disk");
      tried[k].result = std::move(*kept);
      const std::lock_guard<std::mutex> lock(mutex);
      ++status.tried;
      write_status(folder, status);
      monitor.advance(static_cast<double>(++done), static_cast<double>(pairs.size()));
    }
  });
  return tried;
}

}  // namespace limen
