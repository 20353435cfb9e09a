// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/guarded_mapping.h"
#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/registered_file.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/cli/terminal/command.h"
#include "limen/files/file_hash.h"
#include "limen/files/scan_in_file.h"
#include "limen/geometry/spline_motion.h"
#include "limen/io/cloud/join_clouds.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/cloud/thin_cloud.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/io/e57/e57_copy.h"
#include "limen/io/table/scan_builder.h"
#include "limen/report/json/json_values.h"
#include "limen/report/pose_file.h"
#include "limen/report/project/read_project.h"
#include "limen/report/view/view_page.h"

namespace limen {
namespace {

/// One scan or model to look at, and where it is.
struct ViewInput {
  std::string path;
  int scan = -1;                               ///< of the file, those without points not counted; -1: all
  Rigid3 frame_from_world;                     ///< metres
  std::string sha256;                          ///< that its bytes must have; empty: any
  std::string stated_by = {};                  ///< the file that says so
  std::optional<double> metres_per_unit = {};  ///< of its numbers, where a result says
  /// Of a mobile pass that drifted: by how much each point moves within the frame, by its time.
  std::shared_ptr<const SplineMotion> bend = {};
};

namespace fs = std::filesystem;

bool is_json_name(const std::string& path) {
  return lower_case(fs::path(path).extension().string()) == ".json";
}

/// A file that another one names: as seen from here, else from the folders that one lies in, for it was
/// written from one of them.
std::string found_beside(const std::string& file, const std::string& named_by) {
  std::error_code ignored;
  if (fs::exists(file_of_scan(file), ignored)) return file;
  for (fs::path folder = fs::absolute(named_by).parent_path();; folder = folder.parent_path()) {
    if (fs::exists(file_of_scan((folder / file).string()), ignored)) return (folder / file).string();
    if (folder == folder.parent_path()) return file;
  }
}

std::vector<ViewInput> sides_of_result(const std::string& path, int alternative) {
  const PoseFile pose = read_pose_file(path);
  if (pose.source_path.empty() || pose.target_path.empty())
    throw Error("does not name the files that were registered", path,
                "give the result.json that limen register wrote");
  const std::string source_path = found_beside(pose.source_path, path);
  const std::string target_path = found_beside(pose.target_path, path);
  ViewInput source{source_path, -1, chosen_pose(pose, alternative, path), pose.source_sha256, path};
  source.metres_per_unit = unit_to_read(source_path, pose.source_metres_per_unit);
  ViewInput target{target_path, -1, Rigid3{}, pose.target_sha256, path};
  target.metres_per_unit = unit_to_read(target_path, pose.target_metres_per_unit);
  return {std::move(source), std::move(target)};
}

std::vector<ViewInput> scans_of_project(const std::string& path, const Session& session) {
  std::vector<ViewInput> inputs;
  for (const ProjectEntry& entry : read_project(path)) {
    if (!entry.frame_from_scan) {
      session.note(fmt::format("{}: {}, not shown", scan_name(entry), entry.state));
      continue;
    }
    inputs.push_back({found_beside(entry.file, path), entry.model ? -1 : entry.index, *entry.frame_from_scan,
                      entry.sha256, path});
    inputs.back().bend = entry.bend;
  }
  return inputs;
}

void check_bytes(const ViewInput& input) {
  if (input.sha256.empty()) return;
  const std::string hash = sha256_of_file(file_of_scan(input.path));
  if (hash.empty() || hash == input.sha256) return;
  throw Error(fmt::format("is not the file registered in {}: its SHA-256 is different", input.stated_by),
              input.path, "give the registered file, or name the clouds themselves instead of the result");
}

/// A cloud file that is open, and those of its scans that are to be shown.
struct CloudToView {
  std::size_t input = 0;
  std::unique_ptr<OpenPoints> file;
  std::vector<PlacedCloud> clouds;
  std::uint64_t points = 0;
};

/// What is bent moves point by point within the frame: it has to stand there before, else it is placed last,
/// when its unit is known.
Rigid3 place_in_file(const ViewInput& input) {
  return input.bend ? input.frame_from_world : Rigid3{};
}
Rigid3 place_of_scan(const ViewInput& input) {
  return input.bend ? Rigid3{} : input.frame_from_world;
}

CloudToView open_cloud(const ViewInput& input, std::size_t number, const Session& session) {
  CloudToView cloud{number, std::make_unique<OpenPoints>(input.path), {}, 0};
  int seen = 0;
  for (PlacedCloud placed : placed_clouds(*cloud.file, place_in_file(input), {}, *session.monitor)) {
    const std::uint64_t points = cloud.file->file().clouds()[placed.cloud].points;
    if (points == 0 || (input.scan >= 0 && seen++ != input.scan)) continue;
    placed.bend = input.bend;
    cloud.clouds.push_back(placed);
    cloud.points += points;
  }
  if (cloud.clouds.empty()) {
    throw Error(input.scan >= 0 ? fmt::format("has no scan {}", input.scan) : "has no points", input.path,
                "give a file with points");
  }
  return cloud;
}

/// How many points of each may be shown: small clouds whole, the others as many as there is room for.
std::vector<std::uint64_t> shares_of(const std::vector<CloudToView>& clouds, std::uint64_t most) {
  std::vector<std::size_t> order(clouds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return clouds[a].points < clouds[b].points; });
  std::vector<std::uint64_t> shares(clouds.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    shares[order[k]] =
        std::max<std::uint64_t>(1, std::min(clouds[order[k]].points, most / (order.size() - k)));
    most -= std::min(most, shares[order[k]]);
  }
  return shares;
}

Scan read_share(const CloudToView& cloud, std::uint64_t share, std::optional<double> metres_per_unit,
                const Session& session) {
  const JoinedClouds joined(cloud.clouds, false);
  ThinOptions thinning;
  thinning.most_points = share;
  CloudThinner thinner(thinning, joined.plan().most_points);
  const std::unique_ptr<PointStream> stream = joined.read();
  while (const std::optional<RecordTable> piece = stream->next(kStreamRows)) {
    thinner.add(*piece);
    session.monitor->throw_if_cancelled();
  }
  const ThinnedCloud thinned = thinner.finish();
  TableFacts facts;
  facts.name = cloud.file->name();
  facts.metres_per_unit = cloud.file->file().clouds()[cloud.clouds.front().cloud].table.metres_per_unit;
  ReadOptions options;
  options.metres_per_unit = metres_per_unit;
  ScanFile file = with_scan({}, thinned.table, facts, options);
  // A grid of returns has a place for those that are missing.
  const std::size_t unusable = cloud.file->format() == PointFormat::ptx ? 0 : thinned.unusable;
  if (const std::string note = unusable_note(unusable, thinned.read - thinned.unusable); !note.empty())
    session.note(fmt::format("{}: {}", cloud.file->name(), note));
  return std::move(file.scans.front());
}

ViewSide side_of_cloud(const ViewInput& input, const CloudToView& cloud, Scan scan, const Vector3d& origin) {
  PicturedSide pictured;
  pictured.features.local_origin = origin;
  RegisterInput placed;
  placed.scans.push_back({std::move(scan), place_of_scan(input)});
  ViewSide side;
  side.points_read = cloud.points;
  side.scene = with_picture(scene_side(placed, cloud.points), pictured);
  return side;
}

/// Room for images on a page.
struct PictureRoom {
  std::size_t bytes = 0;
  std::size_t left = 0;
};

/// What so many points leave of a page: three bytes of an image are four on it.
PictureRoom room_beside(std::uint64_t points) {
  constexpr std::uint64_t kBytesPerPoint = 12;  // place, plane and colour
  const std::uint64_t taken = std::min<std::uint64_t>(kMostPageBytes, kBytesPerPoint * points);
  const std::size_t bytes = std::min<std::size_t>(kMostPictureBytes, (kMostPageBytes - taken) / 4 * 3);
  return {bytes, bytes};
}

/// The images of an E57 at their places, as long as there is room for them.
std::vector<ViewPicture> pictures_of(const ViewInput& input, const CloudToView& cloud, const Vector3d& origin,
                                     PictureRoom& room, const Session& session) {
  std::vector<ViewPicture> pictures;
  if (cloud.file->format() != PointFormat::e57) return pictures;
  const E57Original original(cloud.file->bytes(), cloud.file->name());
  for (const E57Picture& picture : original.pictures()) {
    const auto shown = std::find_if(cloud.clouds.begin(), cloud.clouds.end(), [&](const PlacedCloud& placed) {
      return cloud.file->number_in_file(placed.cloud) == picture.scan;
    });
    if (shown == cloud.clouds.end()) continue;
    if (picture.bytes > room.left) {
      session.note(fmt::format(
          "{}: an image of {:.1f} MB is left out: beside so many points a page holds {:.0f} MB of images",
          cloud.file->name(), static_cast<double>(picture.bytes) / 1e6,
          static_cast<double>(room.bytes) / 1e6));
      continue;
    }
    room.left -= picture.bytes;
    pictures.push_back({input.frame_from_world * picture.file_from_image.translation - origin, picture.type,
                        original.bytes_of(picture)});
  }
  return pictures;
}

/// File names, with the number of the scan where one file has several, and numbered where two are the same.
void name_sides(const std::vector<ViewInput>& inputs, ViewScene& scene) {
  std::map<std::string, int> of_file;
  for (const ViewInput& input : inputs) ++of_file[input.path];
  std::map<std::string, int> taken;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    std::string name = fs::path(inputs[k].path).filename().string();
    if (inputs[k].scan >= 0 && of_file[inputs[k].path] > 1) name += fmt::format(", scan {}", inputs[k].scan);
    if (const int before = taken[name]++; before > 0) name += fmt::format(" ({})", before + 1);
    scene.sides[k].name = name;
  }
}

