// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/match/planes/axis_pairs.h"

namespace limen {

/// Shifts along three axes: by their places in the axes' lists.
using ShiftPlaces = std::array<std::uint32_t, 3>;

/// Three axes whose shifts make a pose, and what each triple of shifts can bring together at most.
///
/// A shift along one axis moves the planes of the others across. So of the surface that the k-th axis brings
/// together, S_k(a, b, c), more is known than its limit L_k where one other shift is known: no place along
/// the way that this shift leaves open gives more than P_km (`ShiftSupport::most_where`), and
///   S_0 + S_1 + S_2 <= min(P_01(a, b), P_02(a, c)) + min(P_10(b, a), P_12(b, c)) + min(P_20(c, a), P_21(c,
///   b)).
/// Six tables of pairs bound all triples.
class ShiftTriples {
 public:
  /// What is found: a triple, and the most that it and the axes outside the basis bring together.
  struct Triple {
    ShiftPlaces at{};
    double most_m2 = 0.0;
  };

  /// `basis`: three of `axes`, independent. `others_m2`: what all other axes add at most. `tolerance`: that
  /// of AxisPairs::support. Triples that bring together no more than `least` are left out.
  ShiftTriples(const std::vector<AxisPairs>& axes, const std::array<std::size_t, 3>& basis, double others_m2,
               double tolerance, double least);

  /// Those above `least`; about those first that can bring most together.
  [[nodiscard]] std::vector<Triple> best_first() const;
  /// The most that the k-th axis of the basis brings together at a triple.
  [[nodiscard]] double most_of(std::size_t k, const ShiftPlaces& at) const;
  /// What the k-th axis of the basis brings together at its shift `at`.
  [[nodiscard]] const ShiftSupport& support(std::size_t k, std::uint32_t at) const {
    return supports_[k][at];
  }

 private:
  /// By the shift of the lower axis of the two, then that of the higher.
  using Table = std::vector<double>;

  [[nodiscard]] std::size_t place(std::size_t k, std::size_t m, const ShiftPlaces& at) const {
    return k < m ? at[k] * supports_[m].size() + at[m] : at[m] * supports_[k].size() + at[k];
  }
  [[nodiscard]] Table most_where(const std::vector<AxisPairs>& axes, std::size_t k, std::size_t m) const;
  void add_row(std::uint32_t i, std::uint32_t j, std::vector<Triple>& found) const;

  std::array<std::size_t, 3> basis_;
  double others_m2_;
  double least_;
  std::array<std::vector<ShiftSupport>, 3> supports_;
  std::array<std::array<Table, 3>, 3> most_;  ///< of the one axis, where another's shift is known
};

}  // namespace limen
