// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "limen/cli/serve/child.h"
#include "limen/report/json/json_values.h"

namespace limen {

/// A file for the page: its name and its size.
struct ServedFile {
  std::string name;
  std::uintmax_t bytes = 0;
};

/// The plain files of a folder that may be served, by name.
std::vector<ServedFile> served_files(const std::filesystem::path& folder);
Json served_files_json(const std::vector<ServedFile>& files);

/// One piece of work: a run of limen, whose results lie in results/ID.
struct PageJob {
  int id = 0;
  std::string kind;                ///< register, project, view, place, decide, plan or link
  std::string title;               ///< for a reader
  Json asked;                      ///< what the page asked for, by name: it alone is kept
  std::vector<std::string> words;  ///< of the command line, made of that; none where it was found on the disk
  std::string state = "queued";    ///< queued, running, done, failed or stopped
  int status = -1;                 ///< exit status; -1 before it ended
  double seconds = 0.0;
  std::string said;
  std::vector<ServedFile> outputs;
};

/// The work that is asked for, one piece after another: each takes all threads of the machine.
class JobBoard {
 public:
  static constexpr std::size_t kMostWaiting = 20;

  /// `folder`: what serve was given; finished work of an earlier run is found again. `common_words`: options
  /// that every job gets.
  explicit JobBoard(std::filesystem::path folder, std::vector<std::string> common_words = {});

  /// The number of the next job, for the names of its results.
  [[nodiscard]] int next_id() const { return next_id_; }
  /// Throws HttpFault where too many wait.
  void add(PageJob job);
  /// Once more, with these words, into the same folder. Throws HttpFault where there is no such job, or it
  /// has not ended.
  void again(int id, std::vector<std::string> words);
  /// Throws HttpFault where there is no such job. What has ended stays as it is.
  void stop(int id);
  /// Throws HttpFault where there is none.
  [[nodiscard]] const PageJob& job(int id) const;
  /// Whether work that waits or runs needs the file: names it, or the results of a job that was about it.
  [[nodiscard]] bool uses(const std::string& word) const;

  /// Hears the running one, ends it, begins the next.
  void tick();
  /// Asks the running one to end, and waits a little for that.
  void finish();
  [[nodiscard]] std::vector<int> ears() const;
  [[nodiscard]] std::filesystem::path results_of(int id) const;
  [[nodiscard]] Json as_json() const;

 private:
  PageJob& find(int id);
  void begin(PageJob& job);
  void end_running(int status);
  void keep(const PageJob& job) const;
  void find_kept();

  std::filesystem::path folder_;
  std::vector<std::string> common_words_;
  std::deque<PageJob> jobs_;
  int next_id_ = 1;
  std::unique_ptr<Child> child_;
  int running_ = 0;  ///< its number; 0: none
  bool stopping_ = false;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace limen
