// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/met_faces.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr double kNextPieceM = 0.35;  // pieces of one face are near one another, piece by piece

double square(double x) {
  return x * x;
}

/// Whether a piece goes on where those of a face, given by their numbers, end. What lies in one plane above
/// one another is of one leaf or cupboard, of which something hides the middle.
bool continues(const MetFace& piece, const std::vector<MetFace>& pieces,
               const std::vector<std::size_t>& face) {
  const MetFace& first = pieces[face.front()];
  if (!in_one_face(piece.at - first.at, first.normal, piece.normal)) return false;
  return std::any_of(face.rbegin(), face.rend(), [&](std::size_t k) {
    return (pieces[k].at - piece.at).head<2>().squaredNorm() < kNextPieceM * kNextPieceM;
  });
}

/// What the pieces of one face say together.
MetFace mean_of(const std::vector<MetFace>& pieces, const std::vector<std::size_t>& face) {
  constexpr double kLeastSigmaM = 1e-4;
  MetFace mean;
  double weights = 0.0;
  for (const std::size_t k : face) {
    const double weight = 1.0 / (square(pieces[k].sigma_m) + square(kLeastSigmaM));
    mean.offset_m += weight * pieces[k].offset_m;
    mean.at += pieces[k].at;
    mean.normal += pieces[k].normal;
    weights += weight;
  }
  const auto count = static_cast<double>(face.size());
  mean.offset_m /= weights;
  mean.at /= count;
  mean.normal.normalize();
  mean.weight = count;
  double scatter = 0.0;
  for (const std::size_t k : face) scatter += square(pieces[k].offset_m - mean.offset_m);
  mean.sigma_m = std::sqrt(1.0 / weights + scatter / square(count));
  return mean;
}

}  // namespace

double correlation(const MetFace& a, const MetFace& b) {
  const Vector3d apart = a.at - b.at;
  const double length = in_one_face(apart, a.normal, b.normal) ? kFrontLengthM : kThingLengthM;
  const Vector2d across = a.normal.head<2>().normalized();
  const double aligned = std::abs(across.dot(b.normal.head<2>().normalized()));
  return aligned * std::exp(-apart.norm() / length);
}

std::vector<MetFace> joined(const std::vector<MetFace>& pieces) {
  std::vector<std::vector<std::size_t>> faces;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto found = std::find_if(faces.begin(), faces.end(),
                                    [&](const auto& face) { return continues(pieces[k], pieces, face); });
    if (found != faces.end())
      found->push_back(k);
    else
      faces.push_back({k});
  }
  std::vector<MetFace> means;
  means.reserve(faces.size());
  for (const std::vector<std::size_t>& face : faces) means.push_back(mean_of(pieces, face));
  return means;
}

}  // namespace limen
