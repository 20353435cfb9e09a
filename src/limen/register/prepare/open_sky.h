// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/model/scan.h"

namespace limen {

/// Share of the directions round the scanner in which nothing is seen higher than 10 degrees below the
/// highest elevation of all: above roofs there is sky. In a room walls and ceiling reach as high as the field
/// of view in all directions, as long as the scanner stands upright. z of the scan points up, and its scanner
/// positions are known. 0 where too few directions are seen. Of the scans it was tried on, those of rooms
/// have 0 where the ceiling is in the field of view, halls up to 0.61 where it is not, and passes along
/// streets 0.24 to 0.92.
double open_sky_share(const Scan& scan);

/// Where a scan was taken, as its own points show it.
enum class Surroundings : std::uint8_t { unknown, inside, outside };

/// Outside: z points up, the scanner positions are known, and much sky is open. A mobile scan is taken inside
/// where it is not. It is taken outside where its scanner sees the ground steeply below, and nothing above 60
/// degrees along most of the path. A static one must be of a scanner that measures all round and up to the
/// zenith, as tripods carry: it shows the ground on all sides down to 45 degrees (of other scanners it is not
/// known where they could see; upright ones in halls have up to 0.81 of it, ones in streets and rooms all).
/// Of what is above 60 degrees such a scan shows nearly all inside and less than half outside; and outside,
/// what is seen does not end at one height on most sides, as where a ceiling was cut off.
Surroundings surroundings_of(const Scan& scan);

/// Of several scans together: what all of them are.
Surroundings common(Surroundings a, Surroundings b);

}  // namespace limen
