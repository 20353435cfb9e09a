// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/geometry/linear.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// Normal equations of small motions of nodes (turn about the node's own origin, shift; frame axes), six
/// unknowns for each node that is not fixed; solved by sparse Cholesky.
class PoseSystem {
 public:
  explicit PoseSystem(const std::vector<bool>& fixed);
  ~PoseSystem();
  PoseSystem(const PoseSystem&) = delete;
  PoseSystem& operator=(const PoseSystem&) = delete;

  /// No node moves.
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] int moving() const { return size_; }
  [[nodiscard]] bool moves(int node) const { return place_[static_cast<std::size_t>(node)] >= 0; }

  /// Forgets all that was added.
  void clear();
  /// Adds to what two nodes have to do with each other; what concerns a fixed node is left out.
  void add(int row, int column, const Matrix6d& block);
  void add_right(int row, const Vector6d& part);
  /// Factors what was added.
  void factor();

  /// Moves the nodes to the solution; returns the largest shift or turn, metres or radians, and 0 where the
  /// system has no finite one.
  double move(std::vector<Rigid3>& poses) const;
  /// Columns of the inverse for one node that moves; `block_of` takes a node's rows from them.
  [[nodiscard]] Eigen::MatrixXd inverse_columns(int node) const;
  [[nodiscard]] Matrix6d block_of(const Eigen::MatrixXd& columns, int node) const;
  /// The inverse times `right`, which has a row for each unknown; a node's six begin at `first_unknown`.
  [[nodiscard]] Eigen::MatrixXd solved(const Eigen::MatrixXd& right) const;
  [[nodiscard]] Eigen::Index unknowns() const { return Eigen::Index{6} * size_; }
  [[nodiscard]] Eigen::Index first_unknown(int node) const { return Eigen::Index{6} * place(node); }

 private:
  struct Sparse;

  [[nodiscard]] int place(int node) const { return place_[static_cast<std::size_t>(node)]; }

  std::vector<int> place_;
  int size_ = 0;
  std::unique_ptr<Sparse> sparse_;
};

}  // namespace limen
