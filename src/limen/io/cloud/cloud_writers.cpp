// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/cloud_writers.h"

#include <string>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/io/e57/write_e57.h"
#include "limen/io/las/write_las.h"
#include "limen/io/ply/ply_writer.h"
#include "limen/io/text/text_writer.h"

namespace limen {
namespace {

std::string ending_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

bool is_text(const std::string& ending) {
  return ending == ".xyz" || ending == ".txt" || ending == ".asc" || ending == ".csv";
}

}  // namespace

std::unique_ptr<CloudWriter> make_cloud_writer(const std::filesystem::path& path, const CloudPlan& plan) {
  const std::string ending = ending_of(path);
  if (ending == ".las" || ending == ".laz") return make_las_writer(path, plan);
  if (ending == ".e57") return make_e57_writer(path, plan);
  if (is_text(ending)) return make_text_writer(path, plan);
  // What has no ending is no ordinary file: a pipe.
  if (ending == ".ply" || ending.empty()) return make_ply_writer(path, plan);
  throw Error(fmt::format("limen cannot write files with the ending \"{}\"", ending), path.string(),
              "name the output .ply, .las, .laz, .e57, .xyz or .csv");
}

bool is_cloud_ending(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".las" || ending == ".laz" || ending == ".e57" || ending == ".ply" || is_text(ending) ||
         ending.empty();
}

bool has_cloud_ending(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".pcd" || ending == ".ptx" || ending == ".pts" ||
         (!ending.empty() && is_cloud_ending(path));
}

}  // namespace limen
