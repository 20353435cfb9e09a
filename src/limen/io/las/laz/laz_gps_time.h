// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_prediction.h"

namespace limen::laz {

/// GPS times as versions 2 to 4 code them: up to four interleaved sequences, each with its last time (as the
/// integer of its bits) and the last step; a step is coded as a multiple of the last one and a rest.
/// `may_stay`: a symbol says that the time does not change (version 2); from version 3 another layer says it.
template <bool may_stay>
class GpsTimeDecoder {
 public:
  void start(std::uint64_t time) { times_[0] = time; }

  std::uint64_t decode(Decoder& decoder) {
    // A change of sequence is followed by a step in it; damaged bytes could change for ever.
    for (int turns = 0; turns < 8; ++turns) {
      if (steps_[now_] == 0 ? decode_first(decoder) : decode_multiple(decoder)) break;
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
  bool decode_first(Decoder& decoder) {
    first_.reset_once();
    const unsigned found = decoder.symbol(first_);
    if (may_stay && found == 0) return true;
    if (found == kStay) {
      steps_[now_] = differences_.decode(decoder, 0, 0);
      advance(steps_[now_]);
      odd_[now_] = 0;
    } else if (found == kStay + 1) {
      begin_sequence(decoder);
    } else {
      now_ = (now_ + found - kStay - 1) & 3U;
      return false;
    }
    return true;
  }

  bool decode_multiple(Decoder& decoder) {
    multiples_.reset_once();
    const unsigned found = decoder.symbol(multiples_);
    if (may_stay && found == kHuge - 1) return true;
    if (found == kHuge) {
      begin_sequence(decoder);
    } else if (found > kHuge) {
      now_ = (now_ + found - kHuge) & 3U;
      return false;
    } else if (found == 1) {
      advance(differences_.decode(decoder, steps_[now_], 1));
      odd_[now_] = 0;
    } else {
      decode_odd_multiple(decoder, static_cast<int>(found));
    }
    return true;
  }

  void decode_odd_multiple(Decoder& decoder, int found) {
    const std::int32_t step = steps_[now_];
    const int multiple = found <= kMost ? found : kMost - found;
    unsigned context = 7;  // for 0
    if (multiple > 0) context = multiple < 10 ? 2 : (multiple < kMost ? 3 : 4);
    if (multiple < 0) context = multiple > kLeast ? 5 : 6;
    const std::int32_t difference = differences_.decode(decoder, wrapping_product(multiple, step), context);
    // A sequence whose steps fit no usual multiple four times over has a new step.
    const bool odd = multiple == 0 || multiple == kMost || multiple == kLeast;
    if (odd && ++odd_[now_] > 3) {
      steps_[now_] = difference;
      odd_[now_] = 0;
    }
    advance(difference);
  }

  /// A time far from all: its upper half is predicted, its lower half is plain.
  void begin_sequence(Decoder& decoder) {
    newest_ = (newest_ + 1) & 3U;
    const auto upper = static_cast<std::int32_t>(static_cast<std::uint32_t>(times_[now_] >> 32U));
    const auto found = static_cast<std::uint32_t>(differences_.decode(decoder, upper, 8));
    times_[newest_] = (static_cast<std::uint64_t>(found) << 32U) | decoder.word();
    now_ = newest_;
    steps_[now_] = 0;
    odd_[now_] = 0;
  }

  void advance(std::int32_t step) {
    times_[now_] += static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
  }

  unsigned now_ = 0;
  unsigned newest_ = 0;
  std::array<std::uint64_t, 4> times_{};
  std::array<std::int32_t, 4> steps_{};
  std::array<int, 4> odd_{};
  SymbolModel<kStay + 5> first_;
  SymbolModel<kSymbols> multiples_;
  IntegerDecoder<32, 9> differences_;
};

}  // namespace limen::laz
