// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/project_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/bim/read_bim.h"
#include "limen/files/file_hash.h"
#include "limen/files/readable.h"

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
  file.fault = why_unreadable(file.path);
  if (!file.fault.empty()) return;
  try {
    file.sha256 = sha256_of_file(file.path);
    file.model = file.model || is_bim_file(file.path);
  } catch (const Error& error) {
    if (error.fault() == Fault::cancelled) throw;
    file.fault = error.problem();
  }
}

}  // namespace

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
      list.files.push_back({path, model, {}, {}, {}});
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
  for (std::size_t k = 0; k < list.files.size(); ++k) {
    monitor.throw_if_cancelled();
    take_hash(list.files[k]);
    monitor.advance(static_cast<double>(k + 1), static_cast<double>(list.files.size()));
  }
  std::map<std::pair<std::string, bool>, std::string> first;
  for (ProjectFile& file : list.files) {
    if (file.sha256.empty()) continue;
    const auto [known_file, fresh] = first.emplace(std::pair(file.sha256, file.model), file.path);
    if (!fresh) file.copy_of = known_file->second;
  }
  return list;
}

}  // namespace limen
