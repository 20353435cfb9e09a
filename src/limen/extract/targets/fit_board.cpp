// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>
#include <vector>

#include "limen/extract/targets/fit_targets.h"
#include "limen/geometry/plane.h"

namespace limen {
namespace {

constexpr double kDisc = 0.46;     // of the side: the circle within the board that is compared
constexpr double kBlurM = 0.0015;  // beams this near an edge may see either side
constexpr std::size_t kLeastInQuadrant = 12;
constexpr double kWrongShare = 0.03;  // of the points clear of the edges
constexpr double kContrast = 4.0;     // of the two kinds of light, in deviations of one kind
constexpr double kMostRoughM = 0.008;
constexpr double kLeastSlant = 0.3;  // cosine between the ray and the normal
constexpr double kGoesOn = 0.35;     // likeness of the surroundings to the pattern

constexpr double kRingFrom = 0.76;  // of the side: clear of the board at any turn
constexpr double kRingTo = 1.0;
constexpr std::size_t kLeastInRing = 8;  // that tell something of what is beside the board

/// A point of the board's plane, or where the ray of a point behind it went through.
struct BoardPoint {
  Vector2d x = Vector2d::Zero();  ///< about where the centre was thought to be
  double tone = 0.0;              ///< 1: bright, -1: dark
  double light = 0.0;
  bool on_board = true;  ///< it can be a point of the board
  bool beside = false;   ///< it can be a point of what is beside the board
};

/// The two kinds of light of points: by two means.
struct TwoTones {
  double dark = 0.0;
  double bright = 0.0;

  [[nodiscard]] double middle() const { return 0.5 * (dark + bright); }
};

template <typename Points>
TwoTones tones_of(const Points& points) {
  TwoTones tones;
  double threshold = 0.0;
  for (const auto& point : points) threshold += point.light / static_cast<double>(points.size());
  for (int step = 0; step < 6; ++step) {
    std::array<double, 2> sum{};
    std::array<double, 2> count{};
    for (const auto& point : points) {
      const std::size_t kind = point.light > threshold ? 1 : 0;
      sum[kind] += point.light;
      ++count[kind];
    }
    if (count[0] == 0.0 || count[1] == 0.0) return {};
    tones = {sum[0] / count[0], sum[1] / count[1]};
    if (threshold == tones.middle()) break;
    threshold = tones.middle();
  }
  return tones;
}

/// Where the two edges of the quadrants cross, and how they lie.
struct BoardPose {
  Vector2d centre = Vector2d::Zero();
  double turn_rad = 0.0;

  /// Along the two edges.
  [[nodiscard]] Vector2d on_board(const Vector2d& x) const {
    const Vector2d off = x - centre;
    const double c = std::cos(turn_rad);
    const double s = std::sin(turn_rad);
    return {c * off.x() + s * off.y(), c * off.y() - s * off.x()};
  }
};

/// The poses that explain the points: the mean of all, each with its probability, and how they scatter. A
/// point on the wrong side of an edge costs its distance; an edge is as probable anywhere between points
/// that it must part, so that a grid of points along the edges is not taken for more informative than it is.
/// Edges are the two that cross in the centre, and the board's border for points that may not be beside it,
/// or must be.
class BoardPosterior {
 public:
  BoardPosterior(const std::vector<BoardPoint>& points, double side_m) : all_(points), side_m_(side_m) {}

  void run(const BoardPose& start) {
    pose_ = start;
    Vector3d half(0.2 * side_m_, 0.2 * side_m_, 0.35);
    for (int level = 0; level < 10; ++level) {
      const Vector3d before = half;
      average(half);
      for (Eigen::Index k = 0; k < 3; ++k)
        half[k] = std::clamp(3.5 * std::sqrt(covariance_(k, k)), 1e-4 * (k < 2 ? side_m_ : 1.0), half[k]);
      if (level > 3 && (half.array() > 0.8 * before.array()).all()) break;
    }
  }

  [[nodiscard]] const BoardPose& pose() const { return pose_; }
  /// Of the centre (metres) and the turn (radians).
  [[nodiscard]] const Matrix3d& covariance() const { return covariance_; }

 private:
  static constexpr int kSteps = 4;  ///< to either side
  static constexpr std::size_t kMostPoints = 800;

