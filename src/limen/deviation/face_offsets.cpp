// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/face_offsets.h"

#include <cmath>
#include <limits>

#include "limen/base/parallel.h"
#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr double kContestedShare = 0.3;  // of a face's points that might be on another face
constexpr double kOwnShare = 0.3;        // of the gap to it: surface nearer than this is the face's own
constexpr double kNearLimit = 0.7;       // of the largest distance: what lies there may be anything
constexpr double kPeakShare = 0.65;      // of a face's points that stand together, else it is two things
constexpr std::size_t kFacePoints = 30;  // fewer do not tell where a face is

/// The typical gap from each face to another that its points might be on; infinite where few might.
std::vector<double> gaps_by_face(const PointFaces& laid, std::size_t faces) {
  std::vector<std::vector<float>> gaps(faces);
  std::vector<std::size_t> asked(faces, 0);
  for (std::size_t k = 0; k < laid.gap_m.size(); ++k) {
    const std::size_t i = k * PointFaces::kGapStride;
    if (i >= laid.face.size() || laid.face[i] < 0) continue;
    const auto face = static_cast<std::size_t>(laid.face[i]);
    ++asked[face];
    if (!std::isnan(laid.gap_m[k])) gaps[face].push_back(laid.gap_m[k]);
  }
  std::vector<double> typical(faces, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < faces; ++k) {
    if (static_cast<double>(gaps[k].size()) <= kContestedShare * static_cast<double>(asked[k])) continue;
    typical[k] = static_cast<double>(median(gaps[k]));
  }
  return typical;
}

}  // namespace

/// The signed distances of each face, by face.
std::vector<std::vector<float>> distances_by_face(const PointFaces& laid, std::size_t faces) {
  std::vector<std::vector<float>> distances(faces);
  for (std::size_t i = 0; i < laid.face.size(); ++i) {
    if (laid.face[i] >= 0) distances[static_cast<std::size_t>(laid.face[i])].push_back(laid.distance_m[i]);
  }
  return distances;
}

std::vector<FaceOffset> face_offsets(const ModelFaces& faces, const PointFaces& laid,
                                     const std::vector<std::vector<float>>& distances_m,
                                     const DeviationOptions& options) {
  const std::vector<double> gap_m = gaps_by_face(laid, faces.faces.size());
  std::vector<FaceOffset> offsets(faces.faces.size());
  parallel_for(offsets.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::vector<float>& distances = distances_m[k];
      if (distances.size() < kFacePoints) continue;
      FaceOffset offset = face_offset(faces.faces[k].plane.normal, distances, options.max_distance_m);
      const double off = std::abs(offset.offset_m);
      const bool split =
          static_cast<double>(offset.points) < kPeakShare * static_cast<double>(distances.size());
      offset.contested = split || off > kOwnShare * gap_m[k] || off > kNearLimit * options.max_distance_m;
      offsets[k] = offset;
    }
  });
  contest_scattered(offsets);
  return offsets;
}

}  // namespace limen
