// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/prepared_bytes.h"

#include "limen/project/store/features_bytes.h"
#include "limen/sight/model_space.h"
#include "limen/sight/panorama.h"
#include "limen/sight/voxel_map.h"

namespace limen {
namespace {

enum class SpaceKind : std::uint8_t { none, panorama, voxels, model };

void put_space(ByteWriter& writer, const SpaceView* space) {
  if (space == nullptr) {
    writer.put(SpaceKind::none);
  } else if (const auto* panorama = dynamic_cast<const Panorama*>(space)) {
    const PanoramaState state = panorama->state();
    writer.put(SpaceKind::panorama);
    writer.put(state.centre);
    writer.put(state.edge);
    writer.put_all(state.near_m);
    writer.put_all(state.far_m);
    writer.put_all(state.near_plane);
    writer.put_all(state.far_plane);
  } else if (const auto* voxels = dynamic_cast<const VoxelMap*>(space)) {
    const VoxelMapState state = voxels->state();
    writer.put(SpaceKind::voxels);
    writer.put(state.edge_m);
    writer.put(state.low);
    for (const std::int32_t size : state.size) writer.put(size);
    writer.put_all(state.free_bits);
  } else if (dynamic_cast<const ModelSpace*>(space) != nullptr) {
    writer.put(SpaceKind::model);
  } else {
    throw Error("this kind of view cannot be kept", "prepared scan", "keep its scans one by one",
                Fault::internal);
  }
}

std::shared_ptr<const SpaceView> get_space(ByteReader& reader, const Features& features) {
  switch (reader.get<SpaceKind>()) {
    case SpaceKind::panorama: {
      PanoramaState state;
      reader.get(state.centre);
      reader.get(state.edge);
      state.near_m = reader.get_all<float>();
      state.far_m = reader.get_all<float>();
      state.near_plane = reader.get_all<std::int32_t>();
      state.far_plane = reader.get_all<std::int32_t>();
      return std::make_unique<Panorama>(state, features);
    }
    case SpaceKind::voxels: {
      VoxelMapState state;
      reader.get(state.edge_m);
      reader.get(state.low);
      for (std::int32_t& size : state.size) reader.get(size);
      state.free_bits = reader.get_all<std::uint8_t>();
      return std::make_unique<VoxelMap>(state, features);
    }
    case SpaceKind::model:
      return std::make_unique<ModelSpace>(features);
    case SpaceKind::none:
      break;
  }
  return nullptr;
}

void put_place(ByteWriter& writer, const ScannerPlace& place) {
  writer.put(place.source);
  writer.put(place.centre);
  writer.put(place.confirmed);
  writer.put(place.sigma_m.value_or(-1.0));
  writer.put(place.refuted.has_value());
  writer.put(place.refuted.value_or(Vector3d::Zero()));
}

ScannerPlace get_place(ByteReader& reader) {
  ScannerPlace place;
  reader.get_enum(place.source, PlaceSource::per_point);
  reader.get(place.centre);
  reader.get(place.confirmed);
  const auto sigma = reader.get<double>();
  if (sigma >= 0) place.sigma_m = sigma;
  const auto refuted = reader.get<bool>();
  const auto at = reader.get<Vector3d>();
  if (refuted) place.refuted = at;
  return place;
}

void put_sigma(ByteWriter& writer, const PoseSigma& sigma) {
  writer.put(sigma.rotation_rad);
  writer.put(sigma.translation_m);
  writer.put(sigma.centre);
  writer.put(sigma.covariance);
}

PoseSigma get_sigma(ByteReader& reader) {
  PoseSigma sigma;
  reader.get(sigma.rotation_rad);
  reader.get(sigma.translation_m);
  reader.get(sigma.centre);
  reader.get(sigma.covariance);
  return sigma;
}

void put_look_alike(ByteWriter& writer, const std::optional<LookAlikeEvidence>& said) {
  writer.put(said.has_value());
  const LookAlikeEvidence look_alike = said.value_or(LookAlikeEvidence{});
  writer.put(look_alike.rooms);
  for (const double stated : {look_alike.otherwise, look_alike.alike, look_alike.things, look_alike.agreeing})
    writer.put(stated);
  for (const NatsOfThings& nats : {look_alike.otherwise_nats, look_alike.alike_nats, look_alike.share_nats})
    for (const double level : nats) writer.put(level);
  for (const auto& levels : {look_alike.built.one, look_alike.built.look_alike, look_alike.built.as_drawn})
    for (const double log : levels) writer.put(log);
}

std::optional<LookAlikeEvidence> get_look_alike(ByteReader& reader) {
  const bool asked = reader.get<bool>();
  LookAlikeEvidence look_alike;
  look_alike.rooms = reader.get<bool>();
  for (double* value : {&look_alike.otherwise, &look_alike.alike, &look_alike.things, &look_alike.agreeing})
    reader.get(*value);
  for (NatsOfThings* nats : {&look_alike.otherwise_nats, &look_alike.alike_nats, &look_alike.share_nats})
    for (double& level : *nats) reader.get(level);
  for (auto* levels : {&look_alike.built.one, &look_alike.built.look_alike, &look_alike.built.as_drawn})
    for (double& log : *levels) reader.get(log);
  return asked ? std::optional(look_alike) : std::nullopt;
}

void put_pose(ByteWriter& writer, const Hypothesis& pose) {
  writer.put(pose.target_from_source.rotation);
  writer.put(pose.target_from_source.translation);
  put_sigma(writer, pose.sigma);
  writer.put(pose.probability.value_or(-1.0));
  for (const double value : {pose.score, pose.agreeing_m2, pose.contradicted_m2, pose.rms_m})
    writer.put(value);
  for (const int count : {pose.matched_planes, pose.matched_openings, pose.matched_segments})
    writer.put(count);
  writer.put(pose.agreeing_length_m);
  writer.put(pose.explained_share.value_or(-1.0));
  writer.put(pose.room);
  put_look_alike(writer, pose.look_alike);
}

Hypothesis get_pose(ByteReader& reader) {
  Hypothesis pose;
  reader.get(pose.target_from_source.rotation);
  reader.get(pose.target_from_source.translation);
  pose.sigma = get_sigma(reader);
  const auto probability = reader.get<double>();
  if (probability >= 0) pose.probability = probability;
  for (double* value : {&pose.score, &pose.agreeing_m2, &pose.contradicted_m2, &pose.rms_m})
    reader.get(*value);
  for (int* count : {&pose.matched_planes, &pose.matched_openings, &pose.matched_segments})
    reader.get(*count);
  reader.get(pose.agreeing_length_m);
  const auto share = reader.get<double>();
  if (share >= 0) pose.explained_share = share;
  reader.get(pose.room);
  pose.look_alike = get_look_alike(reader);
  return pose;
}

constexpr std::size_t kLeastDetail = 56;  // bytes
constexpr std::size_t kLeastPose = 521;   // bytes, 65 numbers and a flag

void put_matches(ByteWriter& writer, const RegistrationResult& result) {
  writer.put_count(result.matches.size());
  for (const PlaneMatch& match : result.matches) {
    writer.put(match.source);
    writer.put(match.target);
    writer.put(match.distance_m);
    writer.put(match.angle_rad);
    writer.put(match.overlap_m2);
  }
  writer.put_count(result.openings.size());
  for (const MatchedOpenings& match : result.openings) {
    writer.put(match.source);
    writer.put(match.target);
    writer.put(match.shift_across_m);
    writer.put(match.shift_up_m);
  }
  writer.put_count(result.thickness.size());
  for (const MeasuredThickness& wall : result.thickness) {
    writer.put(wall.source_plane);
    writer.put(wall.target_plane);
    writer.put(wall.openings);
    writer.put(wall.value_m);
    writer.put(wall.sigma_m);
  }
}

void get_matches(ByteReader& reader, const PairCounts& counts, RegistrationResult& result) {
  result.matches.resize(reader.get_count(32));
  for (PlaneMatch& match : result.matches) {
    reader.get_index(match.source, counts.source.planes);
    reader.get_index(match.target, counts.target.planes);
    reader.get(match.distance_m);
    reader.get(match.angle_rad);
    reader.get(match.overlap_m2);
  }
  result.openings.resize(reader.get_count(24));
  for (MatchedOpenings& match : result.openings) {
    reader.get_index(match.source, counts.source.openings);
    reader.get_index(match.target, counts.target.openings);
    reader.get(match.shift_across_m);
    reader.get(match.shift_up_m);
  }
  result.thickness.resize(reader.get_count(28));
  for (MeasuredThickness& wall : result.thickness) {
    reader.get_index(wall.source_plane, counts.source.planes);
    reader.get_index(wall.target_plane, counts.target.planes);
    reader.get(wall.openings);
    reader.get(wall.value_m);
    reader.get(wall.sigma_m);
  }
}

void put_details(ByteWriter& writer, const std::vector<SurfaceDetail>& details) {
  writer.put_count(details.size());
  for (const SurfaceDetail& detail : details) {
    writer.put(detail.mean);
    writer.put(detail.normal);
    writer.put(detail.area_m2);
    writer.put(detail.sigma_m);
  }
}

std::vector<SurfaceDetail> get_details(ByteReader& reader) {
  std::vector<SurfaceDetail> details(reader.get_count(kLeastDetail));
  for (SurfaceDetail& detail : details) {
    reader.get(detail.mean);
    reader.get(detail.normal);
    reader.get(detail.area_m2);
    reader.get(detail.sigma_m);
  }
  return details;
}

}  // namespace

std::string bytes_of(const PreparedScan& prepared) {
  ByteWriter writer;
  put_features(writer, prepared.extracted.features);
  writer.put(prepared.upright_from_scan);
  writer.put(prepared.surroundings);
  for (const bool flag : {prepared.mobile, prepared.upright, prepared.surely_upright, prepared.model})
    writer.put(flag);
  put_rooms(writer, prepared.rooms);
  writer.put_all(prepared.stations);
  writer.put(Vector3d(prepared.reach.min()));
  writer.put(Vector3d(prepared.reach.max()));
  put_place(writer, prepared.place);
  put_details(writer, prepared.details);
  put_space(writer, prepared.space.get());
  return writer.bytes();
}

namespace {

/// All but its view of space, which comes last.
PreparedScan without_space(ByteReader& reader) {
  PreparedScan prepared;
  prepared.extracted.features = get_features(reader);
  reader.get(prepared.upright_from_scan);
  reader.get(prepared.surroundings);
  for (bool* flag : {&prepared.mobile, &prepared.upright, &prepared.surely_upright, &prepared.model})
    reader.get(*flag);
  prepared.rooms = get_rooms(reader);
  prepared.stations = reader.get_all<Vector3d>();
  reader.get(prepared.reach.min());
  reader.get(prepared.reach.max());
  prepared.place = get_place(reader);
  prepared.details = get_details(reader);
  return prepared;
}

}  // namespace

void require_prepared(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where);
  static_cast<void>(without_space(reader));
}

