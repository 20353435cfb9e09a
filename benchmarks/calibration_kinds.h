// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Which buildings a judge may be fitted to, which serve to choose between judges, and which are kept to judge
// by. The three are apart by kind of building, not by seed alone: nothing may be fitted or chosen on the
// third list. scripts/fit_posterior fits on all kinds at once and judges by sets that it leaves out.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace limen::calibration {

enum class Purpose { fitting, choosing, judging };

struct Kind {
  const char* building;  ///< of whole_building_names()
  Purpose purpose;
};

inline constexpr std::array<Kind, 6> kKinds = {{{"office_floor", Purpose::fitting},
                                                {"flats", Purpose::fitting},
                                                {"equal_bays", Purpose::choosing},
                                                {"hotel", Purpose::judging},
                                                {"terrace", Purpose::judging},
                                                {"museum", Purpose::judging}}};

inline const char* to_string(Purpose purpose) {
  return purpose == Purpose::fitting ? "fitting" : purpose == Purpose::choosing ? "choosing" : "judging";
}

/// The kinds of one purpose ("fitting", "choosing", "judging"), or all.
inline std::vector<Kind> kinds_for(const std::string& purpose) {
  std::vector<Kind> kinds;
  for (const Kind& kind : kKinds)
    if (purpose == "all" || purpose == to_string(kind.purpose)) kinds.push_back(kind);
  return kinds;
}

}  // namespace limen::calibration
