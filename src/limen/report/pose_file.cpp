// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/pose_file.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/bounded_json.h"
#include "limen/files/mapped_file.h"
#include "limen/files/scan_in_file.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

/// Rows of six decimals, as some programs write them, still count as a rotation.
constexpr double kRigidTolerance = 5e-6;
constexpr const char* kRemedy = "give a result.json, or a text of four rows of four numbers";
/// No pose file is larger; a scan named by mistake must not be read whole.
constexpr std::uintmax_t kMostBytes = 256U << 20U;

std::string read_text(const fs::path& path) {
  std::error_code error;
  require_readable(path, kRemedy);
  if (fs::file_size(path, error) > kMostBytes)
    throw Error("is far too large for a pose", path.string(), kRemedy);
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  std::string text(without_byte_order_mark(bytes));
  if (!stream) throw Error("cannot be read", path.string(), "check its permissions");
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw Error("is empty", path.string(), kRemedy);
  return text;
}

Rigid3 rigid_from(const Matrix4d& matrix, const fs::path& path) {
  try {
    return from_matrix(matrix, kRigidTolerance);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    throw Error(error.problem(), path.string(), error.remedy());
  }
}

/// Four rows of four numbers; `where` names the key in messages.
Rigid3 pose_from(const Json& rows, const std::string& where, const fs::path& path) {
  const auto is_row = [](const Json& row) {
    if (!row.is_array() || row.size() != 4) return false;
    return std::all_of(row.begin(), row.end(), [](const Json& item) { return item.is_number(); });
  };
  if (!rows.is_array() || rows.size() != 4 || !std::all_of(rows.begin(), rows.end(), is_row)) {
    throw Error(fmt::format("{} is not four rows of four numbers", where), path.string(), kRemedy);
  }
  Matrix4d matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      matrix(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>();
    }
  }
  return rigid_from(matrix, path);
}

std::optional<Vector3d> vector_at(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) return std::nullopt;
  const Json& list = object[key];
  if (!list.is_array() || list.size() != 3) return std::nullopt;
  Vector3d vector;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!list[i].is_number()) return std::nullopt;
    vector[static_cast<Eigen::Index>(i)] = list[i].get<double>();
  }
  return vector;
}

std::optional<PoseSigma> sigma_at(const Json& object) {
  if (!object.contains("sigma")) return std::nullopt;
  const auto rotation = vector_at(object["sigma"], "rotation_rad");
  const auto translation = vector_at(object["sigma"], "translation_m");
  const auto centre = vector_at(object["sigma"], "centre");
  if (!rotation || !translation || !centre) return std::nullopt;
  return PoseSigma{*rotation, *translation, *centre};
}

std::optional<Outcome> outcome_at(const Json& object) {
  const auto found = object.find("outcome");
  if (found == object.end() || !found->is_string()) return std::nullopt;
  for (const Outcome outcome : {Outcome::registered, Outcome::probable, Outcome::ambiguous,
                                Outcome::under_constrained, Outcome::no_match}) {
    if (found->get<std::string>() == to_string(outcome)) return outcome;
  }
  return std::nullopt;
}

std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void take_inputs(const Json& object, PoseFile& pose) {
  const Json inputs = object.value("inputs", Json::object());
  if (!inputs.is_object()) return;
  const Json source = inputs.value("source", Json::object());
  const Json target = inputs.value("target", Json::object());
  if (source.is_object()) pose.source_path = text_at(source, "path");
  if (source.is_object()) pose.source_sha256 = text_at(source, "sha256");
  if (target.is_object()) pose.target_sha256 = text_at(target, "sha256");
  if (source.is_object()) pose.source_middle = vector_at(source, "middle");
  const auto unit_of = [](const Json& side) -> std::optional<double> {
    if (!side.is_object() || !side.contains("metres_per_unit")) return {};
    const Json& unit = side["metres_per_unit"];
    return unit.is_number() && unit.get<double>() > 0 ? std::optional(unit.get<double>()) : std::nullopt;
  };
  pose.source_metres_per_unit = unit_of(source);
  pose.target_metres_per_unit = unit_of(target);
  if (target.is_object()) pose.target_path = text_at(target, "path");
}

void take_alternatives(const Json& object, const fs::path& path, PoseFile& pose) {
  const Json list = object.value("alternatives", Json::array());
  if (!list.is_array()) return;
  for (const Json& item : list) {
    if (!item.is_object() || !item.contains("target_from_source")) continue;
    const std::string where = fmt::format("alternative {}", pose.alternatives.size() + 1);
    pose.alternatives.push_back(pose_from(item["target_from_source"], where, path));
  }
}

PoseFile pose_from_object(const Json& object, const fs::path& path) {
  PoseFile pose;
  pose.outcome = outcome_at(object);
  if (const auto found = object.find("probability"); found != object.end() && found->is_number())
    pose.probability = found->get<double>();
  pose.sigma = sigma_at(object);
  take_inputs(object, pose);
  take_alternatives(object, path, pose);
  for (const char* key : {"target_from_source", "transform"}) {
    if (!object.contains(key)) continue;
    const bool none = object[key].is_null() && pose.outcome == Outcome::no_match;
    if (!none) pose.target_from_source = pose_from(object[key], key, path);
    return pose;
  }
  throw Error("holds neither target_from_source nor transform", path.string(), kRemedy);
}

