// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_prediction.h"

namespace limen::laz {

/// GPS times as versions 2 to 4 code them: up to four interleaved sequences, each with its last time (as the
/// integer of its bits) and the last step; a step is coded as a multiple of the last one and a rest.
/// `may_stay`: a symbol says that the time does not change (version 2); from version 3 another layer says it.
template <typename Coder, bool may_stay>
class GpsTimeCoder {
 public:
  void start(std::uint64_t time) { times_[0] = time; }

  std::uint64_t code(Coder& coder, std::uint64_t wanted) {
    // A change of sequence is followed by a step in it; damaged bytes could change for ever.
    for (int turns = 0; turns < 8; ++turns) {
      if (steps_[now_] == 0 ? code_first(coder, wanted) : code_multiple(coder, wanted)) break;
    }
    return times_[now_];
  }

 private:
  static constexpr unsigned kStay = may_stay ? 1 : 0;
  static constexpr int kMost = 500;   ///< largest multiple
  static constexpr int kLeast = -10;  ///< smallest one
  static constexpr unsigned kHuge = kMost - kLeast + 1 + kStay;
  static constexpr unsigned kSymbols = kHuge + 4;

  /// True where a time was found, false where another sequence is to be asked.
  bool code_first(Coder& coder, std::uint64_t wanted) {
    first_.reset_once();
    const unsigned found = coder.code(first_, Coder::kEncodes ? first_symbol(wanted) : 0U);
    if (may_stay && found == 0) return true;
    if (found == kStay) {
      steps_[now_] = differences_.code(coder, short_step(wanted), 0, 0);
      advance(steps_[now_]);
      odd_[now_] = 0;
    } else if (found == kStay + 1) {
      begin_sequence(coder, wanted);
    } else {
      now_ = (now_ + found - kStay - 1) & 3U;
      return false;
    }
    return true;
  }

  bool code_multiple(Coder& coder, std::uint64_t wanted) {
    multiples_.reset_once();
    const unsigned found = coder.code(multiples_, Coder::kEncodes ? multiple_symbol(wanted) : 0U);
    if (may_stay && found == kHuge - 1) return true;
    if (found == kHuge) {
      begin_sequence(coder, wanted);
    } else if (found > kHuge) {
      now_ = (now_ + found - kHuge) & 3U;
      return false;
    } else if (found == 1) {
      advance(differences_.code(coder, short_step(wanted), steps_[now_], 1));
      odd_[now_] = 0;
    } else {
      code_odd_multiple(coder, wanted, static_cast<int>(found));
    }
    return true;
  }

  void code_odd_multiple(Coder& coder, std::uint64_t wanted, int found) {
    const std::int32_t step = steps_[now_];
    const int multiple = found <= kMost ? found : kMost - found;
    unsigned context = 7;  // for 0
    if (multiple > 0) context = multiple < 10 ? 2 : (multiple < kMost ? 3 : 4);
    if (multiple < 0) context = multiple > kLeast ? 5 : 6;
    const std::int32_t difference =
        differences_.code(coder, short_step(wanted), wrapping_product(multiple, step), context);
    // A sequence whose steps fit no usual multiple four times over has a new step.
    const bool odd = multiple == 0 || multiple == kMost || multiple == kLeast;
    if (odd && ++odd_[now_] > 3) {
      steps_[now_] = difference;
      odd_[now_] = 0;
    }
    advance(difference);
  }

  /// A time far from all: its upper half is predicted, its lower half is plain.
  void begin_sequence(Coder& coder, std::uint64_t wanted) {
    newest_ = (newest_ + 1) & 3U;
    const std::int32_t upper = upper_half(times_[now_]);
    const auto found = static_cast<std::uint32_t>(differences_.code(coder, upper_half(wanted), upper, 8));
    times_[newest_] =
        (static_cast<std::uint64_t>(found) << 32U) | coder.code_word(static_cast<std::uint32_t>(wanted));
    now_ = newest_;
    steps_[now_] = 0;
    odd_[now_] = 0;
  }

  void advance(std::int32_t step) {
    times_[now_] += static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
  }

  static std::int32_t upper_half(std::uint64_t time) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(time >> 32U));
  }
  /// From the last time of the sequence; of meaning where it fits.
  [[nodiscard]] std::int32_t short_step(std::uint64_t wanted) const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(wanted - times_[now_]));
  }
  [[nodiscard]] bool fits(std::uint64_t wanted, unsigned sequence) const {
    const auto step = static_cast<std::int64_t>(wanted - times_[sequence]);
    return step == static_cast<std::int32_t>(step);
  }
  /// How many sequences further one lies that the time fits; 0: none.
  [[nodiscard]] unsigned turns_to_sequence_of(std::uint64_t wanted) const {
    for (unsigned turns = 1; turns < 4; ++turns) {
      if (fits(wanted, (now_ + turns) & 3U)) return turns;
    }
    return 0;
  }

  [[nodiscard]] unsigned first_symbol(std::uint64_t wanted) const {
    if (may_stay && wanted == times_[now_]) return 0;
    return fits(wanted, now_) ? kStay : kStay + 1 + turns_to_sequence_of(wanted);
  }
  [[nodiscard]] unsigned multiple_symbol(std::uint64_t wanted) const {
    if (may_stay && wanted == times_[now_]) return kHuge - 1;
    if (!fits(wanted, now_)) return kHuge + turns_to_sequence_of(wanted);
    const double ratio = static_cast<double>(short_step(wanted)) / static_cast<double>(steps_[now_]);
    const auto multiple = static_cast<int>(
        std::clamp(std::round(ratio), static_cast<double>(kLeast), static_cast<double>(kMost)));
    return static_cast<unsigned>(multiple >= 0 ? multiple : kMost - multiple);
  }

  unsigned now_ = 0;
  unsigned newest_ = 0;
  std::array<std::uint64_t, 4> times_{};
  std::array<std::int32_t, 4> steps_{};
  std::array<int, 4> odd_{};
  SymbolModel<kStay + 5> first_;
  SymbolModel<kSymbols> multiples_;
  IntegerCoder<Coder, 32, 9> differences_;
};

}  // namespace limen::laz
