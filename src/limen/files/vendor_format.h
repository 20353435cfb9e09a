// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace limen {

/// Throws Error for a file in the format of one maker's programs, which limen does not read: it names the
/// maker, and how those programs export what limen reads. By the bytes where they tell, else by the ending of
/// `path`: formats that limen reads are to be recognised before.
void refuse_vendor_format(std::string_view bytes, const std::filesystem::path& path);

/// Whether a file of this name is in such a format, if its bytes do not tell otherwise.
bool has_vendor_ending(const std::filesystem::path& path);

}  // namespace limen
