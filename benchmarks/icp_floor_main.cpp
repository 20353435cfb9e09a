// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// The noise floor that registration is held against: point-to-plane ICP of all points, started at the truth.
//   bench_icp_floor [SCENE] [SEEDS]
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <nanoflann.hpp>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/geometry/plane.h"
#include "limen/simulate/scene.h"

namespace {

using namespace limen;  // NOLINT(google-build-using-namespace): a program, not a header

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kNeighbours = 20;
constexpr double kGateM = 0.02;
constexpr int kRounds = 12;

struct PointSet {
  const std::vector<Vector3d>& points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>, PointSet, 3>;

struct Normals {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
};

/// The tile of a source point: the plane of the nearest target points, where these lie in one.
void add_point(const Tree& tree, const std::vector<Vector3d>& target, const Vector3d& x, Normals& sums) {
  std::array<std::uint32_t, kNeighbours> index{};
  std::array<double, kNeighbours> squared{};
  tree.knnSearch(x.data(), kNeighbours, index.data(), squared.data());
  PointMoments moments;
  for (const std::uint32_t i : index) moments.add(target[i] - x);
  const PlaneFit fit = fit_plane(moments);
  if (fit.variances[1] < 4.0 * fit.variances[0]) return;
  const double residual = fit.plane.offset;  // from x, along the normal
  if (std::abs(residual) > kGateM) return;
  Vector6 row;
  row << x.cross(fit.plane.normal), fit.plane.normal;
  sums.matrix += row * row.transpose();
  sums.right += residual * row;
}

Rigid3 icp(const Scan& source, const Scan& target, Rigid3 pose) {
  const PointSet set{target.points};
  const Tree tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  for (int round = 0; round < kRounds; ++round) {
    const Normals sums = parallel_reduce(
        source.size(), 8192, Normals{},
        [&](std::size_t begin, std::size_t end) {
          Normals part;
          for (std::size_t i = begin; i < end; ++i)
            add_point(tree, target.points, pose * source.points[i], part);
          return part;
        },
        [](Normals a, const Normals& b) {
          a.matrix += b.matrix;
          a.right += b.right;
          return a;
        });
    const Vector6 step = sums.matrix.ldlt().solve(sums.right);
    pose = Rigid3{rotation_exp(step.head<3>()), step.tail<3>()} * pose;
  }
  return pose;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "room";
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 5;
  std::vector<double> shifts;
  std::vector<double> turns;
  for (int seed = 1; seed <= seeds; ++seed) {
    SceneOptions options;
    options.name = name;
    options.seed = static_cast<std::uint64_t>(seed);
    const SimulatedCase simulated = simulate(options);
    const Scan& source = simulated.scans.at(0);
    const Scan& target = simulated.scans.at(1);
    const Rigid3 truth =
        to_local(true_target_from_source(simulated.truth, 0, 1), source.local_origin, target.local_origin);
    const Rigid3 error = inverse(truth) * icp(source, target, truth);
    const Vector3d centre = source.centre(0);
    shifts.push_back(1000.0 * (error * centre - centre).norm());
    turns.push_back(degrees(rotation_angle(error.rotation)));
    fmt::print("{},{},{:.4f} mm,{:.5f} deg\n", name, seed, shifts.back(), turns.back());
  }
  std::sort(shifts.begin(), shifts.end());
  std::sort(turns.begin(), turns.end());
  fmt::print("# median {:.4f} mm {:.5f} deg\n", shifts[shifts.size() / 2], turns[turns.size() / 2]);
  return 0;
}
