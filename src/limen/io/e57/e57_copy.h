// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "limen/base/progress.h"
#include "limen/geometry/rigid.h"
#include "limen/io/e57/e57_description.h"
#include "limen/io/e57/e57_document.h"
#include "limen/io/e57/e57_pages.h"

namespace pugi {
class xml_document;
class xml_node;
}  // namespace pugi

namespace limen {

/// An image of an E57 file as it is stored there.
struct E57Picture {
  std::size_t scan = 0;       ///< that it goes with
  Rigid3 file_from_image;     ///< of the scan where it has none of its own
  std::string type;           ///< "image/jpeg" or "image/png"
  std::uint64_t section = 0;  ///< physical offset
  std::uint64_t bytes = 0;
};

/// An E57 file whose scans are copied into others one by one, as they are but for their poses: points with
/// invalid ones and grids, names, GUIDs, sensors, extensions, and the images that name the scan's GUID. An
/// image that names no scan with points goes with the nearest one, without a place with the first. Check sums
/// are verified; large images and points are never in memory as a whole.
class E57Original {
 public:
  /// `bytes` must outlive this; `forget` gives the memory of those that were read back. Throws Error where
  /// the description is damaged.
  E57Original(std::string_view bytes, const std::string& name, std::function<void()> forget = {});
  E57Original(const E57Original&) = delete;
  E57Original& operator=(const E57Original&) = delete;
  ~E57Original();

  [[nodiscard]] const E57Document& document() const { return document_; }
  /// The images that can be shown: JPEG and PNG, in the order of the file.
  [[nodiscard]] std::vector<E57Picture> pictures() const;
  /// Throws Error for damaged bytes.
  [[nodiscard]] std::vector<std::uint8_t> bytes_of(const E57Picture& picture) const;
  /// Appends the bytes of the scan and its images to `file`; gives what its description needs. Throws Error
  /// for damaged bytes.
  E57Entry copy(std::size_t scan, const Rigid3& target_from_source, E57PageWriter& file,
                Monitor& monitor = silent_monitor()) const;

 private:
  [[nodiscard]] std::size_t owner_of(std::size_t image) const;
  std::string copied(const pugi::xml_node& element, const Rigid3* pose, E57PageWriter& file,
                     Monitor& monitor) const;

  E57Pages pages_;
  std::function<void()> forget_;
  E57Document document_;
  std::unique_ptr<pugi::xml_document> tree_;
  std::vector<pugi::xml_node> scans_;
  std::vector<pugi::xml_node> images_;
  std::vector<E57Space> spaces_;
  std::vector<std::size_t> owners_;  ///< scan of each image
};

}  // namespace limen
