// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// The comparison of methods as text: one row per level and method.
#pragma once

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "method_cases.h"
#include <fmt/format.h>

namespace limen::methods {

inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

/// Counts and quantiles of the rows of one level and one method.
struct Summary {
  std::size_t pairs = 0;
  std::size_t right = 0;
  std::size_t wrong = 0;
  std::size_t probable = 0;
  std::size_t ambiguous = 0;
  std::size_t ambiguous_listed = 0;  ///< with the true pose among those listed
  std::size_t under_constrained = 0;
  std::size_t no_match = 0;
  std::size_t freedoms = 0;  ///< of registered poses
  std::size_t freedoms_in_two_sigma = 0;
  std::vector<double> translations_m;  ///< of right poses
  std::vector<double> rotations_deg;
  std::vector<double> thickness_errors_m;  ///< of right poses that know the thickness to 5 cm
  std::size_t thicknesses_in_two_sigma = 0;
  std::vector<double> seconds;
};

inline Summary summary_of(const std::vector<Row>& rows) {
  Summary sum;
  for (const Row& row : rows) {
    ++sum.pairs;
    sum.right += row.right() ? 1U : 0U;
    sum.wrong += row.wrong() ? 1U : 0U;
    sum.probable += row.outcome == Outcome::probable ? 1U : 0U;
    sum.ambiguous += row.outcome == Outcome::ambiguous ? 1U : 0U;
    sum.ambiguous_listed += row.outcome == Outcome::ambiguous && row.listed ? 1U : 0U;
    sum.under_constrained += row.outcome == Outcome::under_constrained ? 1U : 0U;
    sum.no_match += row.outcome == Outcome::no_match ? 1U : 0U;
    sum.seconds.push_back(row.seconds);
    if (!row.registered()) continue;
    for (const double error : row.sigmas) {
      ++sum.freedoms;
      sum.freedoms_in_two_sigma += std::abs(error) <= 2.0 ? 1U : 0U;
    }
    if (!row.near) continue;
    sum.translations_m.push_back(row.translation_m);
    sum.rotations_deg.push_back(row.rotation_deg);
    if (!(row.thickness_sigma_m < 0.05)) continue;
    sum.thickness_errors_m.push_back(std::abs(row.thickness_error_m));
    sum.thicknesses_in_two_sigma += std::abs(row.thickness_error_m) <= 2.0 * row.thickness_sigma_m ? 1U : 0U;
  }
  return sum;
}

inline std::vector<Row> rows_of(const std::vector<Row>& rows, const std::string& level,
                                const std::string& method) {
  std::vector<Row> kept;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(kept),
               [&](const Row& row) { return row.level == level && row.method == method; });
  return kept;
}

inline std::string share_text(std::size_t part, std::size_t whole) {
  if (whole == 0) return "";
  return fmt::format("{:.0f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

inline std::string median_text(const std::vector<double>& values, double unit, const char* suffix) {
  return values.empty() ? "" : fmt::format("{:.2f} {}", quantile(values, 0.5) / unit, suffix);
}

inline std::string table_row(const Level& level, const std::string& method, const Summary& s) {
  return fmt::format(
      "| {} | {} | {} of {} | {} | {} | {} ({}) | {} | {} | {} | {} | {} | {} | {} | {} |\n", level.name,
      method, s.right, s.pairs, s.wrong, s.probable, s.ambiguous, s.ambiguous_listed, s.under_constrained,
      s.no_match, median_text(s.translations_m, 1e-3, "mm"), median_text(s.rotations_deg, 1.0, "°"),
      share_text(s.freedoms_in_two_sigma, s.freedoms), median_text(s.thickness_errors_m, 1e-3, "mm"),
      share_text(s.thicknesses_in_two_sigma, s.thickness_errors_m.size()), median_text(s.seconds, 1.0, "s"));
}

/// The markdown table, level by level, methods in the order they were run.
inline std::string table(const std::vector<Row>& rows, const std::vector<std::string>& methods) {
  std::string text =
      "| level | method | right | wrong | probable | ambiguous (true pose listed) | "
      "under-constrained "
      "| no match | median shift | median turn | freedoms within 2 sigma | thickness error "
      "| thickness within 2 sigma | time |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Level& level : all_levels()) {
    for (const std::string& method : methods) {
      const std::vector<Row> kept = rows_of(rows, level.name, method);
      if (!kept.empty()) text += table_row(level, method, summary_of(kept));
    }
  }
  return text;
}

/// Right poses by kind of building: where a method falls short.
inline std::string table_by_kind(const std::vector<Row>& rows, const std::vector<std::string>& methods) {
  std::set<std::string> kinds;
  for (const Row& row : rows) kinds.insert(row.kind);
  std::string text = "| level | method |";
  for (const std::string& kind : kinds) text += " " + kind + " |";
  text += "\n|---|---|";
  for (std::size_t i = 0; i < kinds.size(); ++i) text += "---|";
  text += "\n";
  for (const Level& level : all_levels()) {
    for (const std::string& method : methods) {
      const std::vector<Row> kept = rows_of(rows, level.name, method);
      if (kept.empty()) continue;
      text += fmt::format("| {} | {} |", level.name, method);
      for (const std::string& kind : kinds) {
        const auto of_kind = [&](const Row& row) { return row.kind == kind; };
        const auto pairs = std::count_if(kept.begin(), kept.end(), of_kind);
        const auto right = std::count_if(kept.begin(), kept.end(),
                                         [&](const Row& row) { return of_kind(row) && row.right(); });
        text += pairs == 0 ? " |" : fmt::format(" {} of {} |", right, pairs);
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace limen::methods
