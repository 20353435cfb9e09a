// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/result.h"

#include "limen/model/method.h"

namespace limen {

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::registered:
      return "registered";
    case Outcome::probable:
      return "probable";
    case Outcome::ambiguous:
      return "ambiguous";
    case Outcome::under_constrained:
      return "under_constrained";
    case Outcome::no_match:
      return "no_match";
  }
  return "no_match";
}

const char* to_string(PublishedMethod method) {
  switch (method) {
    case PublishedMethod::threshold_2021:
      return "2021-threshold";
    case PublishedMethod::cluster_2021:
      return "2021-cluster";
    case PublishedMethod::openings_2022:
      return "2022";
    case PublishedMethod::hybrid_2023:
      return "2023-hybrid";
    case PublishedMethod::segments_2023:
      return "2023-segments";
  }
  return "2021-cluster";
}

}  // namespace limen
