// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/answer_places.h"

#include <algorithm>
#include <numeric>

namespace limen {

AnswerPlaces answer_places(const RegistrationResult& result) {
  constexpr double kShare = 0.95;
  const std::size_t count = result.alternatives.size();
  AnswerPlaces places;
  places.alternatives.resize(count);
  std::iota(places.alternatives.begin(), places.alternatives.end(), std::size_t{0});
  if (!result.others || !result.best.probability) return places;
  const auto probability = [&](std::size_t k) {
    return k < count ? result.alternatives[k].probability.value_or(0.0) : result.others->twin;
  };
  std::vector<std::size_t> order(count + 1);  // the last is the place that no pose is listed of
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probability(a) > probability(b); });
  places.alternatives.clear();
  double reached = *result.best.probability;
  for (const std::size_t k : order) {
    if (reached >= kShare * (1.0 - result.others->nothing_shared) || probability(k) <= 0.0) break;
    reached += probability(k);
    if (k == count)
      places.look_alike = true;
    else
      places.alternatives.push_back(k);
  }
  std::sort(places.alternatives.begin(), places.alternatives.end());
  return places;
}

}  // namespace limen
