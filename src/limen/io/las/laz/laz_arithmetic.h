// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

/// Adaptive arithmetic decoding as LAZ uses it.
///
/// The coder keeps an interval [0, length) of 32 bits and the place `value` of the message in it. A model
/// divides the interval in proportion to how often each symbol came so far; the interval of the symbol that
/// holds `value` becomes the new one. When the length falls below 2^24 the next byte is taken in.
/// Source: A. Said, Introduction to Arithmetic Coding - Theory and Practice, HP Laboratories HPL-2004-76
/// (adaptive models with integer arithmetic); M. Isenburg, LASzip: lossless compression of LiDAR data,
/// PE&RS 79(2), 2013.

namespace limen::laz {

/// Probabilities of a bit have 13 binary digits, those of other symbols 15.
inline constexpr unsigned kBitDigits = 13;
inline constexpr unsigned kSymbolDigits = 15;

/// How often a bit was 0.
class BitModel {
 public:
  void reset() { *this = BitModel{}; }
  [[nodiscard]] std::uint32_t zero_share() const { return zero_share_; }
  void count(bool bit) {
    if (!bit) ++zeros_;
    if (--until_update_ == 0) update();
  }

 private:
  void update() {
    total_ += cycle_;
    if (total_ > (1U << kBitDigits)) {
      total_ = (total_ + 1) >> 1U;
      zeros_ = (zeros_ + 1) >> 1U;
      if (zeros_ == total_) ++total_;
    }
    const std::uint32_t scale = 0x80000000U / total_;
    zero_share_ = (zeros_ * scale) >> (31U - kBitDigits);
    cycle_ = std::min<std::uint32_t>((5 * cycle_) >> 2U, 64);
    until_update_ = cycle_;
  }

  std::uint32_t zeros_ = 1;
  std::uint32_t total_ = 2;
  std::uint32_t zero_share_ = 1U << (kBitDigits - 1);
  std::uint32_t cycle_ = 4;
  std::uint32_t until_update_ = 4;
};

/// How often each of up to `most` symbols came. Not usable before reset().
template <unsigned most>
class SymbolModel {
 public:
  static constexpr bool kSearched = most <= 16;  ///< few symbols: compared with all at once

  [[nodiscard]] bool ready() const { return symbols_ != 0; }
  void reset(unsigned symbols = most) {
    symbols_ = symbols;
    total_ = 0;
    cycle_ = symbols;
    begins_.fill(0xFFFF);
    std::fill_n(counts_.begin(), symbols, std::uint16_t{1});
    update();
    cycle_ = until_update_ = (symbols + 6) >> 1U;
  }
  void reset_once(unsigned symbols = most) {
    if (!ready()) reset(symbols);
  }

  /// The symbol whose part of the unit interval holds `share` (below 2^15).
  [[nodiscard]] unsigned find(std::uint32_t share) const {
    if constexpr (kSearched) {
      unsigned below = 0;
      for (unsigned k = 0; k < kPlaces; ++k) below += begins_[k] <= share ? 1U : 0U;
      return below - 1;
    } else {
      unsigned symbol = lookup_[share >> kLookupShift];
      while (begins_[symbol + 1] <= share) ++symbol;
      return symbol;
    }
  }
  [[nodiscard]] std::uint32_t begin_of(unsigned symbol) const { return begins_[symbol]; }
  [[nodiscard]] bool is_last(unsigned symbol) const { return symbol + 1 == symbols_; }
  void count(unsigned symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }

 private:
  static constexpr unsigned kPlaces = kSearched ? 16 : most + 1;
  static constexpr unsigned kLookups = most > 256 ? 512 : (most > 64 ? 256 : 128);
  static constexpr unsigned kLookupShift = most > 256 ? 6 : (most > 64 ? 7 : 8);

  void update() {
    total_ += cycle_;
    if (total_ > (1U << kSymbolDigits)) {
      total_ = 0;
      for (unsigned k = 0; k < symbols_; ++k) {
        counts_[k] = static_cast<std::uint16_t>((counts_[k] + 1U) >> 1U);
        total_ += counts_[k];
      }
    }
    const std::uint32_t scale = 0x80000000U / total_;
    std::uint32_t sum = 0;
    for (unsigned k = 0; k < symbols_; ++k) {
      begins_[k] = static_cast<std::uint16_t>((scale * sum) >> (31U - kSymbolDigits));
      sum += counts_[k];
    }
    if constexpr (!kSearched) fill_lookup();
    cycle_ = std::min((5 * cycle_) >> 2U, (symbols_ + 6) << 3U);
    until_update_ = cycle_;
  }

