// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Drifting passes in the joint adjustment alone, from simulated features: passes drive round a building of
// 60 x 40 m, 30 stations stand behind its facades, linked to their neighbours (4 mm, 0.03 degrees), and see
// part of what the passes see; some stations are known, as by control points. Prints how far points of the
// passes, and the stations, lie from the truth with rigid passes and with bent ones, and what the truth's own
// splines would leave.
//   bench_bent_passes --drift-m 0.02 --passes 4 --seeds 10
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/linear.h"
#include "limen/geometry/random_vectors.h"
#include "limen/geometry/spline_motion.h"
#include "limen/project/passes/bent_passes.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

constexpr double kKnotM = 2.5;    // as find_pass_track() has them
constexpr double kCoarseM = 5.0;  // another spline to compare with
constexpr int kFine = 8;          // steps of the walk from knot to knot
constexpr double kTileM = 0.002;
constexpr double kCommonM = 0.001;
constexpr int kTiles = 8;
const double kLinkRad = radians(0.03);
constexpr double kLinkM = 0.004;

struct Settings {
  double drift_m = 0.008;
  int passes = 4;
  int stations = 30;
  int known = 4;
  int seeds = 5;
  int first = 1;
};

/// A rectangle's outline, walked counterclockwise.
struct Outline {
  double width = 60.0;
  double depth = 40.0;
  [[nodiscard]] double length() const { return 2.0 * (width + depth); }
  /// Place on it, and outward direction.
  [[nodiscard]] std::pair<Vector3d, Vector3d> at(double s) const {
    s = std::fmod(s + 10.0 * length(), length());
    if (s < width) return {{s - width / 2, -depth / 2, 0}, {0, -1, 0}};
    s -= width;
    if (s < depth) return {{width / 2, s - depth / 2, 0}, {1, 0, 0}};
    s -= depth;
    if (s < width) return {{width / 2 - s, depth / 2, 0}, {0, 1, 0}};
    s -= width;
    return {{-width / 2, depth / 2 - s, 0}, {-1, 0, 0}};
  }
};

/// A patch of a plane: where along the outline it is seen, and the patch itself.
struct Patch {
  double along = 0.0;
  Vector3d middle;
  Vector3d u;
  Vector3d v;
};

struct Pass {
  double from = 0.0;  // along the outline
  PassWay way;
  std::vector<Vector3d> error;  // of what is measured, kFine steps from knot to knot

  [[nodiscard]] Vector3d error_at(double place) const {
    const double at = kFine * place;
    const auto step = std::min(error.size() - 2, static_cast<std::size_t>(at));
    const double share = at - static_cast<double>(step);
    return (1.0 - share) * error[step] + share * error[step + 1];
  }
};

class Site {
 public:
  Site(const Settings& settings, std::uint64_t seed) : settings_(settings), seed_(seed) {
    RandomStream random(seed, 1);
    for (double s = 1.5; s < outline_.length(); s += 3.0) add_patches(s);
    for (int k = 0; k < settings.passes; ++k) passes_.push_back(driven(k, random));
    for (int k = 0; k < settings.stations; ++k) {
      const auto [x, out] = outline_.at(outline_.length() * k / settings.stations);
      Rigid3 pose;
      pose.rotation = rotation_exp({0, 0, random.uniform(-3.0, 3.0)});
      pose.translation = x - 4.0 * out + Vector3d(0, 0, 1.6);
      stations_.push_back(pose);
    }
  }

  struct Missed {
    double points_m = 0.0;
    double spline_m = 0.0;
    double coarse_m2 = 0.0;  ///< of a spline with knots 5 m apart
    double stations_m = 0.0;
    int within = 0;
    int numbers = 0;
  };

  Missed run(bool bend) const {
    std::vector<PassToBend> given;
    for (std::size_t k = 0; bend && k < passes_.size(); ++k)
      given.push_back({node_of_pass(k), &passes_[k].way, settings_.drift_m});
    BentPasses bent(given);
    for (int round = 0; bend && round < 8; ++round) {
      const JointProblem made = problem(bent);
      if (bent.take(made, adjust_jointly(made)) < 1.1 && round >= 2) break;
    }
    const JointProblem made = problem(bent);
    const JointSolution solution = adjust_jointly(made);
    return missed(solution, bent.stated(solution));
  }

 private:
  [[nodiscard]] int node_of_pass(std::size_t k) const { return settings_.stations + static_cast<int>(k); }