/// What the words on the command line mean: scans and models as they lie, both sides of a result.json under
/// pose number `alternative`, all placed scans of a project.json. Notes what has no place. Throws Error for
/// JSON that is neither.
std::vector<ViewInput> view_inputs(const std::vector<std::string>& files, int alternative,
                                   const Session& session) {
  std::vector<ViewInput> inputs;
  const auto has_alternatives = [](const std::string& file) {
    return is_json_name(file) && !is_project(file);
  };
  if (alternative > 0 && std::none_of(files.begin(), files.end(), has_alternatives))
    throw Error("--alternative chooses among the poses of a result.json, but none is given", "",
                "name the result.json, or leave the option out");
  for (const std::string& file : files) {
    std::vector<ViewInput> more{{file, -1, Rigid3{}, "", ""}};
    if (is_json_name(file))
      more = is_project(file) ? scans_of_project(file, session) : sides_of_result(file, alternative);
    inputs.insert(inputs.end(), more.begin(), more.end());
  }
  if (inputs.empty()) throw Error("no scan has a pose in it", files.front(), "give scans or models");
  return inputs;
}

/// Reads them all, thinned to `most_points` together: small clouds whole, the rest in equal parts.
/// Throws Error where one cannot be read or is not the file that a result is about.
ViewScene read_view(const std::vector<ViewInput>& inputs, std::size_t most_points, const Session& session) {
  std::vector<CloudToView> clouds;
  std::map<std::size_t, BimModel> models;
  std::set<std::string> checked;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (checked.insert(inputs[k].path).second) check_bytes(inputs[k]);
    if (is_bim_file(inputs[k].path)) {
      models.emplace(k, read_model_input(inputs[k].path, session, inputs[k].metres_per_unit, "--units"));
    } else {
      clouds.push_back(open_cloud(inputs[k], k, session));
    }
  }
  ViewScene scene;
  scene.sides.resize(inputs.size());
  std::optional<Vector3d> origin;
  const auto about = [&](const Vector3d& place) -> const Vector3d& {
    if (!origin) origin = round_origin_near(place);
    return *origin;
  };
  const std::vector<std::uint64_t> shares = shares_of(clouds, most_points);
  PictureRoom picture_room = room_beside(std::accumulate(shares.begin(), shares.end(), std::uint64_t{0}));
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    const ViewInput& input = inputs[clouds[k].input];
    Scan scan =
        with_whole_inputs([&] { return read_share(clouds[k], shares[k], input.metres_per_unit, session); });
    const Vector3d& middle = about(place_of_scan(input) * (scan.local_origin + scan.points.front()));
    ViewSide& side = scene.sides[clouds[k].input] = side_of_cloud(input, clouds[k], std::move(scan), middle);
    side.pictures = pictures_of(input, clouds[k], middle, picture_room, session);
    // Of files whose coordinates are shown as they are.
    if (clouds[k].file->file().clouds().size() == 1 && !input.bend &&
        input.metres_per_unit.value_or(1.0) == 1.0) {
      side.path = fs::path(input.path).filename().string();
      side.file_from_frame = inverse(input.frame_from_world);
    }
  }
  for (const auto& [k, model] : models)
    scene.sides[k].scene = view_of_model(model, inputs[k].frame_from_world,
                                         about(inputs[k].frame_from_world * model.local_origin));
  scene.origin = *origin;
  name_sides(inputs, scene);
  return scene;
}

