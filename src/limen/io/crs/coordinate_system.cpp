// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/crs/coordinate_system.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/io/crs/proj_library.h"
#include "limen/io/las/las_unit.h"

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

namespace {

// PROJ's numbers of the forms of well-known text, and of what counts as equal.
constexpr int kWkt1 = 4;
constexpr int kWkt2 = 2;
constexpr int kEquivalent = 1;

/// "EPSG:2154", whatever its letters; empty: the text is no code.
std::string code_in(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || lower_case(text.substr(0, colon)) != "epsg") return {};
  const std::string digits = text.substr(colon + 1);
  const bool number =
      !digits.empty() && digits.size() < 8 &&
      std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return number ? "EPSG:" + digits : std::string();
}

bool is_wkt(const std::string& text) {
  const std::size_t open = text.find_first_of("[(");
  return open != std::string::npos && open > 2 &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(open),
                     [](unsigned char c) { return std::isupper(c) != 0 || c == '_' || c == ' '; });
}

/// Words in the first quotation marks.
std::string first_quoted(const std::string& text) {
  const std::size_t open = text.find('"');
  const std::size_t close = open == std::string::npos ? open : text.find('"', open + 1);
  return close == std::string::npos ? std::string() : text.substr(open + 1, close - open - 1);
}

/// The system's own EPSG number: the last thing in a text, AUTHORITY["EPSG","2154"]] or ID["EPSG",2154]].
std::string last_code(const std::string& wkt) {
  const std::size_t at = std::max(wkt.rfind("AUTHORITY[") == std::string::npos ? 0 : wkt.rfind("AUTHORITY["),
                                  wkt.rfind("ID[") == std::string::npos ? 0 : wkt.rfind("ID["));
  if (at == 0) return {};
  const std::string rest = wkt.substr(at);
  // Nothing but the brackets that close everything may follow.
  const std::size_t close = rest.find(']');
  if (close == std::string::npos || rest.find_first_not_of("] \r\n", close) != std::string::npos) return {};
  const std::size_t epsg = rest.find("\"EPSG\"");
  if (epsg == std::string::npos || epsg > close) return {};
  std::string digits;
  for (std::size_t k = epsg + 6; k < close; ++k) {
    if (std::isdigit(static_cast<unsigned char>(rest[k])) != 0) digits += rest[k];
  }
  return digits.empty() ? std::string() : "EPSG:" + digits;
}

std::string text_of_proj(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

/// What PROJ knows; empty where it does not know the text.
std::optional<CoordinateSystem> by_proj(const std::string& text) {
  const ProjLibrary* proj = proj_library();
  if (proj == nullptr) return {};
  const ProjHandle handle(text);
  if (handle.get() == nullptr || proj->is_crs(handle.get()) == 0) return {};
  CoordinateSystem system;
  system.stated = text;
  system.name = text_of_proj(proj->get_name(handle.get()));
  const std::string authority = text_of_proj(proj->get_id_auth_name(handle.get(), 0));
  if (authority == "EPSG") system.code = "EPSG:" + text_of_proj(proj->get_id_code(handle.get(), 0));
  const char* const on_one_line[] = {"MULTILINE=NO", nullptr};
  system.wkt = text_of_proj(proj->as_wkt(handle.context(), handle.get(), kWkt1, on_one_line));
  if (system.wkt.empty())
    system.wkt = text_of_proj(proj->as_wkt(handle.context(), handle.get(), kWkt2, on_one_line));
  return system;
}

/// What the text itself says.
CoordinateSystem by_text(const std::string& text) {
  CoordinateSystem system;
  system.stated = text;
  system.code = code_in(text);
  if (!is_wkt(text)) return system;
  system.wkt = text;
  system.name = first_quoted(text);
  system.code = last_code(text);
  return system;
}

bool has_word(const std::string& wkt, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view it) { return wkt.find(it) != std::string::npos; });
}

/// Coordinates are written in metres on a plane: a system of degrees or feet would name other numbers.
void require_metres(const CoordinateSystem& system, const std::string& where) {
  const bool plane =
      has_word(system.wkt, {"PROJCS", "PROJCRS", "PROJECTEDCRS", "LOCAL_CS", "ENGCRS", "ENGINEERINGCRS"});
  if (!plane)
    throw Error(
        fmt::format("{} is not a projected coordinate system with eastings and northings", words_of(system)),
        where, "name a projected system, as EPSG:2154 or EPSG:25832");
  const std::optional<double> unit = wkt_metres_per_unit(system.wkt);
  if (unit && std::abs(*unit - 1.0) > 1e-9)
    throw Error(fmt::format("{} has units of {:g} m, and limen writes metres", words_of(system), *unit),
                where, "name a system in metres");
}

ProjHandle::Object on_the_ground(const ProjHandle& handle) {
  return owned(proj_library()->get_sub_crs(handle.context(), handle.get(), 0));
}

}  // namespace

CoordinateSystem stated_system(const std::string& text) {
  const std::string plain(trimmed(text));
  if (std::optional<CoordinateSystem> known = by_proj(plain)) return *known;
  return by_text(plain);
}

CoordinateSystem coordinate_system(const std::string& text, const std::string& where) {
  const std::string plain(trimmed(text));
  const bool form = !code_in(plain).empty() || is_wkt(plain) || (!plain.empty() && plain.front() == '{');
  if (!form)
    throw Error(fmt::format("\"{:.60}\" names no coordinate system", plain), where,
                "write EPSG:NUMBER, well-known text (WKT) or PROJJSON");
  CoordinateSystem system = stated_system(plain);
  if (proj_library() != nullptr && system.wkt.empty())
    throw Error(fmt::format("\"{:.60}\" is not a coordinate system that PROJ knows", plain), where,
                "check the number or the text");
  if (system.wkt.empty())
    throw Error(fmt::format("{:.60} needs the database of PROJ, which was not found", plain), where,
                "install PROJ (Debian: libproj25), or give the system as well-known text (WKT)");
  require_metres(system, where);
  return system;
}

bool same_system(const CoordinateSystem& a, const CoordinateSystem& b) {
  if (!a.known() || !b.known() || a.stated == b.stated) return true;
  if (!a.code.empty() && a.code == b.code) return true;
  const ProjLibrary* proj = proj_library();
  if (proj != nullptr) {
    const ProjHandle left(a.wkt.empty() ? a.stated : a.wkt);
    const ProjHandle right(b.wkt.empty() ? b.stated : b.wkt);
    if (left.get() == nullptr || right.get() == nullptr) return true;
    const ProjHandle::Object left_ground = on_the_ground(left);
    const ProjHandle::Object right_ground = on_the_ground(right);
    return proj->is_equivalent_to(left_ground ? left_ground.get() : left.get(),
                                  right_ground ? right_ground.get() : right.get(), kEquivalent) != 0;
  }
  return a.code.empty() || b.code.empty();
}

std::string words_of(const CoordinateSystem& system) {
  if (!system.name.empty())
    return system.code.empty() ? system.name : fmt::format("{} ({})", system.name, system.code);
  if (!system.code.empty()) return system.code;
  return system.stated.substr(0, 60);
}

}  // namespace limen