  void add_patches(double s) {
    const auto [x, out] = outline_.at(s);
    const Vector3d along(-out.y(), out.x(), 0.0);
    const Vector3d up = Vector3d::UnitZ();
    for (const double z : {2.0, 5.0, 8.0}) patches_.push_back({s, x + z * up, along, up});
    for (const double far : {3.0, 6.0, 9.0}) patches_.push_back({s, x + far * out, along, out});
    for (const double z : {2.0, 5.0}) patches_.push_back({s, x + 16.0 * out + z * up, along, up});
    // Sides of porches and bays.
    if (std::fmod(s, 12.0) < 3.0) patches_.push_back({s, x + 0.5 * out + 3.0 * up, out, up});
  }

  Pass driven(int number, RandomStream& random) const {
    Pass pass;
    // Each along two sides, from a quarter further on.
    pass.from = outline_.length() * number / std::max(1, settings_.passes);
    const double length = 0.5 * outline_.length();
    const int spans = static_cast<int>(std::lround(length / kKnotM));
    for (int k = 0; k <= spans; ++k) {
      const auto [x, out] = outline_.at(pass.from + length * k / spans);
      pass.way.times_s.push_back(k);
      pass.way.distances_m.push_back(length * k / spans);
      pass.way.places.emplace_back(x + 8.0 * out + Vector3d(0, 0, 2));
    }
    const double step = settings_.drift_m * std::sqrt(6.0 / (spans * kFine));
    Vector3d at = Vector3d::Zero();
    Vector3d mean = Vector3d::Zero();
    for (int k = 0; k <= spans * kFine; ++k) {
      pass.error.push_back(at);
      mean += at / (spans * kFine + 1);
      for (Eigen::Index axis = 0; axis < 3; ++axis) at[axis] += step * random.normal();
    }
    for (Vector3d& error : pass.error) error -= mean;
    return pass;
  }

  PlaneObservation seen(const Patch& patch, double half_u, const Rigid3& node_from_world, double common_m,
                        RandomStream& random) const {
    PlaneObservation observation;
    observation.anchor = node_from_world * patch.middle;
    observation.most_points = kTiles;
    observation.sigma_m = std::hypot(kTileM, common_m * std::sqrt(double{kTiles}));
    const Vector3d normal = patch.u.cross(patch.v);
    const double common = kCommonM * random.normal();
    for (int k = 0; k < kTiles; ++k) {
      const double off = common + kTileM * random.normal();
      const Vector2d in = uniform_vector(Vector2d(-half_u, -1.5), Vector2d(half_u, 1.5), random);
      const Vector3d point = patch.middle + in.x() * patch.u + in.y() * patch.v + off * normal;
      observation.moments.add(node_from_world * point - observation.anchor);
    }
    return observation;
  }

  JointProblem problem(BentPasses& bent) const {
    RandomStream random(seed_, 2);
    JointProblem made;
    for (std::size_t k = 0; k < stations_.size() + passes_.size(); ++k) {
      made.frame_from_node.push_back(k < stations_.size() ? stations_[k] : Rigid3{});
      const std::size_t every = stations_.size() / static_cast<std::size_t>(std::max(1, settings_.known));
      made.fixed.push_back(k < stations_.size() && k % every == 0 &&
                           k / every < static_cast<std::size_t>(std::max(1, settings_.known)));
    }
    bent.add_to(made);
    add_links(made, random);
    for (const Patch& patch : patches_) {
      add_seen_by_stations(patch, made, random);
      for (std::size_t k = 0; k < passes_.size(); ++k) add_seen_by_pass(patch, k, bent, made, random);
      ++made.planes;
    }
    return made;
  }

  void add_links(JointProblem& made, RandomStream& random) const {
    const auto count = static_cast<int>(stations_.size());
    for (int k = 0; k < count; ++k) {
      for (const int step : {1, 2}) {
        const int other = (k + step) % count;
        Vector6d error;
        for (Eigen::Index j = 0; j < 6; ++j) error[j] = (j < 3 ? kLinkRad : kLinkM) * random.normal();
        PoseEdge edge;
        edge.source = k;
        edge.target = other;
        const Rigid3 truth =
            inverse(stations_[static_cast<std::size_t>(other)]) * stations_[static_cast<std::size_t>(k)];
        edge.pose.centre = truth.translation;
        edge.pose.target_from_source.rotation = rotation_exp(error.head<3>()) * truth.rotation;
        edge.pose.target_from_source.translation = truth.translation + error.tail<3>();
        edge.pose.covariance.setZero();
        edge.pose.covariance.diagonal().head<3>().setConstant(kLinkRad * kLinkRad);
        edge.pose.covariance.diagonal().tail<3>().setConstant(kLinkM * kLinkM);
        made.edges.push_back(edge);
      }
    }
  }

