// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/terminal/command.h"
#include "limen/geometry/random_vectors.h"
#include "limen/io/e57/e57.h"
#include "limen/io/ply/ply.h"
#include "limen/report/json/result_json.h"
#include "limen/report/json/truth_json.h"
#include "limen/simulate/model/bim_recipe.h"
#include "limen/simulate/model/bim_scene.h"
#include "limen/simulate/scene.h"
#include "limen/simulate/whole/project_scene.h"
#include "limen/simulate/whole/site_targets.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {
namespace {

/// Files of a case that is complete only with its last one: without it none is left.
class CaseFiles {
 public:
  CaseFiles() = default;
  ~CaseFiles() {
    std::error_code ignored;
    for (const std::filesystem::path& path : written_) std::filesystem::remove(path, ignored);
  }
  CaseFiles(const CaseFiles&) = delete;
  CaseFiles& operator=(const CaseFiles&) = delete;

  /// Names a file that is about to be written; one that was there before stays.
  const std::filesystem::path& add(const std::filesystem::path& path) {
    return std::filesystem::exists(path) ? path : written_.emplace_back(path);
  }
  void keep() { written_.clear(); }

 private:
  std::vector<std::filesystem::path> written_;
};

std::string summary(const ProjectTruth& truth, const std::string& folder) {
  std::size_t points = 0;
  std::size_t passes = 0;
  for (const SimulatedScan& scan : truth.scans) {
    points += scan.points;
    passes += scan.mobile ? 1U : 0U;
  }
  return fmt::format(
      "{} stations and {} passes, {} points\nwritten to {} with task.json; the truth is in "
      "truth/project.json\n",
      truth.scans.size() - passes, passes, points, folder);
}

/// The targets as a surveyor measures them, or exactly, in the format of limen project --control.
template <typename AnyTruth>
std::string control_text(const AnyTruth& truth, const std::vector<SiteTarget>& targets, double sigma_m) {
  std::string text = "name,x,y,z,sigma\n";
  for (std::size_t k = 0; k < targets.size(); ++k) {
    RandomStream random(truth.seed, 600000 + k);
    const Vector3d x = truth.local_origin + targets[k].centre + sigma_m * normal_vector(random);
    text += fmt::format("{},{:.5f},{:.5f},{:.5f},{}\n", targets[k].name, x.x(), x.y(), x.z(),
                        sigma_m > 0.0 ? sigma_m : 1e-5);
  }
  return text;
}

template <typename AnyTruth>
void write_control(const std::filesystem::path& folder, const AnyTruth& truth,
                   const std::vector<SiteTarget>& targets, CaseFiles& files) {
  constexpr double kSurveyedM = 0.001;
  if (targets.empty()) return;
  write_file(files.add(folder / "control.csv"), control_text(truth, targets, kSurveyedM));
  write_file(files.add(folder / "truth" / "control.csv"), control_text(truth, targets, 0.0));
}

void write_scan(const std::filesystem::path& folder, const Scan& scan, bool e57, CaseFiles& files) {
  const std::filesystem::path path = files.add(folder / (scan.name + (e57 ? ".e57" : ".ply")));
  e57 ? write_e57(path, scan) : write_ply(path, scan);
}

/// Stations as E57, passes as PLY.
template <typename AnyTruth>
void name_as_e57(AnyTruth& truth) {
  for (auto& scan : truth.scans) {
    if (!scan.mobile) scan.ending = ".e57";
  }
}

/// `limen simulate BUILDING --project -o DIR`: scans a whole building, one file a scan, and writes task.json
/// and truth/project.json. `options.seed` is set.
int run_simulate_project(const ProjectSceneOptions& options, const std::string& output, bool e57,
                         const Session& session) {
  options.check();
  const OutputFolder folder(output);
  const OutputFolder truth_folder(folder.path() / "truth");
  CaseFiles files;
  const auto keep = [&](const Scan& scan) { write_scan(folder.path(), scan, e57 && !scan.mobile(), files); };
  ProjectTruth truth = simulate_project(options, keep, *session.monitor);
  if (e57) name_as_e57(truth);
  const std::string task = project_task_json(truth);
  write_file(files.add(truth_folder.path() / "project.json"), project_truth_json(truth));
  write_file(files.add(folder.path() / "task.json"), task);
  write_control(folder.path(), truth, truth.targets, files);
  files.keep();
  session.say(summary(truth, output));
  session.answer(task);
  return kExitOk;
}

struct SimulateOptions {
  std::string output;
  SceneOptions scene;
  std::string room = "any";  ///< the remaining ones are of models
  std::string units = "m";
  bool as_built = false;
  bool as_drawn = false;
  bool project = false;  ///< a whole building
  int passes = -1;
  std::string drift = "waves";
  bool styles = false;
  std::string outdoor = "mobile";
  std::string places = "usual";
  std::size_t tripods = 0;
  std::size_t targets = 0;
  double open_doors = -1.0;
  std::string as = "ply";
  [[nodiscard]] bool e57() const { return as == "e57"; }
};

std::string summary(const SimulatedCase& simulated, const std::string& folder) {
  std::string text;
  for (std::size_t k = 0; k < simulated.scans.size(); ++k) {
    const Scan& scan = simulated.scans[k];
    text += fmt::format("{:<16} {:>9} points, {}\n", scan.name + simulated.truth.scans[k].ending, scan.size(),
                        scan.mobile() ? "mobile, world coordinates" : "station, its own frame");
  }
  if (simulated.truth.model) text += fmt::format("{:<16} the model\n", simulated.truth.model->file);
  return text + fmt::format("written to {} with task.json; the truth is in truth/truth.json\n", folder);
}

/// The known poses of further stations in the first one's frame, one file each.
void write_station_poses(const SimulatedCase& simulated, const std::filesystem::path& folder,
                         CaseFiles& files) {
  for (std::size_t i = 1; simulated.truth.model && i < simulated.scans.size(); ++i)
    write_file(files.add(folder / fmt::format("source_from_{}.txt", simulated.scans[i].name)),
               transform_text(true_target_from_source(simulated.truth, i, 0)));
}

RoomChoice room_choice(const std::string& room) {
  if (room == "unique") return RoomChoice::unique;
  if (room == "each") return RoomChoice::each;
  if (room == "doorways") return RoomChoice::doorways;
  return room == "repeated" ? RoomChoice::repeated : RoomChoice::any;
}

constexpr const char* kOffice = "office";

BimSceneOptions bim_options(const SimulateOptions& options) {
  BimSceneOptions bim;
  bim.seed = options.scene.seed;
  bim.stations = std::max<std::size_t>(1, options.scene.stations);
  if (options.scene.points_indoor > 0) bim.points = options.scene.points_indoor;
  bim.any_rotation = options.scene.any_rotation;
  bim.room = room_choice(options.room);
  // Who scans a building room by room leaves the doors open.
  if (bim.room == RoomChoice::each) bim.open_door_share = 0.9;
  if (bim.room == RoomChoice::doorways) bim.open_door_share = 1.0;
  bim.as_built.on = options.as_built;
  bim.scanner = options.scene.scanner;
  bim.targets = options.targets;
  bim.check();
  return bim;
}

/// Scans a model file, or the built-in one, which is written beside the scans.
SimulatedCase simulate_model(const SimulateOptions& options, const std::filesystem::path& folder,
                             CaseFiles& files, Monitor& monitor) {
  const BimSceneOptions bim = bim_options(options);
  if (options.scene.name != kOffice) {
    const std::filesystem::path path(options.scene.name);
    BimModel model = read_bim(path, monitor);
    model.name = path.filename().string();
    return simulate_bim(model, bim, monitor);
  }
  const BimRecipe recipe = office_recipe();
  BimModel model = model_of(recipe);
  model.name = "model.ifc";
  SimulatedCase simulated = simulate_bim(model, bim, monitor);
  write_file(files.add(folder / model.name),
             ifc_text(recipe, options.units == "mm" ? IfcUnit::millimetre : IfcUnit::metre));
  return simulated;
}

/// A model is meant where the name is no scene's but that of an existing file, or the built-in model's.
bool means_model(const std::string& name) {
  const std::vector<std::string> scenes = scene_names();
  if (std::find(scenes.begin(), scenes.end(), name) != scenes.end()) return false;
  std::error_code error;
  return name == kOffice || std::filesystem::exists(name, error);
}

std::string known_scenes() {
  return fmt::format("{}, {}", fmt::join(scene_names(), ", "), kOffice);
}

/// An option that would be passed over without a word is a mistake.
void check_options(const SimulateOptions& options, bool model) {
  const SceneOptions& scene = options.scene;
  const auto refuse = [](bool given, const std::string& option, const char* what) {
    if (given) throw Error(option + " is for " + what + " only", "limen simulate", "leave it out");
  };
  if (model) {
    refuse(scene.points_outdoor > 0, "--points-outdoor", "scenes");
    refuse(scene.facades > 0, "--facades", "scenes");
    refuse(scene.curtain_share >= 0.0, "--curtain-share", "scenes");
    refuse(scene.drift_m > 0.0, "--drift-m", "scenes");
    refuse(scene.outdoor == Outdoor::tripod, "--outdoor", "scenes");
    refuse(options.units != "m" && scene.name != kOffice, "--units", kOffice);
    return;
  }
  refuse(options.as_built, "--as-built", "models");
  refuse(options.targets > 0, "--targets", "models and whole buildings (--project)");
  refuse(scene.drift_m > 0.0 && scene.outdoor == Outdoor::tripod, "--drift-m", "mobile scans");
  refuse(options.room != "any", "--room", "models");
  refuse(options.units != "m", "--units", kOffice);
  if (scene.name.find_first_of("./") != std::string::npos)
    throw Error("there is no such file", scene.name, "give a model file, or one of: " + known_scenes());
  scene.check();
}

/// A whole building, scan by scan.
int run_project(const SimulateOptions& options, const Session& session) {
  const SceneOptions& scene = options.scene;
  const auto refuse = [](bool given, const std::string& option) {
    if (given)
      throw Error(option + " is not for whole buildings", "limen simulate --project", "leave it out");
  };
  refuse(scene.facades > 0, "--facades");
  refuse(scene.curtain_share >= 0.0, "--curtain-share");
  refuse(options.as_built, "--as-built");
  refuse(options.room != "any", "--room");
  refuse(options.units != "m", "--units");
  if (options.outdoor != "mobile")
    throw Error("--outdoor is for single cases only", "limen simulate --project",
                "give --tripods N for stations in the street, and --passes 0 for no vehicle");
  ProjectSceneOptions project;
  project.name = scene.name;
  project.seed = session.common.seed;
  project.stations = scene.stations;
  project.passes = options.passes;
  if (scene.points_indoor > 0) project.points_station = scene.points_indoor;
  project.points_pass = scene.points_outdoor;
  project.any_rotation = scene.any_rotation;
  if (scene.drift_m >= 0.0) project.drift_m = scene.drift_m;
  project.drift = options.drift == "walk" ? DriftKind::walk : DriftKind::waves;
  project.as_built = !options.as_drawn;
  project.tripods = options.tripods;
  project.targets = options.targets;
  if (options.places == "rooms") project.places = StationPlaces::rooms;
  if (options.places == "doorways") project.places = StationPlaces::doorways;
  // Who sets up in doorways has opened the doors.
  if (project.places == StationPlaces::doorways) project.open_door_share = 1.0;
  if (options.open_doors >= 0.0) project.open_door_share = options.open_doors;
  project.scanner = scene.scanner;
  project.styles = options.styles;
  return run_simulate_project(project, options.output, options.e57(), session);
}

int run(SimulateOptions& options, const Session& session) {
  if (options.project) return run_project(options, session);
  options.scene.seed = session.common.seed;
  options.scene.drift_m = std::max(0.0, options.scene.drift_m);
  const auto only_project = [](bool given, const std::string& option) {
    if (given) throw Error(option + " is for whole buildings only", "limen simulate", "add --project");
  };
  only_project(options.styles, "--styles");
  only_project(options.passes >= 0, "--passes");
  only_project(options.tripods > 0, "--tripods");
  only_project(options.places != "usual", "--places");
  only_project(options.open_doors >= 0.0, "--open-doors");
  options.scene.as_built = !options.as_drawn;
  if (options.outdoor == "static") options.scene.outdoor = Outdoor::tripod;
  const bool model = means_model(options.scene.name);
  check_options(options, model);
  // Made before the long work: a place that cannot be written to is an error at once.
  const OutputFolder folder(options.output);
  const OutputFolder truth_folder(folder.path() / "truth");
  CaseFiles files;
  SimulatedCase simulated = model ? simulate_model(options, folder.path(), files, *session.monitor)
                                  : simulate(options.scene, *session.monitor);
  if (options.e57()) name_as_e57(simulated.truth);
  session.monitor->begin_stage("writing");
  for (const Scan& scan : simulated.scans) {
    session.monitor->throw_if_cancelled();
    write_scan(folder.path(), scan, options.e57() && !scan.mobile(), files);
  }
  if (simulated.truth.model)
    write_control(folder.path(), simulated.truth, simulated.truth.model->targets, files);
  const std::string task = task_json(simulated);
  write_station_poses(simulated, folder.path(), files);
  write_file(files.add(truth_folder.path() / "truth.json"), truth_json(simulated.truth));
  write_file(files.add(folder.path() / "task.json"), task);
  files.keep();
  session.say(summary(simulated, options.output));
  session.answer(task);
  return kExitOk;
}

void add_count_option(CommandLine& command, const std::string& name, std::size_t& count,
                      const std::string& description) {
  command.add_option(name, count, description + "; 0: the scene's own (default)")->type_name("N");
}

}  // namespace

