// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/stairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace limen {
namespace {

// Steps as people can climb them, with what the middles of pieces miss those of risers by.
constexpr double kLeastRunM = 0.1;  // of steep ones
constexpr double kMostRunM = 0.38;
constexpr double kLeastRiseM = 0.09;
constexpr double kMostRiseM = 0.27;
constexpr double kSameRunM = 0.04;
constexpr double kSameRiseM = 0.08;
constexpr double kBesideStepM = 0.6;

constexpr double kRiserUpright = 0.1;  // cosine of its normal to the vertical, at most
constexpr double kParallelRisers = 0.985;
constexpr double kOneRiserM = 0.05;     // across
constexpr double kNextToRiserM = 0.35;  // along

constexpr double kHalfFlightM = 1.3;
constexpr double kBelowFlightM = 0.6;
constexpr double kRailingM = 1.3;
constexpr double kUnseenFlightM = 1.5;  // of the flight, either way

struct Riser {
  Vector3d at = Vector3d::Zero();
  Vector2d in = Vector2d::UnitX();  ///< away from who sees it
  Vector3d last = Vector3d::Zero();
  double pieces = 0.0;
};

/// The pieces joined to risers, or to whatever else is upright.
std::vector<Riser> upright_faces(const std::vector<SurfaceDetail>& details) {
  std::vector<Riser> faces;
  for (const SurfaceDetail& piece : details) {
    if (!piece.flat() || std::abs(piece.normal.z()) > kRiserUpright) continue;
    const Vector2d in = -piece.normal.head<2>().normalized();
    const auto found = std::find_if(faces.begin(), faces.end(), [&](const Riser& face) {
      const Vector3d apart = piece.mean - face.at;
      return face.in.dot(in) > kParallelRisers && std::abs(apart.head<2>().dot(face.in)) < kOneRiserM &&
             (piece.mean - face.last).norm() < kNextToRiserM + 0.1 * face.pieces;
    });
    if (found == faces.end()) {
      faces.push_back({piece.mean, in, piece.mean, 1.0});
      continue;
    }
    found->at = (found->pieces * found->at + piece.mean) / (found->pieces + 1.0);
    found->last = piece.mean;
    found->pieces += 1.0;
  }
  return faces;
}

/// Who climbs sees the risers' fronts; who is below the flight, or behind one without risers' boards,
/// sees their backs, and the flight leads up towards him.
struct Step {
  bool fronts = true;
  double run_m = 0.0;
  double rise_m = 0.0;

  [[nodiscard]] bool is_like(const Step& other) const {
    return fronts == other.fronts && std::abs(run_m - other.run_m) < kSameRunM &&
           std::abs(rise_m - other.rise_m) < kSameRiseM;
  }
};

/// The step that leads from one riser to the other, if one does.
std::optional<Step> step_between(const Riser& lower, const Riser& upper) {
  if (lower.in.dot(upper.in) < kParallelRisers) return std::nullopt;
  const Vector3d apart = upper.at - lower.at;
  const Vector2d level = apart.head<2>();
  const double run = level.dot(lower.in);
  const Step step{run > 0.0, std::abs(run), apart.z()};
  const double beside = std::abs(lower.in.x() * level.y() - lower.in.y() * level.x());
  const bool climbs = step.run_m > kLeastRunM && step.run_m < kMostRunM && step.rise_m > kLeastRiseM &&
                      step.rise_m < kMostRiseM && beside < kBesideStepM;
  return climbs ? std::optional(step) : std::nullopt;
}

}  // namespace

bool Flight::contains(const Vector3d& x) const {
  const Vector3d apart = x - foot;
  const double along = apart.head<2>().dot(up);
  if (along < -kUnseenFlightM || along > length_m + kUnseenFlightM) return false;
  if (std::abs(up.x() * apart.y() - up.y() * apart.x()) > kHalfFlightM) return false;
  const double above = apart.z() - slope * along;
  return above > -kBelowFlightM && above < kRailingM;
}

std::vector<Flight> find_flights(const std::vector<SurfaceDetail>& details) {
  const std::vector<Riser> faces = upright_faces(details);
  std::vector<Flight> flights;
  for (const Riser& first : faces) {
    const bool known = std::any_of(flights.begin(), flights.end(),
                                   [&](const Flight& flight) { return flight.contains(first.at); });
    if (known) continue;
    for (const Riser& second : faces) {
      const std::optional<Step> step = step_between(first, second);
      if (!step) continue;
      const auto third = std::find_if(faces.begin(), faces.end(), [&](const Riser& face) {
        const std::optional<Step> next = step_between(second, face);
        return next && next->is_like(*step);
      });
      if (third == faces.end()) continue;
      const Vector3d all = third->at - first.at;
      const Vector2d up = step->fronts ? first.in : Vector2d(-first.in);
      const double run = all.head<2>().dot(up);
      Flight flight{first.at, up, all.z() / run, run};
      for (const Riser& face : faces) {
        if (!flight.contains(face.at) || face.in.dot(first.in) < kParallelRisers) continue;
        flight.length_m = std::max(flight.length_m, (face.at - flight.foot).head<2>().dot(flight.up));
      }
      flights.push_back(flight);
      break;
    }
  }
  return flights;
}

}  // namespace limen