  /// Takes the mean of the poses within `half` of the present one.
  void average(const Vector3d& half) {
    const double blur_m = std::max(kBlurM, half.head<2>().maxCoeff() / kSteps);
    choose(half, blur_m);
    std::vector<std::array<double, 4>> tried;  // steps along the three axes, and the cost
    double least = 1e300;
    for (int t = -kSteps; t <= kSteps; ++t) {
      for (int x = -kSteps; x <= kSteps; ++x) {
        for (int y = -kSteps; y <= kSteps; ++y) {
          const Vector3d move = half.cwiseProduct(Vector3d(x, y, t)) / kSteps;
          const double cost = cost_of({pose_.centre + move.head<2>(), pose_.turn_rad + move[2]}, blur_m);
          tried.push_back({move[0], move[1], move[2], cost});
          least = std::min(least, cost);
        }
      }
    }
    double weights = 0.0;
    Vector3d sum = Vector3d::Zero();
    Matrix3d outer = Matrix3d::Zero();
    for (const auto& [x, y, t, cost] : tried) {
      const double weight = std::exp(least - cost);
      const Vector3d move(x, y, t);
      weights += weight;
      sum += weight * move;
      outer += weight * move * move.transpose();
    }
    const Vector3d mean = sum / weights;
    covariance_ = outer / weights - mean * mean.transpose();
    // Between two steps all is possible.
    for (Eigen::Index k = 0; k < 3; ++k) covariance_(k, k) += half[k] * half[k] / (kSteps * kSteps * 12.0);
    pose_.centre += mean.head<2>();
    pose_.turn_rad += mean[2];
  }

  /// Points that no edge comes near say the same of all poses.
  void choose(const Vector3d& half, double blur_m) {
    near_.clear();
    for (const BoardPoint& point : all_) {
      const Vector2d at = pose_.on_board(point.x).cwiseAbs();
      const double reach = 1.5 * half.head<2>().maxCoeff() + half[2] * at.maxCoeff() + 2.0 * blur_m;
      const bool border = !(point.on_board && point.beside) && at.maxCoeff() > 0.5 * side_m_ - reach;
      if (at.minCoeff() < reach || border) near_.push_back(point);
    }
    if (near_.size() <= kMostPoints) return;
    const std::size_t stride = (near_.size() + kMostPoints - 1) / kMostPoints;
    for (std::size_t k = 0; k * stride < near_.size(); ++k) near_[k] = near_[k * stride];
    near_.resize((near_.size() + stride - 1) / stride);
  }

  /// How far a point is from where it can be, by its place along the two edges.
  [[nodiscard]] double misfit_m(const Vector2d& at, const BoardPoint& point) const {
    const double out_m = at.cwiseAbs().maxCoeff() - 0.5 * side_m_;
    const double off_tone_m = at.x() * at.y() * point.tone < 0.0 ? at.cwiseAbs().minCoeff() : 0.0;
    const double as_board_m = point.on_board ? std::max(out_m, off_tone_m) : 1e300;
    const double as_beside_m = point.beside ? -out_m : 1e300;
    return std::max(0.0, std::min(as_board_m, as_beside_m));
  }

  [[nodiscard]] double cost_of(const BoardPose& pose, double blur_m) const {
    constexpr double kMostCost = 5.0;
    double cost = 0.0;
    const double c = std::cos(pose.turn_rad);
    const double s = std::sin(pose.turn_rad);
    for (const BoardPoint& point : near_) {
      const Vector2d off = point.x - pose.centre;
      const double away_m = misfit_m({c * off.x() + s * off.y(), c * off.y() - s * off.x()}, point);
      cost += std::min(kMostCost, away_m / blur_m);
    }
    return cost;
  }

  const std::vector<BoardPoint>& all_;
  double side_m_;
  std::vector<BoardPoint> near_;
  BoardPose pose_;
  Matrix3d covariance_ = Matrix3d::Zero();
};

/// What is seen of a board's circle and round it.
class BoardCheck {
 public:
  BoardCheck(const BoardPose& pose, double side_m, double noise_m)
      : pose_(pose), side_m_(side_m), clear_m_(std::max(2.0 * kBlurM, noise_m)) {}

