// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/crs/map_projection.h"

#include <cmath>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/io/crs/coordinate_system.h"
#include "limen/io/crs/proj_library.h"

namespace limen {
namespace {

constexpr const char* kGeographic = "EPSG:4979";  // WGS 84: latitude, longitude, height above the ellipsoid
constexpr int kForward = 1;
constexpr int kInverse = -1;
constexpr double kStepRad = 1e-6;  // to the north, 6 m

}  // namespace

struct MapProjection::Parts {
  explicit Parts(const std::string& system) : target(system), transformation(owned(nullptr)) {}

  [[nodiscard]] Vector3d moved(const Vector3d& x, int direction) const {
    ProjCoordinate coordinate;
    for (std::size_t k = 0; k < 3; ++k) coordinate.v[k] = x[static_cast<Eigen::Index>(k)];
    // The time of the coordinates, in years: none is stated.
    coordinate.v[3] = HUGE_VAL;
    const ProjCoordinate result = proj_library()->trans(transformation.get(), direction, coordinate);
    return {result.v[0], result.v[1], result.v[2]};
  }

  ProjHandle target;
  ProjHandle::Object transformation;
  std::string name;
};

MapProjection::MapProjection(const std::string& system, const std::string& where) {
  const ProjLibrary* proj = proj_library();
  if (proj == nullptr)
    throw Error("converting latitude and longitude to this system needs PROJ, which was not found", where,
                "install PROJ (Debian: libproj25), or name a UTM zone, as 32N");
  const CoordinateSystem known = coordinate_system(system, where);
  parts_ = std::make_unique<Parts>(known.stated);
  parts_->name = words_of(known);
  ProjContext* context = parts_->target.context();
  const ProjHandle::Object geographic = owned(proj->create(context, kGeographic));
  const ProjHandle::Object plain =
      owned(geographic ? proj->create_crs_to_crs_from_pj(context, geographic.get(), parts_->target.get(),
                                                         nullptr, nullptr)
                       : nullptr);
  if (plain) parts_->transformation = owned(proj->normalize_for_visualization(context, plain.get()));
  if (!parts_->transformation)
    throw Error(fmt::format("PROJ cannot convert latitude and longitude to {}", parts_->name), where,
                "name another system");
}

MapProjection::~MapProjection() = default;
MapProjection::MapProjection(MapProjection&&) noexcept = default;
MapProjection& MapProjection::operator=(MapProjection&&) noexcept = default;

Vector3d MapProjection::to_map(double latitude_rad, double longitude_rad, double height_m) const {
  const Vector3d x = parts_->moved({degrees(longitude_rad), degrees(latitude_rad), height_m}, kForward);
  if (x.allFinite()) return x;
  throw Error(fmt::format("latitude {:.5f}, longitude {:.5f} degrees is outside {}", degrees(latitude_rad),
                          degrees(longitude_rad), parts_->name),
              "", "give the coordinate system of this area");
}

Vector3d MapProjection::from_map(const Vector3d& x) const {
  const Vector3d place = parts_->moved(x, kInverse);
  if (!place.allFinite())
    throw Error(
        fmt::format("({:.1f}, {:.1f}, {:.1f}) is not a position in {}", x.x(), x.y(), x.z(), parts_->name),
        "", "give the coordinate system of these coordinates");
  return {radians(place.y()), radians(place.x()), place.z()};
}

double MapProjection::convergence_rad(double latitude_rad, double longitude_rad, double height_m) const {
  const Vector3d south = to_map(latitude_rad - kStepRad, longitude_rad, height_m);
  const Vector3d north = to_map(latitude_rad + kStepRad, longitude_rad, height_m);
  return -std::atan2(north.x() - south.x(), north.y() - south.y());
}

}  // namespace limen
