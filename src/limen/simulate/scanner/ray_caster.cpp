// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scanner/ray_caster.h"

#include <cmath>
#include <limits>
#include <optional>

#include <embree3/rtcore.h>

#include "limen/base/error.h"

namespace limen {
namespace {

void fill_buffers(RTCGeometry geometry, const Mesh& mesh) {
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices().size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles().size()));
  if (vertices == nullptr || indices == nullptr)
    throw Error("not enough memory for the simulated building", "ray caster", "ask for a smaller scene",
                Fault::internal);
  for (const Vector3d& vertex : mesh.vertices())
    for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(vertex[axis]);
  for (const auto& triangle : mesh.triangles())
    for (const std::uint32_t corner : triangle) *indices++ = corner;
}

/// The range to a wall that bulges by millimetres, from the range to its plane: a few steps of a fixed point.
/// Rays along the wall keep the plane's.
double range_on_bulge(const Surface& surface, const Vector3d& origin, const Vector3d& direction,
                      double range_m) {
  const double slope = surface.plane.normal.dot(direction);
  if (surface.bulge.height_m == 0.0 || std::abs(slope) < 0.05) return range_m;
  const double distance = surface.plane.signed_distance(origin);
  for (int step = 0; step < 6; ++step)
    range_m = (surface.bulge.at(origin + range_m * direction) - distance) / slope;
  return range_m;
}

/// How far off along the ray the ball is, and how steeply it is met, of the surface of `hit`; nothing where
/// the ray passes.
std::optional<RayHit> hit_on_ball(RayHit hit, const Ball& ball, const Vector3d& origin,
                                  const Vector3d& direction) {
  const double along = direction.dot(ball.centre - origin);
  const double off = (ball.centre - origin - along * direction).squaredNorm();
  if (off >= ball.radius_m * ball.radius_m) return std::nullopt;
  const double half_chord = std::sqrt(ball.radius_m * ball.radius_m - off);
  hit.range_m = along - half_chord;
  hit.cosine = half_chord / ball.radius_m;
  return hit.range_m > 0.0 ? std::optional(hit) : std::nullopt;
}

}  // namespace

struct RayCaster::Scene {
  const Mesh* mesh = nullptr;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(const Mesh& mesh) : scene_(std::make_unique<Scene>()) {
  scene_->mesh = &mesh;
  // One thread: only base/parallel may start others, and the tree is then the same on every run.
  scene_->device = rtcNewDevice("threads=1");
  if (scene_->device == nullptr)
    throw Error("the ray tracing library did not start", "ray caster", "check that Embree 3 is installed",
                Fault::internal);
  scene_->scene = rtcNewScene(scene_->device);
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  fill_buffers(geometry, mesh);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

const Mesh& RayCaster::mesh() const {
  return *scene_->mesh;
}

RayHit RayCaster::cast(const Vector3d& origin, const Vector3d& direction, double from_m) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(origin.x());
  query.ray.org_y = static_cast<float>(origin.y());
  query.ray.org_z = static_cast<float>(origin.z());
  query.ray.dir_x = static_cast<float>(direction.x());
  query.ray.dir_y = static_cast<float>(direction.y());
  query.ray.dir_z = static_cast<float>(direction.z());
  query.ray.tnear = static_cast<float>(from_m);
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = 0xFFFFFFFFU;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &context, &query);
  RayHit hit;
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;

  // The tree works in single precision: it only names the triangle. The range comes from the exact plane.
  const Mesh& mesh = *scene_->mesh;
  hit.surface = mesh.surface_of_triangle()[query.hit.primID];
  const Surface& surface = mesh.surfaces()[static_cast<std::size_t>(hit.surface)];
  Plane plane = surface.plane;
  if (!surface.planar) {
    const auto& corners = mesh.triangles()[query.hit.primID];
    const Vector3d& a = mesh.vertices()[corners[0]];
    plane.normal = (mesh.vertices()[corners[1]] - a).cross(mesh.vertices()[corners[2]] - a).normalized();
    plane.offset = plane.normal.dot(a);
  }
  const double slope = plane.normal.dot(direction);
  hit.cosine = std::abs(slope);
  hit.range_m = hit.cosine > 1e-6 ? -plane.signed_distance(origin) / slope : query.ray.tfar;
  hit.range_m = range_on_bulge(surface, origin, direction, hit.range_m);
  if (surface.ball.radius_m > 0.0) {
    if (const std::optional<RayHit> met = hit_on_ball(hit, surface.ball, origin, direction)) return *met;
    return cast(origin, direction, static_cast<double>(query.ray.tfar) + 1e-4);
  }
  if (slope > 0.0 && surface.back >= 0) hit.surface = surface.back;
  hit.inside = slope > 0.0 && surface.back < 0 && surface.planar;
  return hit;
}

}  // namespace limen