  void add(const BoardPoint& point) {
    const Vector2d at = pose_.on_board(point.x);
    const double away = at.norm() / side_m_;
    const double as_on_board = at.x() * at.y() > 0.0 ? point.tone : -point.tone;
    if (away < kDisc) {
      Part& part = quadrants_[(at.x() > 0.0 ? 1U : 0U) + (at.y() > 0.0 ? 2U : 0U)];
      ++part.count;
      if (at.cwiseAbs().minCoeff() < clear_m_) return;
      ++clear_;
      wrong_ += as_on_board < 0.0 ? 1.0 : 0.0;
      part.light.push_back(point.light);
    } else if (away > kRingFrom && away < kRingTo) {
      // Squares of half the side would be as on the board at its corners, and the reverse beside it.
      Around& around = at.cwiseAbs().minCoeff() > 0.5 * side_m_ ? corners_ : sides_;
      ++around.count;
      around.likeness += as_on_board;
    }
  }

  [[nodiscard]] bool board() const {
    if (clear_ == 0.0 || wrong_ > kWrongShare * clear_) return false;
    double count = 0.0;
    for (const Part& part : quadrants_) count += part.count;
    for (const Part& part : quadrants_) {
      if (part.light.size() < kLeastInQuadrant || part.count < 0.12 * count) return false;
    }
    return contrast() > kContrast;
  }
  /// Whether the pattern ends with the board.
  [[nodiscard]] bool ends() const { return !corners_.goes_on() && !sides_.goes_on(); }

 private:
  struct Part {
    double count = 0.0;
    std::vector<double> light;
  };
  struct Around {
    double count = 0.0;
    double likeness = 0.0;
    [[nodiscard]] bool goes_on() const {
      return count >= static_cast<double>(kLeastInRing) && std::abs(likeness) > kGoesOn * count;
    }
  };

  /// How far the darkest bright quadrant is from the brightest dark one, in deviations within them.
  [[nodiscard]] double contrast() const {
    std::array<double, 4> means{};
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      for (const double light : quadrants_[k].light) means[k] += light;
      means[k] /= static_cast<double>(quadrants_[k].light.size());
      for (const double light : quadrants_[k].light) squares += (light - means[k]) * (light - means[k]);
      count += static_cast<double>(quadrants_[k].light.size());
    }
    const double one = std::min(means[0], means[3]) - std::max(means[1], means[2]);
    const double other = std::min(means[1], means[2]) - std::max(means[0], means[3]);
    return std::max(one, other) / std::sqrt(std::max(squares / count, 1e-12));
  }

