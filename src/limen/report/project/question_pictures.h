// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/project/project_pictures.h"

namespace limen {

inline constexpr std::size_t kMostPictures = 40;

/// The answers of a question that are about the same scans, in their order.
std::vector<std::vector<Decision>> asked_of(const ProjectQuestion& question);

/// "Are these two the same place, fitted together as shown? hall.ply and stairs.ply"
std::string asked_words(const std::vector<Decision>& answers);

/// An SVG for each of the first pairs of scans that questions ask about, in the order of the questions and of
/// asked_of(): plans of both scans, cut at window height and turned to match by their link, side by side and
/// then overlaid. Empty where a scan has no picture.
std::vector<std::string> question_pictures(const ProjectResult& result,
                                           const std::vector<ProjectPicture>& pictures);

}  // namespace limen
