// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/work.h"

#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limen/base/atomic_file.h"
#include "limen/base/version.h"
#include "limen/files/bounded_json.h"
#include "limen/files/scan_in_file.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
using Order = nlohmann::json;

constexpr std::string_view kLevel = "-level";

/// A worker cannot do its job here or now.
struct Unavailable {
  std::string words;
};

/// A file in the order: by its bytes, and by what it is taken as.
std::string name_in_order(const ProjectFile& file) {
  return file.sha256 + (file.model ? "-model" : "") +
         (file.scan < 0 ? "" : fmt::format("-scan{}", file.scan));
}

std::string key_of_file(const ProjectFile& file, const Store& store) {
  return name_in_order(file) + "-" + store.options_key();
}

fs::path order_path(const fs::path& folder, const std::string& options_key) {
  return folder / "store" / "orders" / (options_key + ".json");
}

Order options_order(const ProjectOptions& options) {
  const RegisterOptions& registering = options.registering;
  const StatedTrajectories& stated = options.trajectories;
  const Vector3d& arm = stated.reading.lever_arm_m;
  return {{"method", static_cast<int>(registering.method)},
          {"gravity", static_cast<int>(registering.gravity)},
          {"wall_thickness_m", registering.wall_thickness_m},
          {"seed", registering.seed},
          {"nothing_repeats", registering.nothing_repeats},
          {"level", options.reading.level},
          {"memory_bytes", options.reading.memory_bytes},
          {"trajectories", stated.files},
          {"trajectory_columns", stated.reading.columns},
          {"utm_zone", stated.reading.utm_zone},
          {"sphere_radius_m", options.targets.sphere_radius_m},
          {"board_side_m", options.targets.board_side_m},
          {"time_offset_s", stated.reading.time_offset_s},
          {"lever_arm_m", {arm.x(), arm.y(), arm.z()}}};
}

ProjectOptions options_from(const Order& order) {
  ProjectOptions options;
  options.registering.method = static_cast<Method>(order.at("method").get<int>());
  options.registering.gravity = static_cast<Gravity>(order.at("gravity").get<int>());
  options.registering.wall_thickness_m = order.at("wall_thickness_m");
  options.registering.seed = order.at("seed");
  options.registering.nothing_repeats = order.at("nothing_repeats");
  options.reading.level = order.at("level");
  options.reading.memory_bytes = order.at("memory_bytes");
  options.targets.sphere_radius_m = order.at("sphere_radius_m");
  options.targets.board_side_m = order.at("board_side_m");
  StatedTrajectories& stated = options.trajectories;
  stated.files = order.at("trajectories").get<std::vector<std::string>>();
  stated.reading.columns = order.at("trajectory_columns").get<std::vector<std::string>>();
  stated.reading.utm_zone = order.at("utm_zone");
  stated.reading.time_offset_s = order.at("time_offset_s");
  for (std::size_t k = 0; k < 3; ++k)
    stated.reading.lever_arm_m[static_cast<Eigen::Index>(k)] = order.at("lever_arm_m").at(k);
  return options;
}

/// The last part of a key: of the options it was made with.
std::string options_key_in(std::string_view key) {
  if (key.ends_with(kLevel)) key.remove_suffix(kLevel.size());
  return std::string(key.substr(key.rfind('-') + 1));
}

Order read_order(const fs::path& folder, const std::string& options_key) {
  const fs::path path = order_path(folder, options_key);
  std::ifstream stream(path);
  const Order order = json_or_nothing<Order>(stream);
  if (!stream || !order.is_object())
    throw Unavailable{"the project's folder is not visible on the worker: no " + path.string()};
  if (order.value("limen", "") != kVersion)
    throw Unavailable{fmt::format("the project is run by limen {}, the worker has {}",
                                  order.value("limen", "?"), kVersion)};
  return order;
}

class Worker {
 public:
  Worker(fs::path folder, const std::string& options_key, Monitor& monitor)
      : folder_(std::move(folder)), order_(read_order(folder_, options_key)) {
    options_ = options_from(order_.at("options"));
    std::error_code error;
    fs::current_path(order_.at("folder").get<std::string>(), error);
    if (error)
      throw Unavailable{"the folder that the scans' names are relative to: " + error.message() + ": " +
                        order_.at("folder").get<std::string>()};
    store_.emplace(folder_ / "store", store_options(options_), monitor);
    if (store_->options_key() != options_key) throw Unavailable{"the job is of another version of limen"};
  }

