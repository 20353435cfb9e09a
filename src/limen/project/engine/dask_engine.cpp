// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Jobs on Dask: a small Python program beside limen (limen_dask.py) takes them line by line and answers line
// by line. It retries what may be retried; here only the rest is reported.
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limen/base/child_process.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/system.h"
#include "limen/files/bounded_json.h"
#include "limen/project/engine/helper_process.h"
#include "limen/project/engine/job_engine.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
using Line = nlohmann::json;

fs::path program_to_call() {
  const char* starter = program_starter();
  return starter != nullptr ? fs::path(starter) : own_program();
}

/// Installed beside the program (PREFIX/share/limen), or in the build's folder.
fs::path find_dask_driver() {
  const char* named = std::getenv("LIMEN_DASK_DRIVER");
  if (named != nullptr && *named != '\0') return named;
  const fs::path folder = program_to_call().parent_path();
  for (const fs::path& place : {folder.parent_path() / "share" / "limen" / "limen_dask.py",
                                folder / "share" / "limen" / "limen_dask.py"}) {
    if (fs::is_regular_file(place)) return place;
  }
  throw Error("limen_dask.py, which gives jobs to Dask, was not found", "share/limen beside limen",
              "install it with limen, name it in LIMEN_DASK_DRIVER, or leave --engine out");
}

std::vector<std::string> command_of(const EngineOptions& options) {
  std::vector<std::string> command{"python3", find_dask_driver().string(), "--program",
                                   program_to_call().string()};
  const auto add = [&](const char* name, const std::string& value) {
    if (value.empty()) return;
    command.emplace_back(name);
    command.push_back(value);
  };
  add("--scheduler", options.scheduler);
  add("--scheduler-file", options.scheduler_file);
  add("--tls-ca", options.tls_ca);
  add("--tls-cert", options.tls_cert);
  add("--tls-key", options.tls_key);
  if (options.trust_network) command.emplace_back("--trust-network");
  add("--workers", std::to_string(thread_count()));
  return command;
}

class DaskEngine : public JobEngine {
 public:
  DaskEngine(const EngineOptions& options, std::string log, Monitor& monitor)
      : options_(options), log_(std::move(log)), helper_(command_of(options), log_) {
    while (!next_line(monitor).contains("ready")) {
    }
  }

  std::vector<JobResult> run(const std::vector<Job>& jobs, const std::function<void(std::size_t)>& on_done,
                             Monitor& monitor) override {
    std::vector<JobResult> results(jobs.size());
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      const Line line = {{"id", first_id_ + k}, {"name", jobs[k].name}, {"words", jobs[k].words}};
      // Where it hears nothing any more, its last words tell why.
      monitor.throw_if_cancelled();
      if (!helper_.say(line.dump())) break;
    }
    for (std::size_t done = 0; done < jobs.size();) {
      const Line line = next_line(monitor);
      if (!line.contains("id")) continue;
      const auto id = line.at("id").get<std::size_t>();
      if (id < first_id_ || id - first_id_ >= jobs.size()) continue;
      results[id - first_id_] = result_of(line);
      on_done(++done);
    }
    first_id_ += jobs.size();
    return results;
  }

 private:
  /// Notes are passed on; a fault ends the run.
  Line next_line(Monitor& monitor) {
    constexpr int kTickMs = 200;
    for (;;) {
      monitor.throw_if_cancelled();
      const std::optional<std::string> text = helper_.hear(kTickMs);
      if (!text) {
        if (!helper_.ended()) continue;
        throw Error("the Python program that gives jobs to Dask has ended", log_,
                    "install python3, python3-distributed and python3-cryptography, look into this file, or "
                    "leave --engine out");
      }
      Line line = json_or_nothing<Line>(*text);
      if (!line.is_object()) continue;
      if (line.contains("fault"))
        throw Error(line.at("fault").get<std::string>(), line.value("where", "Dask"),
                    line.value("remedy", "look into " + log_));
      if (!line.contains("note")) return line;
      if (options_.on_note) options_.on_note(line.at("note").get<std::string>());
    }
  }

  static JobResult result_of(const Line& line) {
    const std::string state = line.value("state", "failed");
    return {state == "done"        ? JobState::done
            : state == "bad_input" ? JobState::bad_input
                                   : JobState::failed,
            line.value("words", "")};
  }

  EngineOptions options_;
  std::string log_;
  HelperProcess helper_;
  std::size_t first_id_ = 0;
};

}  // namespace

void EngineOptions::check() const {
  if (!scheduler.empty() && !scheduler_file.empty())
    throw Error("the scheduler is named twice", "--scheduler, --scheduler-file", "give one of the two");
  const bool any = !tls_ca.empty() || !tls_cert.empty() || !tls_key.empty();
  const bool all = !tls_ca.empty() && !tls_cert.empty() && !tls_key.empty();
  if (any && !all)
    throw Error("TLS needs three files", "--tls-ca, --tls-cert, --tls-key", "give all of them or none");
  const bool stated = any || !scheduler.empty() || !scheduler_file.empty() || trust_network;
  if (stated && kind == EngineKind::local)
    throw Error("a scheduler is used by the engine dask only", "--engine", "add --engine dask");
}

std::unique_ptr<JobEngine> make_engine(const EngineOptions& options, const std::string& log,
                                       Monitor& monitor) {
  options.check();
  if (options.kind == EngineKind::local) return nullptr;
  return std::make_unique<DaskEngine>(options, log, monitor);
}

}  // namespace limen
