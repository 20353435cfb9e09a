// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/summary/registration_report.h"

namespace limen {

/// "0.4 mm", "12 mm", "35.2 cm" or "1.20 m": so that a reader sees how large it is.
std::string length_words(double metres);

/// "0.0012°" or "12.3°".
std::string angle_words(double angle_rad);

/// "97.3 %", "99.98 %", "more than 99.99 %", "less than 0.01 %": never a certainty.
std::string probability_words(double probability);

/// "the vertical", or "(0.71, 0.71, 0.00)".
std::string axis_words(const Vector3d& axis);

/// "m2" of messages as "m²".
std::string square_metres(std::string text);

/// "12.3 x 8.1 x 2.9 m"
std::string size_words(const Vector3d& size_m);

/// The path's last part.
std::string file_name(const InputSummary& input);

/// A shift along an axis, or a turn about it, is left open by the data.
bool is_open(const RegistrationResult& result, bool rotation, int axis);

/// Whether one of the sides is a building model.
bool in_model(const RegistrationReport& report);

/// Whether the stated accuracy counts that the scanner of a side may have moved: its position is unknown.
bool may_have_moved(const RegistrationReport& report, const InputSummary& side);

}  // namespace limen
