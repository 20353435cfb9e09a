// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/twins_across.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limen {

TwinsAcross twins_across(const SharedViews& views, const TwinKind& kind, std::vector<TwinVoice> voices,
                         const std::vector<bool>& side) {
  TwinsAcross all;
  std::stable_sort(voices.begin(), voices.end(), [&](const TwinVoice& a, const TwinVoice& b) {
    return std::abs(a.said.*kind.nats) > std::abs(b.said.*kind.nats);
  });
  std::vector<SaidByPair> said;
  said.reserve(voices.size());
  for (const TwinVoice& voice : voices) said.push_back({voice.pair, voice.said.*kind.nats});
  all.fresh = views.fresh_shares(said, side);
  double most_shown_m2 = -1.0;
  for (std::size_t i = 0; i < voices.size(); ++i) {
    all.nats += all.fresh[i] * said[i].nats;
    all.held_nats += all.fresh[i] * std::max(0.0, said[i].nats);
    if (voices[i].link < 0 || !voices[i].asked) continue;
    const double prior = voices[i].said.*kind.prior;
    all.prior = most_shown_m2 < 0.0 ? prior : std::min(all.prior, prior);
    if (const double shown_m2 = voices[i].pair->poses.front().agreeing_m2; shown_m2 > most_shown_m2) {
      most_shown_m2 = shown_m2;
      all.built_nats = voices[i].said.built_nats;
    }
  }
  all.voices = std::move(voices);
  return all;
}

}  // namespace limen
