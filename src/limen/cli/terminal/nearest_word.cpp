// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/nearest_word.h"

#include <algorithm>

namespace limen {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table of distances between the beginnings of both words.
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t kLeastBeginning = 3;
  std::string best;
  std::size_t least = 0;
  for (const std::string& one : known) {
    const bool begun = word.size() >= kLeastBeginning && one.starts_with(word);
    const std::size_t distance = begun ? 1 : edit_distance(word, one);
    const std::size_t bearable = std::max<std::size_t>(1, one.size() / 3);
    if (distance > bearable || (!best.empty() && distance >= least)) continue;
    best = one;
    least = distance;
  }
  return best;
}

}  // namespace limen