  void add_seen_by_stations(const Patch& patch, JointProblem& made, RandomStream& random) const {
    for (std::size_t k = 0; k < stations_.size(); ++k) {
      if ((patch.middle - stations_[k].translation).norm() > 9.0) continue;
      PlaneObservation observation = seen(patch, 1.5, inverse(stations_[k]), kCommonM, random);
      observation.node = static_cast<int>(k);
      observation.plane = made.planes;
      made.observations.push_back(observation);
    }
  }

  /// In two strips, as it drives past.
  void add_seen_by_pass(const Patch& patch, std::size_t k, const BentPasses& bent, JointProblem& made,
                        RandomStream& random) const {
    const Pass& pass = passes_[k];
    const int node = node_of_pass(k);
    for (const double part : {-0.75, 0.75}) {
      double along = patch.along + part - pass.from;
      along = std::fmod(along + 10.0 * outline_.length(), outline_.length());
      if (along > pass.way.distances_m.back()) continue;
      const double place = along / pass.way.distances_m.back() * (pass.way.knots() - 1);
      Patch strip = patch;
      const bool lies_along = std::abs(patch.u.dot(outline_.at(patch.along).second)) < 0.5;
      if (lies_along) strip.middle += part * patch.u;
      const Rigid3 measured{Matrix3d::Identity(), pass.error_at(place)};
      const double drift = bent.bends(node) ? bent.unfollowed_m(node) : settings_.drift_m;
      PlaneObservation observation =
          seen(strip, lies_along ? 0.75 : 1.5, measured, std::hypot(kCommonM, drift), random);
      observation.node = bent.bends(node) ? bent.node_at(made, node, {place}) : node;
      observation.plane = made.planes;
      made.observations.push_back(observation);
    }
  }

  /// What a natural spline with so many knots leaves that is fitted to a pass's true drift, squared.
  static double spline_leaves(const Pass& pass, int knots) {
    const double every = static_cast<double>(pass.error.size() - 1) / (knots - 1);
    Eigen::MatrixXd normal = 1e-9 * Eigen::MatrixXd::Identity(knots, knots);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(knots, 3);
    const auto each = [&](const auto& use) {
      for (std::size_t i = 0; i < pass.error.size(); ++i)
        use(spline_shares(knots, static_cast<double>(i) / every), pass.error[i]);
    };
    each([&](const auto& shares, const Vector3d& error) {
      for (const SplineShare& a : shares) {
        right.row(a.control) += a.weight * error.transpose();
        for (const SplineShare& b : shares) normal(a.control, b.control) += a.weight * b.weight;
      }
    });
    const Eigen::MatrixXd controls = inverse_of(normal) * right;
    double squares = 0.0;
    each([&](const auto& shares, const Vector3d& error) {
      Vector3d left = error;
      for (const SplineShare& a : shares) left -= a.weight * controls.row(a.control).transpose();
      squares += left.squaredNorm();
    });
    return squares / static_cast<double>(pass.error.size());
  }

