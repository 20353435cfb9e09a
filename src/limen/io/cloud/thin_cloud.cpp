// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/thin_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/io/cloud/cell_table.h"
#include "limen/io/table/packed_rows.h"

namespace limen {
namespace {

/// Rows of one piece of parallel work; columns are decoded strip by strip.
constexpr std::size_t kThinnedPerPiece = 32768;
constexpr std::size_t kThinnedStrip = 1024;
/// Cells are at least this small where the spacing is not given.
constexpr double kFinestCellM = 1e-3;
/// While the cloud comes in there may be so many times more cells than points are wanted: the last choice
/// then comes close to the number.
constexpr double kMoreCells = 2.2;
/// Cubes grow by the root of two at least, and not by more than this at once.
constexpr double kFastestGrowth = 4.0;
/// So many cells ahead are brought near before they are looked at.
constexpr std::size_t kAhead = 12;
/// The last choice keeps at least this share of the points wanted.
constexpr double kCloseEnough = 0.95;
/// Bytes of a cell beside its record: its two slots, its row.
constexpr std::size_t kBytesPerCell = 40;

/// A random rank for each point: the point of the lowest rank in a cell is kept. No two ranks are equal.
std::uint64_t lot_of(std::uint64_t row) {
  return mix64(row);
}

std::uint64_t floor_of(double value) {
  const auto whole = static_cast<std::int64_t>(value);
  return static_cast<std::uint64_t>(whole - (value < static_cast<double>(whole) ? 1 : 0));
}

/// Which cube a point lies in, as a hash. The grid is shifted so that walls at round coordinates do not lie
/// on the borders of cubes.
struct Grid {
  double per_m = 1.0;

  [[nodiscard]] std::uint64_t key(double x, double y, double z) const {
    const std::uint64_t i = floor_of(x * per_m + 0.3819660113);
    const std::uint64_t j = floor_of(y * per_m + 0.2360679775);
    const std::uint64_t k = floor_of(z * per_m + 0.7082039325);
    return mix64(i * 0x9E3779B97F4A7C15ULL + j * 0xC2B2AE3D27D4EB4FULL + k * 0x165667B19E3779F9ULL);
  }
};

/// Columns of the coordinates.
struct Coordinates {
  const Field* field[3];

  explicit Coordinates(const RecordTable& table)
      : field{table.find({"x"}), table.find({"y"}), table.find({"z"})} {
    for (std::size_t k = 0; k < 3; ++k) {
      if (field[k] != nullptr) continue;
      throw Error(fmt::format("the points have no {}", "xyz"[k]), "", "export the points with x, y and z");
    }
  }
};

/// Calls action(row, x, y, z) for the rows of a range, strip by strip.
template <typename Action>
void for_each_point(const RecordTable& table, const Coordinates& columns, RowRange rows,
                    const Action& action) {
  std::array<std::array<double, kThinnedStrip>, 3> strip;
  for (std::size_t at = rows.begin; at < rows.end; at += kThinnedStrip) {
    const std::size_t end = std::min(rows.end, at + kThinnedStrip);
    for (std::size_t k = 0; k < 3; ++k) load_numbers(table, *columns.field[k], {at, end}, strip[k].data());
    for (std::size_t i = at; i < end; ++i) action(i, strip[0][i - at], strip[1][i - at], strip[2][i - at]);
  }
}

bool usable(double x, double y, double z) {
  return std::abs(x) < kLargestCoordinateM && std::abs(y) < kLargestCoordinateM &&
         std::abs(z) < kLargestCoordinateM;
}

/// A point that may become the one of its cell.
struct Candidate {
  std::uint64_t key;
  std::uint64_t lot;
  std::size_t row;  ///< of the piece
};

/// What one piece of parallel work found.
struct Found {
  std::vector<Candidate> candidates;
  std::uint64_t unusable = 0;
};

/// Neighbouring rows share cells: a small memory of the last ones spares most looks into the large table.
class RecentCells {
 public:
  explicit RecentCells(std::vector<Candidate>& out) : out_(out) {
    slots_.fill({0, ~std::uint64_t{0}, kNone});
  }
  void add(const Candidate& candidate) {
    Candidate& slot = slots_[candidate.key % kSlots];
    if (slot.key == candidate.key && slot.row != kNone) {
      if (candidate.lot < slot.lot) slot = candidate;
      return;
    }
    pass_on(slot);
    slot = candidate;
  }
  void flush() {
    for (const Candidate& slot : slots_) pass_on(slot);
  }

 private:
  static constexpr std::size_t kSlots = 2048;
  static constexpr std::size_t kNone = ~std::size_t{0};

  void pass_on(const Candidate& slot) {
    if (slot.row != kNone) out_.push_back(slot);
  }

