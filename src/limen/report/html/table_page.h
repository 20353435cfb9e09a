// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limen {

/// The style of pages of tables and plans without a view in space.
const char* table_page_style();

}  // namespace limen
