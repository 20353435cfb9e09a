// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "limen/sight/space_view.h"

namespace limen {

/// What several scanners in one frame know together: a surface that one of them measured is there; else a
/// place that one saw through is free.
class JoinedSpace : public SpaceView {
 public:
  /// One scanner's view, with the joint index of each of its planes.
  struct Member {
    std::shared_ptr<const SpaceView> view;
    std::vector<std::int32_t> joint_plane;
  };
  explicit JoinedSpace(std::vector<Member> members);

  [[nodiscard]] Sight look(const SightQuery& query) const override;
  void look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                       const Rigid3& view_from_scan, const LookTolerances& tolerances,
                       Looks& looks) const override;

 private:
  std::vector<Member> members_;
};

}  // namespace limen
