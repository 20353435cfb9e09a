// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace limen {

/// The parts of the page of `limen serve`, made of serve/page at build time.
std::string_view serve_page_html();
std::string_view serve_page_css();
std::string_view serve_page_js();

}  // namespace limen
