// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/state/project_status.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/files/bounded_json.h"

namespace limen {
namespace {

std::filesystem::path status_path(const std::filesystem::path& folder) {
  return folder / "store" / "status.json";
}

}  // namespace

void write_status(const std::filesystem::path& folder, const ProjectStatus& status) {
  const nlohmann::ordered_json json = {{"stage", status.stage},          {"scans", status.scans},
                                       {"ready", status.ready},          {"pairs", status.pairs},
                                       {"tried", status.tried},          {"copies", status.copies},
                                       {"unreadable", status.unreadable}};
  write_file(status_path(folder), json.dump() + "\n");
}

ProjectStatus project_status(const std::filesystem::path& folder) {
  std::ifstream stream(status_path(folder));
  if (!stream)
    throw Error("holds no project", folder.string(), "give the folder that a project was written to");
  try {
    const nlohmann::json json = json_or_nothing<nlohmann::json>(stream);
    // An earlier version wrote neither of the last two.
    return {json.at("stage"),
            json.at("scans"),
            json.at("ready"),
            json.at("pairs"),
            json.at("tried"),
            json.value("copies", std::size_t{0}),
            json.value("unreadable", std::size_t{0})};
  } catch (const nlohmann::json::exception&) {
    throw Error("the status is damaged", status_path(folder).string(), "run the project again");
  }
}

}  // namespace limen
