// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "limen/base/progress.h"

namespace limen {

/// Where the jobs of a project run.
enum class EngineKind {
  local,  ///< threads of this program
  dask    ///< workers of Dask, on this machine or others, over a shared folder
};

struct EngineOptions {
  EngineKind kind = EngineKind::local;
  std::string scheduler = {};       ///< tcp://HOST:PORT or tls://HOST:PORT; empty: see below
  std::string scheduler_file = {};  ///< that `dask-scheduler --scheduler-file` wrote; both empty: own workers
  std::string tls_ca = {};          ///< certificate of who signed the others'
  std::string tls_cert = {};        ///< our certificate
  std::string tls_key = {};         ///< and its key
  bool trust_network = false;       ///< a scheduler elsewhere may be reached without TLS
  std::function<void(const std::string&)> on_note = {};  ///< hears what goes wrong and is made good

  /// Throws Error where both ways to the scheduler are given, or TLS is given in part.
  void check() const;
};

/// One idempotent call of the program: `limen project work` and `words`.
struct Job {
  std::string name;  ///< in a user's words
  std::vector<std::string> words;
};

enum class JobState {
  done,       ///< the store holds its result
  bad_input,  ///< the file is no good, as `words` say
  failed      ///< it ended its worker, or itself, again and again
};

struct JobResult {
  JobState state = JobState::done;
  std::string words;
};

/// Runs jobs somewhere else.
class JobEngine {
 public:
  JobEngine() = default;
  JobEngine(const JobEngine&) = delete;
  JobEngine& operator=(const JobEngine&) = delete;
  virtual ~JobEngine() = default;

  /// Results in the order of the jobs; `on_done` hears how many are. Throws Error where the workers cannot
  /// be reached any more, or none of them can use the project's folder.
  virtual std::vector<JobResult> run(const std::vector<Job>& jobs,
                                     const std::function<void(std::size_t)>& on_done, Monitor& monitor) = 0;
};

/// Null for the local engine. `log`: a file for what the engine's own programs say. Throws Error where what
/// the engine needs is not installed, or the scheduler cannot be reached.
std::unique_ptr<JobEngine> make_engine(const EngineOptions& options, const std::string& log,
                                       Monitor& monitor);

}  // namespace limen