  std::vector<Candidate>& out_;
  std::array<Candidate, kSlots> slots_;
};

}  // namespace

void ThinOptions::check() const {
  constexpr double kLeastSpacingM = 1e-6;  // less than any file tells apart
  if (!(spacing_m == 0.0 || (spacing_m >= kLeastSpacingM && spacing_m < 1e4)))
    throw_bad_option("spacing_m", spacing_m, "0.000001 to 10 000 m");
  if (most_points == 0 && spacing_m == 0.0 && memory_bytes == 0)
    throw_bad_option("most_points", 0.0, "above 0, where neither a spacing nor a memory is given");
}

class CloudThinner::Cells {
 public:
  Cells(const ThinOptions& options, std::uint64_t expected) : options_(options), expected_(expected) {
    options.check();
    spacing_m_ = options.spacing_m > 0.0 ? options.spacing_m : kFinestCellM;
  }

  void add(const RecordTable& piece) {
    if (piece.rows == 0) return;
    prepare(piece);
    for (std::size_t begin = 0; begin < piece.rows; begin += rows_at_once_) {
      take(piece, {begin, std::min(piece.rows, begin + rows_at_once_)});
      while (rows_.size() > most_cells_) grow();
    }
    read_ += piece.rows;
  }

  ThinnedCloud finish() {
    if (options_.most_points > 0 && rows_.size() > options_.most_points) make_last_choice();
    std::vector<std::uint32_t> order(rows_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return rows_[a] < rows_[b]; });
    cells_ = CellTable{};
    ThinnedCloud thinned;
    thinned.table = packed_.taken(order);
    for (const std::uint32_t i : order) thinned.rows.push_back(rows_[i]);
    thinned.read = read_;
    thinned.unusable = unusable_;
    thinned.spacing_m = spacing_m_;
    return thinned;
  }

 private:
  /// Settles, with the first piece, how many cells there may be.
  void prepare(const RecordTable& piece) {
    const bool first = packed_.record_bytes() == 0;
    packed_.require_columns(piece);
    if (!first) return;
    double most = 4e9;
    if (options_.most_points > 0)
      most = std::min(most, kMoreCells * static_cast<double>(options_.most_points));
    if (options_.memory_bytes > 0) {
      const auto bytes = static_cast<double>(kBytesPerCell + packed_.record_bytes());
      most = std::min(most, static_cast<double>(options_.memory_bytes) / bytes);
    }
    most_cells_ = std::max<std::size_t>(16, static_cast<std::size_t>(most));
    rows_at_once_ = std::clamp<std::size_t>(most_cells_ / 4, kThinnedPerPiece, kStreamRows);
    const std::size_t room =
        std::min<std::size_t>(most_cells_ + rows_at_once_, static_cast<std::size_t>(expected_));
    cells_ = CellTable(room);
    packed_.reserve(room);
    rows_.reserve(room);
  }

  [[nodiscard]] Found look_at(const RecordTable& piece, RowRange rows, const Grid& grid) const {
    Found found;
    RecentCells recent(found.candidates);
    for_each_point(piece, Coordinates(piece), rows, [&](std::size_t row, double x, double y, double z) {
      if (usable(x, y, z)) {
        recent.add({grid.key(x, y, z), lot_of(read_ + row), row});
      } else {
        ++found.unusable;
      }
    });
    recent.flush();
    keep_hopeful(found.candidates);
    return found;
  }

