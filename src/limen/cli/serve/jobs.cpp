// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/jobs.h"

#include <algorithm>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/cli/serve/gate.h"
#include "limen/cli/serve/http_request.h"
#include "limen/cli/terminal/command.h"
#include "limen/files/bounded_json.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kGrace{3};
constexpr std::chrono::milliseconds kGraceTick{20};
constexpr std::size_t kMostKept = 1000;

bool has_ended(const PageJob& job) {
  return job.state != "queued" && job.state != "running";
}

/// All statuses that tell of an answer: also that there is none.
std::string state_of(int status, bool stopped) {
  if (status == kExitOk || status == kExitUndecided || status == kExitNoMatch) return "done";
  return stopped || status == kExitInterrupted ? "stopped" : "failed";
}

Json kept_json(const PageJob& job) {
  return {{"id", job.id},           {"kind", job.kind},
          {"title", job.title},     {"asked", job.asked},
          {"state", job.state},     {"status", job.status},
          {"seconds", job.seconds}, {"said", printable_lines(job.said)}};
}

/// What lies in the folder may be of somebody else: nothing of it is run before it was looked at as what the
/// page asks for is, and what did not end does not go on.
PageJob job_from(const Json& json) {
  PageJob job;
  job.id = json.at("id").get<int>();
  job.kind = printable(json.at("kind").get<std::string>());
  job.title = printable(json.at("title").get<std::string>());
  job.asked = json.value("asked", Json::object());
  job.state = json.at("state").get<std::string>();
  if (job.state != "done" && job.state != "failed") job.state = "stopped";
  job.status = json.at("status").get<int>();
  job.seconds = json.at("seconds").get<double>();
  job.said = json.at("said").get<std::string>();
  return job;
}

Json read_kept(const fs::path& path) {
  constexpr std::uintmax_t kMostBytes = 1U << 20U;
  std::error_code gone;
  if (!fs::is_regular_file(fs::symlink_status(path, gone)) || fs::file_size(path, gone) > kMostBytes)
    return {};
  std::ifstream stream(path);
  return json_or_nothing<Json>(stream);
}

}  // namespace

std::vector<ServedFile> served_files(const fs::path& folder) {
  std::vector<ServedFile> files;
  std::error_code stop;
  fs::directory_iterator entry(folder, stop);
  for (; !stop && entry != fs::directory_iterator(); entry.increment(stop)) {
    std::error_code gone;
    if (!is_safe_name(entry->path().filename().string()) || entry->is_symlink(gone) ||
        !entry->is_regular_file(gone))
      continue;
    const std::uintmax_t bytes = entry->file_size(gone);
    if (!gone) files.push_back({entry->path().filename().string(), bytes});
  }
  std::sort(files.begin(), files.end(),
            [](const ServedFile& a, const ServedFile& b) { return a.name < b.name; });
  return files;
}

Json served_files_json(const std::vector<ServedFile>& files) {
  Json json = Json::array();
  for (const ServedFile& file : files) json.push_back({{"name", file.name}, {"bytes", file.bytes}});
  return json;
}

JobBoard::JobBoard(fs::path folder, std::vector<std::string> common_words)
    : folder_(std::move(folder)), common_words_(std::move(common_words)) {
  find_kept();
}

fs::path JobBoard::results_of(int id) const {
  return folder_ / "results" / std::to_string(id);
}