  /// For the first share of each cell: the symbol that holds it.
  void fill_lookup() {
    unsigned cell = 0;
    for (unsigned k = 1; k < symbols_; ++k) {
      const unsigned next = (begins_[k] + (1U << kLookupShift) - 1) >> kLookupShift;
      while (cell < next) lookup_[cell++] = static_cast<std::uint16_t>(k - 1);
    }
    while (cell < kLookups) lookup_[cell++] = static_cast<std::uint16_t>(symbols_ - 1);
  }

  std::uint32_t symbols_ = 0;
  std::uint32_t total_ = 0;
  std::uint32_t cycle_ = 0;
  std::uint32_t until_update_ = 0;
  alignas(16) std::array<std::uint16_t, kPlaces> begins_;  // last: never reached
  std::array<std::uint16_t, most> counts_;
  std::array<std::uint16_t, kSearched ? 1 : kLookups> lookup_;
};

/// Decodes symbols from bytes that the caller keeps. Behind their end it goes on with zeros; sound() tells.
///
/// What is written once for both directions calls code(): this one finds a value and passes over the wanted
/// one, Encoder (below) stores the wanted one and returns it.
class Decoder {
 public:
  static constexpr bool kEncodes = false;

  Decoder() = default;
  explicit Decoder(std::string_view bytes)
      : at_(reinterpret_cast<const unsigned char*>(bytes.data())), end_(at_ + bytes.size()) {
    for (int k = 0; k < 4; ++k) value_ = (value_ << 8U) | next_byte();
  }

  bool bit(BitModel& model) {
    const std::uint32_t split = model.zero_share() * (length_ >> kBitDigits);
    const bool one = value_ >= split;
    if (one) {
      value_ -= split;
      length_ -= split;
    } else {
      length_ = split;
    }
    refill();
    model.count(one);
    return one;
  }

  template <unsigned most>
  unsigned symbol(SymbolModel<most>& model) {
    const std::uint32_t unit = length_ >> kSymbolDigits;
    const std::uint32_t share = std::min<std::uint32_t>(value_ / unit, (1U << kSymbolDigits) - 1);
    const unsigned found = model.find(share);
    const std::uint32_t low = model.begin_of(found) * unit;
    const std::uint32_t high = model.is_last(found) ? length_ : model.begin_of(found + 1) * unit;
    value_ -= low;
    length_ = high - low;
    refill();
    model.count(found);
    return found;
  }

  bool code(BitModel& model, bool /*wanted*/) { return bit(model); }
  template <unsigned most>
  unsigned code(SymbolModel<most>& model, unsigned /*wanted*/) {
    return symbol(model);
  }
  std::uint32_t code_bits(unsigned count, std::uint32_t /*wanted*/) { return bits(count); }
  std::uint32_t code_word(std::uint32_t /*wanted*/) { return word(); }
  std::uint64_t code_long_word(std::uint64_t /*wanted*/) { return long_word(); }

  /// Plain bits, up to 32.
  std::uint32_t bits(unsigned count) {
    if (count <= 19) return few_bits(count);
    const std::uint32_t low = few_bits(16);
    return low | (few_bits(count - 16) << 16U);
  }
  std::uint32_t word() {
    const std::uint32_t low = few_bits(16);
    return low | (few_bits(16) << 16U);
  }
  std::uint64_t long_word() {
    const std::uint64_t low = word();
    return low | (static_cast<std::uint64_t>(word()) << 32U);
  }

  /// No more bytes were needed than are there, and in the end none are left but a few that writers add.
  /// Damaged bytes decode to something, but to another length.
  [[nodiscard]] bool sound(bool at_end) const {
    return missing_ <= kSlack && (!at_end || end_ - at_ <= static_cast<std::ptrdiff_t>(kSlack));
  }