  const BoardPose& pose_;
  double side_m_;
  double clear_m_;
  std::array<Part, 4> quadrants_;
  Around corners_;
  Around sides_;
  double clear_ = 0.0;
  double wrong_ = 0.0;
};

/// The plane of a board by the points within its circle: refined from those in a ball.
std::optional<PlaneFit> plane_near(const Vector3d& start, std::span<const LitPoint> points, double side_m) {
  std::optional<PlaneFit> fit;
  for (int step = 0; step < 4; ++step) {
    PointMoments moments;
    const double within_m = fit ? std::max(3.0 * fit->rms_m, 0.003) : side_m;
    for (const LitPoint& point : points) {
      if ((point.x - start).norm() > kDisc * side_m) continue;
      if (fit && std::abs(fit->plane.signed_distance(point.x)) > within_m) continue;
      moments.add(point.x - start);
    }
    if (moments.count < 4.0 * static_cast<double>(kLeastInQuadrant)) return std::nullopt;
    fit = fit_plane(moments);
    fit->centroid += start;
    fit->plane.offset += fit->plane.normal.dot(start);
  }
  if (fit->rms_m > kMostRoughM || std::abs(fit->plane.normal.dot(start.normalized())) < kLeastSlant)
    return std::nullopt;
  return fit;
}

/// The second harmonic of the tones round `frame`'s origin.
std::complex<double> quadrant_harmonic(const PlaneFrame& frame, std::span<const LitPoint> points,
                                       double threshold) {
  std::complex<double> sum = 0.0;
  for (const LitPoint& point : points) {
    const Vector2d x = frame.to_plane(point.x);
    const double squared = x.squaredNorm();
    if (squared < 1e-12) continue;
    const std::complex<double> twice(x.x() * x.x() - x.y() * x.y(), 2.0 * x.x() * x.y());
    sum += (point.light > threshold ? 1.0 : -1.0) * twice / squared;
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

std::vector<LitPoint> within_circle(const Vector3d& middle, std::span<const LitPoint> points, double side_m) {
  std::vector<LitPoint> within;
  for (const LitPoint& point : points) {
    if ((point.x - middle).norm() < kDisc * side_m) within.push_back(point);
  }
  return within;
}

/// What is seen of a plane: on it, and through it.
struct PlaneView {
  std::vector<BoardPoint> on;
  std::vector<BoardPoint> through;
};

PlaneView view_of(const PlaneFit& fit, const PlaneFrame& frame, std::span<const LitPoint> points,
                  double threshold) {
  const double thick_m = std::max(4.0 * fit.rms_m, 0.004);
  const double scanner = fit.plane.signed_distance(Vector3d::Zero());
  PlaneView view;
  for (const LitPoint& point : points) {
    const double height = fit.plane.signed_distance(point.x);
    // Where the ray meets the plane: noise moves points along their rays.
    const BoardPoint met{frame.to_plane(scanner / (scanner - height) * point.x),
                         point.light > threshold ? 1.0 : -1.0, point.light};
    if (std::abs(height) < thick_m) {
      view.on.push_back(met);
    } else if (height * scanner < 0.0) {
      view.through.push_back(met);
    }
  }
  return view;
}

std::vector<BoardPoint> in_disc(const std::vector<BoardPoint>& points, const Vector2d& middle,
                                double radius_m) {
  std::vector<BoardPoint> within;
  std::copy_if(points.begin(), points.end(), std::back_inserter(within),
               [&](const BoardPoint& point) { return (point.x - middle).norm() < radius_m; });
  return within;
}

/// The points of a view that tell where the board lies. Where the border can be seen, because there is
/// nothing in its plane beside it, or because that sends back another light, points are of the board, or
/// beside it; else only the circle within is used.
class BorderPoints {
 public:
  BorderPoints(const PlaneView& view, const BoardPose& pose, double side_m)
      : view_(view), pose_(pose), side_m_(side_m), inner_(in_disc(view.on, pose.centre, kDisc * side_m)) {}

  [[nodiscard]] std::vector<BoardPoint> run() const {
    std::vector<BoardPoint> points;
    const std::vector<BoardPoint> around = ring(view_.on);
    const bool stands_free = around.size() < kLeastInRing;
    if (stands_free && ring(view_.through).size() < kLeastInRing) return inner_;
    const TwoTones tones = tones_of(inner_);
    const Light beside = light_of(around);
    for (BoardPoint point : in_disc(view_.on, pose_.centre, side_m_)) {
      if (!stands_free) {
        const double tone = point.tone > 0.0 ? tones.bright : tones.dark;
        const bool distinct = std::abs(beside.mean - tone) > kContrast * beside.deviation;
        point.beside = !distinct || std::abs(point.light - beside.mean) < std::abs(point.light - tone);
        point.on_board = !(distinct && point.beside);
      }
      points.push_back(point);
    }
    for (BoardPoint point : in_disc(view_.through, pose_.centre, side_m_)) {
      point.on_board = false;
      point.beside = true;
      points.push_back(point);
    }
    return ends_there(points) ? points : inner_;
  }

 private:
  struct Light {
    double mean = 0.0;
    double deviation = 0.0;
  };

  [[nodiscard]] std::vector<BoardPoint> ring(const std::vector<BoardPoint>& points) const {
    std::vector<BoardPoint> within;
    for (const BoardPoint& point : points) {
      const double away = (point.x - pose_.centre).norm() / side_m_;
      if (away > kRingFrom && away < kRingTo) within.push_back(point);
    }
    return within;
  }

  static Light light_of(const std::vector<BoardPoint>& points) {
    Light light;
    const auto count = static_cast<double>(std::max<std::size_t>(1, points.size()));
    for (const BoardPoint& point : points) light.mean += point.light / count;
    double squares = 0.0;
    for (const BoardPoint& point : points)
      squares += (point.light - light.mean) * (point.light - light.mean) / count;
    light.deviation = std::sqrt(squares);
    return light;
  }

  /// Whether the points change where the board's side says: it may have a margin, or something may hide it.
  [[nodiscard]] bool ends_there(const std::vector<BoardPoint>& points) const {
    double count = 0.0;
    double wrong = 0.0;
    for (const BoardPoint& point : points) {
      const double out = pose_.on_board(point.x).cwiseAbs().maxCoeff() / side_m_ - 0.5;
      if (std::abs(out) < 0.05 || std::abs(out) > 0.15 || (point.on_board && point.beside)) continue;
      ++count;
      if (out < 0.0 ? !point.on_board : !point.beside) ++wrong;
    }
    return wrong <= kWrongShare * count;
  }

  const PlaneView& view_;
  const BoardPose& pose_;
  double side_m_;
  std::vector<BoardPoint> inner_;
};

BoardCheck check_of(const PlaneView& view, const BoardPose& pose, double side_m, double noise_m) {
  BoardCheck check(pose, side_m, noise_m);
  for (const BoardPoint& point : view.on) check.add(point);
  return check;
}

double largest_variance(const Eigen::Matrix2d& covariance) {
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1));
  return mean + std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
}

}  // namespace

