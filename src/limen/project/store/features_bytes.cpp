// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/features_bytes.h"

namespace limen {
namespace {

void put_plane(ByteWriter& writer, const Plane& plane) {
  writer.put(plane.normal);
  writer.put(plane.offset);
}

Plane get_plane(ByteReader& reader) {
  Plane plane;
  reader.get(plane.normal);
  reader.get(plane.offset);
  return plane;
}

void put_frame(ByteWriter& writer, const PlaneFrame& frame) {
  writer.put(frame.origin);
  writer.put(frame.u);
  writer.put(frame.v);
}

PlaneFrame get_frame(ByteReader& reader) {
  PlaneFrame frame;
  reader.get(frame.origin);
  reader.get(frame.u);
  reader.get(frame.v);
  return frame;
}

void put_polygon(ByteWriter& writer, const Polygon& polygon) {
  writer.put_all(polygon.outer);
  writer.put_count(polygon.holes.size());
  for (const Ring& hole : polygon.holes) writer.put_all(hole);
}

Polygon get_polygon(ByteReader& reader) {
  Polygon polygon;
  polygon.outer = reader.get_all<Vector2d>();
  polygon.holes.resize(reader.get_count(8));
  for (Ring& hole : polygon.holes) hole = reader.get_all<Vector2d>();
  return polygon;
}

void put_planar(ByteWriter& writer, const PlanarPolygon& polygon) {
  put_plane(writer, polygon.plane);
  put_frame(writer, polygon.frame);
  writer.put_count(polygon.parts.size());
  for (const Polygon& part : polygon.parts) put_polygon(writer, part);
  writer.put_count(polygon.inliers);
  writer.put(polygon.rms_m);
  writer.put(polygon.area_m2);
  writer.put(polygon.centroid);
  writer.put(polygon.oriented);
  writer.put(polygon.interior);
}

PlanarPolygon get_planar(ByteReader& reader) {
  PlanarPolygon polygon;
  polygon.plane = get_plane(reader);
  polygon.frame = get_frame(reader);
  polygon.parts.resize(reader.get_count(16));
  for (Polygon& part : polygon.parts) part = get_polygon(reader);
  polygon.inliers = reader.get<std::uint64_t>();
  reader.get(polygon.rms_m);
  reader.get(polygon.area_m2);
  reader.get(polygon.centroid);
  reader.get(polygon.oriented);
  reader.get(polygon.interior);
  return polygon;
}

void put_opening(ByteWriter& writer, const Opening& opening) {
  for (const Vector3d& corner : opening.corners) writer.put(corner);
  writer.put(opening.facade);
  writer.put_count(opening.evidence);
  writer.put(opening.view);
  for (const double sigma : opening.edge_sigma_m) writer.put(sigma);
  writer.put(opening.reveal_depth_m);
  writer.put(opening.reveal_sigma_m);
  writer.put(opening.reveal_complete);
  writer.put_all(opening.outline);
}

Opening get_opening(ByteReader& reader, std::size_t planes) {
  Opening opening;
  for (Vector3d& corner : opening.corners) reader.get(corner);
  reader.get_index(opening.facade, planes, true);
  opening.evidence = reader.get<std::uint64_t>();
  reader.get_enum(opening.view, OpeningView::hole);
  for (double& sigma : opening.edge_sigma_m) reader.get(sigma);
  reader.get(opening.reveal_depth_m);
  reader.get(opening.reveal_sigma_m);
  reader.get(opening.reveal_complete);
  opening.outline = reader.get_all<Vector3d>();
  return opening;
}

void put_sample(ByteWriter& writer, const SurfaceSample& sample) {
  writer.put(sample.mean);
  writer.put(sample.normal);
  writer.put(sample.plane);
  writer.put(sample.area_m2);
  writer.put(sample.count);
}

SurfaceSample get_sample(ByteReader& reader, std::size_t planes) {
  SurfaceSample sample;
  reader.get(sample.mean);
  reader.get(sample.normal);
  reader.get_index(sample.plane, planes, true);
  reader.get(sample.area_m2);
  reader.get(sample.count);
  return sample;
}

constexpr std::size_t kLeastPlane = 144;  // bytes, 18 numbers
constexpr std::size_t kLeastOpening = 160;
constexpr std::size_t kLeastSample = 48;

}  // namespace

void put_features(ByteWriter& writer, const Features& features) {
  writer.put(features.local_origin);
  writer.put_count(features.planes.size());
  for (const PlanarPolygon& plane : features.planes) put_planar(writer, plane);
  writer.put_count(features.openings.size());
  for (const Opening& opening : features.openings) put_opening(writer, opening);
  writer.put_count(features.segments.size());
  for (const Segment& segment : features.segments) {
    writer.put(segment.a);
    writer.put(segment.b);
  }
  writer.put_count(features.samples.size());
  for (const SurfaceSample& sample : features.samples) put_sample(writer, sample);
  writer.put(features.inlier_threshold_m);
  writer.put(features.noise_m);
  writer.put(features.drift_m);
}

Features get_features(ByteReader& reader) {
  Features features;
  reader.get(features.local_origin);
  features.planes.resize(reader.get_count(kLeastPlane));
  for (PlanarPolygon& plane : features.planes) plane = get_planar(reader);
  features.openings.resize(reader.get_count(kLeastOpening));
  for (Opening& opening : features.openings) opening = get_opening(reader, features.planes.size());
  features.segments.resize(reader.get_count(48));
  for (Segment& segment : features.segments) {
    reader.get(segment.a);
    reader.get(segment.b);
  }
  features.samples.resize(reader.get_count(kLeastSample));
  for (SurfaceSample& sample : features.samples) sample = get_sample(reader, features.planes.size());
  reader.get(features.inlier_threshold_m);
  reader.get(features.noise_m);
  reader.get(features.drift_m);
  return features;
}

void put_rooms(ByteWriter& writer, const std::vector<BimSpace>& rooms) {
  writer.put_count(rooms.size());
  for (const BimSpace& room : rooms) {
    writer.put(room.guid);
    writer.put(room.name);
    writer.put(room.storey);
    writer.put_count(room.faces.size());
    for (const BimFace& face : room.faces) {
      put_plane(writer, face.plane);
      put_frame(writer, face.frame);
      put_polygon(writer, face.outline);
      writer.put(face.area_m2);
      writer.put(face.element);
    }
  }
}

std::vector<BimSpace> get_rooms(ByteReader& reader) {
  std::vector<BimSpace> rooms(reader.get_count(32));
  for (BimSpace& room : rooms) {
    reader.get(room.guid);
    reader.get(room.name);
    reader.get(room.storey);
    room.faces.resize(reader.get_count(112));
    for (BimFace& face : room.faces) {
      face.plane = get_plane(reader);
      face.frame = get_frame(reader);
      face.outline = get_polygon(reader);
      reader.get(face.area_m2);
      reader.get(face.element);
    }
  }
  return rooms;
}

}  // namespace limen
