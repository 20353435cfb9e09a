// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <new>
#include <utility>

namespace limen {

/// For lists whose values are all written by their makers, on all threads: new values are not set to 0 first.
template <typename Value>
class UnsetAllocator : public std::allocator<Value> {
 public:
  // NOLINTBEGIN(readability-identifier-naming): the names of the standard's requirements of an allocator
  template <typename Other>
  struct rebind {
    using other = UnsetAllocator<Other>;
  };
  // NOLINTEND(readability-identifier-naming)

  template <typename Other>
  void construct(Other* place) noexcept {
    ::new (static_cast<void*>(place)) Other;
  }
  template <typename Other, typename... Arguments>
  void construct(Other* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }
};

}  // namespace limen
