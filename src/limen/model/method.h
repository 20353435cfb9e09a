// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/named.h"

namespace limen {

/// What poses are proposed from.
enum class Method {
  automatic,  ///< planes and openings; segments where a model's planes propose no place
  polygons,   ///< planar polygons (2021)
  openings,   ///< openings (2022)
  hybrid,     ///< openings, and planes for the shift across the wall (2023, III)
  segments    ///< line segments (2023, IV)
};
inline constexpr Named<Method> kMethods[] = {{Method::automatic, "auto"},
                                             {Method::polygons, "polygons"},
                                             {Method::openings, "openings"},
                                             {Method::hybrid, "hybrid"},
                                             {Method::segments, "segments"}};
inline const char* to_string(Method method) {
  return name_of(kMethods, method);
}

/// The papers' own methods, run as they are published.
enum class PublishedMethod {
  threshold_2021,  ///< polygons within thresholds at the start (2021, 3.2.1)
  cluster_2021,    ///< polygons clustered by direction and offset (2021, 3.2.2)
  openings_2022,   ///< edges of openings (2022, 3)
  hybrid_2023,     ///< corners of openings and planes across their wall (2023, III)
  segments_2023    ///< line segments (2023, IV)
};
inline constexpr Named<PublishedMethod> kPublishedMethods[] = {
    {PublishedMethod::threshold_2021, "2021-threshold"},
    {PublishedMethod::cluster_2021, "2021-cluster"},
    {PublishedMethod::openings_2022, "2022"},
    {PublishedMethod::hybrid_2023, "2023-hybrid"},
    {PublishedMethod::segments_2023, "2023-segments"}};
inline const char* to_string(PublishedMethod method) {
  return name_of(kPublishedMethods, method);
}

/// What is known of the vertical.
enum class Gravity {
  automatic,  ///< level where the planes of both scans say so, else as each scan shows by itself
  up,         ///< both z axes point up
  unknown     ///< any orientation: only what each scan shows by itself counts
};
inline constexpr Named<Gravity> kGravities[] = {
    {Gravity::automatic, "auto"}, {Gravity::up, "up"}, {Gravity::unknown, "unknown"}};

}  // namespace limen
