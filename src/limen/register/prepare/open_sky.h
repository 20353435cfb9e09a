// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/scan.h"

namespace limen {

/// Share of the directions round the scanner in which nothing is seen higher than 10 degrees below the
/// highest elevation of all: above roofs there is sky. In a room walls and ceiling reach as high as the field
/// of view in all directions, as long as the scanner stands upright. z of the scan points up, and its scanner
/// positions are known. Of the scans it was tried on, upright ones in rooms and halls have 0 to 0.25, whole
/// passes along streets 0.40 to 0.92. 0 where too few directions are seen.
double open_sky_share(const Scan& scan);

/// Whether a mobile scan was taken outside: z points up, and much sky is open. Of a static scan it is not
/// known: a scanner of narrow field of view that stands askew in a hall leaves as much open.
bool taken_outside(const Scan& scan);

}  // namespace limen