void add_simulate_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<SimulateOptions>();
  CommandLine* command =
      add_command(app, session, "simulate",
                  "Simulate scans of a made-up building or of a model; the true poses are known exactly",
                  [options, &session] { return run(*options, session); });
  SceneOptions& scene = options->scene;
  scene.drift_m = -1.0;  // what is not given is not the same for scenes and whole buildings
  command
      ->add_option("NAME", scene.name,
                   "A model file (IFC, OBJ, PLY), or a scene (office is a BIM model): " + known_scenes())
      ->type_name(fmt::format("FILE:{{{},{}}}", fmt::join(scene_names(), ","), kOffice))
      ->required();
  command
      ->add_option("-o,--output DIR", options->output, "The folder for scans, task.json and truth/truth.json")
      ->required();
  add_count_option(*command, "--points-indoor", scene.points_indoor,
                   "Approximate number of points of each station");
  add_count_option(*command, "--points-outdoor", scene.points_outdoor,
                   "Approximate number of points of the mobile scan");
  add_count_option(*command, "--stations", scene.stations, "Number of stations");
  add_count_option(
      *command, "--facades", scene.facades,
      "Number of facades in which the first station's room has open windows (museum, townhouse, villa)");
  command->add_flag("--any-rotation", scene.any_rotation,
                    "Rotate the stations at random about all axes, not only about the vertical");
  command->add_option("--curtain-share SHARE", scene.curtain_share,
                      "Share of the windows with a drawn curtain or blind");
  add_length_option(*command, "--noise-m", scene.scanner.noise_m,
                    "Range noise, one standard deviation (default 0.003)");
  command->add_flag("--as-built", options->as_built,
                    "For a model: some elements moved by 1 to 5 cm, some missing, furniture added");
  command->add_flag("--as-drawn", options->as_drawn,
                    "The building exactly as drawn; by default its walls lean, and walls, slabs and openings "
                    "are off by millimetres to a centimetre");
  command
      ->add_option(
          "--room", options->room,
          "For a model: scan a room that is unique in it, or repeated, or each in turn, or doorways between "
          "rooms and then each room")
      ->one_of({"any", "unique", "repeated", "each", "doorways"});
  command->add_option("--units", options->units, "Unit of office's model.ifc")->one_of({"m", "mm"});
  add_length_option(*command, "--drift-m", scene.drift_m,
                    "Drift of the mobile scan's trajectory (default 0, with --project 0.008)");
  command->add_flag("--project", options->project,
                    fmt::format("Scan a whole building, one file for each station and each pass: {}",
                                fmt::join(whole_building_names(), ", ")));
  command->add_option("--passes N", options->passes, "With --project: street passes, each along two facades");
  command
      ->add_option("--outdoor", options->outdoor,
                   "Scan the street from a vehicle, or from a tripod before the first room's windows")
      ->one_of({"mobile", "static"});
  command->add_option("--as", options->as, "Format of stations: ply (default), or e57, each with a panorama")
      ->one_of({"ply", "e57"});
  command
      ->add_option(
          "--places", options->places,
          "With --project: some stations as usual, one per room, or as usual in every room and one more in "
          "every doorway, whatever --stations says")
      ->one_of({"usual", "rooms", "doorways"});
  command->add_option("--tripods N", options->tripods,
                      "With --project: number of stations outside, around the building (default 0)");
  command->add_option(
      "--targets N", options->targets,
      fmt::format(
          "With --project: number of targets in each scanned room, spheres of {0} mm radius and "
          "checkerboards of {1} mm side by turns; of a model: of such spheres in all, three to a room; "
          "control.csv has their surveyed centres (default 0)",
          1e3 * kSphereRadiusM, 1e3 * kBoardSideM));
  command->add_option(
      "--open-doors SHARE", options->open_doors,
      "With --project: share of the inner doors that are open (default 0.9; 1 with --places doorways)");
  command->add_option("--drift", options->drift, "With --project: kind of trajectory error of the passes")
      ->one_of({"waves", "walk"});
  command->add_flag("--styles", options->styles,
                    "With --project: random noise, density, field of view, tilt, origin, glass and people");
}

}  // namespace limen
