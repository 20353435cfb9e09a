// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/weigh_looks.h"

#include "limen/base/wide.h"
#include "limen/sight/space_view.h"

namespace limen {
namespace {

constexpr auto kSurfaceMet = static_cast<std::int32_t>(SightKind::surface);
constexpr auto kPassed = static_cast<std::int32_t>(SightKind::free);

LIMEN_WIDE void weigh(const Looks& __restrict looks, const float* __restrict areas_m2,
                      const std::int32_t* __restrict planar, float per_surface_m, float per_clutter_m,
                      std::size_t size, Answers& __restrict answers) {
  for (std::size_t k = 0; k < size; ++k) {
    const float off = looks.distance_m[k] * (planar[k] != 0 ? per_surface_m : per_clutter_m);
    const float area = areas_m2[k];
    const float gain = area * (1.0F - off * off);
    answers.gain_m2[k] = looks.kind[k] == kSurfaceMet ? gain : 0.0F;
    answers.contradicted_m2[k] = looks.kind[k] == kPassed ? area : 0.0F;
  }
}

}  // namespace

void weigh_looks(const Looks& looks, const float* areas_m2, const std::int32_t* planar,
                 const LookTolerances& tolerances, std::size_t size, Answers& answers) {
  weigh(looks, areas_m2, planar, static_cast<float>(1.0 / tolerances.surface_m),
        static_cast<float>(1.0 / tolerances.clutter_m), size, answers);
}

}  // namespace limen
