// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/deviation/building_deviation.h"
#include "limen/report/deviation/deviation_issues.h"
#include "limen/report/html/html_cover.h"
#include "limen/report/json/result_json.h"
#include "limen/report/sheet/sheet.h"

namespace limen {

/// A model that a building was measured against.
struct BuildingModel {
  std::string path;
  std::size_t elements = 0;
  Rigid3 frame_from_model;  ///< world to world
  std::string place;        ///< who says so: "project", "with the first", "in the frame"
};

/// A scan that was measured.
struct BuildingScan {
  std::string path;
  int index = 0;
  double pose_sigma_m = 0.0;
  bool bent = false;       ///< moved by the correction of each point's own time
  Rigid3 model_from_scan;  ///< world to world, into the coordinates of the first model
};

/// A scan of the project that was not, and why.
struct BuildingLeftOut {
  std::string path;
  int index = 0;
  std::string reason;
};

/// All that the files of a building's deviation tell beside the points. Places are in the coordinates of the
/// first model.
struct BuildingReport {
  BuildingDeviation deviation;
  BimModel model;                              ///< all models in one
  std::vector<std::int32_t> model_of_element;  ///< into `models`
  std::size_t doubled = 0;                     ///< elements that an earlier model has too
  std::string project;                         ///< its file
  std::vector<BuildingModel> models;
  std::vector<BuildingScan> scans;  ///< in the order of deviation.scans
  std::vector<BuildingLeftOut> left_out;
  DeviationOptions measured;
  IssueOptions issues;
  std::size_t issues_stated = 0;
  std::size_t cloud_points = 0;  ///< of the coloured cloud
};

/// The text of deviation.json; its schema is project_deviation_schema().
std::string building_json(const BuildingReport& report);

/// A row for each element, the worst first, with the model it is from and by how many scans it was seen.
Sheet building_sheet(const BuildingReport& report);

/// One page: what is missing, what is elsewhere, what the model lacks, each scan's share, and a plan.
/// `cover`: what is written above and signed below.
std::string building_page(const BuildingReport& report, const ReportCover& cover = {});

}  // namespace limen
