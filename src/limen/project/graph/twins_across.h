// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/twin_evidence.h"
#include "limen/project/graph/shared_views.h"

namespace limen {

/// What a pair whose nodes a cut parts says of twins.
struct TwinVoice {
  const GraphLink* pair = nullptr;
  TwinEvidence said;
  bool asked =
      true;       ///< its things were; else other places are among its poses, and nothing is believed of it
  int link = -1;  ///< its number, -1: a pair that holds nothing
};

/// Twins of one kind.
struct TwinKind {
  double TwinEvidence::*prior;
  double TwinEvidence::*nats;
};
inline constexpr TwinKind kTwinOtherwise{&TwinEvidence::otherwise, &TwinEvidence::otherwise_nats};
inline constexpr TwinKind kTwinAlike{&TwinEvidence::alike, &TwinEvidence::alike_nats};

/// What is said across a cut of one twin that would explain all of it.
struct TwinsAcross {
  double prior = 0.0;      ///< of a twin, before things are asked; 0 where no link's were
  double nats = 0.0;       ///< what they say against it
  double held_nats = 0.0;  ///< the same of those only that do
  /// What walls say against it, once for a building: by the link that shows most surface. The link that
  /// says most would be chosen for what it says, and of many some say much by chance.
  double built_nats = 0.0;
  std::vector<TwinVoice> voices;  ///< those first that say most ...
  std::vector<double> fresh;      ///< ... and the share of each that none before it has said
};

/// That there is a twin is believed once, as little as any link believes it; what things say multiplies, as
/// far as they are different ones. `side`: of every node whether it lies on the one side of the cut.
TwinsAcross twins_across(const SharedViews& views, const TwinKind& kind, std::vector<TwinVoice> voices,
                         const std::vector<bool>& side);

}  // namespace limen
