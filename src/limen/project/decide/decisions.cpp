// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/decide/decisions.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limen/base/error.h"
#include "limen/base/named.h"
#include "limen/base/text.h"
#include "limen/files/bounded_json.h"
#include "limen/files/mapped_file.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

using Json = nlohmann::ordered_json;

constexpr Named<DecisionKind> kKinds[] = {
    {DecisionKind::accept, "accept"},         {DecisionKind::reject, "reject"},
    {DecisionKind::choose, "choose"},         {DecisionKind::level, "level"},
    {DecisionKind::same_floor, "same-floor"}, {DecisionKind::start, "start"},
    {DecisionKind::forget, "forget"}};
constexpr int kLastPose = 1000;  // no pair has so many
constexpr const char* kDecisionsRemedy =
    "write accept A B, reject A B, choose A B N, level A, same-floor A B, start A B POINTS or forget A B";

bool counts_fit(const Decision& decision) {
  const std::size_t scans = decision.scans.size();
  if (decision.kind == DecisionKind::level) return scans == 1;
  if (decision.kind == DecisionKind::forget) return scans == 1 || scans == 2;
  return scans == 2 && decision.scans[0] != decision.scans[1];
}

bool is_of_link(DecisionKind kind) {
  return kind == DecisionKind::accept || kind == DecisionKind::reject || kind == DecisionKind::choose;
}

bool same_scans(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return a.size() == b.size() && std::is_permutation(a.begin(), a.end(), b.begin());
}

bool replaces(const Decision& later, const Decision& earlier) {
  if (!same_scans(later.scans, earlier.scans)) return false;
  if (earlier.kind == DecisionKind::start && later.kind == DecisionKind::reject) return true;
  if (later.kind == DecisionKind::start && is_of_link(earlier.kind)) return true;
  return later.kind == DecisionKind::forget || later.kind == earlier.kind ||
         (is_of_link(later.kind) && is_of_link(earlier.kind));
}

Decision from_json(const Json& json, const std::string& where) {
  for (const auto& [name, value] : json.items()) {
    const std::optional<DecisionKind> kind = value_called(kKinds, name);
    if (!kind) continue;
    const auto pose = json.value("pose", std::int64_t{0});
    Decision decision{*kind, value.get<std::vector<std::string>>(),
                      pose < 0 || pose > kLastPose ? -1 : static_cast<int>(pose)};
    const bool numbered =
        *kind != DecisionKind::choose || (json.contains("pose") && json.at("pose").is_number_integer());
    if (!counts_fit(decision) || decision.pose < 0 || !numbered)
      throw Error(fmt::format("\"{}\" has the wrong number of scans, or no pose", name), where,
                  "name two scans, for level one; choose needs \"pose\" too");
    if (*kind == DecisionKind::start) {
      decision.points = json.at("points").get<std::vector<ShownPoint>>();
      static_cast<void>(start_from_points(decision.points));
    }
    return in_order(std::move(decision));
  }
  throw Error("a decision is none of accept, reject, choose, level, same-floor, start, forget", where,
              R"(write {"decisions": [{"accept": ["A", "B"]}]})");
}

}  // namespace

const char* to_string(DecisionKind kind) {
  return name_of(kKinds, kind);
}

std::string words_of(const Decision& decision) {
  std::string text = to_string(decision.kind);
  for (const std::string& scan : decision.scans) text += " " + shell_word(scan);
  if (decision.kind == DecisionKind::choose) text += fmt::format(" {}", decision.pose);
  for (const ShownPoint& point : decision.points) text += " " + words_of(point);
  return text;
}

std::string decide_line(const std::string& folder, const Decision& decision) {
  return fmt::format("limen project decide {} {}", shell_word(folder), words_of(decision));
}

Decision decision_from(const std::vector<std::string>& words) {
  const std::optional<DecisionKind> kind = words.empty() ? std::nullopt : value_called(kKinds, words.front());
  if (!kind) throw Error("no decision is given", "project decide", kDecisionsRemedy);
  Decision decision{*kind, {words.begin() + 1, words.end()}, 0};
  if (*kind == DecisionKind::choose && !decision.scans.empty()) {
    const std::optional<std::size_t> number = parse_count(decision.scans.back());
    if (!number || *number > std::size_t{kLastPose})
      throw Error(fmt::format("\"{}\" is not the number of a pose", decision.scans.back()), "project decide",
                  kDecisionsRemedy);
    decision.pose = static_cast<int>(*number);
    decision.scans.pop_back();
  }
  if (*kind == DecisionKind::start && decision.scans.size() > 2) {
    for (std::size_t k = 2; k < decision.scans.size(); ++k)
      decision.points.push_back(shown_point(decision.scans[k]));
    decision.scans.resize(2);
  }
  if (*kind == DecisionKind::start) static_cast<void>(start_from_points(decision.points));
  if (!counts_fit(decision))
    throw Error(fmt::format("\"{}\" has the wrong number of scans", words.front()), "project decide",
                kDecisionsRemedy);
  return in_order(std::move(decision));
}

std::vector<Decision> read_decisions(const std::filesystem::path& path) {
  require_readable(path, "check the name");
  std::ifstream stream(path);
  const Json json = json_or_nothing<Json>(stream);
  if (!json.is_object() || !json.contains("decisions") || !json["decisions"].is_array())
    throw Error("is not a file of decisions", path.string(),
                R"(write {"decisions": [{"accept": ["A", "B"]}]})");
  std::vector<Decision> decisions;
  int number = 0;
  for (const Json& entry : json["decisions"]) {
    const std::string where = fmt::format("{}, decision {}", path.string(), ++number);
    try {
      if (!entry.is_object()) throw Error("is not a decision", where, R"(write {"accept": ["A", "B"]})");
      decisions.push_back(from_json(entry, where));
    } catch (const Json::exception&) {
      throw Error("a decision does not name scans, or its pose is not a number", where,
                  R"(write {"choose": ["A", "B"], "pose": 2})");
    }
  }
  return decisions;
}

std::string decisions_text(const std::vector<Decision>& decisions) {
  std::string text = "{\"decisions\": [";
  for (std::size_t k = 0; k < decisions.size(); ++k) {
    Json json = {{to_string(decisions[k].kind), decisions[k].scans}};
    if (decisions[k].kind == DecisionKind::choose) json["pose"] = decisions[k].pose;
    if (!decisions[k].points.empty()) json["points"] = decisions[k].points;
    text += (k == 0 ? "\n  " : ",\n  ") + json.dump();
  }
  return text + "\n]}\n";
}

Decision in_order(Decision decision) {
  if (std::is_sorted(decision.scans.begin(), decision.scans.end())) return decision;
  std::reverse(decision.scans.begin(), decision.scans.end());
  for (ShownPoint& point : decision.points) std::rotate(point.begin(), point.begin() + 3, point.end());
  return decision;
}

std::vector<Decision> merged(std::vector<Decision> decisions, const std::vector<Decision>& later) {
  for (const Decision& word : later) {
    decisions.erase(std::remove_if(decisions.begin(), decisions.end(),
                                   [&](const Decision& earlier) { return replaces(word, earlier); }),
                    decisions.end());
    if (word.kind != DecisionKind::forget) decisions.push_back(word);
  }
  std::sort(decisions.begin(), decisions.end(), [](const Decision& a, const Decision& b) {
    return std::pair(a.scans, a.kind) < std::pair(b.scans, b.kind);
  });
  return decisions;
}

}  // namespace limen
