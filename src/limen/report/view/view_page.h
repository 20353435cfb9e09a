// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/report/html/html_scene.h"

namespace limen {

/// A picture that was taken at a station.
struct ViewPicture {
  Vector3d place = Vector3d::Zero();  ///< about the origin of the ViewScene
  std::string type;                   ///< "image/jpeg"
  std::vector<std::uint8_t> bytes;
};

/// A scan or a model to look at. Its scene lies about the origin of the ViewScene; its own is not used.
struct ViewSide {
  std::string name;
  std::uint64_t points_read = 0;  ///< of the file; 0 for a model
  std::string path;        ///< the file's name, of a scan that can be registered as it lies; else empty
  Rigid3 file_from_frame;  ///< of such a scan
  std::vector<ViewPicture> pictures;
  SceneSide scene;
};

/// Everything that one page shows, in one frame.
struct ViewScene {
  std::string title;
  Vector3d origin = Vector3d::Zero();  ///< world = origin + x
  std::vector<ViewSide> sides;
};

/// Bytes of the largest page: what a mail takes, and a browser opens at once.
inline constexpr std::size_t kMostPageBytes = 20'000'000;

/// Bytes of all pictures of a page together, at most.
inline constexpr std::size_t kMostPictureBytes = 9'000'000;

/// A page that shows clouds and models in space, with sections and measuring; it needs nothing but itself.
/// Throws Error where it would be larger than kMostPageBytes.
std::string view_page(const ViewScene& scene);

/// A model's faces and outlines as a page draws them, in the frame of `frame_from_model`, about `origin`.
SceneSide view_of_model(const BimModel& model, const Rigid3& frame_from_model, const Vector3d& origin);

}  // namespace limen
