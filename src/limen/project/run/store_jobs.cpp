// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/store_jobs.h"

#include <algorithm>

#include <fmt/format.h>

#include "limen/base/progress.h"
#include "limen/bim/read_bim.h"
#include "limen/extract/targets/find_targets.h"
#include "limen/files/file_hash.h"
#include "limen/files/scan_in_file.h"
#include "limen/io/cloud/point_print.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/model/plausible_size.h"
#include "limen/project/store/kept_notes.h"
#include "limen/project/store/scan_picture.h"
#include "limen/register/prepare/prepare_model.h"
#include "limen/register/prepare/prepared_pair.h"

namespace limen {

std::shared_ptr<const PreparedScan> ScanCache::get(const std::string& key) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = entries_.find(key);
    if (found != entries_.end()) {
      found->second.used = ++clock_;
      return found->second.scan;
    }
  }
  std::optional<PreparedScan> loaded = store_.load_features(key);
  if (!loaded)
    throw Error("its features are gone from the store, or damaged", name_(key), "run the project again");
  auto scan = std::make_shared<const PreparedScan>(std::move(*loaded));
  const std::lock_guard<std::mutex> lock(mutex_);
  entries_[key] = {scan, ++clock_};
  while (entries_.size() > most_) {
    entries_.erase(std::min_element(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    }));
  }
  return scan;
}

namespace {

/// Saves something; that it cannot be saved is no fault of what it was made of.
template <typename Save>
void into_store(const Save& save) {
  try {
    save();
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    throw StoreFault(error.problem(), error.where(), error.remedy());
  }
}

/// Throws Error where the file is not any more what its hash was taken of: what was read of it would be kept
/// under the wrong key, and used in all later runs.
void require_unchanged(const ProjectFile& file) {
  if (sha256_of_file(file_of_scan(file.path)) != file.sha256)
    throw Error("was changed while it was read", file.path, "run the project again once it is written");
}

/// One scan of many may be a few points; where none can be a scan, the file is refused.
void require_a_plausible_scan(const std::vector<Scan>& scans) {
  if (!scans.empty() && std::none_of(scans.begin(), scans.end(), has_plausible_size))
    require_plausible_size(scans.front());
}

/// In world coordinates.
std::vector<FoundTarget> targets_in(const Scan& scan, const TargetOptions& sizes) {
  std::vector<FoundTarget> targets = find_targets(scan, sizes);
  for (FoundTarget& target : targets) target.centre += scan.local_origin;
  return targets;
}

FileRecord make_scan_features(const ProjectFile& file, const ProjectOptions& options, const Store& store,
                              Monitor& monitor) {
  constexpr double kReading = 0.3;
  ScanFile read;
  {
    StagePart reading(monitor, 0.0, kReading);
    read = read_scan_file(file.path, options.reading, reading);
  }
  require_unchanged(file);
  require_a_plausible_scan(read.scans);
  const bool timed =
      std::any_of(read.scans.begin(), read.scans.end(), [](const Scan& it) { return !it.times_s.empty(); });
  const Trajectories trajectories = timed ? read_trajectories(options.trajectories) : Trajectories{};
  FileRecord record;
  record.notes = read.notes;
  for (std::string remark : {unit_remark(read.metres_per_unit), offset_remark(read.offset_applied)})
    if (!remark.empty()) record.notes.push_back(std::move(remark));
  const auto all = static_cast<double>(read.scans.size());
  for (std::size_t k = 0; k < read.scans.size(); ++k) {
    const auto at = [&](std::size_t i) { return kReading + (1.0 - kReading) * static_cast<double>(i) / all; };
    StagePart preparing(monitor, at(k), at(k + 1));
    Scan scan = along_trajectory(std::move(read.scans[k]), trajectories, record.notes);
    for (const std::string& doubt : hints_about(scan))
      record.notes.push_back(read.scans.size() > 1 ? fmt::format("scan {}: {}", k, doubt) : doubt);
    record.points.push_back(scan.size());
    record.prints.push_back(print_of(scan));
    const std::string key = store.feature_key(file.key(), static_cast<int>(k));
    if (!store.has_picture(key)) into_store([&] { store.save_picture(key, picture_of(scan)); });
    if (options.targets.any() && !scan.centre_known())
      record.notes.push_back(
          "no target is looked for, because the file does not say where the scanner stood");
    if (options.targets.any() && !store.load_targets(key, options.targets))
      into_store([&] { store.save_targets(key, options.targets, targets_in(scan, options.targets)); });
    std::optional<PreparedScan> prepared;
    if (store.has_features(key)) prepared = store.load_features(key);
    if (!prepared) {
      PrepareOptions with_track = prepare_options(options.registering);
      with_track.track = true;
      prepared = prepare_scan(std::move(scan), with_track, preparing);
      into_store([&] { store.save_features(key, *prepared); });
    }
    if (std::string words = words_of_refuted(prepared->place); !words.empty())
      record.notes.push_back(std::move(words));
  }
  record.notes = without_name(std::move(record.notes), file.path);
  return record;
}

FileRecord make_model_features(const ProjectFile& file, const Store& store, Monitor& monitor) {
  const BimModel model = read_bim(file.path, monitor);
  require_unchanged(file);
  const PreparedScan prepared = prepare_model(model, monitor);
  into_store([&] { store.save_features(store.feature_key(file.key(), 0), prepared); });
  return {{0}, without_name(model.warnings, file.path)};
}

/// A record as it is reported in this run.
FileRecord stated_record(FileRecord record, const ProjectFile& file, const ProjectOptions& options) {
  std::vector<std::string> names{file.path};
  names.insert(names.end(), options.trajectories.files.begin(), options.trajectories.files.end());
  record.notes = with_names(std::move(record.notes), names);
  return record;
}

}  // namespace