 private:
  std::uint32_t few_bits(unsigned count) {
    length_ >>= count;
    const std::uint32_t found = std::min(value_ / length_, (1U << count) - 1);
    value_ -= found * length_;
    refill();
    return found;
  }
  std::uint32_t next_byte() {
    if (at_ != end_) return *at_++;
    ++missing_;
    return 0;
  }
  void refill() {
    if (end_ - at_ >= 4) {
      // As many bytes as the length has leading zero bytes, without a branch that depends on the data.
      const auto digits = static_cast<unsigned>(std::countl_zero(length_)) & ~7U;
      std::uint32_t next = 0;
      std::memcpy(&next, at_, sizeof next);
      next = __builtin_bswap32(next);
      value_ = static_cast<std::uint32_t>((std::uint64_t{value_} << digits) |
                                          (std::uint64_t{next} >> (32U - digits)));
      length_ <<= digits;
      at_ += digits / 8U;
      return;
    }
    while (length_ < (1U << 24U)) {
      value_ = (value_ << 8U) | next_byte();
      length_ <<= 8U;
    }
  }

  static constexpr std::uint64_t kSlack = 8;  ///< bytes that writers may add or leave out

  std::uint32_t value_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  const unsigned char* at_ = nullptr;
  const unsigned char* end_ = nullptr;
  std::uint64_t missing_ = 0;
};

/// A model for each value of something, made when it is first met.
template <unsigned symbols, unsigned values>
class ModelPerValue {
 public:
  SymbolModel<symbols>& of(unsigned value) {
    std::unique_ptr<SymbolModel<symbols>>& model = models_[value];
    if (!model) {
      model = std::make_unique<SymbolModel<symbols>>();
      model->reset();
    }
    return *model;
  }
  unsigned decode(Decoder& decoder, unsigned value) { return decoder.symbol(of(value)); }

 private:
  std::array<std::unique_ptr<SymbolModel<symbols>>, values> models_;
};

/// The other direction of Decoder: the interval is narrowed to the part of each symbol, and the bytes that
/// its beginning can no longer change go out. Source: as laz_arithmetic.h.
class Encoder {
 public:
  static constexpr bool kEncodes = true;

  bool code(BitModel& model, bool wanted) {
    const std::uint32_t split = model.zero_share() * (length_ >> kBitDigits);
    wanted ? narrow(split, length_ - split) : narrow(0, split);
    model.count(wanted);
    return wanted;
  }

  template <unsigned most>
  unsigned code(SymbolModel<most>& model, unsigned wanted) {
    const std::uint32_t unit = length_ >> kSymbolDigits;
    const std::uint32_t low = model.begin_of(wanted) * unit;
    const std::uint32_t high = model.is_last(wanted) ? length_ : model.begin_of(wanted + 1) * unit;
    narrow(low, high - low);
    model.count(wanted);
    return wanted;
  }

  /// Plain bits, up to 32.
  std::uint32_t code_bits(unsigned count, std::uint32_t wanted) {
    if (count <= 19) {
      few_bits(count, wanted);
    } else {
      few_bits(16, wanted & 0xFFFFU);
      few_bits(count - 16, wanted >> 16U);
    }
    return wanted;
  }
  std::uint32_t code_word(std::uint32_t wanted) {
    few_bits(16, wanted & 0xFFFFU);
    few_bits(16, wanted >> 16U);
    return wanted;
  }
  std::uint64_t code_long_word(std::uint64_t wanted) {
    code_word(static_cast<std::uint32_t>(wanted));
    code_word(static_cast<std::uint32_t>(wanted >> 32U));
    return wanted;
  }

  /// The message. Call it once, last: it ends with as many bytes as a decoder takes in advance.
  std::string finish() {
    constexpr std::uint32_t kLeast = 1U << 24U;
    const bool wide = length_ > 2 * kLeast;
    narrow(wide ? kLeast : kLeast / 2, wide ? kLeast / 2 : kLeast >> 9U);
    bytes_.append(wide ? 3 : 2, '\0');
    return std::move(bytes_);
  }

 private:
  void few_bits(unsigned count, std::uint32_t wanted) {
    const std::uint32_t unit = length_ >> count;
    narrow(wanted * unit, unit);
  }
  void narrow(std::uint32_t low, std::uint32_t length) {
    base_ += low;
    if (base_ < low) carry();
    length_ = length;
    while (length_ < (1U << 24U)) {
      bytes_ += static_cast<char>(base_ >> 24U);
      base_ <<= 8U;
      length_ <<= 8U;
    }
  }
  /// The beginning passed 1: one more in the bytes that are out. The message is below 1, so one is there.
  void carry() {
    std::size_t at = bytes_.size();
    while (++bytes_[--at] == 0) {
    }
  }

  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  std::string bytes_;
};

}  // namespace limen::laz
