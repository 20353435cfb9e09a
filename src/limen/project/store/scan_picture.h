// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "limen/model/scan.h"

namespace limen {

/// Points of a picture: a quarter of a megabyte of a scan.
inline constexpr std::size_t kMostPictured = 16000;

/// What a report draws of a scan: at most `most` of its points, evenly over the surface they show, with their
/// colours or intensities, in the scan's own frame. In an order by chance, so that the first ones are spread
/// as evenly as all.
Scan picture_of(const Scan& scan, std::size_t most = kMostPictured);

/// To a tenth of a millimetre about the local origin; the first `most` points come back.
std::string picture_bytes(const Scan& picture);
Scan picture_from(std::string_view bytes, const std::string& where, std::size_t most);

}  // namespace limen
