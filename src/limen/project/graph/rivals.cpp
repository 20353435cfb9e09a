// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/rivals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limen/base/progress.h"
#include "limen/project/graph/flow_network.h"
#include "limen/project/graph/shared_views.h"
#include "limen/project/graph/twins_across.h"

namespace limen {
namespace {

constexpr double kMildRival = 4.0;
constexpr double kMostRivalNats = 7.0;  // no link is surer than a thousand to one here: sure ones contradict
constexpr double kRivalLoopNats = 7.0;  // sure links that are wrong agree once in a thousand
constexpr double kMostTwinNats = 14.0;  // no pair is surer of twins than about one in a million
constexpr double kOpenWrong = 0.02;     // of links with several poses perhaps none is right

/// A link that crosses a cut, and by how much it speaks for a place.
struct Voice {
  int link = -1;
  double nats = 0.0;
};

/// What a link makes of a movement of one of its ends.
struct Bend {
  bool source_moves = false;  ///< it follows where its source moves and its target stays ...
  bool target_moves = false;  ///< ... or the other way round
  [[nodiscard]] bool any() const { return source_moves || target_moves; }
};

class RivalSearch {
 public:
  RivalSearch(const PoseGraph& graph, const AcceptedPoses& accepted)
      : graph_(graph), accepted_(accepted), views_(graph, accepted) {
    for (std::size_t k = 0; k < graph.links.size(); ++k)
      beside_twins_.push_back(accepted.pose[k] < 0 ? 0.0 : nats_beside_twins(static_cast<int>(k)));
  }

