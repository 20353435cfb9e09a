// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/block_cholesky.h"

#include <algorithm>
#include <set>
#include <utility>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace limen {
namespace {

/// X with X unit^T = block, of a lower triangle with ones on its diagonal.
Matrix6d over_transposed(const Matrix6d& block, const Matrix6d& unit) {
  Matrix6d x = block;
  for (Eigen::Index c = 1; c < 6; ++c) {
    for (Eigen::Index m = 0; m < c; ++m) x.col(c) -= unit(c, m) * x.col(m);
  }
  return x;
}

/// X with X unit = block.
Matrix6d over_unit(const Matrix6d& block, const Matrix6d& unit) {
  Matrix6d x = block;
  for (Eigen::Index c = 4; c >= 0; --c) {
    for (Eigen::Index m = c + 1; m < 6; ++m) x.col(c) -= unit(m, c) * x.col(m);
  }
  return x;
}

/// unit^-1 times the six rows, in place; and unit^-T times them.
template <typename Rows>
void forward(const Matrix6d& unit, Rows rows) {
  for (Eigen::Index r = 1; r < 6; ++r) {
    for (Eigen::Index m = 0; m < r; ++m) rows.row(r) -= unit(r, m) * rows.row(m);
  }
}
template <typename Rows>
void backward(const Matrix6d& unit, Rows rows) {
  for (Eigen::Index r = 4; r >= 0; --r) {
    for (Eigen::Index m = r + 1; m < 6; ++m) rows.row(r) -= unit(m, r) * rows.row(m);
  }
}

Eigen::Index first_row(std::size_t place) {
  return 6 * static_cast<Eigen::Index>(place);
}

}  // namespace

void BlockCholesky::factor(const LowerBlocks& matrix) {
  std::size_t entries = 0;
  for (const auto& column : matrix) entries += column.size();
  if (columns_.size() != matrix.size() || entries != entries_) {
    order(matrix);
    find_rows(matrix);
    entries_ = entries;
  }
  take_values(matrix);
  inverse_.clear();
  // Of each column those before it that have a block in its row, each with the place of that block.
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> before(columns_.size());
  place_.assign(columns_.size(), 0);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    eliminate(j, before[j]);
    for (const auto& [k, at] : before[j]) {
      if (at + 1 < columns_[k].rows.size())
        before[static_cast<std::size_t>(columns_[k].rows[at + 1])].emplace_back(k, at + 1);
    }
    if (!columns_[j].rows.empty())
      before[static_cast<std::size_t>(columns_[j].rows.front())].emplace_back(j, 0);
    before[j] = {};
  }
}

void BlockCholesky::order(const LowerBlocks& matrix) {
  const auto size = static_cast<Eigen::Index>(matrix.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t column = 0; column < matrix.size(); ++column) {
    for (const auto& [row, block] : matrix[column]) {
      entries.emplace_back(row, static_cast<int>(column), 1.0);
      if (row != static_cast<int>(column)) entries.emplace_back(static_cast<int>(column), row, 1.0);
    }
  }
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  old_of_.assign(order.indices().begin(), order.indices().end());
  new_of_.resize(old_of_.size());
  for (std::size_t k = 0; k < old_of_.size(); ++k)
    new_of_[static_cast<std::size_t>(old_of_[k])] = static_cast<int>(k);
}

/// Of each column the rows of the matrix, and those of the columns that are eliminated into it.
void BlockCholesky::find_rows(const LowerBlocks& matrix) {
  std::vector<std::set<int>> rows(matrix.size());
  for (std::size_t column = 0; column < matrix.size(); ++column) {
    const int j = new_of_[column];
    for (const auto& [row, block] : matrix[column]) {
      const int i = new_of_[static_cast<std::size_t>(row)];
      if (i != j) rows[static_cast<std::size_t>(std::min(i, j))].insert(std::max(i, j));
    }
  }
  columns_.assign(matrix.size(), {});
  for (std::size_t j = 0; j < rows.size(); ++j) {
    columns_[j].rows.assign(rows[j].begin(), rows[j].end());
    if (!rows[j].empty()) {
      const auto parent = static_cast<std::size_t>(*rows[j].begin());
      rows[parent].insert(std::next(rows[j].begin()), rows[j].end());
    }
    rows[j] = {};
  }
}

void BlockCholesky::take_values(const LowerBlocks& matrix) {
  for (Column& column : columns_) column.blocks.assign(column.rows.size(), Matrix6d::Zero());
  for (std::size_t old_column = 0; old_column < matrix.size(); ++old_column) {
    for (const auto& [old_row, block] : matrix[old_column]) {
      const int i = new_of_[static_cast<std::size_t>(old_row)];
      const int j = new_of_[old_column];
      Column& column = columns_[static_cast<std::size_t>(std::min(i, j))];
      if (i == j) {
        column.unit = block;
        continue;
      }
      const auto at = std::lower_bound(column.rows.begin(), column.rows.end(), std::max(i, j));
      Matrix6d& value = column.blocks[static_cast<std::size_t>(at - column.rows.begin())];
      if (i > j)
        value = block;
      else
        value = block.transpose();
    }
  }
}

