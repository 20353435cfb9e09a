// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "limen/base/progress.h"

namespace limen {

/// The Chromium of this machine: the one that LIMEN_CHROMIUM names, else the first along PATH. Throws Error
/// where there is none.
std::filesystem::path find_chromium();

/// Prints a page to a PDF, as its own style says for paper; nothing is kept of the browser. The file appears
/// whole or not at all; throws Error where the browser fails or takes longer than two minutes.
void print_pdf(const std::filesystem::path& browser, const std::filesystem::path& page,
               const std::filesystem::path& pdf, Monitor& monitor = silent_monitor());

}  // namespace limen
