// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Poses between the frames that scans are prepared in.
#pragma once

#include "limen/register/prepare/prepared_pair.h"
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

}  // namespace limen::calibration