double board_likeness(const Vector3d& middle, std::span<const LitPoint> about, double side_m) {
  const std::vector<LitPoint> within = within_circle(middle, about, side_m);
  if (within.size() < 4 * kLeastInQuadrant) return 0.0;
  // Light of two kinds is off its mean by about as much everywhere; one pass leaves few places.
  const auto count = static_cast<double>(within.size());
  double mean = 0.0;
  for (const LitPoint& point : within) mean += point.light / count;
  double off = 0.0;
  double squares = 0.0;
  for (const LitPoint& point : within) {
    off += std::abs(point.light - mean) / count;
    squares += (point.light - mean) * (point.light - mean) / count;
  }
  if (!(off > 0.85 * std::sqrt(squares)) || squares == 0.0) return 0.0;
  PointMoments moments;
  for (const LitPoint& point : within) moments.add(point.x - middle);
  const PlaneFit fit = fit_plane(moments);
  if (fit.rms_m > 0.1 * side_m) return 0.0;
  const PlaneFrame frame = make_frame({fit.plane.normal, fit.plane.normal.dot(middle)}, middle);
  const double likeness = std::abs(quadrant_harmonic(frame, within, tones_of(within).middle()));
  constexpr double kLeastLikeness = 0.35;
  return likeness > kLeastLikeness ? likeness * count : 0.0;
}

std::optional<FoundTarget> fit_board(const Vector3d& start, std::span<const LitPoint> points, double side_m) {
  const std::optional<PlaneFit> fit = plane_near(start, points, side_m);
  if (!fit) return std::nullopt;
  const PlaneFrame frame = make_frame(fit->plane, start);
  const std::vector<LitPoint> within = within_circle(frame.origin, points, side_m);
  const double threshold = tones_of(within).middle();
  const PlaneView view = view_of(*fit, frame, points, threshold);
  // Edges at 45 degrees to where the tones are brightest; by few points at first, which are the board's.
  BoardPose pose{Vector2d::Zero(),
                 0.5 * std::arg(quadrant_harmonic(frame, within, threshold)) - 0.25 * std::numbers::pi};
  Matrix3d covariance = Matrix3d::Zero();
  for (const double share : {0.7, 1.0}) {
    const std::vector<BoardPoint> telling = share < 1.0
                                                ? in_disc(view.on, pose.centre, share * kDisc * side_m)
                                                : BorderPoints(view, pose, side_m).run();
    if (telling.size() < 4 * kLeastInQuadrant) return std::nullopt;
    BoardPosterior posterior(telling, side_m);
    posterior.run(pose);
    pose = posterior.pose();
    covariance = posterior.covariance();
    if (pose.centre.norm() > 0.3 * side_m || !check_of(view, pose, side_m, fit->rms_m).ends())
      return std::nullopt;
  }
  const std::size_t count = in_disc(view.on, pose.centre, kDisc * side_m).size();
  const std::size_t open = in_disc(view.through, pose.centre, 0.9 * kDisc * side_m).size();
  if (!check_of(view, pose, side_m, fit->rms_m).board() || 20 * open > count) return std::nullopt;
  const double sigma_m = std::sqrt(std::max(largest_variance(covariance.topLeftCorner<2, 2>()),
                                            fit->rms_m * fit->rms_m / static_cast<double>(count)) +
                                   kTargetMakeM * kTargetMakeM);
  if (!(sigma_m <= kMostTargetSigmaM)) return std::nullopt;
  return FoundTarget{TargetKind::board, frame.to_space(pose.centre), sigma_m, count};
}

}  // namespace limen
