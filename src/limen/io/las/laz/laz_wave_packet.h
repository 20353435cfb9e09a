// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_prediction.h"

namespace limen::laz {

/// Bytes of a wave packet's description: index (1), offset (8), size (4), place of the return and the three
/// direction numbers (4 each, as the integers of their bits).
inline constexpr std::size_t kWavePacketBytes = 29;

class WavePacketDecoder {
 public:
  /// `out` may be `last`.
  void decode(Decoder& decoder, const char* last, char* out) {
    index_.reset_once();
    const auto index = static_cast<std::uint8_t>(decoder.symbol(index_));
    offset_kinds_[offset_kind_].reset_once();
    offset_kind_ = decoder.symbol(offset_kinds_[offset_kind_]);
    const std::uint64_t offset = decode_offset(decoder, last);
    std::array<std::int32_t, 5> numbers{};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const auto before = get<std::int32_t>(last + 9 + 4 * k);
      numbers[k] = k == 0   ? size_.decode(decoder, before)
                   : k == 1 ? return_.decode(decoder, before)
                            : direction_.decode(decoder, before, static_cast<unsigned>(k - 2));
    }
    put(out, index);
    put(out + 1, offset);
    std::memcpy(out + 9, numbers.data(), sizeof numbers);
  }

 private:
  std::uint64_t decode_offset(Decoder& decoder, const char* last) {
    const auto offset = get<std::uint64_t>(last + 1);
    if (offset_kind_ == 0) return offset;
    if (offset_kind_ == 1) return offset + get<std::uint32_t>(last + 9);
    if (offset_kind_ == 3) return decoder.long_word();
    step_ = offset_.decode(decoder, step_);
    return offset + static_cast<std::uint64_t>(static_cast<std::int64_t>(step_));
  }

  unsigned offset_kind_ = 0;
  std::int32_t step_ = 0;
  SymbolModel<256> index_;
  std::array<SymbolModel<4>, 4> offset_kinds_;
  IntegerDecoder<32, 1> offset_;
  IntegerDecoder<32, 1> size_;
  IntegerDecoder<32, 1> return_;
  IntegerDecoder<32, 3> direction_;
};

}  // namespace limen::laz