Rigid3 pose_from_text(const std::string& text, const fs::path& path) {
  const auto is_gap = [](char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == ';';
  };
  std::vector<double> numbers;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data();;) {
    while (at != end && is_gap(*at)) ++at;
    if (at == end) break;
    if (*at == '+') ++at;
    double number = 0.0;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (rest != end && !is_gap(*rest)) || numbers.size() == 16) {
      throw Error("is not a pose: expected 16 numbers and nothing else", path.string(), kRemedy);
    }
    numbers.push_back(number);
    at = rest;
  }
  if (numbers.size() != 16) {
    throw Error(fmt::format("holds {} numbers where a pose has 16", numbers.size()), path.string(), kRemedy);
  }
  return rigid_from(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data()), path);
}

/// The JSON object of a text that starts like one; nothing for other texts.
std::optional<Json> object_in(const std::string& text, const fs::path& path) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (text[first] != '{') return std::nullopt;
  try {
    return parsed_json<Json>(text);
  } catch (const std::exception&) {
    throw Error("is not valid JSON", path.string(), kRemedy);
  }
}

/// A scan of a truth as it is called there; its pose is not read yet.
TrueScan called(const Json& scan) {
  TrueScan stated;
  stated.file = text_at(scan, "file");
  stated.name = text_at(scan, "name");
  const auto index = scan.find("index");
  if (index != scan.end() && index->is_number_integer()) stated.index = index->get<int>();
  return stated;
}

std::optional<Rigid3> world_from(const Json& scan, const fs::path& path) {
  for (const char* key : {"world_from_scan", "to_world"}) {
    if (scan.contains(key)) return pose_from(scan[key], key, path);
  }
  return std::nullopt;
}

/// The pose of a scan, or of the model: that is where the world is.
Rigid3 world_from_input(const Json& truth, const std::string& scan_path, const fs::path& path) {
  const ScanInFile named = split_scan_name(scan_path);
  const fs::path wanted(named.file);
  const Json model = truth.value("model", Json());
  if (model.is_object() && text_at(model, "file") == wanted.filename()) return {};
  for (const Json& scan : truth["scans"]) {
    if (!scan.is_object() || !called(scan).is_of(wanted)) continue;
    if (named.index && static_cast<std::size_t>(called(scan).index) != *named.index) continue;
    if (const std::optional<Rigid3> pose = world_from(scan, path)) return *pose;
  }
  throw Error(fmt::format("holds no pose of the scan {}", wanted.filename().string()), path.string(),
              "give the truth of the scans that were registered");
}

}  // namespace

int TrueScan::names_shared_with(const fs::path& path) const {
  const fs::path own = file.empty() ? fs::path(name) : fs::path(file);
  if (own.filename() != path.filename() && fs::path(name).filename() != path.stem()) return 0;
  const fs::path mine = own.lexically_normal().parent_path();
  const fs::path theirs = path.lexically_normal().parent_path();
  int shared = 1;
  for (auto a = mine.end(), b = theirs.end(); a != mine.begin() && b != theirs.begin(); ++shared) {
    if (*--a != *--b) break;
  }
  return shared;
}

PoseFile read_pose_file(const fs::path& path) {
  const std::string text = read_text(path);
  if (const std::optional<Json> object = object_in(text, path)) return pose_from_object(*object, path);
  PoseFile pose;
  pose.target_from_source = pose_from_text(text, path);
  pose.of_numbers = true;
  return pose;
}

Rigid3 chosen_pose(const PoseFile& file, int choice, const fs::path& path) {
  if (choice > 0) {
    const auto index = static_cast<std::size_t>(choice) - 1;
    if (index < file.alternatives.size()) return file.alternatives[index];
    throw Error(fmt::format("holds {} alternative{}, not {}", file.alternatives.size(),
                            file.alternatives.size() == 1 ? "" : "s", choice),
                path.string(), "look at its alternatives and choose one of them by its number");
  }
  if (file.target_from_source) return *file.target_from_source;
  throw Error("holds no pose: no reliable overlap was found", path.string(),
              "give the result of a registration that found one");
}

std::vector<TrueScan> read_true_scans(const fs::path& path) {
  const std::optional<Json> object = object_in(read_text(path), path);
  if (!object || !object->contains("scans") || !(*object)["scans"].is_array())
    throw Error("holds no list of scans with poses", path.string(),
                "give the truth that limen simulate wrote, or an object with scans, each with file and "
                "world_from_scan");
  std::vector<TrueScan> scans;
  for (const Json& scan : (*object)["scans"]) {
    const std::optional<Rigid3> pose = scan.is_object() ? world_from(scan, path) : std::nullopt;
    if (!pose) continue;
    scans.push_back(called(scan));
    scans.back().world_from_scan = *pose;
    scans.back().scanner = vector_at(scan, "scanner");
  }
  return scans;
}

Rigid3 read_true_pose(const fs::path& path, const PoseFile& result) {
  const std::string text = read_text(path);
  const std::optional<Json> object = object_in(text, path);
  if (!object) {
    Rigid3 pose = pose_from_text(text, path);
    if (result.source_metres_per_unit == result.target_metres_per_unit)
      pose.translation *= result.source_metres_per_unit.value_or(1.0);
    return pose;
  }
  if (!object->contains("scans") || object->contains("transform") || object->contains("target_from_source")) {
    const PoseFile truth = pose_from_object(*object, path);
    if (!truth.target_from_source) throw Error("holds no pose", path.string(), "give the true pose");
    return *truth.target_from_source;
  }
  if (result.source_path.empty() || result.target_path.empty()) {
    throw Error("holds poses by scan, but the result does not say which scans it registered", path.string(),
                "give the result.json that limen register wrote");
  }
  return inverse(world_from_input(*object, result.target_path, path)) *
         world_from_input(*object, result.source_path, path);
}

}  // namespace limen