  WorkAnswer features(const std::string& key, Monitor& monitor) const {
    const std::string name = key.substr(0, key.rfind('-'));
    const Order& files = order_.at("files");
    if (!files.contains(name)) throw Unavailable{"the file is not part of the project's last run"};
    const Order& stated = files.at(name);
    ProjectFile file{stated.at("path"), stated.at("model"), name.substr(0, name.find('-')), {}, {},
                     stated.at("scan")};
    require_whole(file.path, stated.at("bytes"));
    try {
      make_features(file, options_, *store_, monitor);
    } catch (const StoreFault&) {
      throw;
    } catch (const Error& error) {
      if (error.fault() != Fault::input) throw;
      require_whole(file.path, stated.at("bytes"));
      return {"bad_input", error.what()};
    }
    return {"done", {}};
  }

  WorkAnswer pair(PairKey pair) const {
    pair.counts = {counts_of(pair.source), counts_of(pair.target)};
    constexpr std::size_t kTwo = 2;
    ScanCache cache(*store_, kTwo, [this](const std::string& key) { return file_of(key); });
    make_pair_result(pair, options_.registering, *store_, cache);
    return {"done", {}};
  }

 private:
  [[nodiscard]] FeatureCounts counts_of(const std::string& key) const {
    const std::optional<ScanDigest> digest = store_->load_digest(key);
    if (!digest || !store_->has_features(key))
      throw Unavailable{"features are not in the store, or damaged: " + file_of(key)};
    return digest->counts();
  }

  /// The file whose features have this key.
  [[nodiscard]] std::string file_of(const std::string& key) const {
    const bool model = key.find("-model-") != std::string::npos;
    for (const auto& [name, stated] : order_.at("files").items()) {
      if (stated.at("model") == model && name.starts_with(key.substr(0, key.find('-'))))
        return stated.at("path");
    }
    return key;
  }

  static void require_whole(const std::string& path, std::uintmax_t bytes) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file_of_scan(path), error);
    if (error || size != bytes) throw Unavailable{path + " is not the same on the worker as for limen"};
  }

  fs::path folder_;
  Order order_;
  ProjectOptions options_;
  std::optional<Store> store_;
};

WorkAnswer do_job(const std::vector<std::string>& words, Monitor& monitor) {
  const Worker worker(words[0], options_key_in(words[2]), monitor);
  if (words[1] == "features") return worker.features(words[2], monitor);
  PairKey pair{words[2], words[3], words[3].ends_with(kLevel)};
  if (pair.level) pair.target.resize(pair.target.size() - kLevel.size());
  return worker.pair(pair);
}

}  // namespace

void write_work_order(const fs::path& folder, const std::vector<ProjectFile>& files,
                      const ProjectOptions& options, const Store& store) {
  Order order = {{"limen", kVersion},
                 {"folder", fs::current_path().string()},
                 {"options", options_order(options)},
                 {"files", Order::object()}};
  for (const ProjectFile& file : files) {
    if (file.sha256.empty() || !file.copy_of.empty()) continue;
    std::error_code ignored;
    order["files"][name_in_order(file)] = {{"path", file.path},
                                           {"model", file.model},
                                           {"scan", file.scan},
                                           {"bytes", fs::file_size(file_of_scan(file.path), ignored)}};
  }
  const fs::path path = order_path(folder, store.options_key());
  std::error_code ignored;
  fs::create_directories(path.parent_path(), ignored);
  write_file(path, order.dump(1, ' ', false, Order::error_handler_t::replace) + "\n");
}

Job features_job(const fs::path& folder, const ProjectFile& file, const Store& store) {
  return {"features of " + file.path,
          {fs::absolute(folder).lexically_normal().string(), "features", key_of_file(file, store)}};
}

Job pair_job(const fs::path& folder, const std::string& name, const PairKey& pair) {
  return {"pair " + name,
          {fs::absolute(folder).lexically_normal().string(), "pair", pair.source, pair.target_name()}};
}

WorkAnswer do_work(const std::vector<std::string>& words, Monitor& monitor) {
  const bool features = words.size() == 3 && words[1] == "features";
  const bool pair = words.size() == 4 && words[1] == "pair";
  if (!features && !pair)
    throw Error("not a job", "project work", "say DIR features KEY, or DIR pair SOURCE TARGET");
  try {
    return do_job(words, monitor);
  } catch (const Unavailable& fault) {
    return {"unavailable", fault.words};
  } catch (const StoreFault& fault) {
    return {"unavailable", fault.what()};
  } catch (const Order::exception&) {
    return {"unavailable", "the work order is damaged: " + words[0]};
  }
}

}  // namespace limen
