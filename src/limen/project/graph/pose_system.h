// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "limen/geometry/linear.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// A node that has no freedoms of its own: its small motion is a weighted sum of those of other nodes, which
/// are no blends themselves.
using NodeBlend = std::vector<std::pair<int, double>>;

/// Normal equations of small motions of nodes (turn about the node's own origin, shift; frame axes), six
/// unknowns for each node that is not fixed; solved by sparse Cholesky of blocks.
class PoseSystem {
 public:
  /// `blends`: of each node, empty: it has freedoms of its own; may be shorter than `fixed`.
  explicit PoseSystem(const std::vector<bool>& fixed, const std::vector<NodeBlend>& blends = {});
  ~PoseSystem();
  PoseSystem(const PoseSystem&) = delete;
  PoseSystem& operator=(const PoseSystem&) = delete;

  /// No node moves.
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// How many nodes have freedoms of their own.
  [[nodiscard]] int moving() const { return size_; }
  [[nodiscard]] bool moves(int node) const { return !shares(node).empty(); }
  /// Of the places of the freedoms that move a node, each with its weight.
  [[nodiscard]] const NodeBlend& shares(int node) const { return shares_[static_cast<std::size_t>(node)]; }

  /// Forgets all that was added.
  void clear();
  /// Adds to what two nodes have to do with each other; what concerns a fixed node is left out.
  void add(int row, int column, const Matrix6d& block);
  /// The same of two places of freedoms. Different columns, and rows of the right side, may be added to at
  /// once.
  void add_at(int row_place, int column_place, const Matrix6d& block);
  void add_right(int row, const Vector6d& part);
  void add_right_at(int row_place, const Vector6d& part);
  /// Factors what was added.
  void factor();

  /// Moves the nodes to the solution; returns the largest shift or turn, metres or radians, and 0 where the
  /// system has no finite one.
  double move(std::vector<Rigid3>& poses) const;
  /// Makes the blocks of the inverse that the factor has, all at once; then inverse_block() costs next to
  /// nothing for a node and for two that have to do with each other.
  void invert();
  /// Rows of one node and columns of another of the inverse; zero where one of them does not move.
  [[nodiscard]] Matrix6d inverse_block(int row, int column) const;
  /// The inverse times `right`, which has a row for each unknown; the six of a place begin at six times it.
  [[nodiscard]] Eigen::MatrixXd solved(const Eigen::MatrixXd& right) const;
  [[nodiscard]] Eigen::Index unknowns() const { return Eigen::Index{6} * size_; }

 private:
  struct Sparse;
  /// Columns of the inverse for one node that moves; `block_of` takes a node's rows from them.
  [[nodiscard]] Eigen::MatrixXd inverse_columns(int node) const;
  [[nodiscard]] Matrix6d block_of(const Eigen::MatrixXd& columns, int node) const;

  std::vector<NodeBlend> shares_;  // of each node: places of freedoms
  int size_ = 0;
  std::unique_ptr<Sparse> sparse_;
};

}  // namespace limen