void JobBoard::find_kept() {
  std::error_code stop;
  fs::directory_iterator entry(folder_ / "results", stop);
  for (; !stop && entry != fs::directory_iterator(); entry.increment(stop)) {
    const std::string name = entry->path().filename().string();
    const std::optional<std::size_t> number = parse_count(name.substr(0, name.find('.')));
    if (!number || *number > 1'000'000'000) continue;
    next_id_ = std::max(next_id_, static_cast<int>(*number) + 1);
    if (entry->path().extension() != ".json" || jobs_.size() == kMostKept) continue;
    try {
      PageJob job = job_from(read_kept(entry->path()));
      if (job.id != static_cast<int>(*number)) continue;
      job.outputs = served_files(results_of(job.id));
      jobs_.push_back(std::move(job));
    } catch (const Json::exception&) {
      continue;  // the record of no job
    }
  }
  std::sort(jobs_.begin(), jobs_.end(), [](const PageJob& a, const PageJob& b) { return a.id < b.id; });
}

PageJob& JobBoard::find(int id) {
  const auto found =
      std::find_if(jobs_.begin(), jobs_.end(), [&](const PageJob& job) { return job.id == id; });
  if (found == jobs_.end()) throw HttpFault(404, "there is no such job");
  return *found;
}

const PageJob& JobBoard::job(int id) const {
  return const_cast<JobBoard*>(this)->find(id);
}

bool JobBoard::uses(const std::string& word) const {
  const std::string quoted = Json(fs::path(word).filename().string()).dump();
  const auto is_about = [&](const std::string& results) {
    return std::any_of(jobs_.begin(), jobs_.end(), [&](const PageJob& job) {
      return results.starts_with(fmt::format("results/{}/", job.id)) &&
             job.asked.dump().find(quoted) != std::string::npos;
    });
  };
  return std::any_of(jobs_.begin(), jobs_.end(), [&](const PageJob& job) {
    return !has_ended(job) && std::any_of(job.words.begin(), job.words.end(), [&](const std::string& own) {
      return own == word || is_about(own);
    });
  });
}

void JobBoard::add(PageJob job) {
  const auto waiting =
      std::count_if(jobs_.begin(), jobs_.end(), [](const PageJob& it) { return it.state == "queued"; });
  if (static_cast<std::size_t>(waiting) >= kMostWaiting)
    throw HttpFault(429, "too many jobs are waiting already");
  job.id = next_id_++;
  jobs_.push_back(std::move(job));
}

void JobBoard::again(int id, std::vector<std::string> words) {
  PageJob& job = find(id);
  if (!has_ended(job)) throw HttpFault(409, "this job has not ended yet");
  job.words = std::move(words);
  job.state = "queued";
  job.status = -1;
  job.said.clear();
}

void JobBoard::stop(int id) {
  PageJob& job = find(id);
  if (job.id == running_) {
    stopping_ = true;
    child_->stop();
  } else if (!has_ended(job)) {
    job.state = "stopped";
    keep(job);
  }
}

void JobBoard::begin(PageJob& job) {
  job.state = "running";
  running_ = job.id;
  stopping_ = false;
  begun_ = Clock::now();
  try {
    if (job.kind == "view" || job.kind == "place" || job.kind == "plan")
      fs::create_directories(results_of(job.id));
    std::vector<std::string> words = job.words;
    words.insert(words.end(), common_words_.begin(), common_words_.end());
    child_ = std::make_unique<Child>(words, folder_);
  } catch (const std::exception& fault) {
    job.said = fault.what();
    end_running(kExitInternal);
  }
}

void JobBoard::end_running(int status) {
  PageJob& job = find(running_);
  if (child_) job.said = child_->said();
  child_.reset();
  running_ = 0;
  job.status = status;
  job.state = state_of(status, stopping_);
  job.seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
  job.outputs = served_files(results_of(job.id));
  keep(job);
}

void JobBoard::keep(const PageJob& job) const {
  try {
    fs::create_directories(folder_ / "results");
    write_file(results_of(job.id).string() + ".json", to_text(kept_json(job)));
  } catch (const std::exception&) {
    return;  // a full disk is reported by the work itself
  }
}

void JobBoard::tick() {
  if (child_) {
    child_->listen();
    if (const std::optional<int> status = child_->ended()) end_running(*status);
  }
  if (running_ != 0) return;
  const auto next =
      std::find_if(jobs_.begin(), jobs_.end(), [](const PageJob& job) { return job.state == "queued"; });
  if (next != jobs_.end()) begin(*next);
}

void JobBoard::finish() {
  for (PageJob& job : jobs_) {
    if (job.state == "queued") stop(job.id);
  }
  if (!child_) return;
  stop(running_);
  const auto begun = Clock::now();
  while (!child_->ended() && Clock::now() - begun < kGrace) {
    child_->listen();
    std::this_thread::sleep_for(kGraceTick);
  }
  end_running(child_->ended().value_or(128 + 9));
}

std::vector<int> JobBoard::ears() const {
  return child_ ? child_->ears() : std::vector<int>();
}

Json JobBoard::as_json() const {
  Json list = Json::array();
  for (const PageJob& job : jobs_) {
    Json json = kept_json(job);
    json["outputs"] = served_files_json(job.outputs);
    if (job.id == running_ && child_) {
      json["said"] = printable_lines(child_->said());
      json["stage"] = printable(child_->stage());
      json["share"] = child_->share() < 0.0 ? Json() : Json(child_->share());
      json["seconds"] = std::chrono::duration<double>(Clock::now() - begun_).count();
    }
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace limen
