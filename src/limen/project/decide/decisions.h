// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limen/project/decide/start_points.h"

namespace limen {

/// What a user says of scans.
enum class DecisionKind {
  accept,      ///< the two scans stand to one another as their link's best pose says
  reject,      ///< the link of the two is wrong
  choose,      ///< of the link's poses this one is right
  level,       ///< the scan is level
  same_floor,  ///< the floors under the two are at one height
  start,       ///< these points of the first are those of the second
  forget       ///< what was said of the two, or the one, is taken back
};
const char* to_string(DecisionKind kind);

struct Decision {
  DecisionKind kind = DecisionKind::accept;
  std::vector<std::string> scans;       ///< one (level) or two
  int pose = 0;                         ///< of choose: its number, as project.json tells it
  std::vector<ShownPoint> points = {};  ///< of start: in the first scan, and in the second
};

/// A decision in a few words, as a shell gives them to `limen project decide DIR`: 'all.e57 #0' is one.
std::string words_of(const Decision& decision);

/// The command that takes it, for a shell.
std::string decide_line(const std::string& folder, const Decision& decision);

/// From words: accept A B, reject A B, choose A B N, level A, same-floor A B, start A B POINT POINT
/// POINT ... (shown_point()), forget A [B]. Throws Error.
Decision decision_from(const std::vector<std::string>& words);

/// {"decisions": [{"accept": ["A", "B"]}, {"choose": ["A", "B"], "pose": 2}, {"level": ["A"]},
/// {"start": ["A", "B"], "points": [[x, y, z, x, y, z], ...]}, ...]}. Throws Error that names the file and
/// what is wrong in it.
std::vector<Decision> read_decisions(const std::filesystem::path& path);
std::string decisions_text(const std::vector<Decision>& decisions);

/// The same with its scans in order of their names: of a pair it does not matter who is named first.
Decision in_order(Decision decision);

/// The later word counts, but a start stays where a pose of its link is accepted or chosen: what was said of
/// the link of the same two scans, or of the same scan's level or the same two floors, is replaced; `forget`
/// takes back all that was said of just these scans. Sorted.
std::vector<Decision> merged(std::vector<Decision> decisions, const std::vector<Decision>& later);

}  // namespace limen
