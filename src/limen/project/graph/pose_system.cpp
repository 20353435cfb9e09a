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

PoseSystem::PoseSystem(const std::vector<bool>& fixed, const std::vector<NodeBlend>& blends)
    : sparse_(std::make_unique<Sparse>()) {
  shares_.resize(fixed.size());
  const auto is_blend = [&](std::size_t node) { return node < blends.size() && !blends[node].empty(); };
  for (std::size_t node = 0; node < fixed.size(); ++node) {
    if (!fixed[node] && !is_blend(node)) shares_[node] = {{size_++, 1.0}};
  }
  for (std::size_t node = 0; node < fixed.size(); ++node) {
    if (fixed[node] || !is_blend(node)) continue;
    for (const auto& [of, weight] : blends[node]) {
      for (const auto& [place, one] : shares(of)) shares_[node].emplace_back(place, weight * one);
    }
  }
  clear();
}

PoseSystem::~PoseSystem() = default;

void PoseSystem::clear() {
  sparse_->entries.clear();
  sparse_->right = Eigen::VectorXd::Zero(unknown(size_));
  for (int k = 0; k < 6 * size_; ++k) sparse_->entries.emplace_back(k, k, kTiny);
}

void PoseSystem::add(int row, int column, const Matrix6d& block) {
  for (const auto& [at_row, of_row] : shares(row)) {
    for (const auto& [at_column, of_column] : shares(column))
      add_at(at_row, at_column, of_row * of_column * block);
  }
}

void PoseSystem::add_at(int row_place, int column_place, const Matrix6d& block) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j)
      sparse_->entries.emplace_back(6 * row_place + i, 6 * column_place + j, block(i, j));
  }
}

void PoseSystem::add_right(int row, const Vector6d& part) {
  for (const auto& [place, weight] : shares(row)) add_right_at(place, weight * part);
}

void PoseSystem::add_right_at(int row_place, const Vector6d& part) {
  sparse_->right.segment<6>(unknown(row_place)) += part;
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
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const NodeBlend& of = shares_[i];
    if (of.empty()) continue;
    Vector6d d = Vector6d::Zero();
    for (const auto& [place, weight] : of) d += weight * delta.segment<6>(unknown(place));
    poses[i].rotation = nearest_rotation(rotation_exp(d.head<3>()) * poses[i].rotation);
    poses[i].translation += d.tail<3>();
  }
  return delta.cwiseAbs().maxCoeff();
}

Eigen::MatrixXd PoseSystem::inverse_columns(int node) const {
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(unknown(size_), 6);
  for (const auto& [place, weight] : shares(node))
    unit.block<6, 6>(unknown(place), 0) += weight * Matrix6d::Identity();
  return solved(unit);
}

Eigen::MatrixXd PoseSystem::solved(const Eigen::MatrixXd& right) const {
  return sparse_->solver.solve(right);
}

Matrix6d PoseSystem::block_of(const Eigen::MatrixXd& columns, int node) const {
  Matrix6d block = Matrix6d::Zero();
  for (const auto& [place, weight] : shares(node)) block += weight * columns.middleRows<6>(unknown(place));
  return block;
}

}  // namespace limen