  std::vector<GraphQuestion> run() {
    std::vector<GraphQuestion> questions;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      CancelScope::check();
      const GraphLink& link = graph_.links[k];
      const int component = component_of(link.source);
      if (component < 0 || component != component_of(link.target)) continue;
      if (link.trust == LinkTrust::weak || link.trust == LinkTrust::given) continue;
      // Of a sure link that was accepted the others are not as likely; of one that was not, only the best is.
      const bool sure = link.trust <= LinkTrust::likely;
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
  [[nodiscard]] int component_of(int node) const {
    return accepted_.component[static_cast<std::size_t>(node)];
  }

  /// What a link would measure, were all places right.
  [[nodiscard]] Rigid3 present_pose(const GraphLink& link) const {
    return inverse(at(link.target)) * at(link.source);
  }

  [[nodiscard]] static bool fits(const LinkPose& pose, const Rigid3& predicted) {
    return chi_square(misfit(pose, predicted), kMildRival * pose.covariance) <= kChiSquareBound;
  }
  /// The likeliest pose of a link that fits, -1: none.
  [[nodiscard]] static int fitting_pose(const GraphLink& link, const Rigid3& predicted) {
    // Other poses of a sure link are no real possibility.
    const std::size_t count = link.trust <= LinkTrust::likely ? 1 : link.poses.size();
    int likeliest = -1;
    for (std::size_t p = 0; p < count; ++p) {
      const bool likelier = likeliest < 0 || link.poses[p].probability >
                                                 link.poses[static_cast<std::size_t>(likeliest)].probability;
      if (likelier && fits(link.poses[p], predicted)) likeliest = static_cast<int>(p);
    }
    return likeliest;
  }
  [[nodiscard]] static bool any_fits(const GraphLink& link, const Rigid3& predicted) {
    return fitting_pose(link, predicted) >= 0;
  }

  [[nodiscard]] static double nats_of(const GraphLink& link, int pose) {
    return nats_for(link, static_cast<std::size_t>(pose), kMostRivalNats,
                    link.trust == LinkTrust::open ? kOpenWrong : 0.0);
  }

  /// Whether a pose says no more than what is known of it allows (as mildly as it would be heard for another
  /// place: a street's openings miss by three deviations at times), or than nobody cares about.
  [[nodiscard]] static bool is_present_place(const LinkPose& pose, const Rigid3& present) {
    const Rigid3 movement = present * inverse(pose.target_from_source);
    const bool near = (movement * pose.centre - pose.centre).norm() < kSamePlaceM &&
                      rotation_angle(movement.rotation) < kSamePlaceRad;
    return near || fits(pose, present);
  }

  /// What a link would measure once one of its ends has moved.
  [[nodiscard]] Rigid3 moved_pose(const GraphLink& link, bool source_moves, const Rigid3& movement) const {
    return source_moves ? inverse(at(link.target)) * movement * at(link.source)
                        : inverse(movement * at(link.target)) * at(link.source);
  }

  /// Of the links of a component.
  [[nodiscard]] std::vector<Bend> bends_of(int component, const Rigid3& movement) const {
    std::vector<Bend> bends(graph_.links.size());
    for (std::size_t k = 0; k < bends.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (component_of(link.source) != component || component_of(link.target) != component) continue;
      bends[k] = {any_fits(link, moved_pose(link, true, movement)),
                  any_fits(link, moved_pose(link, false, movement))};
    }
    return bends;
  }

  void ask(const GraphLink& link, const LinkPose& pose, std::vector<GraphQuestion>& questions) const {
    // The source would stand at movement * its present place.
    const Rigid3 movement = at(link.target) * pose.target_from_source * inverse(at(link.source));
    if (is_present_place(pose, present_pose(link))) return;
    // Shifts are told where the two meet: a frame's own origin may be far away, on a national grid.
    const Vector3d meets = at(link.target) * pose.centre;
    const Vector3d from = inverse(movement) * meets;
    for (const GraphQuestion& known : questions) {
      const bool same =
          (known.frame_from_frame * from - meets).norm() < kSamePlaceM &&
          rotation_angle(known.frame_from_frame.rotation.transpose() * movement.rotation) < kSamePlaceRad;
      if (same && contains(known.moved, link.source) && !contains(known.moved, link.target)) return;
    }
    const std::vector<Bend> bends = bends_of(component_of(link.source), movement);
    // Rooms built alike lie one storey or one bay from one another, so that links of many places speak for
    // one movement, and together they would cut the building in two: each is asked by itself as well.
    const Sides sides = sides_of(link, bends);
    const Sides ends = ends_of(link);
    std::vector<std::vector<bool>> cuts = {ends.moving, all_but(link.target)};
    for (const auto& [apart, by] : {std::pair(&sides, CutBy::count), std::pair(&ends, CutBy::nats)}) {
      FlowNetwork network = network_of(bends, by);
      for (const Sides& tried :
           {*apart, with_neighbours(*apart, bends, true), with_neighbours(*apart, bends, false)}) {
        std::vector<bool> moved = smallest_cut(network, tried);
        if (std::find(cuts.begin(), cuts.end(), moved) == cuts.end()) cuts.push_back(std::move(moved));
      }
    }
    for (const std::vector<bool>& moved : cuts) weigh(moved, movement, questions);
  }

  /// The nodes of a node's component without it.
  [[nodiscard]] std::vector<bool> all_but(int node) const {
    std::vector<bool> others(static_cast<std::size_t>(graph_.nodes), false);
    for (int other = 0; other < graph_.nodes; ++other)
      others[static_cast<std::size_t>(other)] = other != node && component_of(other) == component_of(node);
    return others;
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
    std::vector<Voice> torn;  // links that both places explain, by how much this one explains them better
    for (std::size_t k = 0; k < graph_.links.size(); ++k)
      witness(k, moved, movement, question, open_rivals, torn);
    // Targets that fit their coordinates to millimetres are no matter of odds of links.
    const bool surveyed = std::any_of(question.current.begin(), question.current.end(), [&](int k) {
      const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
      return graph_.anchor >= 0 && (link.source == graph_.anchor || link.target == graph_.anchor);
    });
    if (surveyed) return;
    // A link of many poses, perhaps none of them right, or to a possible twin, is no witness against a sure
    // one.
    const bool firm = std::any_of(question.current.begin(), question.current.end(), [&](int k) {
      return graph_.links[static_cast<std::size_t>(k)].trust <= LinkTrust::sure;
    });
    if (!firm) question.rival.insert(question.rival.end(), open_rivals.begin(), open_rivals.end());
    std::vector<Voice> present;
    std::vector<Voice> other;
    for (const int k : question.current)
      present.push_back({k, nats_of(graph_.links[static_cast<std::size_t>(k)],
                                    accepted_.pose[static_cast<std::size_t>(k)])});
    for (const int k : question.rival)
      other.push_back(
          {k, nats_of(graph_.links[static_cast<std::size_t>(k)], rival_pose(k, moved, movement))});
    std::vector<Voice> torn_present;
    std::vector<Voice> torn_other;
    for (const Voice& voice : torn)
      (voice.nats > 0.0 ? torn_present : torn_other).push_back({voice.link, std::abs(voice.nats)});
    if (question.current.empty() && question.rival.empty() && !follow_together(moved, movement)) return;
    // That what holds a scan may be wrong says nothing of another place: doubts_of() asks for that.
    const bool unrivalled = question.rival.empty() && !question.current.empty();
    question.rival_nats = nats_of(other, torn_other, moved);
    if (unrivalled || nats_of(present, torn_present, moved) - question.rival_nats >= kRivalClearNats) return;
    questions.push_back(std::move(question));
  }

  /// What links that know of one place only say for it, and those that choose between the two. The former may
  /// all lie on a twin together, however many they are and however surely each shows what it shows.
  [[nodiscard]] double nats_of(const std::vector<Voice>& one_place, const std::vector<Voice>& torn,
                               const std::vector<bool>& moved) const {
    std::vector<Voice> all = torn;
    all.insert(all.end(), one_place.begin(), one_place.end());
    const double by_chance = nats_of(one_place, moved);
    const double chosen = nats_of(std::move(all), moved) - by_chance;
    return chosen - std::log(std::exp(-by_chance) + odds_of_twin(one_place, moved));
  }

  /// Of links that cross a cut, that a place built alike explains what all of them show, against one place. 0
  /// where no things were asked.
  [[nodiscard]] double odds_of_twin(const std::vector<Voice>& voices, const std::vector<bool>& moved) const {
    std::vector<TwinVoice> all;
    for (const Voice& voice : voices) {
      const GraphLink& link = graph_.links[static_cast<std::size_t>(voice.link)];
      TwinVoice said{&link, link.against_twins(), link.asks_for_twins(), voice.link};
      // Where things were not asked the other places were searched too.
      if (!said.asked)
        said.said.otherwise_nats = said.said.alike_nats =
            link.trust <= LinkTrust::sure ? nats_for(link, 0, kMostTwinNats) : voice.nats;
      for (const TwinKind& kind : {kTwinOtherwise, kTwinAlike})
        said.said.*kind.nats = std::min(said.said.*kind.nats, kMostTwinNats);
      all.push_back(said);
    }
    TwinEvidence evidence;
    for (const TwinKind& kind : {kTwinOtherwise, kTwinAlike}) {
      const TwinsAcross across = twins_across(views_, kind, all, moved);
      evidence.*kind.prior = across.prior;
      evidence.*kind.nats = across.nats;
      evidence.built_nats = across.built_nats;
    }
    return evidence.odds();
  }

  /// What links say together: those that see the same say it once, but that sure ones agree says more.
  [[nodiscard]] double nats_of(std::vector<Voice> voices, const std::vector<bool>& moved) const {
    std::stable_sort(voices.begin(), voices.end(),
                     [](const Voice& a, const Voice& b) { return a.nats > b.nats; });
    std::vector<int> links;
    for (const Voice& voice : voices) links.push_back(voice.link);
    const std::vector<int> chosen = views_.independent(links, moved);
    double sum = 0.0;
    bool first = true;
    for (const Voice& voice : voices) {
      if (std::find(chosen.begin(), chosen.end(), voice.link) == chosen.end()) continue;
      sum += voice.nats;
      const bool sure = graph_.links[static_cast<std::size_t>(voice.link)].trust <= LinkTrust::sure;
      if (sure && !first) sum += kRivalLoopNats;
      first = false;
    }
    return sum;
  }

  /// Links that could follow a movement each by itself, by what is known of them, may not do so all together.
  [[nodiscard]] bool follow_together(const std::vector<bool>& moved, const Rigid3& movement) const {
    double more = 0.0;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      const bool source = moved[static_cast<std::size_t>(link.source)];
      if (accepted_.pose[k] < 0 || source == moved[static_cast<std::size_t>(link.target)]) continue;
      const Rigid3 now = present_pose(link);
      more += least_miss(link, moved_pose(link, source, movement)) - least_miss(link, now);
    }
    return more <= kChiSquareBound;
  }

