// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_prediction.h"

namespace limen::laz {

/// Bytes of a wave packet's description: index (1), offset (8), size (4), place of the return and the three
/// direction numbers (4 each, as the integers of their bits).
inline constexpr std::size_t kWavePacketBytes = 29;

using WavePacket = std::array<char, kWavePacketBytes>;

template <typename Coder>
class WavePacketCoder {
 public:
  WavePacket code(Coder& coder, const WavePacket& last, const WavePacket& wanted) {
    WavePacket next{};
    index_.reset_once();
    put(next.data(), static_cast<std::uint8_t>(coder.code(index_, get<std::uint8_t>(wanted.data()))));
    put(&next[1], code_offset(coder, last, get<std::uint64_t>(&wanted[1])));
    for (std::size_t k = 0; k < 5; ++k) {
      const auto before = get<std::int32_t>(&last[9 + 4 * k]);
      const auto after = get<std::int32_t>(&wanted[9 + 4 * k]);
      put(&next[9 + 4 * k], k == 0   ? size_.code(coder, after, before)
                            : k == 1 ? return_.code(coder, after, before)
                                     : direction_.code(coder, after, before, static_cast<unsigned>(k - 2)));
    }
    return next;
  }

 private:
  /// 0: the offset stays, 1: the next packet lies behind the last one, 2: a step of 32 bits, 3: any.
  static unsigned kind_of(const WavePacket& last, std::uint64_t wanted) {
    const auto step = static_cast<std::int64_t>(wanted - get<std::uint64_t>(&last[1]));
    if (step == 0) return 0;
    if (step == get<std::uint32_t>(&last[9])) return 1;
    return step == static_cast<std::int32_t>(step) ? 2 : 3;
  }

  std::uint64_t code_offset(Coder& coder, const WavePacket& last, std::uint64_t wanted) {
    const auto offset = get<std::uint64_t>(&last[1]);
    SymbolModel<4>& kinds = offset_kinds_[offset_kind_];
    kinds.reset_once();
    offset_kind_ = coder.code(kinds, Coder::kEncodes ? kind_of(last, wanted) : 0U);
    if (offset_kind_ == 0) return offset;
    if (offset_kind_ == 1) return offset + get<std::uint32_t>(&last[9]);
    if (offset_kind_ == 3) return coder.code_long_word(wanted);
    step_ =
        offset_.code(coder, static_cast<std::int32_t>(static_cast<std::uint32_t>(wanted - offset)), step_);
    return offset + static_cast<std::uint64_t>(static_cast<std::int64_t>(step_));
  }

  unsigned offset_kind_ = 0;
  std::int32_t step_ = 0;
  SymbolModel<256> index_;
  std::array<SymbolModel<4>, 4> offset_kinds_;
  IntegerCoder<Coder, 32, 1> offset_;
  IntegerCoder<Coder, 32, 1> size_;
  IntegerCoder<Coder, 32, 1> return_;
  IntegerCoder<Coder, 32, 3> direction_;
};

}  // namespace limen::laz
