// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/scan_digest.h"

#include "limen/project/store/byte_stream.h"

namespace limen {

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

void put_moments(ByteWriter& writer, const PointMoments& moments) {
  writer.put(moments.count);
  writer.put(moments.sum);
  writer.put(moments.outer);
}
void get_moments(ByteReader& reader, PointMoments& moments) {
  reader.get(moments.count);
  reader.get(moments.sum);
  reader.get(moments.outer);
}

void put_track(ByteWriter& writer, const PassTrack& track) {
  writer.put_all(track.way.times_s);
  writer.put_all(track.way.distances_m);
  writer.put_all(track.way.places);
  writer.put_count(track.strips.size());
  for (const PassStrip& strip : track.strips) {
    writer.put(strip.plane);
    writer.put(strip.place);
    writer.put(strip.anchor);
    put_moments(writer, strip.moments);
  }
}
PassTrack get_track(ByteReader& reader, std::size_t planes) {
  PassTrack track;
  track.way.times_s = reader.get_all<double>();
  track.way.distances_m = reader.get_all<double>();
  track.way.places = reader.get_all<Vector3d>();
  reader.require(track.way.distances_m.size() == track.way.times_s.size() &&
                 track.way.places.size() == track.way.times_s.size());
  track.strips.resize(reader.get_count(140));
  for (PassStrip& strip : track.strips) {
    reader.get_index(strip.plane, planes);
    reader.get(strip.place);
    reader.get(strip.anchor);
    get_moments(reader, strip.moments);
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
  ByteWriter writer;
  writer.put(digest.local_origin);
  for (const bool flag : {digest.mobile, digest.upright, digest.surely_upright, digest.model})
    writer.put(flag);
  writer.put(digest.upright_from_scan);
  writer.put_all(digest.stations);
  writer.put(digest.middle);
  writer.put(digest.noise_m);
  writer.put(digest.drift_m);
  writer.put_count(digest.planes.size());
  for (const PlaneDigest& plane : digest.planes) {
    writer.put(plane.plane.normal);
    writer.put(plane.plane.offset);
    writer.put(plane.centroid);
    writer.put(plane.area_m2);
    writer.put(plane.oriented);
    writer.put(plane.interior);
    put_moments(writer, plane.moments);
  }
  writer.put_all(digest.openings);
  put_track(writer, digest.track);
  return writer.bytes();
}

ScanDigest digest_from(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where);
  ScanDigest digest;
  reader.get(digest.local_origin);
  for (bool* flag : {&digest.mobile, &digest.upright, &digest.surely_upright, &digest.model})
    reader.get(*flag);
  reader.get(digest.upright_from_scan);
  digest.stations = reader.get_all<Vector3d>();
  reader.get(digest.middle);
  reader.get(digest.noise_m);
  reader.get(digest.drift_m);
  digest.planes.resize(reader.get_count(168));
  for (PlaneDigest& plane : digest.planes) {
    reader.get(plane.plane.normal);
    reader.get(plane.plane.offset);
    reader.get(plane.centroid);
    reader.get(plane.area_m2);
    reader.get(plane.oriented);
    reader.get(plane.interior);
    get_moments(reader, plane.moments);
  }
  digest.openings = reader.get_all<Vector2d>();
  digest.track = get_track(reader, digest.planes.size());
  return digest;
}

}  // namespace limen
