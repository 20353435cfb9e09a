// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/inputs/project_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/bim/read_bim.h"
#include "limen/files/file_hash.h"
#include "limen/files/mapped_file.h"
#include "limen/files/scan_in_file.h"

namespace limen {
namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The number that begins at `at`, without leading zeros.
std::string number_at(const std::string& text, std::size_t& at) {
  while (at < text.size() && text[at] == '0') ++at;
  std::string digits;
  while (at < text.size() && is_digit(text[at])) digits += text[at++];
  return digits;
}

void take_hash(ProjectFile& file) {
  const ScanInFile named = scan_in_file(file.path);
  file.fault = why_unreadable(named.file);
  if (!file.fault.empty()) return;
  try {
    if (named.index) file.scan = static_cast<int>(*named.index);
    file.sha256 = sha256_of_file(named.file);
    file.model = file.model || is_bim_file(file.path);
  } catch (const Error& error) {
    if (error.fault() == Fault::cancelled) throw;
    file.fault = error.problem();
  }
}

/// Files of equal bytes are copies. One scan of a file that is there as a whole is there already.
void mark_copies(ProjectFiles& list) {
  std::map<std::tuple<std::string, bool, int>, std::string> first;
  for (const ProjectFile& file : list.files)
    if (!file.sha256.empty() && file.scan < 0)
      first.emplace(std::tuple(file.sha256, file.model, -1), file.path);
  std::vector<ProjectFile> kept;
  for (ProjectFile& file : list.files) {
    const auto whole = file.scan < 0 ? first.end() : first.find({file.sha256, file.model, -1});
    if (whole != first.end()) {
      list.notes.push_back(
          fmt::format("{} is one scan of {}, which is given too; it counts once", file.path, whole->second));
      continue;
    }
    if (!file.sha256.empty()) {
      const auto known = first.emplace(std::tuple(file.sha256, file.model, file.scan), file.path).first;
      if (known->second != file.path) {
        file.copy_of = known->second;
        list.notes.push_back(
            fmt::format("{} is identical to {} and treated as its copy", file.path, file.copy_of));
      }
    }
    kept.push_back(std::move(file));
  }
  list.files = std::move(kept);
}

}  // namespace

std::string ProjectFiles::full_name(const std::string& name) const {
  const ScanInFile meant = split_scan_name(name);
  std::set<std::string> found;
  for (const ProjectFile& file : files) {
    if (file.path == name) return name;
    const std::string whole = split_scan_name(file.path).file;
    if (whole == meant.file || std::filesystem::path(whole).filename() == meant.file) found.insert(whole);
  }
  if (found.count(meant.file) == 0 && found.size() != 1) return name;
  const std::string& file = found.count(meant.file) > 0 ? meant.file : *found.begin();
  return meant.index ? fmt::format("{} #{}", file, *meant.index) : file;
}

bool lists_files(const std::string& path) {
  constexpr std::streamsize kLongest = 4096;
  if (!why_unreadable(path).empty()) return false;
  std::ifstream stream(path);
  std::string line;
  line.resize(kLongest);
  while (stream.getline(line.data(), kLongest)) {
    const std::string_view name = trimmed(without_byte_order_mark(line.c_str()));
    if (name.empty() || name.front() == '#') continue;
    std::error_code ignored;
    return std::filesystem::is_regular_file(std::filesystem::path(path).parent_path() / name, ignored);
  }
  return false;
}

bool comes_before(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string x = number_at(a, i);
      const std::string y = number_at(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if ((i < a.size()) != (j < b.size())) return j < b.size();
  return a < b;
}

ProjectFiles list_files(const ProjectInputs& inputs, Monitor& monitor) {
  ProjectFiles list;
  std::set<std::filesystem::path> known;
  const auto add = [&](const std::string& path, bool model) {
    std::error_code ignored;
    const std::filesystem::path real = std::filesystem::weakly_canonical(path, ignored);
    if (known.insert(real).second) {
      list.files.push_back({path, model, {}, {}, {}, -1});
    } else {
      list.notes.push_back(fmt::format("{} was given more than once; it counts once", path));
    }
  };
  // By name first, so that of two ways to write one path the same is kept in any order.
  std::vector<std::string> scans = inputs.scans;
  std::vector<std::string> models = inputs.models;
  std::sort(scans.begin(), scans.end(), comes_before);
  std::sort(models.begin(), models.end(), comes_before);
  for (const std::string& model : models) add(model, true);
  for (const std::string& scan : scans) add(scan, false);
  monitor.begin_stage("files");
  StageShares progress(monitor, list.files.size());
  parallel_for(list.files.size(), 1, [&](std::size_t k, std::size_t /*end*/) {
    monitor.throw_if_cancelled();
    take_hash(list.files[k]);
    progress.worker(k).advance(1.0, 1.0);
  });
  mark_copies(list);
  return list;
}

}  // namespace limen