  [[nodiscard]] Missed missed(const JointSolution& solution, const std::vector<BentPass>& stated) const {
    Missed missed;
    double points = 0.0;
    double spline = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < passes_.size(); ++k) {
      const Pass& pass = passes_[k];
      const Rigid3& whole = solution.frame_from_node[static_cast<std::size_t>(node_of_pass(k))];
      std::vector<Vector6d> values;
      if (!stated.empty()) {
        for (const BentKnot& knot : stated[k].knots) values.push_back(knot.value);
        count_knots(pass, stated[k], missed);
      }
      const double passes = static_cast<double>(passes_.size());
      spline += spline_leaves(pass, pass.way.knots()) / passes;
      const int coarse = static_cast<int>(std::lround(pass.way.distances_m.back() / kCoarseM)) + 1;
      missed.coarse_m2 += spline_leaves(pass, coarse) / passes;
      for (std::size_t i = 0; i < pass.error.size(); ++i) {
        const double place = static_cast<double>(i) / kFine;
        const auto [x, out] =
            outline_.at(pass.from + pass.way.distances_m.back() * place / (pass.way.knots() - 1));
        for (const double far : {0.0, 8.0, 16.0}) {
          const Vector3d truth = x + far * out + Vector3d(0, 0, 3);
          Vector3d found = whole * (truth + pass.error[i]);
          if (!values.empty())
            found = SplineMotion(pass.way.times_s, values, whole.translation).moved(found, place);
          points += (found - truth).squaredNorm();
          count += 1.0;
        }
      }
    }
    double stations = 0.0;
    for (std::size_t k = 1; k < stations_.size(); ++k)
      stations += (solution.frame_from_node[k].translation - stations_[k].translation).squaredNorm() /
                  static_cast<double>(stations_.size() - 1);
    missed.points_m = std::sqrt(points / count);
    missed.spline_m = std::sqrt(spline);
    missed.stations_m = std::sqrt(stations);
    return missed;
  }

  /// Numbers of the corrections, about their means, within two of their deviations.
  static void count_knots(const Pass& pass, const BentPass& stated, Missed& missed) {
    const auto moved = [&](std::size_t k) {
      return Vector3d(stated.knots[k].value.tail<3>() +
                      stated.knots[k].value.head<3>().cross(pass.way.places[k]));
    };
    Vector3d mean = Vector3d::Zero();
    const auto count = static_cast<double>(stated.knots.size());
    for (std::size_t k = 0; k < stated.knots.size(); ++k)
      mean += (moved(k) + pass.error_at(static_cast<double>(k))) / count;
    for (std::size_t k = 0; k < stated.knots.size(); ++k) {
      const Vector3d off = moved(k) + pass.error_at(static_cast<double>(k)) - mean;
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        ++missed.numbers;
        missed.within +=
            std::abs(off[axis]) < 2.0 * std::sqrt(stated.knots[k].covariance(3 + axis, 3 + axis)) ? 1 : 0;
      }
    }
  }

  const Settings& settings_;
  std::uint64_t seed_;
  Outline outline_;
  std::vector<Patch> patches_;
  std::vector<Pass> passes_;
  std::vector<Rigid3> stations_;
};

void run(const Settings& settings) {
  fmt::print("{} passes of 100 m, drift {} mm (random walk), {} stations; mm, root of the mean square\n",
             settings.passes, 1e3 * settings.drift_m, settings.stations);
  fmt::print("{:>4} {:>13} {:>12} {:>12} {:>7} {:>12} {:>7} {:>15} {:>14} {:>11}\n", "seed", "points rigid",
             "bent", "own spline", "ratio", "of 5 m", "ratio", "stations rigid", "bent", "in 2 sigma");
  double points = 0.0;
  double splines = 0.0;
  for (int seed = settings.first; seed < settings.first + settings.seeds; ++seed) {
    const Site site(settings, static_cast<std::uint64_t>(seed));
    const Site::Missed rigid = site.run(false);
    const Site::Missed bent = site.run(true);
    points += bent.points_m * bent.points_m;
    splines += bent.spline_m * bent.spline_m;
    const double coarse_m = std::sqrt(bent.coarse_m2);
    fmt::print("{:4} {:13.2f} {:12.2f} {:12.2f} {:7.2f} {:12.2f} {:7.2f} {:15.2f} {:14.2f} {:9.1f} %\n", seed,
               1e3 * rigid.points_m, 1e3 * bent.points_m, 1e3 * bent.spline_m, bent.points_m / bent.spline_m,
               1e3 * coarse_m, bent.points_m / coarse_m, 1e3 * rigid.stations_m, 1e3 * bent.stations_m,
               100.0 * bent.within / std::max(1, bent.numbers));
    std::fflush(stdout);
  }
  fmt::print("all: points {:.2f} times what the own splines leave\n", std::sqrt(points / splines));
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app{"Drifting passes in the joint adjustment, from simulated features"};
  app.add_option("--drift-m", settings.drift_m, "One standard deviation per axis");
  app.add_option("--passes", settings.passes, "Each along half of the building");
  app.add_option("--stations", settings.stations, "Behind the facades");
  app.add_option("--known", settings.known, "Stations whose pose is known");
  app.add_option("--seeds", settings.seeds, "How many");
  app.add_option("--seed", settings.first, "The first");
  CLI11_PARSE(app, argc, argv);
  run(settings);
  return 0;
}
