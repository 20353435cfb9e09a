// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "limen/geometry/linear.h"

namespace limen {

/// Blocks of a symmetric matrix at and below its diagonal: of each column of blocks those by their rows. All
/// blocks of the diagonal are there.
using LowerBlocks = std::vector<std::map<int, Matrix6d>>;

/// Sparse L D L^T of a symmetric matrix of 6 x 6 blocks, ordered by approximate minimum degree: pivots are
/// scalars, so that freedoms that are hardly held break nothing. Of its inverse the blocks that the factor
/// has can be had all at once (Takahashi, Fagan and Chen 1973), at about the factor's cost.
class BlockCholesky {
 public:
  void factor(const LowerBlocks& matrix);

  /// The inverse times `right`, of six rows per block.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

  /// Makes the blocks of the inverse, once for each factor(), which comes before it.
  void invert();
  /// A block of the inverse where the factor has one: everywhere where the matrix has, and at the diagonal.
  [[nodiscard]] std::optional<Matrix6d> inverse_block(int row, int column) const;

 private:
  /// A column of the factor, rows and columns by the order of elimination.
  struct Column {
    std::vector<int> rows;  ///< below the diagonal, ascending
    std::vector<Matrix6d> blocks;
    Matrix6d unit = Matrix6d::Identity();  ///< lower triangle of the diagonal block, ones on its diagonal
    Vector6d pivots = Vector6d::Ones();
  };
  void order(const LowerBlocks& matrix);
  void find_rows(const LowerBlocks& matrix);
  void take_values(const LowerBlocks& matrix);
  void eliminate(std::size_t j, const std::vector<std::pair<std::size_t, std::size_t>>& before);
  void invert_column(std::size_t j);

  std::size_t entries_ = 0;  ///< of the matrix whose order and rows are kept
  std::vector<int> old_of_;  ///< by the order of elimination
  std::vector<int> new_of_;
  std::vector<Column> columns_;
  std::vector<std::size_t> place_;              ///< of a row within the column that is worked on
  std::vector<std::vector<Matrix6d>> inverse_;  ///< like the columns' blocks
  std::vector<Matrix6d> inverse_diagonal_;
};

}  // namespace limen