constexpr int kFewestViewed = 1000;
constexpr int kMostViewed = 1'500'000;

struct ViewCommand {
  std::vector<std::string> files;
  std::string output = "view.html";
  std::string title;
  std::string units;
  int most_points = 1'000'000;
  int alternative = 0;
};

std::string viewed_as_json(const ViewCommand& command, const ViewScene& scene, std::size_t bytes) {
  Json json;
  json["output"] = command.output;
  json["bytes"] = bytes;
  json["files"] = Json::array();
  for (const ViewSide& side : scene.sides)
    json["files"].push_back({{"name", side.name},
                             {"points_read", side.points_read},
                             {"points_shown", side.scene.points.size()},
                             {"faces_shown", side.scene.faces.size()}});
  return to_text(json);
}

std::string title_of(const ViewCommand& command, const ViewScene& scene) {
  if (!command.title.empty()) return command.title;
  return listed(scene.sides, 3, [](const ViewSide& side) { return side.name; });
}

int run(const ViewCommand& command, const Session& session) {
  for (const std::string& file : command.files) refuse_same_file(command.output, file);
  for (const std::string& file : command.files) {
    if (!is_project(file)) continue;
    for (const ProjectEntry& entry : read_project(file)) refuse_same_file(command.output, entry.file);
  }
  std::vector<ViewInput> inputs = view_inputs(command.files, command.alternative, session);
  if (const std::optional<double> unit = metres_per_unit_of(command.units)) {
    for (ViewInput& input : inputs) input.metres_per_unit = unit;
  }
  for (const ViewInput& input : inputs) refuse_same_file(command.output, input.path);
  // Opened before the long work: a place that cannot be written to is an error at once.
  AtomicFile file(command.output);
  const CancelScope scope(*session.monitor);
  session.monitor->begin_stage("reading");
  ViewScene scene = read_view(inputs, static_cast<std::size_t>(command.most_points), session);
  scene.title = title_of(command, scene);
  const std::string page = view_page(scene);
  file.write(page);
  file.commit();
  session.say(fmt::format("{} file{}, {:.1f} MB; written to {}: open it in a browser\n", scene.sides.size(),
                          scene.sides.size() == 1 ? "" : "s", static_cast<double>(page.size()) / 1e6,
                          command.output));
  session.answer(viewed_as_json(command, scene, page.size()));
  return kExitOk;
}

}  // namespace

void add_view_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<ViewCommand>();
  CommandLine* command =
      add_command(app, session, "view", "Write a web page to view, section and measure scans and models",
                  [options, &session] { return run(*options, session); });
  command
      ->add_option(
          "FILE", options->files,
          "Scans and models in one frame, a result.json (both its sides), or a project.json (all its scans)")
      ->required();
  command->add_option("-o,--output FILE", options->output, "The page to write (default view.html)");
  command
      ->add_option("--most-points N", options->most_points,
                   "Number of points of all files together (default 1000000); scans are thinned evenly")
      ->in_range(kFewestViewed, kMostViewed);
  command->add_option("--title WORDS", options->title,
                      "Heading of the page (default: the names of the files)");
  add_alternative_option(*command, options->alternative);
  add_units_option(*command, options->units);
}

}  // namespace limen
