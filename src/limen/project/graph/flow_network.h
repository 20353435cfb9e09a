// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace limen {

/// Pipes between nodes, and the smallest cuts through them (Edmonds and Karp 1972). Each cut is sought in the
/// empty network, and undoes no more than it filled: where much flows near by, it costs no more than what
/// lies near by.
class FlowNetwork {
 public:
  explicit FlowNetwork(std::size_t nodes) : pipes_(nodes), before_(nodes), seen_(nodes, 0) {}

  /// A pipe from a to b with room for `forward`, and back for `backward`.
  void connect(int a, int b, int forward, int backward);

  /// The nodes on the side of `start` of the smallest cut that parts all of it from all of `end`; empty where
  /// `enough` flows between them, or more.
  std::optional<std::vector<bool>> smallest_cut(const std::vector<int>& start, const std::vector<bool>& end,
                                                int enough);

 private:
  struct Pipe {
    int to = -1;
    int room = 0;
    std::size_t back = 0;
  };
  /// The node before on the way from the start, and which of its pipes; -1: a start.
  struct Step {
    int node = -1;
    std::size_t pipe = 0;
  };
  struct Filled {
    int node = -1;
    std::size_t pipe = 0;
    int flow = 0;
  };

  /// An end with room on the way to it, -1: none.
  int reach(const std::vector<int>& start, const std::vector<bool>& end);
  /// As much as the way that was found has room for flows along it; returns how much.
  int fill(int end);
  void move(int node, std::size_t pipe, int flow);
  void empty();

  std::vector<std::vector<Pipe>> pipes_;
  std::vector<Step> before_;
  std::vector<std::uint32_t> seen_;  ///< the search in which a node was reached last
  std::uint32_t search_ = 0;
  std::vector<int> reached_;  ///< in order
  std::vector<Filled> filled_;
};

}  // namespace limen
