// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/rivals.h"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include "limen/base/progress.h"

namespace limen {
namespace {

constexpr double kMild = 4.0;
constexpr int kClearLead =
    3;  // as many independent links must speak for a place for each that speaks against
constexpr double kSameView = 0.6;  // share of a link's surface that two scans share: they are one witness
constexpr double kSameShiftM = 0.05;
constexpr double kSameTurnRad = 0.0175;

/// What a link makes of a movement of one of its ends.
struct Bend {
  bool source_moves = false;  ///< it follows where its source moves and its target stays ...
  bool target_moves = false;  ///< ... or the other way round
};

class RivalSearch {
 public:
  RivalSearch(const PoseGraph& graph, const AcceptedPoses& accepted) : graph_(graph), accepted_(accepted) {
    for (std::size_t k = 0; k < graph.links.size(); ++k) {
      if (accepted.pose[k] < 0) continue;
      const LinkPose& pose = graph.links[k].poses[static_cast<std::size_t>(accepted.pose[k])];
      shared_[{graph.links[k].source, graph.links[k].target}] = pose.agreeing_m2;
    }
  }

  std::vector<GraphQuestion> run() {
    std::vector<GraphQuestion> questions;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      CancelScope::check();
      const GraphLink& link = graph_.links[k];
      const int component = accepted_.component[static_cast<std::size_t>(link.source)];
      if (component < 0 || component != accepted_.component[static_cast<std::size_t>(link.target)]) continue;
      if (link.trust == LinkTrust::weak || link.trust == LinkTrust::given) continue;
      // Of a sure link that was accepted the others are not as likely; of one that was not, only the best is.
      const bool sure = link.trust == LinkTrust::sure;
      if (sure && accepted_.pose[k] >= 0) continue;
      const std::size_t count = sure ? 1 : link.poses.size();
      for (std::size_t p = 0; p < count; ++p) {
        if (static_cast<int>(p) == accepted_.pose[k]) continue;
        ask(link, link.poses[p], questions);
      }
    }
    return questions;
  }

 private:
  [[nodiscard]] const Rigid3& at(int node) const {
    return accepted_.frame_from_node[static_cast<std::size_t>(node)];
  }

  [[nodiscard]] static bool fits(const LinkPose& pose, const Rigid3& predicted) {
    return chi_square(misfit(pose, predicted), kMild * pose.covariance) <= kChiSquareBound;
  }
  [[nodiscard]] static bool any_fits(const GraphLink& link, const Rigid3& predicted) {
    // Other poses of a sure link are no real possibility.
    if (link.trust <= LinkTrust::sure) return fits(link.poses.front(), predicted);
    return std::any_of(link.poses.begin(), link.poses.end(),
                       [&](const LinkPose& pose) { return fits(pose, predicted); });
  }

  [[nodiscard]] Bend bend_of(const GraphLink& link, const Rigid3& movement) const {
    return {any_fits(link, inverse(at(link.target)) * movement * at(link.source)),
            any_fits(link, inverse(movement * at(link.target)) * at(link.source))};
  }

  void ask(const GraphLink& link, const LinkPose& pose, std::vector<GraphQuestion>& questions) const {
    // The source would stand at movement * its present place.
    const Rigid3 movement = at(link.target) * pose.target_from_source * inverse(at(link.source));
    const Vector3d from = at(link.source).translation;
    if ((movement * from - from).norm() < kSameShiftM && rotation_angle(movement.rotation) < kSameTurnRad)
      return;
    for (const GraphQuestion& known : questions) {
      const bool same =
          (known.frame_from_frame * from - movement * from).norm() < kSameShiftM &&
          rotation_angle(known.frame_from_frame.rotation.transpose() * movement.rotation) < kSameTurnRad;
      if (same && contains(known.moved, link.source) && !contains(known.moved, link.target)) return;
    }
    const Sides sides = sides_of(link, movement);
    std::vector<std::vector<bool>> cuts;
    for (const Sides& tried :
         {sides, with_neighbours(sides, movement, true), with_neighbours(sides, movement, false)}) {
      const std::vector<bool> moved = smallest_cut(tried, movement);
      if (std::find(cuts.begin(), cuts.end(), moved) != cuts.end()) continue;
      cuts.push_back(moved);
      weigh(moved, movement, questions);
    }
  }

