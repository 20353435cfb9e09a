// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/loops.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "limen/base/progress.h"

namespace limen {
namespace {

/// A link leaving a node.
struct Arm {
  int to = -1;
  int link = -1;
  bool forward = true;  ///< the node is the link's source
};

std::vector<std::vector<Arm>> arms_of(const PoseGraph& graph) {
  std::vector<std::vector<Arm>> arms(static_cast<std::size_t>(graph.nodes));
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    const GraphLink& link = graph.links[k];
    arms[static_cast<std::size_t>(link.source)].push_back({link.target, static_cast<int>(k), true});
    arms[static_cast<std::size_t>(link.target)].push_back({link.source, static_cast<int>(k), false});
  }
  return arms;
}

/// Legs of a loop, walked one after the other.
using Walk = std::vector<Arm>;

struct Closure {
  Vector6d misfit;
  double chi_square = 0.0;
};

/// What is left after walking the loop: the last leg against the way back along the others.
Closure close(const std::vector<LinkPose>& legs) {
  const LinkPose& first = legs.front();
  // The first leg leads from a to b; the others from b round to a. Their way, reversed, predicts the first.
  Rigid3 a_from_b;
  for (std::size_t k = 1; k < legs.size(); ++k) a_from_b = legs[k].target_from_source * a_from_b;
  Closure closure;
  closure.misfit = misfit(first, inverse(a_from_b));
  Matrix6d covariance = first.covariance;
  Rigid3 b_from_here = inverse(a_from_b);  // the frame at the end of the last leg is a
  for (std::size_t k = legs.size(); k-- > 1;) {
    covariance += moved_covariance(legs[k], b_from_here, first.centre);
    b_from_here = b_from_here * legs[k].target_from_source;
  }
  closure.chi_square = chi_square(closure.misfit, covariance);
  return closure;
}

LinkPose leg_of(const PoseGraph& graph, const Arm& arm, std::size_t pose) {
  const LinkPose& found = graph.links[static_cast<std::size_t>(arm.link)].poses[pose];
  return arm.forward ? found : reversed(found);
}

/// Every loop of three links once: a < b < c by number.
template <typename Visit>
void for_each_triangle(const PoseGraph& graph, const Visit& visit) {
  const std::vector<std::vector<Arm>> arms = arms_of(graph);
  for (int a = 0; a < graph.nodes; ++a) {
    CancelScope::check();
    for (const Arm& ab : arms[static_cast<std::size_t>(a)]) {
      if (ab.to < a) continue;
      for (const Arm& bc : arms[static_cast<std::size_t>(ab.to)]) {
        if (bc.to <= ab.to) continue;
        for (const Arm& ca : arms[static_cast<std::size_t>(bc.to)]) {
          if (ca.to == a) visit(Walk{ab, bc, ca});
        }
      }
    }
  }
}

GraphLoop loop_of(const PoseGraph& graph, const Walk& walk, const std::vector<int>& poses) {
  std::vector<LinkPose> legs;
  GraphLoop loop;
  for (const Arm& arm : walk) {
    const int pose = std::max(0, poses[static_cast<std::size_t>(arm.link)]);
    legs.push_back(leg_of(graph, arm, static_cast<std::size_t>(pose)));
    loop.links.push_back(arm.link);
  }
  const Closure closure = close(legs);
  loop.error_rad = closure.misfit.head<3>().norm();
  loop.error_m = closure.misfit.tail<3>().norm();
  loop.chi_square = closure.chi_square;
  loop.closes = closure.chi_square <= kChiSquareBound;
  return loop;
}

/// The shortest loop of four links through `link`, if there is one.
std::optional<Walk> square_through(const std::vector<std::vector<Arm>>& arms, const PoseGraph& graph,
                                   int link) {
  const GraphLink& own = graph.links[static_cast<std::size_t>(link)];
  for (const Arm& bc : arms[static_cast<std::size_t>(own.target)]) {
    if (bc.to == own.source || bc.link == link) continue;
    for (const Arm& cd : arms[static_cast<std::size_t>(bc.to)]) {
      if (cd.to == own.target || cd.to == own.source) continue;
      for (const Arm& da : arms[static_cast<std::size_t>(cd.to)]) {
        if (da.to == own.source) return Walk{{own.target, link, true}, bc, cd, da};
      }
    }
  }
  return {};
}

}  // namespace

std::vector<GraphLoop> tested_loops(const PoseGraph& graph, const std::vector<int>& poses, std::size_t most) {
  std::vector<GraphLoop> loops;
  std::vector<std::size_t> seen(graph.links.size(), 0);
  for_each_triangle(graph, [&](const Walk& walk) {
    const auto full = [&](const Arm& arm) { return seen[static_cast<std::size_t>(arm.link)] >= most; };
    if (std::all_of(walk.begin(), walk.end(), full)) return;
    for (const Arm& arm : walk) ++seen[static_cast<std::size_t>(arm.link)];
    loops.push_back(loop_of(graph, walk, poses));
  });
  const std::vector<std::vector<Arm>> arms = arms_of(graph);
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    if (seen[k] > 0) continue;
    const std::optional<Walk> walk = square_through(arms, graph, static_cast<int>(k));
    if (!walk) continue;
    for (const Arm& arm : *walk) ++seen[static_cast<std::size_t>(arm.link)];
    loops.push_back(loop_of(graph, *walk, poses));
  }
  return loops;
}

}  // namespace limen