PreparedScan prepared_from(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where);
  PreparedScan prepared = without_space(reader);
  if (prepared.model) prepared.runs = SampleRuns(prepared.extracted.features.samples);
  prepared.space = get_space(reader, prepared.extracted.features);
  return prepared;
}

std::string bytes_of(const RegistrationResult& result) {
  ByteWriter writer;
  writer.put(result.outcome);
  writer.put(result.reason);
  put_pose(writer, result.best);
  put_sigma(writer, result.sigma);
  writer.put_count(result.unobserved.size());
  for (const UnobservedFreedom& freedom : result.unobserved) {
    writer.put(freedom.rotation);
    writer.put(freedom.direction);
    writer.put(freedom.name);
  }
  writer.put_count(result.alternatives.size());
  for (const Hypothesis& pose : result.alternatives) put_pose(writer, pose);
  put_matches(writer, result);
  writer.put_count(result.judged_poses);
  writer.put_count(result.rivals);
  writer.put(result.others.has_value());
  const OtherExplanations others = result.others.value_or(OtherExplanations{});
  for (const double probability : {others.nothing_shared, others.look_alike, others.unlisted_pose})
    writer.put(probability);
  return writer.bytes();
}

RegistrationResult result_from(std::string_view bytes, const std::string& where, const PairCounts& counts) {
  ByteReader reader(bytes, where);
  RegistrationResult result;
  reader.get_enum(result.outcome, Outcome::no_match);
  reader.get(result.reason);
  result.best = get_pose(reader);
  result.sigma = get_sigma(reader);
  result.unobserved.resize(reader.get_count(33));
  for (UnobservedFreedom& freedom : result.unobserved) {
    reader.get(freedom.rotation);
    reader.get(freedom.direction);
    reader.get(freedom.name);
  }
  result.alternatives.resize(reader.get_count(kLeastPose));
  for (Hypothesis& pose : result.alternatives) pose = get_pose(reader);
  get_matches(reader, counts, result);
  result.judged_poses = reader.get<std::uint64_t>();
  result.rivals = reader.get<std::uint64_t>();
  const bool others = reader.get<bool>();
  OtherExplanations stated;
  for (double* probability : {&stated.nothing_shared, &stated.look_alike, &stated.unlisted_pose})
    reader.get(*probability);
  if (others) result.others = stated;
  return result;
}

}  // namespace limen
