// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The library's front door: what a program that uses limen includes. These headers are the public ones; what
// they include in turn may change between minor versions.
#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/base/version.h"
#include "limen/bim/read_bim.h"
#include "limen/deviation/deviation.h"
#include "limen/extract/features/extract_features.h"
#include "limen/extract/openings/openings.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/model/bim_model.h"
#include "limen/model/features.h"
#include "limen/model/result.h"
#include "limen/model/scan.h"
#include "limen/project/solve_project.h"
#include "limen/register/register.h"
#include "limen/report/json/result_json.h"