  /// Of the poses that are possible, with mild deviations: those of one pass err alike.
  [[nodiscard]] static double least_miss(const GraphLink& link, const Rigid3& predicted) {
    double least = std::numeric_limits<double>::infinity();
    for (const LinkPose& pose : link.poses) {
      least = std::min(least, chi_square(misfit(pose, predicted), kMildRival * pose.covariance));
      if (link.trust <= LinkTrust::likely) break;
    }
    return least;
  }

  /// Nodes that would move, and nodes that would stay.
  struct Sides {
    std::vector<bool> moving;
    std::vector<bool> staying;
  };

  [[nodiscard]] Sides ends_of(const GraphLink& link) const {
    Sides sides;
    sides.moving.assign(static_cast<std::size_t>(graph_.nodes), false);
    sides.staying = sides.moving;
    sides.moving[static_cast<std::size_t>(link.source)] = true;
    sides.staying[static_cast<std::size_t>(link.target)] = true;
    return sides;
  }

  /// The ends of all links that speak for the movement and not for the present places.
  [[nodiscard]] Sides sides_of(const GraphLink& first, const std::vector<Bend>& bends) const {
    Sides sides = ends_of(first);
    const auto add = [&](int moving, int staying) {
      const auto m = static_cast<std::size_t>(moving);
      const auto s = static_cast<std::size_t>(staying);
      if (sides.staying[m] || sides.moving[s]) return;
      sides.moving[m] = true;
      sides.staying[s] = true;
    };
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (accepted_.pose[k] >= 0 || link.trust == LinkTrust::weak) continue;
      const Bend& bend = bends[k];
      if (bend.source_moves) add(link.source, link.target);
      if (bend.target_moves) add(link.target, link.source);
    }
    return sides;
  }

