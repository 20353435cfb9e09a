// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/scan_digest.h"

#include "limen/project/store/features_bytes.h"

namespace limen {

void transfer(auto& bytes, Is<PointMoments> auto& moments) {
  bytes(moments.count, moments.sum, moments.outer);
}

void transfer(auto& bytes, Is<PassStrip> auto& strip) {
  bytes(strip.plane, strip.place, strip.anchor, strip.moments);
}

void transfer(auto& bytes, Is<PlaneDigest> auto& plane) {
  bytes(plane.plane, plane.centroid, plane.area_m2, plane.oriented, plane.interior, plane.moments);
}

void transfer(auto& bytes, Is<ScanDigest> auto& digest) {
  auto& way = digest.track.way;
  bytes(digest.local_origin, digest.mobile, digest.upright, digest.surely_upright, digest.model,
        digest.upright_from_scan, digest.stations, digest.middle, digest.noise_m, digest.drift_m,
        digest.planes, digest.openings, way.times_s, way.distances_m, way.places, digest.track.strips);
  bytes.require(way.distances_m.size() == way.times_s.size() && way.places.size() == way.times_s.size());
  for (const PassStrip& strip : digest.track.strips)
    bytes.require(is_place(strip.plane, digest.planes.size()));
}

namespace {

/// The same about a point near the middle of what was seen: turns about a far origin are shifts as well.
void recentre(ScanDigest& digest) {
  const Vector3d shift = digest.middle.array().round();
  digest.local_origin += shift;
  digest.middle -= shift;
  for (Vector3d& station : digest.stations) station -= shift;
  for (PlaneDigest& plane : digest.planes) {
    plane.plane = shifted(plane.plane, shift);
    plane.centroid -= shift;
  }
  for (Vector3d& place : digest.track.way.places) place -= shift;
  for (PassStrip& strip : digest.track.strips) strip.anchor -= shift;
}

/// The track in the scan's own axes.
PassTrack turned(PassTrack track, const Matrix3d& back) {
  for (Vector3d& place : track.way.places) place = back * place;
  for (PassStrip& strip : track.strips) {
    strip.anchor = back * strip.anchor;
    strip.moments.sum = back * strip.moments.sum;
    strip.moments.outer = back * strip.moments.outer * back.transpose();
  }
  return track;
}

}  // namespace

ScanDigest digest_of(const PreparedScan& prepared) {
  const Features& features = prepared.extracted.features;
  const Matrix3d back = prepared.upright_from_scan.transpose();
  ScanDigest digest;
  digest.local_origin = features.local_origin;
  digest.mobile = prepared.mobile;
  digest.upright = prepared.upright;
  digest.surely_upright = prepared.surely_upright;
  digest.model = prepared.model;
  digest.upright_from_scan = prepared.upright_from_scan;
  for (const Vector3d& station : prepared.stations) digest.stations.emplace_back(back * station);
  digest.noise_m = features.noise_m;
  digest.drift_m = features.drift_m;
  for (const PlanarPolygon& plane : features.planes) {
    PlaneDigest kept;
    kept.plane = {back * plane.plane.normal, plane.plane.offset};
    kept.centroid = back * plane.centroid;
    kept.area_m2 = plane.area_m2;
    kept.oriented = plane.oriented;
    kept.interior = plane.interior;
    digest.planes.push_back(kept);
  }
  Vector3d sum = Vector3d::Zero();
  for (const SurfaceSample& sample : features.samples) {
    const Vector3d mean = back * sample.mean;
    sum += mean;
    if (sample.plane < 0) continue;
    PlaneDigest& plane = digest.planes[static_cast<std::size_t>(sample.plane)];
    plane.moments.add(mean - plane.centroid);
  }
  if (!features.samples.empty()) digest.middle = sum / static_cast<double>(features.samples.size());
  digest.track = turned(prepared.track.way.known() ? prepared.track : find_static_track(features), back);
  recentre(digest);
  for (const Opening& opening : features.openings) {
    digest.openings.emplace_back((opening.corners[1] - opening.corners[0]).norm(),
                                 (opening.corners[3] - opening.corners[0]).norm());
  }
  return digest;
}

std::string bytes_of(const ScanDigest& digest) {
  return bytes_of_all(digest);
}

ScanDigest digest_from(std::string_view bytes, const std::string& where) {
  return value_from<ScanDigest>(bytes, where);
}

}  // namespace limen
