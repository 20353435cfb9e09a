// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What things say of pairs whose truth is known: what scripts/fit_judge estimates the judge's numbers from.
#pragma once

#include <string>

#include <fmt/format.h>

#include "limen/register/judge/individual_matter.h"
#include "limen/register/register.h"

namespace limen::calibration {

/// A pose between the scans' own frames, expressed between the frames that they were prepared in.
inline Rigid3 in_prepared_frames(const Rigid3& pose, const PreparedPair& pair) {
  const Vector3d& of_source = pair.source.extracted.features.local_origin;
  const Vector3d& of_target = pair.target.extracted.features.local_origin;
  const Vector3d shift = pose * of_source - of_target;
  Rigid3 prepared;
  prepared.rotation =
      pair.target.upright_from_scan * pose.rotation * pair.source.upright_from_scan.transpose();
  prepared.translation = pair.target.upright_from_scan * shift;
  return prepared;
}

/// One line of JSON: the observations under `pose`, and whether it lays one room on itself or on its twin.
inline std::string matter_line(const PreparedPair& pair, const Rigid3& pose, const std::string& about,
                               bool twin) {
  const IndividualMatter seen =
      individual_matter(pair.source.view(), pair.target.view(), in_prepared_frames(pose, pair));
  std::string faces;
  for (const FaceMiss& face : seen.faces)
    faces += fmt::format("{}[{:.6f}, {:.4f}, {:.6f}, {}, {}]", faces.empty() ? "" : ", ", face.offset_m,
                         face.share, face.sigma_m, face.front ? 1 : 0, face.thing);
  return fmt::format(R"({{{}, "twin": {}, "count": {:.3f}, "share": {:.4f}, "chance": {:.4f}, "apart": {}, )"
                     R"("faces": [{}]}})",
                     about, twin, seen.matter.count, seen.matter.share, seen.chance, seen.apart, faces);
}

}  // namespace limen::calibration
