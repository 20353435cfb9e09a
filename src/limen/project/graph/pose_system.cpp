// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_system.h"

#include <algorithm>

#include <Eigen/SparseCholesky>

namespace limen {
namespace {

constexpr double kTiny = 1e-9;  // keeps a node that nothing holds from breaking the rest

/// The first of the six unknowns of the node at a place.
Eigen::Index unknown(int place) {
  return Eigen::Index{6} * place;
}

}  // namespace

struct PoseSystem::Sparse {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
};

PoseSystem::PoseSystem(const std::vector<bool>& fixed) : sparse_(std::make_unique<Sparse>()) {
  for (const bool is_fixed : fixed) place_.push_back(is_fixed ? -1 : size_++);
  clear();
}

PoseSystem::~PoseSystem() = default;

void PoseSystem::clear() {
  sparse_->entries.clear();
  sparse_->right = Eigen::VectorXd::Zero(unknown(size_));
  for (int k = 0; k < 6 * size_; ++k) sparse_->entries.emplace_back(k, k, kTiny);
}

void PoseSystem::add(int row, int column, const Matrix6d& block) {
  const int at_row = 6 * place(row);
  const int at_column = 6 * place(column);
  if (at_row < 0 || at_column < 0) return;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) sparse_->entries.emplace_back(at_row + i, at_column + j, block(i, j));
  }
}

void PoseSystem::add_right(int row, const Vector6d& part) {
  if (place(row) >= 0) sparse_->right.segment<6>(unknown(place(row))) += part;
}

void PoseSystem::factor() {
  Eigen::SparseMatrix<double> normal(unknown(size_), unknown(size_));
  normal.setFromTriplets(sparse_->entries.begin(), sparse_->entries.end());
  sparse_->solver.compute(normal);
}

double PoseSystem::move(std::vector<Rigid3>& poses) const {
  if (empty()) return 0.0;
  const Eigen::VectorXd delta = sparse_->solver.solve(sparse_->right);
  if (!delta.allFinite()) return 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (place_[i] < 0) continue;
    const Vector6d d = delta.segment<6>(unknown(place_[i]));
    poses[i].rotation = nearest_rotation(rotation_exp(d.head<3>()) * poses[i].rotation);
    poses[i].translation += d.tail<3>();
    largest = std::max(largest, d.cwiseAbs().maxCoeff());
  }
  return largest;
}

Eigen::MatrixXd PoseSystem::inverse_columns(int node) const {
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(unknown(size_), 6);
  unit.block<6, 6>(unknown(place(node)), 0).setIdentity();
  return solved(unit);
}

Eigen::MatrixXd PoseSystem::solved(const Eigen::MatrixXd& right) const {
  return sparse_->solver.solve(right);
}

Matrix6d PoseSystem::block_of(const Eigen::MatrixXd& columns, int node) const {
  if (place(node) < 0) return Matrix6d::Zero();
  return columns.middleRows<6>(unknown(place(node)));
}

}  // namespace limen