  /// Asks where what speaks for the present place is not clearly more.
  void weigh(const std::vector<bool>& moved, const Rigid3& movement,
             std::vector<GraphQuestion>& questions) const {
    GraphQuestion question;
    question.frame_from_frame = movement;
    for (int node = 0; node < graph_.nodes; ++node) {
      if (moved[static_cast<std::size_t>(node)]) question.moved.push_back(node);
    }
    std::vector<int> open_rivals;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) witness(k, moved, movement, question, open_rivals);
    // A link of many poses, perhaps none of them right, is no witness against a sure one.
    const bool firm = std::any_of(question.current.begin(), question.current.end(), [&](int k) {
      return graph_.links[static_cast<std::size_t>(k)].trust <= LinkTrust::sure;
    });
    if (!firm) question.rival.insert(question.rival.end(), open_rivals.begin(), open_rivals.end());
    const int present = independent(question.current, moved);
    const int other = independent(question.rival, moved);
    if (kClearLead * other > present || present == 0) questions.push_back(std::move(question));
  }

  /// Nodes that would move, and nodes that would stay.
  struct Sides {
    std::vector<bool> moving;
    std::vector<bool> staying;
  };

  /// The ends of all links that speak for the movement and not for the present places.
  [[nodiscard]] Sides sides_of(const GraphLink& first, const Rigid3& movement) const {
    Sides sides;
    sides.moving.assign(static_cast<std::size_t>(graph_.nodes), false);
    sides.staying = sides.moving;
    const auto add = [&](int moving, int staying) {
      const auto m = static_cast<std::size_t>(moving);
      const auto s = static_cast<std::size_t>(staying);
      if (sides.staying[m] || sides.moving[s]) return;
      sides.moving[m] = true;
      sides.staying[s] = true;
    };
    add(first.source, first.target);
    const int home = accepted_.component[static_cast<std::size_t>(first.source)];
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (accepted_.pose[k] >= 0 || link.trust == LinkTrust::weak) continue;
      if (accepted_.component[static_cast<std::size_t>(link.source)] != home ||
          accepted_.component[static_cast<std::size_t>(link.target)] != home)
        continue;
      const Bend bend = bend_of(link, movement);
      if (bend.source_moves) add(link.source, link.target);
      if (bend.target_moves) add(link.target, link.source);
    }
    return sides;
  }

  /// The same with what is linked to one of the sides: a room that another was taken for goes with what its
  /// own links say, not with the other room.
  [[nodiscard]] Sides with_neighbours(const Sides& sides, const Rigid3& movement, bool of_moving) const {
    Sides more = sides;
    const std::vector<bool>& own = of_moving ? sides.moving : sides.staying;
    const std::vector<bool>& other = of_moving ? sides.staying : sides.moving;
    std::vector<bool>& grown = of_moving ? more.moving : more.staying;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (accepted_.pose[k] < 0 || link.trust == LinkTrust::weak) continue;
      const auto s = static_cast<std::size_t>(link.source);
      const auto t = static_cast<std::size_t>(link.target);
      const Bend bend = bend_of(link, movement);
      if (bend.source_moves || bend.target_moves) continue;
      if (own[s] && !other[t]) grown[t] = true;
      if (own[t] && !other[s]) grown[s] = true;
    }
    return more;
  }

  static bool contains(const std::vector<int>& nodes, int node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  }

  /// Notes for which place the link speaks, if it crosses the cut.
  void witness(std::size_t k, const std::vector<bool>& moved, const Rigid3& movement, GraphQuestion& question,
               std::vector<int>& open_rivals) const {
    const GraphLink& link = graph_.links[k];
    const bool source = moved[static_cast<std::size_t>(link.source)];
    const bool target = moved[static_cast<std::size_t>(link.target)];
    const int component = accepted_.component[static_cast<std::size_t>(question.moved.front())];
    const bool here = accepted_.component[static_cast<std::size_t>(link.source)] == component &&
                      accepted_.component[static_cast<std::size_t>(link.target)] == component;
    if (source == target || !here || link.trust == LinkTrust::weak) return;
    const Bend bend = bend_of(link, movement);
    const bool follows = source ? bend.source_moves : bend.target_moves;
    const bool stays = accepted_.pose[k] >= 0;
    if (stays && !follows) question.current.push_back(static_cast<int>(k));
    if (follows && !stays)
      (link.trust == LinkTrust::open ? open_rivals : question.rival).push_back(static_cast<int>(k));
  }

  [[nodiscard]] bool same_view(int a, int b, double surface_m2) const {
    if (a == b) return true;
    const auto found = shared_.find({std::min(a, b), std::max(a, b)});
    const auto other = shared_.find({std::max(a, b), std::min(a, b)});
    const double shared =
        std::max(found == shared_.end() ? 0.0 : found->second, other == shared_.end() ? 0.0 : other->second);
    return shared > kSameView * surface_m2;
  }

  /// Number of links, those counted once whose ends see the same on either side.
  [[nodiscard]] int independent(const std::vector<int>& links, const std::vector<bool>& moved) const {
    std::vector<int> chosen;
    const auto ends = [&](int k) {
      const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
      return moved[static_cast<std::size_t>(link.source)] ? std::pair(link.source, link.target)
                                                          : std::pair(link.target, link.source);
    };
    for (const int k : links) {
      const std::pair<int, int> own = ends(k);
      const double surface = graph_.links[static_cast<std::size_t>(k)].poses.front().agreeing_m2;
      const bool counted = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
        const std::pair<int, int> theirs = ends(other);
        return same_view(own.first, theirs.first, surface) && same_view(own.second, theirs.second, surface);
      });
      if (!counted) chosen.push_back(k);
    }
    return static_cast<int>(chosen.size());
  }

  struct Pipe {
    int to = -1;
    int room = 0;
    std::size_t back = 0;
  };

  /// The nodes that go with the moving ones while the others stay (Edmonds and Karp's maximum flow).
  [[nodiscard]] std::vector<bool> smallest_cut(const Sides& sides, const Rigid3& movement) const {
    std::vector<std::vector<Pipe>> pipes(static_cast<std::size_t>(graph_.nodes));
    const auto add = [&](int a, int b, int forward, int backward) {
      std::vector<Pipe>& out = pipes[static_cast<std::size_t>(a)];
      std::vector<Pipe>& in = pipes[static_cast<std::size_t>(b)];
      out.push_back({b, forward, in.size()});
      in.push_back({a, backward, out.size() - 1});
    };
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      if (accepted_.pose[k] < 0) continue;
      const GraphLink& link = graph_.links[k];
      const int firm = link.trust == LinkTrust::weak ? 1 : link.trust == LinkTrust::given ? 1000 : 10;
      const Bend bend = bend_of(link, movement);
      add(link.source, link.target, bend.source_moves ? 0 : firm, bend.target_moves ? 0 : firm);
    }
    for (;;) {
      const Search search = reach(pipes, sides);
      if (search.end < 0) return search.reached;
      int room = 1 << 30;
      for (int node = search.end; search.came[static_cast<std::size_t>(node)].first >= 0;
           node = search.came[static_cast<std::size_t>(node)].first) {
        const auto [before, k] = search.came[static_cast<std::size_t>(node)];
        room = std::min(room, pipes[static_cast<std::size_t>(before)][k].room);
      }
      for (int node = search.end; search.came[static_cast<std::size_t>(node)].first >= 0;
           node = search.came[static_cast<std::size_t>(node)].first) {
        const auto [before, k] = search.came[static_cast<std::size_t>(node)];
        Pipe& pipe = pipes[static_cast<std::size_t>(before)][k];
        pipe.room -= room;
        pipes[static_cast<std::size_t>(node)][pipe.back].room += room;
      }
    }
  }

  struct Search {
    std::vector<bool> reached;
    std::vector<std::pair<int, std::size_t>> came;  ///< the node before, and which of its pipes; -1: a start
    int end = -1;                                   ///< a staying node that was reached, -1: none
  };

  [[nodiscard]] static Search reach(const std::vector<std::vector<Pipe>>& pipes, const Sides& sides) {
    Search search{sides.moving, std::vector<std::pair<int, std::size_t>>(pipes.size(), {-1, 0}), -1};
    std::deque<int> waiting;
    for (std::size_t node = 0; node < pipes.size(); ++node) {
      if (sides.moving[node]) waiting.push_back(static_cast<int>(node));
    }
    while (!waiting.empty()) {
      const int node = waiting.front();
      waiting.pop_front();
      const std::vector<Pipe>& out = pipes[static_cast<std::size_t>(node)];
      for (std::size_t k = 0; k < out.size(); ++k) {
        const auto to = static_cast<std::size_t>(out[k].to);
        if (out[k].room <= 0 || search.reached[to]) continue;
        search.reached[to] = true;
        search.came[to] = {node, k};
        if (sides.staying[to]) {
          search.end = out[k].to;
          return search;
        }
        waiting.push_back(out[k].to);
      }
    }
    return search;
  }

  const PoseGraph& graph_;
  const AcceptedPoses& accepted_;
  std::map<std::pair<int, int>, double> shared_;
};

}  // namespace

std::vector<GraphQuestion> rival_places(const PoseGraph& graph, const AcceptedPoses& accepted) {
  return RivalSearch(graph, accepted).run();
}

}  // namespace limen
