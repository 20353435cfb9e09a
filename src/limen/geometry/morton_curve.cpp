// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/morton_curve.h"

#include <algorithm>
#include <array>
#include <bit>

#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr std::size_t kPieces = 16;
constexpr std::uint32_t kDigitBits = 11;
constexpr std::uint32_t kDigits = 1U << kDigitBits;

std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | (v << 32U)) & 0x1f00000000ffffULL;
  v = (v | (v << 16U)) & 0x1f0000ff0000ffULL;
  v = (v | (v << 8U)) & 0x100f00f00f00f00fULL;
  v = (v | (v << 4U)) & 0x10c30c30c30c30c3ULL;
  return (v | (v << 2U)) & 0x1249249249249249ULL;
}

std::uint32_t gather(std::uint64_t v) {
  v &= 0x1249249249249249ULL;
  v = (v | (v >> 2U)) & 0x10c30c30c30c30c3ULL;
  v = (v | (v >> 4U)) & 0x100f00f00f00f00fULL;
  v = (v | (v >> 8U)) & 0x1f0000ff0000ffULL;
  v = (v | (v >> 16U)) & 0x1f00000000ffffULL;
  v = (v | (v >> 32U)) & 0x1fffffULL;
  return static_cast<std::uint32_t>(v);
}

/// One stable pass of a radix sort on `shift`'s digit; pieces keep their order, whoever works on them.
void radix_pass(const CurvePlaces& from, CurvePlaces& to, std::uint32_t shift) {
  const std::size_t n = from.size();
  const std::size_t grain = (n + kPieces - 1) / kPieces;
  std::vector<std::array<std::uint32_t, kDigits>> starts(kPieces);
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    std::array<std::uint32_t, kDigits>& count = starts[begin / grain];
    count.fill(0);
    for (std::size_t i = begin; i < end; ++i) ++count[(from[i].code >> shift) & (kDigits - 1)];
  });
  const std::size_t used = (n + grain - 1) / grain;
  std::uint32_t total = 0;
  for (std::uint32_t digit = 0; digit < kDigits; ++digit) {
    for (std::size_t piece = 0; piece < used; ++piece) {
      const std::uint32_t count = starts[piece][digit];
      starts[piece][digit] = total;
      total += count;
    }
  }
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    std::array<std::uint32_t, kDigits>& next = starts[begin / grain];
    for (std::size_t i = begin; i < end; ++i) to[next[(from[i].code >> shift) & (kDigits - 1)]++] = from[i];
  });
}

}  // namespace

std::uint64_t morton_encode(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread(x) | (spread(y) << 1U) | (spread(z) << 2U);
}

CellIndex morton_decode(std::uint64_t code) {
  return {gather(code), gather(code >> 1U), gather(code >> 2U)};
}

void sort_along_curve(CurvePlaces& places) {
  if (places.empty()) return;
  // Points that were laid along the curve once stay so, also with larger cubes.
  if (std::is_sorted(places.begin(), places.end(),
                     [](const CurvePlace& a, const CurvePlace& b) { return a.code < b.code; }))
    return;
  const std::uint64_t first = places.front().code;
  const std::uint64_t differ = parallel_reduce(
      places.size(), 65536, std::uint64_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::uint64_t part = 0;
        for (std::size_t i = begin; i < end; ++i) part |= places[i].code ^ first;
        return part;
      },
      [](std::uint64_t a, std::uint64_t b) { return a | b; });
  CurvePlaces other(places.size());
  // Digits above the highest bit in which any two codes differ need no pass.
  const auto bits = static_cast<std::uint32_t>(std::bit_width(differ));
  for (std::uint32_t shift = 0; shift < bits; shift += kDigitBits) {
    radix_pass(places, other, shift);
    places.swap(other);
  }
}

}  // namespace limen
