// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/block_cholesky.h"

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

constexpr int kBlocks = 12;

/// A chain of blocks with some more ties, as links between scans make it.
LowerBlocks tied_blocks(Eigen::MatrixXd& dense) {
  RandomStream random(3, 0);
  dense = Eigen::MatrixXd::Zero(6 * kBlocks, 6 * kBlocks);
  const auto tie = [&](int a, int b) {
    Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(6, 6 * kBlocks);
    for (const int block : {a, b}) {
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 6; ++k) factor(i, 6 * block + k) = random.normal();
      }
    }
    dense += factor.transpose() * factor;
  };
  for (int k = 0; k < kBlocks; ++k) tie(k, (k + 1) % kBlocks);
  tie(0, 5);
  tie(7, 3);
  dense += 0.1 * Eigen::MatrixXd::Identity(6 * kBlocks, 6 * kBlocks);
  LowerBlocks blocks(kBlocks);
  for (int column = 0; column < kBlocks; ++column) {
    for (int row = column; row < kBlocks; ++row) {
      const Matrix6d block = dense.block<6, 6>(6 * row, 6 * column);
      if (row == column || !block.isZero()) blocks[static_cast<std::size_t>(column)][row] = block;
    }
  }
  return blocks;
}

TEST(BlockCholesky, SolvesAndInvertsAsADenseSolverDoes) {
  Eigen::MatrixXd dense;
  LowerBlocks blocks = tied_blocks(dense);
  BlockCholesky solver;
  for (int again = 0; again < 2; ++again) {
    const Eigen::MatrixXd inverse = inverse_of(dense);
    solver.factor(blocks);
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(6 * kBlocks, 6 * kBlocks);
    EXPECT_LT((solver.solve(identity) - inverse).cwiseAbs().maxCoeff(), 1e-9 * inverse.cwiseAbs().maxCoeff());
    solver.invert();
    int left_out = 0;
    for (int row = 0; row < kBlocks; ++row) {
      for (int column = 0; column < kBlocks; ++column) {
        const std::optional<Matrix6d> block = solver.inverse_block(row, column);
        const bool tied = !dense.block<6, 6>(6 * row, 6 * column).isZero();
        EXPECT_TRUE(block || !tied) << row << " " << column;
        left_out += block ? 0 : 1;
        if (!block) continue;
        EXPECT_LT((*block - inverse.block<6, 6>(6 * row, 6 * column)).cwiseAbs().maxCoeff(),
                  1e-9 * inverse.cwiseAbs().maxCoeff());
      }
    }
    EXPECT_GT(left_out, 0);
    // The same pattern with other values: order and rows are kept.
    dense *= 3.0;
    for (auto& column : blocks) {
      for (auto& [row, block] : column) block *= 3.0;
    }
  }
}

TEST(BlockCholesky, AFreedomThatIsHardlyHeldSpoilsNoOther) {
  LowerBlocks blocks(2);
  Vector6d held = Vector6d::Constant(1e8);
  held[3] = 1e-9;
  blocks[0][0] = held.asDiagonal();
  blocks[1][1] = 2.0 * Matrix6d(held.asDiagonal());
  Vector6d tie = -held;
  tie[3] = 0.0;
  blocks[0][1] = tie.asDiagonal();
  BlockCholesky solver;
  solver.factor(blocks);
  solver.invert();
  const Matrix6d block = *solver.inverse_block(0, 0);
  EXPECT_NEAR(block(0, 0), 2e-8, 1e-14);
  EXPECT_NEAR(block(3, 3), 1e9, 1.0);
}

}  // namespace
}  // namespace limen