  /// The same with what is linked to one of the sides: a room that another was taken for goes with what its
  /// own links say, not with the other room.
  [[nodiscard]] Sides with_neighbours(const Sides& sides, const std::vector<Bend>& bends,
                                      bool of_moving) const {
    Sides more = sides;
    const std::vector<bool>& own = of_moving ? sides.moving : sides.staying;
    const std::vector<bool>& other = of_moving ? sides.staying : sides.moving;
    std::vector<bool>& grown = of_moving ? more.moving : more.staying;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (accepted_.pose[k] < 0 || link.trust == LinkTrust::weak) continue;
      if (bends[k].any()) continue;
      const auto s = static_cast<std::size_t>(link.source);
      const auto t = static_cast<std::size_t>(link.target);
      if (own[s] && !other[t]) grown[t] = true;
      if (own[t] && !other[s]) grown[s] = true;
    }
    return more;
  }

  static bool contains(const std::vector<int>& nodes, int node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  }

  /// The pose of a link that crosses the cut once what moves has moved; -1: none.
  [[nodiscard]] int rival_pose(int k, const std::vector<bool>& moved, const Rigid3& movement) const {
    const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
    return fitting_pose(link, moved_pose(link, moved[static_cast<std::size_t>(link.source)], movement));
  }

  /// Notes for which place the link speaks, if it crosses the cut.
  void witness(std::size_t k, const std::vector<bool>& moved, const Rigid3& movement, GraphQuestion& question,
               std::vector<int>& open_rivals, std::vector<Voice>& torn) const {
    const GraphLink& link = graph_.links[k];
    const bool source = moved[static_cast<std::size_t>(link.source)];
    const bool target = moved[static_cast<std::size_t>(link.target)];
    const int component = component_of(question.moved.front());
    const bool here = component_of(link.source) == component && component_of(link.target) == component;
    if (source == target || !here || link.trust == LinkTrust::weak) return;
    const int now = accepted_.pose[k];
    const int then = rival_pose(static_cast<int>(k), moved, movement);
    if (now >= 0 && then < 0) question.current.push_back(static_cast<int>(k));
    const bool fits_both = then >= 0 && fits(link.poses[static_cast<std::size_t>(then)], present_pose(link));
    if (now < 0 && then >= 0 && !fits_both)
      (link.trust > LinkTrust::sure ? open_rivals : question.rival).push_back(static_cast<int>(k));
    if (now >= 0 && then >= 0 && now != then) {
      const double better = nats_of(link, now) - nats_of(link, then);
      torn.push_back({static_cast<int>(k), better});
    }
  }

  /// By what a cut is small: how many links it breaks, or how little these say.
  enum class CutBy { count, nats };

  /// What a link says once it is granted that there are twins.
  [[nodiscard]] double nats_beside_twins(int k) const {
    const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
    const double nats = nats_of(link, accepted_.pose[static_cast<std::size_t>(k)]);
    if (!link.asks_for_twins()) return nats;
    const TwinEvidence said = link.against_twins();
    return std::max(0.0, std::min({nats, said.otherwise_nats, said.alike_nats}));
  }

  /// What holds the nodes of the graph together against a movement.
  [[nodiscard]] FlowNetwork network_of(const std::vector<Bend>& bends, CutBy by) const {
    FlowNetwork network(static_cast<std::size_t>(graph_.nodes));
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      if (accepted_.pose[k] < 0) continue;
      const GraphLink& link = graph_.links[k];
      const int usual = by == CutBy::count ? 10 : 1 + static_cast<int>(10.0 * beside_twins_[k]);
      const int firm = link.trust == LinkTrust::weak ? 1 : link.trust == LinkTrust::given ? 1000 : usual;
      const Bend& bend = bends[k];
      network.connect(link.source, link.target, bend.source_moves ? 0 : firm, bend.target_moves ? 0 : firm);
    }
    return network;
  }

  /// The nodes that go with the moving ones while the others stay.
  [[nodiscard]] static std::vector<bool> smallest_cut(FlowNetwork& network, const Sides& sides) {
    std::vector<int> moving;
    for (std::size_t node = 0; node < sides.moving.size(); ++node) {
      if (sides.moving[node]) moving.push_back(static_cast<int>(node));
    }
    return network.smallest_cut(moving, sides.staying, std::numeric_limits<int>::max())
        .value_or(sides.moving);
  }

  const PoseGraph& graph_;
  const AcceptedPoses& accepted_;
  SharedViews views_;
  std::vector<double> beside_twins_;  ///< of each link that was accepted
};

}  // namespace

std::vector<GraphQuestion> rival_places(const PoseGraph& graph, const AcceptedPoses& accepted) {
  return RivalSearch(graph, accepted).run();
}

}  // namespace limen
