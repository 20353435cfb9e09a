// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/prepare_files.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <shared_mutex>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/progress.h"
#include "limen/files/scan_in_file.h"

namespace limen {
namespace {

constexpr std::uintmax_t kLargeBytes = std::uintmax_t{32} << 20U;

class FilePreparer {
 public:
  FilePreparer(const std::vector<ProjectFile>& files, const ProjectOptions& options, const Store& store,
               Monitor& monitor, const std::function<void(std::size_t, FileOutcome)>& on_done)
      : files_(files),
        options_(options),
        store_(store),
        on_done_(on_done),
        progress_(monitor, files.size()),
        outcomes_(files.size()) {}

  /// Takes one file after the other until none is left, or another thread has failed.
  void work() {
    try {
      for (std::size_t k = next_++; k < files_.size(); k = next_++) {
        CancelScope::check();
        settle(k, outcome_of(k));
      }
    } catch (...) {
      next_ = files_.size();
      throw;
    }
  }

 private:
  FileOutcome outcome_of(std::size_t k) {
    const ProjectFile& file = files_[k];
    if (!file.fault.empty() || !file.copy_of.empty()) return {};
    std::error_code ignored;
    const bool large = options_.reading.memory_bytes > 0 ||
                       std::filesystem::file_size(file_of_scan(file.path), ignored) > kLargeBytes;
    std::shared_lock beside(memory_, std::defer_lock);
    std::unique_lock alone(memory_, std::defer_lock);
    if (large)
      alone.lock();
    else
      beside.lock();
    try {
      return {make_features(file, options_, store_, progress_.worker(k)), {}};
    } catch (const StoreFault&) {
      throw;
    } catch (const Error& error) {
      if (error.fault() != Fault::input) throw;
      return {std::nullopt, error.what()};
    }
  }

  /// Hands on what is complete from the first file on.
  void settle(std::size_t k, FileOutcome outcome) {
    const std::scoped_lock lock(mutex_);
    outcomes_[k] = std::move(outcome);
    for (; settled_ < outcomes_.size() && outcomes_[settled_]; ++settled_) {
      on_done_(settled_, std::move(*outcomes_[settled_]));
      progress_.worker(settled_).advance(1.0, 1.0);
    }
  }

  const std::vector<ProjectFile>& files_;
  const ProjectOptions& options_;
  const Store& store_;
  const std::function<void(std::size_t, FileOutcome)>& on_done_;
  StageShares progress_;
  std::atomic<std::size_t> next_{0};
  std::shared_mutex memory_;
  std::mutex mutex_;
  std::size_t settled_ = 0;
  std::vector<std::optional<FileOutcome>> outcomes_;
};

}  // namespace

void prepare_files(const std::vector<ProjectFile>& files, const ProjectOptions& options, const Store& store,
                   Monitor& monitor, const std::function<void(std::size_t, FileOutcome)>& on_done) {
  FilePreparer preparer(files, options, store, monitor, on_done);
  run_both([&] { preparer.work(); }, [&] { preparer.work(); });
}

}  // namespace limen
