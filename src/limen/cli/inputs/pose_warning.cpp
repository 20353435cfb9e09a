// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/pose_warning.h"

#include <fmt/format.h>

#include "limen/report/summary/words.h"

namespace limen {

void warn_of_doubt(const PoseFile& file, const std::string& path, const Session& session) {
  if (!file.outcome || *file.outcome == Outcome::registered) return;
  if (*file.outcome == Outcome::probable && file.probability)
    return session.warn(fmt::format("the pose in {} is only probable; the probability that it is right is {}",
                                    path, probability_words(*file.probability)));
  session.note(fmt::format("the pose in {} is {}: check it", path, to_string(*file.outcome)));
}

}  // namespace limen
