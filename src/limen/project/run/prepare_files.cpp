// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/prepare_files.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <mutex>
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
        outcomes_(files.size()) {
    for (std::size_t k = 0; k < files.size(); ++k) (is_large(files[k]) ? large_ : small_).files.push_back(k);
  }

  void large_first() { work({&large_, &small_}); }
  void small_ones() { work({&small_}); }

 private:
  /// Files that are made one after the other, each by the thread that takes it.
  struct Queue {
    std::vector<std::size_t> files;
    std::atomic<std::size_t> next{0};
  };

  [[nodiscard]] bool is_large(const ProjectFile& file) const {
    std::error_code ignored;
    return options_.reading.memory_bytes > 0 ||
           std::filesystem::file_size(file_of_scan(file.path), ignored) > kLargeBytes;
  }

  /// Takes one file after the other until none is left, or another thread has failed.
  void work(std::initializer_list<Queue*> queues) {
    try {
      for (Queue* queue : queues) {
        for (std::size_t k = queue->next++; k < queue->files.size(); k = queue->next++) {
          CancelScope::check();
          settle(queue->files[k], outcome_of(files_[queue->files[k]], progress_.worker(queue->files[k])));
        }
      }
    } catch (...) {
      large_.next = small_.next = files_.size();
      throw;
    }
  }

  FileOutcome outcome_of(const ProjectFile& file, Monitor& monitor) {
    if (!file.fault.empty() || !file.copy_of.empty()) return {};
    try {
      return {make_features(file, options_, store_, monitor), {}};
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
  Queue large_;
  Queue small_;
  std::mutex mutex_;
  std::size_t settled_ = 0;
  std::vector<std::optional<FileOutcome>> outcomes_;
};

}  // namespace

void prepare_files(const std::vector<ProjectFile>& files, const ProjectOptions& options, const Store& store,
                   Monitor& monitor, const std::function<void(std::size_t, FileOutcome)>& on_done) {
  FilePreparer preparer(files, options, store, monitor, on_done);
  run_both([&] { preparer.large_first(); }, [&] { preparer.small_ones(); });
}

}  // namespace limen