std::string store_options(const ProjectOptions& options) {
  const RegisterOptions& registering = options.registering;
  std::string text = fmt::format("method {} gravity {} thickness {} seed {} level {} memory {}",
                                 static_cast<int>(registering.method), static_cast<int>(registering.gravity),
                                 registering.wall_thickness_m, registering.seed, options.reading.level,
                                 options.reading.memory_bytes);
  if (registering.nothing_repeats) text += " nothing repeats";
  if (const std::string key = key_of(options.trajectories); !key.empty()) text += " trajectories " + key;
  return text;
}

std::optional<FileRecord> kept_record(const Store& store, const ProjectFile& file,
                                      const ProjectOptions& options) {
  std::optional<FileRecord> record = store.load_file(file.key());
  if (!record) return {};
  for (std::size_t k = 0; k < record->points.size(); ++k) {
    const std::string key = store.feature_key(file.key(), static_cast<int>(k));
    if (!store.has_features(key)) return {};
    if (file.model) continue;
    if (!store.has_picture(key) || (options.targets.any() && !store.load_targets(key, options.targets)))
      return {};
  }
  return stated_record(std::move(*record), file, options);
}

FileRecord make_features(const ProjectFile& file, const ProjectOptions& options, const Store& store,
                         Monitor& monitor) {
  if (std::optional<FileRecord> kept = kept_record(store, file, options)) return std::move(*kept);
  FileRecord record = file.model ? make_model_features(file, store, monitor)
                                 : make_scan_features(file, options, store, monitor);
  into_store([&] { store.save_file(file.key(), record); });
  return stated_record(std::move(record), file, options);
}

std::string PairKey::target_name() const {
  constexpr std::size_t kDigits = 16;
  std::string name = target + (level ? "-level" : "");
  if (!start) return name;
  std::string numbers = fmt::format("{} {} ", start->sigma_m, start->sigma_rad);
  for (const double number : to_matrix(start->target_from_source).reshaped())
    numbers += fmt::format("{} ", number);
  return name + "-start" + sha256_of(numbers).substr(0, kDigits);
}

RegistrationResult make_pair_result(const PairKey& pair, const RegisterOptions& options, const Store& store,
                                    ScanCache& cache) {
  std::optional<RegistrationResult> kept = store.load_pair(pair.source, pair.target_name(), pair.counts);
  if (!kept) {
    RegisterOptions own = options;
    // What is kept of a pair does not depend on the risk: the project weighs it.
    own.verdict.risk = VerdictOptions{}.risk;
    own.verdict.probable_risk = VerdictOptions{}.probable_risk;
    if (pair.level) own.gravity = Gravity::up;
    own.start = pair.start;
    // Copies, but of little: the views of space are shared.
    const PreparedPair prepared{*cache.get(pair.source), *cache.get(pair.target)};
    const RegistrationResult result = register_prepared(prepared, own);
    into_store([&] { store.save_pair(pair.source, pair.target_name(), result); });
    kept = store.load_pair(pair.source, pair.target_name(), pair.counts);
  }
  if (!kept) throw StoreFault("the result of a pair cannot be read back", pair.source, "check the disk");
  return std::move(*kept);
}

}  // namespace limen
