// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_system.h"

#include <optional>

#include "limen/project/graph/block_cholesky.h"

namespace limen {
namespace {

constexpr double kTiny = 1e-9;  // keeps a node that nothing holds from breaking the rest

/// The first of the six unknowns of the node at a place.
Eigen::Index unknown(int place) {
  return Eigen::Index{6} * place;
}

}  // namespace

struct PoseSystem::Sparse {
  LowerBlocks blocks;
  Eigen::VectorXd right;
  BlockCholesky solver;
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
  sparse_->right = Eigen::VectorXd::Zero(unknown(size_));
  sparse_->blocks.resize(static_cast<std::size_t>(size_));
  // Which nodes have to do with each other stays from step to step.
  for (std::size_t k = 0; k < sparse_->blocks.size(); ++k) {
    for (auto& [row, block] : sparse_->blocks[k]) block.setZero();
    sparse_->blocks[k][static_cast<int>(k)] = kTiny * Matrix6d::Identity();
  }
}

void PoseSystem::add(int row, int column, const Matrix6d& block) {
  for (const auto& [at_row, of_row] : shares(row)) {
    for (const auto& [at_column, of_column] : shares(column))
      add_at(at_row, at_column, of_row * of_column * block);
  }
}

void PoseSystem::add_at(int row_place, int column_place, const Matrix6d& block) {
  // The other half is the same.
  if (row_place < column_place) return;
  auto& column = sparse_->blocks[static_cast<std::size_t>(column_place)];
  column.try_emplace(row_place, Matrix6d::Zero()).first->second += block;
}

void PoseSystem::add_right(int row, const Vector6d& part) {
  for (const auto& [place, weight] : shares(row)) add_right_at(place, weight * part);
}

void PoseSystem::add_right_at(int row_place, const Vector6d& part) {
  sparse_->right.segment<6>(unknown(row_place)) += part;
}

void PoseSystem::factor() {
  sparse_->solver.factor(sparse_->blocks);
}

void PoseSystem::invert() {
  sparse_->solver.invert();
}

Matrix6d PoseSystem::inverse_block(int row, int column) const {
  Matrix6d sum = Matrix6d::Zero();
  for (const auto& [at_row, of_row] : shares(row)) {
    for (const auto& [at_column, of_column] : shares(column)) {
      const std::optional<Matrix6d> block = sparse_->solver.inverse_block(at_row, at_column);
      if (!block) return block_of(inverse_columns(column), row);
      sum += of_row * of_column * *block;
    }
  }
  return sum;
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
