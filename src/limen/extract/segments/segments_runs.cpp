// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/extract/segments/segments_borders.h"

namespace limen {
namespace {

constexpr double kWaviness = 0.6;       // of an outline, in units of the spacing
constexpr double kShortestPiece = 4.0;  // pixels

double tolerance_at(const PlaneImage& image, const Vector2d& p) {
  return image.pixel_m() + kWaviness * image.spacing_m(p);
}

/// Corners of a ring, as indices: no point is further from its chord than the tolerance at that point.
class CornerFinder {
 public:
  CornerFinder(const PlaneImage& image, const Ring& ring) : ring_(ring) {
    tolerance_.reserve(ring.size());
    for (const Vector2d& p : ring) tolerance_.push_back(tolerance_at(image, p));
  }

  [[nodiscard]] std::vector<std::size_t> run() const {
    // From the point farthest from the first to the point farthest from that: a ring has no ends.
    const std::size_t first = farthest_from(0);
    const std::size_t second = farthest_from(first);
    std::vector<std::size_t> corners;
    split(std::min(first, second), std::max(first, second), corners);
    split(std::max(first, second), std::min(first, second) + ring_.size(), corners);
    return corners;
  }

 private:
  [[nodiscard]] const Vector2d& at(std::size_t i) const { return ring_[i % ring_.size()]; }
  [[nodiscard]] std::size_t farthest_from(std::size_t from) const {
    std::size_t best = 0;
    for (std::size_t i = 0; i < ring_.size(); ++i)
      if ((ring_[i] - ring_[from]).squaredNorm() > (ring_[best] - ring_[from]).squaredNorm()) best = i;
    return best;
  }
  /// Writes the first corner of each piece between `begin` and `end`.
  void split(std::size_t begin, std::size_t end, std::vector<std::size_t>& corners) const {
    std::vector<std::pair<std::size_t, std::size_t>> open = {{begin, end}};
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      const std::size_t worst = worst_between(from, to);
      if (worst == from) {
        corners.push_back(from);
        continue;
      }
      open.emplace_back(worst, to);
      open.emplace_back(from, worst);
    }
  }
  [[nodiscard]] std::size_t worst_between(std::size_t from, std::size_t to) const {
    const Vector2d chord = (at(to) - at(from)).normalized();
    const Vector2d across(-chord.y(), chord.x());
    std::size_t worst = from;
    double most = 1.0;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double off = std::abs((at(i) - at(from)).dot(across)) / tolerance_[i % ring_.size()];
      if (off <= most) continue;
      most = off;
      worst = i;
    }
    return worst;
  }

  const Ring& ring_;
  std::vector<double> tolerance_;
};

/// Least-squares line through ring points [begin, end], `along` the way the ring runs.
Strip line_through(const Ring& ring, std::size_t begin, std::size_t end) {
  Vector2d mean = Vector2d::Zero();
  for (std::size_t i = begin; i <= end; ++i) mean += ring[i % ring.size()];
  mean /= static_cast<double>(end - begin + 1);
  Eigen::Matrix2d outer = Eigen::Matrix2d::Zero();
  for (std::size_t i = begin; i <= end; ++i) {
    const Vector2d off = ring[i % ring.size()] - mean;
    outer += off * off.transpose();
  }
  const double angle = 0.5 * std::atan2(2.0 * outer(0, 1), outer(0, 0) - outer(1, 1));
  Strip strip;
  strip.origin = mean;
  strip.along = Vector2d(std::cos(angle), std::sin(angle));
  if (strip.along.dot(ring[end % ring.size()] - ring[begin % ring.size()]) < 0.0) strip.along = -strip.along;
  return strip;
}

/// Grows pieces of one ring into straight runs.
class RunGrower {
 public:
  RunGrower(const PlaneImage& image, const Ring& ring)
      : image_(image), ring_(ring), used_(ring.size(), 0), hole_(signed_area(ring) < 0.0) {}

  void run(double min_length_m, std::vector<StraightRun>& runs) {
    const std::vector<std::size_t> corners = CornerFinder(image_, ring_).run();
    std::vector<std::pair<std::size_t, std::size_t>> pieces;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::size_t next = corners[(k + 1) % corners.size()];
      pieces.emplace_back(corners[k], next > corners[k] ? next : next + ring_.size());
    }
    std::stable_sort(pieces.begin(), pieces.end(),
                     [&](const auto& a, const auto& b) { return length(a) > length(b); });
    for (const auto& piece : pieces) {
      if (length(piece) < kShortestPiece * image_.pixel_m()) break;
      if (used_[(piece.first + piece.second) / 2 % ring_.size()] != 0) continue;
      const StraightRun run = grown(piece);
      if (run.line.end_m - run.line.begin_m >= min_length_m) runs.push_back(run);
    }
  }

 private:
  using Piece = std::pair<std::size_t, std::size_t>;
  [[nodiscard]] const Vector2d& at(std::size_t i) const { return ring_[i % ring_.size()]; }
  [[nodiscard]] double length(const Piece& piece) const {
    return (at(piece.second) - at(piece.first)).norm();
  }

  [[nodiscard]] StraightRun grown(const Piece& piece) {
    Piece span = piece;
    Strip line = line_through(ring_, span.first, span.second);
    for (int round = 0; round < 2; ++round) {
      extend(line, span);
      line = line_through(ring_, span.first, span.second);
    }
    StraightRun run{line, hole_};
    for (std::size_t i = span.first; i <= span.second; ++i) {
      const double t = (at(i) - line.origin).dot(line.along);
      run.line.begin_m = std::min(run.line.begin_m, t);
      run.line.end_m = std::max(run.line.end_m, t);
      used_[i % ring_.size()] = 1;
    }
    return run;
  }

  /// Takes in what follows on either side as long as it keeps to the line.
  void extend(const Strip& line, Piece& span) const {
    const auto fits = [&](std::size_t i) {
      const Vector2d& p = at(i);
      return used_[i % ring_.size()] == 0 &&
             std::abs((p - line.origin).dot(line.inward())) < 1.5 * tolerance_at(image_, p);
    };
    while (span.second - span.first + 1 < ring_.size() && fits(span.second + 1)) ++span.second;
    while (span.second - span.first + 1 < ring_.size() && fits(span.first + ring_.size() - 1)) {
      if (span.first == 0) {
        span.first += ring_.size();
        span.second += ring_.size();
      }
      --span.first;
    }
  }

  const PlaneImage& image_;
  const Ring& ring_;
  std::vector<char> used_;
  bool hole_;
};

}  // namespace

std::vector<StraightRun> straight_runs(const PlaneImage& image, double min_length_m) {
  std::vector<StraightRun> runs;
  for (const Ring& ring : image.contours()) {
    if (static_cast<double>(ring.size()) * image.pixel_m() < 2.0 * min_length_m) continue;
    RunGrower(image, ring).run(min_length_m, runs);
  }
  return runs;
}

}  // namespace limen
