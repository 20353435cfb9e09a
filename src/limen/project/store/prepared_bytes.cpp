// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/prepared_bytes.h"

#include "limen/project/store/features_bytes.h"
#include "limen/sight/model_space.h"
#include "limen/sight/panorama.h"
#include "limen/sight/voxel_map.h"

namespace limen {

void transfer(auto& bytes, Is<ScannerPlace> auto& place) {
  bytes(place.source, place.centre, place.confirmed, place.sigma_m, place.refuted);
  bytes.require(is_value(place.source, PlaceSource::per_point));
}

void transfer(auto& bytes, Is<SurfaceDetail> auto& detail) {
  bytes(detail.mean, detail.normal, detail.area_m2, detail.sigma_m);
}

/// All but its view of space, which comes last.
void transfer(auto& bytes, Is<PreparedScan> auto& scan) {
  bytes(scan.extracted.features, scan.upright_from_scan, scan.surroundings, scan.mobile, scan.upright,
        scan.surely_upright, scan.model, scan.rooms, scan.stations, scan.reach.min(), scan.reach.max(),
        scan.place, scan.details);
}

void transfer(auto& bytes, Is<PanoramaState> auto& state) {
  bytes(state.centre, state.edge, state.near_m, state.far_m, state.near_plane, state.far_plane);
}

void transfer(auto& bytes, Is<VoxelMapState> auto& state) {
  bytes(state.edge_m, state.low, state.size, state.free_bits);
}

void transfer(auto& bytes, Is<Rigid3> auto& pose) {
  bytes(pose.rotation, pose.translation);
}

void transfer(auto& bytes, Is<PoseSigma> auto& sigma) {
  bytes(sigma.rotation_rad, sigma.translation_m, sigma.centre, sigma.covariance);
}

void transfer(auto& bytes, Is<LookAlikeEvidence> auto& evidence) {
  bytes(evidence.rooms, evidence.otherwise, evidence.alike, evidence.things, evidence.agreeing,
        evidence.otherwise_nats, evidence.alike_nats, evidence.share_nats, evidence.built.one,
        evidence.built.look_alike, evidence.built.as_drawn);
}

void transfer(auto& bytes, Is<Hypothesis> auto& pose) {
  bytes(pose.target_from_source, pose.sigma, pose.probability, pose.score, pose.agreeing_m2,
        pose.contradicted_m2, pose.rms_m, pose.matched_planes, pose.matched_openings, pose.matched_segments,
        pose.agreeing_length_m, pose.explained_share, pose.room, pose.look_alike);
}

void transfer(auto& bytes, Is<UnobservedFreedom> auto& freedom) {
  bytes(freedom.rotation, freedom.direction, freedom.name);
}

void transfer(auto& bytes, Is<PlaneMatch> auto& match) {
  bytes(match.source, match.target, match.distance_m, match.angle_rad, match.overlap_m2);
}

void transfer(auto& bytes, Is<MatchedOpenings> auto& match) {
  bytes(match.source, match.target, match.shift_across_m, match.shift_up_m);
}

void transfer(auto& bytes, Is<MeasuredThickness> auto& wall) {
  bytes(wall.source_plane, wall.target_plane, wall.openings, wall.value_m, wall.sigma_m);
}

void transfer(auto& bytes, Is<OtherExplanations> auto& others) {
  bytes(others.nothing_shared, others.look_alike, others.unlisted_pose);
}

void transfer(auto& bytes, Is<RegistrationResult> auto& result) {
  bytes(result.outcome, result.reason, result.best, result.sigma, result.unobserved, result.alternatives,
        result.matches, result.moved, result.openings, result.thickness, result.judged_poses, result.rivals,
        result.others);
  bytes.require(is_value(result.outcome, Outcome::no_match));
}

namespace {

enum class SpaceKind : std::uint8_t { none, panorama, voxels, model };

void put_space(ByteWriter& writer, const SpaceView* space) {
  if (space == nullptr) {
    writer(SpaceKind::none);
  } else if (const auto* panorama = dynamic_cast<const Panorama*>(space)) {
    writer(SpaceKind::panorama, panorama->state());
  } else if (const auto* voxels = dynamic_cast<const VoxelMap*>(space)) {
    writer(SpaceKind::voxels, voxels->state());
  } else if (dynamic_cast<const ModelSpace*>(space) != nullptr) {
    writer(SpaceKind::model);
  } else {
    throw Error("this kind of view cannot be kept", "prepared scan", "keep its scans one by one",
                Fault::internal);
  }
}

std::shared_ptr<const SpaceView> get_space(ByteReader& reader, const Features& features) {
  SpaceKind kind = SpaceKind::none;
  reader(kind);
  switch (kind) {
    case SpaceKind::panorama: {
      PanoramaState state;
      reader(state);
      return std::make_unique<Panorama>(state, features);
    }
    case SpaceKind::voxels: {
      VoxelMapState state;
      reader(state);
      return std::make_unique<VoxelMap>(state, features);
    }
    case SpaceKind::model:
      return std::make_unique<ModelSpace>(features);
    case SpaceKind::none:
      break;
  }
  return nullptr;
}

}  // namespace

std::string bytes_of(const PreparedScan& prepared) {
  ByteWriter writer;
  writer(prepared);
  put_space(writer, prepared.space.get());
  return writer.bytes();
}

void require_prepared(std::string_view bytes, const std::string& where) {
  static_cast<void>(value_from<PreparedScan>(bytes, where));
}

PreparedScan prepared_from(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where);
  PreparedScan prepared;
  reader(prepared);
  if (prepared.model) prepared.runs = SampleRuns(prepared.extracted.features.samples);
  prepared.space = get_space(reader, prepared.extracted.features);
  return prepared;
}

std::string bytes_of(const RegistrationResult& result) {
  return bytes_of_all(result);
}

RegistrationResult result_from(std::string_view bytes, const std::string& where, const PairCounts& counts) {
  ByteReader reader(bytes, where);
  RegistrationResult result;
  reader(result);
  const FeatureCounts& source = counts.source;
  const FeatureCounts& target = counts.target;
  for (const std::vector<PlaneMatch>* matches : {&result.matches, &result.moved}) {
    for (const PlaneMatch& match : *matches)
      reader.require(is_place(match.source, source.planes) && is_place(match.target, target.planes));
  }
  for (const MatchedOpenings& match : result.openings)
    reader.require(is_place(match.source, source.openings) && is_place(match.target, target.openings));
  for (const MeasuredThickness& wall : result.thickness)
    reader.require(is_place(wall.source_plane, source.planes) && is_place(wall.target_plane, target.planes));
  return result;
}

}  // namespace limen
