// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace limen {

/// Pipes between nodes, and the smallest cut through them (Edmonds and Karp 1972).
class FlowNetwork {
 public:
  explicit FlowNetwork(std::size_t nodes) : pipes_(nodes) {}

  /// A pipe from a to b with room for `forward`, and back for `backward`.
  void connect(int a, int b, int forward, int backward);

  /// The nodes on the side of `start` of the smallest cut that parts them from `end`; empty where more than
  /// `enough` flows between them. To be called once.
  std::optional<std::vector<bool>> smallest_cut(const std::vector<bool>& start, const std::vector<bool>& end,
                                                int enough);

 private:
  struct Pipe {
    int to = -1;
    int room = 0;
    std::size_t back = 0;
  };
  struct Search {
    std::vector<bool> reached;
    std::vector<std::pair<int, std::size_t>> came;  ///< the node before, and which of its pipes; -1: a start
    int end = -1;                                   ///< an end that was reached, -1: none
  };
  [[nodiscard]] Search reach(const std::vector<bool>& start, const std::vector<bool>& end) const;

  /// As much as the way that was found has room for flows along it; returns how much.
  int fill(const Search& search);

  std::vector<std::vector<Pipe>> pipes_;
};

}  // namespace limen
