// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/job_request.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/length_unit.h"
#include "limen/base/text.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/serve/gate.h"
#include "limen/cli/serve/http_request.h"
#include "limen/files/bounded_json.h"
#include "limen/project/decide/start_points.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 1000;
constexpr int kMostAlternative = 1000;

/// What was asked, and where it is looked up.
struct Asked {
  const Json& json;
  const fs::path& folder;
  const JobBoard& board;
  int id = 0;  ///< of the job that is asked for

  [[nodiscard]] std::string text(const char* key) const {
    const auto found = json.find(key);
    if (found == json.end() || found->is_null()) return {};
    if (!found->is_string()) throw HttpFault(400, fmt::format("{} is not text", key));
    return found->get<std::string>();
  }

  [[nodiscard]] int number(const char* key) const {
    const auto found = json.find(key);
    if (found == json.end() || found->is_null()) return 0;
    if (!found->is_number_integer()) throw HttpFault(400, fmt::format("{} is not a number", key));
    const auto value = found->get<std::int64_t>();
    if (value < 0 || value > 1'000'000'000) throw HttpFault(400, fmt::format("{} is out of bounds", key));
    return static_cast<int>(value);
  }

  [[nodiscard]] bool flag(const char* key) const {
    const auto found = json.find(key);
    if (found == json.end() || found->is_null()) return false;
    if (!found->is_boolean()) throw HttpFault(400, fmt::format("{} is neither true nor false", key));
    return found->get<bool>();
  }

  /// "files/NAME" of a file that is there.
  [[nodiscard]] std::string file(const std::string& name) const {
    std::error_code gone;
    if (!is_safe_name(name) || !fs::is_regular_file(fs::symlink_status(folder / "files" / name, gone)))
      throw HttpFault(400, name.empty() ? "choose a file" : "there is no such file: upload it first");
    return "files/" + name;
  }

  [[nodiscard]] std::string file_at(const char* key) const { return file(text(key)); }

  [[nodiscard]] std::vector<std::string> files() const {
    const auto found = json.find("files");
    if (found == json.end() || !found->is_array() || found->empty() || found->size() > kMostFiles)
      throw HttpFault(400, "choose some files");
    std::vector<std::string> paths;
    for (const Json& name : *found) {
      if (!name.is_string()) throw HttpFault(400, "the name of a file is not text");
      paths.push_back(file(name.get<std::string>()));
    }
    return paths;
  }

  /// A job that has ended and whose results are asked for.
  [[nodiscard]] const PageJob& of(const char* kind) const {
    const PageJob& job = board.job(number("of"));
    if (job.kind != kind || job.state != "done")
      throw HttpFault(409, fmt::format("there is no such {} job that ended without an error", kind));
    return job;
  }

  /// The folder of results of a job, to write into. A link in it could lead out of the folder.
  [[nodiscard]] std::string results(int of) const {
    const std::string name = fmt::format("results/{}", of);
    std::error_code stop;
    bool link = fs::is_symlink(folder / name, stop);
    fs::recursive_directory_iterator entry(folder / name, stop);
    for (; !link && !stop && entry != fs::recursive_directory_iterator(); entry.increment(stop))
      link = entry->is_symlink(stop);
    if (link) throw HttpFault(409, fmt::format("{} holds a link: work writes into plain folders only", name));
    return name;
  }
  [[nodiscard]] std::string results() const { return results(id); }
};

std::string last_name(const std::string& path) {
  return fs::path(path).filename().string();
}

void add_units(const Asked& asked, const char* key, const char* option, std::vector<std::string>& words) {
  const std::string unit = asked.text(key);
  if (unit.empty()) return;
  if (!length_unit(unit)) throw HttpFault(400, "that is not a unit of length");
  words.insert(words.end(), {option, unit});
}

/// What the user knows of the building.
void add_repeats(const Asked& asked, std::vector<std::string>& words) {
  if (asked.flag("no_repeats")) words.insert(words.end(), {"--repeats", "none"});
}

/// A size of targets in tenths of a millimetre.
void add_target_size(const Asked& asked, const char* key, const char* option,
                     std::vector<std::string>& words) {
  constexpr int kLeast = 200;
  constexpr int kMost = 10000;
  const int size = asked.number(key);
  if (size == 0) return;
  if (size < kLeast || size > kMost) throw HttpFault(400, "targets have 20 mm to 1 m");
  words.insert(words.end(), {option, fmt::format("{}.{}mm", size / 10, size % 10)});
}

PageJob registering(const Asked& asked) {
  PageJob job;
  const std::string source = asked.file_at("source");
  const std::string target = asked.file_at("target");
  if (source == target) throw HttpFault(400, "choose two different files");
  job.words = {"register", source, target, "-o", asked.results()};
  add_units(asked, "source_units", "--source-units", job.words);
  add_units(asked, "target_units", "--target-units", job.words);
  add_repeats(asked, job.words);
  if (asked.flag("pdf")) job.words.emplace_back("--pdf");
  job.title = fmt::format("{} into {}", last_name(source), last_name(target));
  return job;
}

PageJob whole_project(const Asked& asked) {
  PageJob job;
  const std::vector<std::string> files = asked.files();
  job.words = {"project"};
  job.words.insert(job.words.end(), files.begin(), files.end());
  job.words.insert(job.words.end(), {"-o", asked.results()});
  for (const char* table : {"control", "poses"}) {
    if (!asked.text(table).empty())
      job.words.insert(job.words.end(), {std::string("--") + table, asked.file_at(table)});
  }
  add_target_size(asked, "sphere", "--sphere-radius", job.words);
  add_target_size(asked, "board", "--board-side", job.words);
  add_repeats(asked, job.words);
  if (asked.flag("pdf")) job.words.emplace_back("--pdf");
  job.title = listed(files, 3, last_name);
  return job;
}

/// Of a registration: its result; of a project: its project.json.
std::string result_of(const PageJob& job) {
  return fmt::format("results/{}/{}", job.id, job.kind == "project" ? "project.json" : "result.json");
}

const PageJob& registration_or_project(const Asked& asked) {
  const std::string& kind = asked.board.job(asked.number("of")).kind;
  return asked.of(kind == "project" || kind == "link" ? kind.c_str() : "register");
}

/// "--alternative N" where one is meant.
std::string add_alternative(const Asked& asked, const PageJob& of, std::vector<std::string>& words) {
  const int alternative = asked.number("alternative");
  if (alternative == 0) return of.title;
  if (of.kind == "project" || alternative > kMostAlternative)
    throw HttpFault(400, "there is no such alternative");
  words.insert(words.end(), {"--alternative", std::to_string(alternative)});
  return fmt::format("{}, alternative {}", of.title, alternative);
}

PageJob viewing(const Asked& asked) {
  PageJob job;
  job.words = {"view"};
  if (asked.json.contains("of")) {
    const PageJob& of = registration_or_project(asked);
    job.words.push_back(result_of(of));
    job.title = add_alternative(asked, of, job.words);
  } else {
    const std::vector<std::string> files = asked.files();
    job.words.insert(job.words.end(), files.begin(), files.end());
    job.title = listed(files, 3, last_name);
  }
  job.words.insert(job.words.end(), {"-o", asked.results() + "/view.html"});
  return job;
}

/// The files of a registration: the scan that is moved is its source, but the target where that is a model.
struct PairFiles {
  std::string scan;
  std::string other;
  bool inverse = false;  ///< the scan is the target
};

PairFiles files_of_pair(const Asked& asked, const PageJob& of) {
  const Asked pair{of.asked, asked.folder, asked.board};
  PairFiles files{pair.file_at("source"), pair.file_at("target")};
  files.inverse = is_bim_file(asked.folder / files.scan);
  if (files.inverse) std::swap(files.scan, files.other);
  return files;
}

PageJob placing(const Asked& asked) {
  PageJob job;
  const PageJob& of = registration_or_project(asked);
  if (of.kind == "project") {
    job.words = {"transform", result_of(of), "-o", asked.results()};
    job.title = of.title;
    return job;
  }
  const PairFiles files = files_of_pair(asked, of);
  const fs::path name = last_name(files.scan);
  job.words = {
      "transform", result_of(of), files.scan,
      fmt::format("{}/{}_placed{}", asked.results(), name.stem().string(), name.extension().string())};
  if (files.inverse) job.words.emplace_back("--invert");
  job.title = add_alternative(asked, of, job.words);
  return job;
}

/// A scan, or all of a project, against the model in which they were registered.
PageJob comparing(const Asked& asked) {
  PageJob job;
  const PageJob& of = registration_or_project(asked);
  job.words = {"deviation"};
  if (of.kind == "project") {
    job.words.push_back(result_of(of));
    if (asked.flag("pdf")) job.words.emplace_back("--pdf");
  } else {
    const PairFiles files = files_of_pair(asked, of);
    job.words.insert(job.words.end(), {files.scan, files.other, "--result", result_of(of)});
    if (files.inverse) job.words.emplace_back("--inverse");
  }
  job.words.insert(job.words.end(), {"-o", asked.results()});
  job.title = of.title;
  return job;
}

Json read_json(const fs::path& path) {
  std::error_code gone;
  if (!fs::is_regular_file(fs::symlink_status(path, gone))) return {};
  std::ifstream stream(path);
  return json_or_nothing<Json>(stream);
}

/// Places that were shown in both scans, as a command line gives them.
std::vector<std::string> shown_points(const Asked& asked) {
  try {
    const auto points = asked.json.value("points", std::vector<ShownPoint>());
    static_cast<void>(start_from_points(points));
    std::vector<std::string> words;
    for (const ShownPoint& point : points) words.push_back(words_of(point));
    return words;
  } catch (const Json::exception&) {
    throw HttpFault(400, "the points are not six numbers each");
  } catch (const Error& error) {
    throw HttpFault(400, fmt::format("{}: {}", error.problem(), error.remedy()));
  }
}

PageJob planning(const Asked& asked) {
  PageJob job;
  const std::string scan = asked.file_at("scan");
  job.words = {"thin", scan, asked.results() + "/plan.ply", "--points", "200000"};
  job.title = last_name(scan);
  return job;
}

PageJob linking(const Asked& asked) {
  PageJob job = registering(asked);
  for (const std::string& point : shown_points(asked))
    job.words.insert(job.words.end(), {"--start-points", point});
  return job;
}

/// The words of `limen project decide DIR` that keep a link.
PageJob keeping(const Asked& asked, const PageJob& of) {
  const PageJob& link = asked.board.job(asked.number("link"));
  if (link.kind != "link") throw HttpFault(409, "there is no such link");
  const Asked linked{link.asked, asked.folder, asked.board, link.id};
  PageJob job;
  job.words = {
      "project", "decide", asked.results(of.id), "start", linked.file_at("source"), linked.file_at("target")};
  for (std::string& point : shown_points(linked)) job.words.push_back(std::move(point));
  job.title = fmt::format("start {} {}", job.words[4], job.words[5]);
  return job;
}

PageJob deciding(const Asked& asked) {
  PageJob job;
  const PageJob& of = asked.of("project");
  if (asked.json.contains("link")) return keeping(asked, of);
  const std::string answer = asked.text("answer");
  const Json project = read_json(asked.folder / result_of(of));
  bool offered = false;
  for (const Json& question :
       project.is_object() ? project.value("questions", Json::array()) : Json::array()) {
    const Json answers = question.is_object() ? question.value("answers", Json::array()) : Json::array();
    offered = offered || std::find(answers.begin(), answers.end(), Json(answer)) != answers.end();
  }
  if (!offered) throw HttpFault(400, "none of the project's questions has this answer");
  const std::vector<std::string> words = shell_words(answer);
  if (std::any_of(words.begin(), words.end(), [](const std::string& word) { return word.starts_with('-'); }))
    throw HttpFault(400, "that is not an answer");
  job.words = {"project", "decide", asked.results(of.id)};
  job.words.insert(job.words.end(), words.begin(), words.end());
  job.title = answer;
  return job;
}

}  // namespace

PageJob job_from_request(const Json& json, const fs::path& folder, const JobBoard& board, int id) {
  if (!json.is_object()) throw HttpFault(400, "the job is not given as JSON");
  const Asked asked{json, folder, board, id};
  const std::string kind = asked.text("kind");
  constexpr std::pair<const char*, PageJob (*)(const Asked&)> kKinds[] = {
      {"register", registering}, {"project", whole_project}, {"view", viewing}, {"place", placing},
      {"decide", deciding},      {"plan", planning},         {"link", linking}, {"deviation", comparing}};
  for (const auto& [name, make] : kKinds) {
    if (kind != name) continue;
    PageJob job = make(asked);
    job.kind = kind;
    job.asked = json;
    return job;
  }
  throw HttpFault(400, "this kind of job is not known");
}

}  // namespace limen