  /// Takes out the candidates whose cells are held by better points already.
  void keep_hopeful(std::vector<Candidate>& candidates) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (i + kAhead < candidates.size()) cells_.expect(candidates[i + kAhead].key);
      const Candidate candidate = candidates[i];
      if (!cells_.has_better(candidate.key, candidate.lot)) candidates[kept++] = candidate;
    }
    candidates.resize(kept);
  }

  void take(const RecordTable& piece, RowRange rows) {
    const Grid grid{1.0 / spacing_m_};
    const std::size_t count = rows.end - rows.begin;
    std::vector<Found> found((count + kThinnedPerPiece - 1) / kThinnedPerPiece);
    parallel_for(count, kThinnedPerPiece, [&](std::size_t begin, std::size_t end) {
      found[begin / kThinnedPerPiece] = look_at(piece, {rows.begin + begin, rows.begin + end}, grid);
    });
    const std::size_t before = rows_.size();
    for (const Found& part : found) {
      unusable_ += part.unusable;
      for (std::size_t i = 0; i < part.candidates.size(); ++i) {
        if (i + kAhead < part.candidates.size()) cells_.expect(part.candidates[i + kAhead].key);
        settle(piece, part.candidates[i]);
      }
    }
    const auto left = static_cast<double>(expected_ - std::min(expected_, read_ + rows.end));
    more_ahead_ = static_cast<double>(rows_.size() - before) * left / static_cast<double>(count);
  }

  void settle(const RecordTable& piece, const Candidate& candidate) {
    const CellTable::Place place = cells_.put(candidate.key, candidate.lot);
    if (place.outcome == CellTable::Outcome::worse) return;
    if (place.outcome == CellTable::Outcome::fresh) {
      packed_.append(piece, candidate.row);
      rows_.push_back(read_ + candidate.row);
    } else {
      packed_.replace(place.index, piece, candidate.row);
      rows_[place.index] = read_ + candidate.row;
    }
  }

  /// Larger cubes: so much larger that those to come, if they come as those of the last rows did, fit too.
  void grow() {
    const double foreseen =
        (static_cast<double>(rows_.size()) + more_ahead_) / static_cast<double>(most_cells_);
    regrid(spacing_m_ * std::clamp(std::sqrt(foreseen), std::sqrt(2.0), kFastestGrowth));
    more_ahead_ = 0.0;
  }

  [[nodiscard]] std::vector<std::uint64_t> keys_at(double spacing_m) const {
    const RecordTable table = packed_.view();
    const Coordinates columns(table);
    const Grid grid{1.0 / spacing_m};
    std::vector<std::uint64_t> keys(table.rows);
    parallel_for(table.rows, kThinnedPerPiece, [&](std::size_t begin, std::size_t end) {
      for_each_point(table, columns, {begin, end},
                     [&](std::size_t row, double x, double y, double z) { keys[row] = grid.key(x, y, z); });
    });
    return keys;
  }

  /// Puts the points that are kept into cubes of another side, in place.
  void regrid(double spacing_m) {
    const std::vector<std::uint64_t> keys = keys_at(spacing_m);
    cells_.clear();
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (i + kAhead < keys.size()) cells_.expect(keys[i + kAhead]);
      const CellTable::Place place = cells_.put(keys[i], lot_of(rows_[i]));
      if (place.outcome == CellTable::Outcome::worse) continue;
      packed_.copy(i, place.index);
      rows_[place.index] = rows_[i];
    }
    rows_.resize(cells_.size());
    packed_.shrink(cells_.size());
    spacing_m_ = spacing_m;
  }

  /// How many cells of this side the points kept fill: counted for one cell of `share`, and scaled.
  [[nodiscard]] double cells_at(double spacing_m, std::uint64_t share) const {
    std::vector<std::uint64_t> keys = keys_at(spacing_m);
    std::erase_if(keys, [&](std::uint64_t key) { return (key >> 32U) % share != 0; });
    std::sort(keys.begin(), keys.end());
    const auto distinct = std::unique(keys.begin(), keys.end()) - keys.begin();
    return static_cast<double>(distinct) * static_cast<double>(share);
  }

  /// The side that leaves about as many points as are wanted; the few too many go by lot.
  void make_last_choice() {
    const auto wanted = static_cast<double>(options_.most_points);
    const std::uint64_t share = 1 + options_.most_points / 100000;
    double low = spacing_m_;
    double high = kFastestGrowth * low;
    while (cells_at(high, share) > wanted) {
      low = high;
      high *= kFastestGrowth;
    }
    double chosen = high;
    for (int round = 0; round < 24; ++round) {
      chosen = std::sqrt(low * high);
      const double cells = cells_at(chosen, share);
      if (cells <= wanted && cells >= kCloseEnough * wanted) break;
      (cells > wanted ? low : high) = chosen;
    }
    regrid(chosen);
    drop_surplus();
  }

  /// Takes points away by lot until no more are left than wanted.
  void drop_surplus() {
    const auto most = static_cast<std::size_t>(options_.most_points);
    if (rows_.size() <= most) return;
    std::vector<std::uint32_t> order(rows_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return lot_of(~rows_[a]) < lot_of(~rows_[b]); });
    order.resize(most);
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < most; ++i) {
      packed_.copy(order[i], i);
      rows_[i] = rows_[order[i]];
    }
    rows_.resize(most);
    packed_.shrink(most);
  }

  ThinOptions options_;
  std::uint64_t expected_;
  double spacing_m_ = kFinestCellM;
  std::size_t most_cells_ = 0;
  std::size_t rows_at_once_ = kStreamRows;
  std::uint64_t read_ = 0;
  std::uint64_t unusable_ = 0;
  double more_ahead_ = 0.0;  ///< cells that the rest of the cloud would add at the rate of the last rows
  CellTable cells_;
  PackedRows packed_;
  std::vector<std::uint64_t> rows_;  ///< of the cloud, for each row of packed_
};

CloudThinner::CloudThinner(const ThinOptions& options, std::uint64_t expected)
    : cells_(std::make_unique<Cells>(options, expected)) {}
CloudThinner::~CloudThinner() = default;

void CloudThinner::add(const RecordTable& piece) {
  cells_->add(piece);
}

ThinnedCloud CloudThinner::finish() {
  return cells_->finish();
}

}  // namespace limen
