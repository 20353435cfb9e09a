// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "limen/report/summary/registration_report.h"

namespace limen {

/// The text of result.json. Everything is the same from run to run but `stages`, the seconds of each stage.
/// `target_from_source` is null for no_match; with any other outcome it is the best pose found.
std::string result_json(const RegistrationReport& report);

/// The 4 x 4 matrix as CloudCompare reads it: four lines of four numbers of 17 digits.
std::string transform_text(const Rigid3& target_from_source);
std::string matrix_text(const Matrix4d& target_from_source);

/// "transform_2.txt": the matrix of the alternative of this number, counted from 1.
std::string alternative_file(std::size_t number);

/// Writes result.json and, but for no_match, transform.txt and a matrix file of every alternative that cannot
/// be distinguished from the best: all, or none where Error is thrown. Transforms of an earlier run do not
/// outlive this one.
void write_numbers(const std::filesystem::path& folder, const RegistrationReport& report);

}  // namespace limen