void BlockCholesky::eliminate(std::size_t j, const std::vector<std::pair<std::size_t, std::size_t>>& before) {
  Column& column = columns_[j];
  for (std::size_t k = 0; k < column.rows.size(); ++k) place_[static_cast<std::size_t>(column.rows[k])] = k;
  Matrix6d own = column.unit;
  for (const auto& [k, at] : before) {
    const Column& other = columns_[k];
    const Matrix6d scaled = (other.blocks[at] * other.pivots.asDiagonal()).transpose();
    own.noalias() -= other.blocks[at] * scaled;
    for (std::size_t q = at + 1; q < other.rows.size(); ++q)
      column.blocks[place_[static_cast<std::size_t>(other.rows[q])]].noalias() -= other.blocks[q] * scaled;
  }
  // Of the diagonal block the lower triangle counts.
  Matrix6d& unit = column.unit;
  unit.setIdentity();
  for (Eigen::Index c = 0; c < 6; ++c) {
    column.pivots[c] = own(c, c);
    for (Eigen::Index r = c + 1; r < 6; ++r) unit(r, c) = own(r, c) / column.pivots[c];
    for (Eigen::Index r = c + 1; r < 6; ++r) {
      for (Eigen::Index m = c + 1; m <= r; ++m) own(r, m) -= unit(r, c) * own(m, c);
    }
  }
  const Matrix6d over_pivots = column.pivots.cwiseInverse().asDiagonal();
  for (Matrix6d& block : column.blocks) block = over_transposed(block, unit) * over_pivots;
}

Eigen::MatrixXd BlockCholesky::solve(const Eigen::MatrixXd& right) const {
  if (right.cols() == 0) return right;  // of nothing Eigen may take no rows
  Eigen::MatrixXd x(right.rows(), right.cols());
  for (std::size_t j = 0; j < columns_.size(); ++j)
    x.middleRows<6>(first_row(j)) = right.middleRows<6>(first_row(static_cast<std::size_t>(old_of_[j])));
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Column& column = columns_[j];
    forward(column.unit, x.middleRows<6>(first_row(j)));
    for (std::size_t k = 0; k < column.rows.size(); ++k)
      x.middleRows<6>(first_row(static_cast<std::size_t>(column.rows[k]))).noalias() -=
          column.blocks[k] * x.middleRows<6>(first_row(j));
  }
  for (std::size_t j = columns_.size(); j-- > 0;) {
    const Column& column = columns_[j];
    auto own = x.middleRows<6>(first_row(j));
    own = column.pivots.cwiseInverse().asDiagonal() * own;
    for (std::size_t k = 0; k < column.rows.size(); ++k)
      own.noalias() -=
          column.blocks[k].transpose() * x.middleRows<6>(first_row(static_cast<std::size_t>(column.rows[k])));
    backward(column.unit, x.middleRows<6>(first_row(j)));
  }
  Eigen::MatrixXd ordered(right.rows(), right.cols());
  for (std::size_t j = 0; j < columns_.size(); ++j)
    ordered.middleRows<6>(first_row(static_cast<std::size_t>(old_of_[j]))) = x.middleRows<6>(first_row(j));
  return ordered;
}

void BlockCholesky::invert() {
  if (!inverse_.empty()) return;
  inverse_.assign(columns_.size(), {});
  inverse_diagonal_.assign(columns_.size(), Matrix6d::Zero());
  for (std::size_t j = columns_.size(); j-- > 0;) invert_column(j);
}

/// From the columns behind it: Z_ij = -sum_k Z_ik L_kj and Z_jj = D_j^-1 - sum_k L_kj^T Z_kj, of a factor
/// with ones in its diagonal blocks.
void BlockCholesky::invert_column(std::size_t j) {
  const Column& column = columns_[j];
  const std::vector<int>& rows = column.rows;
  std::vector<Matrix6d> lower;
  lower.reserve(rows.size());
  for (const Matrix6d& block : column.blocks) lower.push_back(over_unit(block, column.unit));
  std::vector<Matrix6d>& out = inverse_[j];
  out.assign(rows.size(), Matrix6d::Zero());
  for (std::size_t b = 0; b < rows.size(); ++b) {
    const auto behind = static_cast<std::size_t>(rows[b]);
    out[b].noalias() -= inverse_diagonal_[behind] * lower[b];
    // What is below in this column is there as well.
    const std::vector<int>& theirs = columns_[behind].rows;
    std::size_t at = 0;
    for (std::size_t a = b + 1; a < rows.size(); ++a) {
      while (theirs[at] != rows[a]) ++at;
      const Matrix6d& z = inverse_[behind][at];
      out[a].noalias() -= z * lower[b];
      out[b].noalias() -= z.transpose() * lower[a];
    }
  }
  Matrix6d own = Matrix6d::Identity();
  forward(column.unit, own.middleRows<6>(0));
  own = column.pivots.cwiseInverse().asDiagonal() * own;
  backward(column.unit, own.middleRows<6>(0));
  for (std::size_t k = 0; k < rows.size(); ++k) own.noalias() -= lower[k].transpose() * out[k];
  inverse_diagonal_[j] = 0.5 * (own + own.transpose());
}

std::optional<Matrix6d> BlockCholesky::inverse_block(int row, int column) const {
  const int i = new_of_[static_cast<std::size_t>(row)];
  const int j = new_of_[static_cast<std::size_t>(column)];
  if (i == j) return inverse_diagonal_[static_cast<std::size_t>(i)];
  const auto first = static_cast<std::size_t>(std::min(i, j));
  const std::vector<int>& rows = columns_[first].rows;
  const auto at = std::lower_bound(rows.begin(), rows.end(), std::max(i, j));
  if (at == rows.end() || *at != std::max(i, j)) return {};
  const Matrix6d& block = inverse_[first][static_cast<std::size_t>(at - rows.begin())];
  return i > j ? Matrix6d(block) : Matrix6d(block.transpose());
}

}  // namespace limen
