// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/project_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "limen/base/angles.h"
#include "limen/geometry/linear.h"
#include "limen/project/solve/word_terms.h"

namespace limen {
namespace {

// What no pair's own deviations know of: how flat walls are, how rigid a scan is. One standard deviation.
constexpr double kFloorM = 0.004;
const double kFloorRad = radians(0.03);
constexpr double kModelDrawnM = 0.01;  // by how much a building misses its model
constexpr double kGivenM = 0.005;      // of poses that a file gives
const double kGivenRad = radians(0.05);
constexpr double kRivalShare = 0.5;    // of the best pose's score: a pose with less is no possibility
constexpr std::size_t kMostPoses = 9;  // of a link
constexpr double kMostChance = 0.5;    // probability of chance above which a pair makes no link
constexpr double kHardly = 1e-4;       // a pose less probable than this is no possibility
constexpr double kMostWrong = 0.05;    // probability that a pose measured in place is wrong
constexpr double kOfUnknown = 0.1;     // probability of being wrong where a pair tells none
constexpr double kStoreyM = 0.5;       // floors further apart are of different storeys
constexpr double kWordWrong = 4e-4;    // probability that a user's word is wrong
constexpr double kPlaceSigmaM = 0.05;  // deviation of the least known shift below which a pose is a place
const double kPlaceSigmaRad = radians(0.5);
constexpr double kOpenM = 0.1;  // where a pair calls a direction open: faces taken for one another
constexpr double kLooseSigmas = 3.0;
const double kOpenRad = radians(1.0);
constexpr double kDriftLengthM = 5.0;  // what a trajectory is off by may turn a scan of so much of it
constexpr double kLooser = 2.0;        // an alternative's deviations against those of the best pose

double square(double x) {
  return x * x;
}

Vector6d diagonal(const Vector3d& turn, const Vector3d& shift) {
  Vector6d all;
  all << turn, shift;
  return all;
}

/// What a pair says, and what it does not know of; a free direction is known to 100 m.
Matrix6d with_floor(const Matrix6d& covariance, bool model) {
  constexpr double kMost = 1e4;
  const Spectrum6 spectrum = spectrum_of(covariance);
  const Vector6d clipped = spectrum.values.cwiseMax(0.0).cwiseMin(kMost);
  const Matrix6d known = spectrum.vectors * clipped.asDiagonal() * spectrum.vectors.transpose();
  const Vector6d floor =
      diagonal(Vector3d::Constant(kFloorRad), Vector3d::Constant(model ? kModelDrawnM : kFloorM));
  return known + Matrix6d(floor.array().square().matrix().asDiagonal());
}

/// What a pair itself calls open hangs on little: one small face, and if that is another one the pose is off
/// by far more than its deviation. What it holds loosely may be off by some deviations. Loops have to fix
/// both.
void open_up(const std::vector<UnobservedFreedom>& unobserved, Matrix6d& covariance) {
  const VerdictOptions bounds;
  for (const UnobservedFreedom& freedom : unobserved) {
    const Eigen::Index first = freedom.rotation ? 0 : 3;
    const double known = std::sqrt(
        std::max(0.0, freedom.direction.dot(covariance.block<3, 3>(first, first) * freedom.direction)));
    const double most = freedom.rotation ? kOpenRad : kOpenM;
    const bool loose = known > (freedom.rotation ? radians(bounds.max_sigma_deg) : bounds.max_sigma_m);
    const double open = loose ? std::min(most, kLooseSigmas * known) : most;
    covariance.block<3, 3>(first, first) += open * open * freedom.direction * freedom.direction.transpose();
  }
}

/// Probability that none of a pair's poses is right, look-alike places left out.
double by_chance(const RegistrationResult& found) {
  if (found.others) return found.others->nothing_shared + found.others->unlisted_pose;
  return found.outcome == Outcome::no_match ? 1.0 : 0.0;
}

class GraphMaker {
 public:
  GraphMaker(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
             const UserWords& words)
      : nodes_(nodes), pairs_(pairs), words_(words) {}

  ProjectGraph run() {
    graph_.nodes = static_cast<int>(nodes_.size());
    for (const ProjectNode& node : nodes_) graph_.scanners.push_back(node.digest.scanner());
    for (std::size_t k = 0; k < pairs_.size(); ++k) pairs_[k].placed ? add_measured_in_place(k) : add_pair(k);
    add_given();
    return {std::move(graph_), std::move(pair_of_), std::move(pair_in_place_)};
  }

 private:
  [[nodiscard]] const ScanDigest& digest(int node) const {
    return nodes_[static_cast<std::size_t>(node)].digest;
  }

  void add_pair(std::size_t k) {
    const RegistrationResult& found = pairs_[k].result;
    // Loops cannot settle what a look-alike place says: rooms built alike laid on one another close their
    // loops too.
    const double look_alike = found.others ? found.others->look_alike : 0.0;
    const auto said = words_.pairs.find({pairs_[k].source, pairs_[k].target});
    const bool spoken = said != words_.pairs.end();
    if (spoken && said->second.kind == DecisionKind::reject) return;
    if (!makes_link(found, spoken)) return;
    GraphLink link = with_poses(pairs_[k]);
    link.trust = trust_of(found);
    link.look_alike = look_alike;
    link.chance = found.others ? by_chance(found) : kOfUnknown;
    if (words_.floors.count({pairs_[k].source, pairs_[k].target}) > 0) keep_floor(link);
    if (spoken) heed(said->second, link);
    graph_.links.push_back(std::move(link));
    pair_of_.push_back(static_cast<int>(k));
  }

  /// The poses that a pair found, its best first.
  [[nodiscard]] GraphLink with_poses(const TriedPair& pair) const {
    const RegistrationResult& found = pair.result;
    GraphLink link;
    link.source = static_cast<int>(pair.source);
    link.target = static_cast<int>(pair.target);
    link.poses.push_back(pose_of(link, found, found.best, 1.0));
    for (const Hypothesis& other : found.alternatives) {
      if (link.poses.size() >= kMostPoses) break;
      if (other.score < kRivalShare * found.best.score) continue;
      if (other.probability && *other.probability < kHardly) continue;
      add_alternative(pose_of(link, found, other, kLooser), link);
    }
    return link;
  }

  /// Whether a measured pose says something of the shift that was known least.
  [[nodiscard]] static bool knows_more(const Matrix6d& measured, const Matrix6d& before) {
    constexpr double kLeastShare = 0.1;  // of what was known
    const Spectrum3 shifts = spectrum_of(Matrix3d(before.bottomRightCorner<3, 3>()));
    const Vector3d loosest = shifts.vectors.col(2);
    const Matrix3d information = inverse_of(measured).bottomRightCorner<3, 3>();
    return loosest.dot(information * loosest) * shifts.values[2] > kLeastShare;
  }

  /// What a pair says of how exactly its scans lie where the links place them, if it found them there. As far
  /// as it may be wrong, they are known no better than before.
  void add_measured_in_place(std::size_t k) {
    const RegistrationResult& found = pairs_[k].result;
    if (!makes_link(found, false)) return;
    GraphLink link = with_poses(pairs_[k]);
    LinkPose& pose = link.poses.front();
    const double wrong = 1.0 - pose.probability;
    if (wrong > kMostWrong) return;
    const LinkPose& placed = *pairs_[k].placed;
    const Matrix6d around = moved_covariance(placed, Rigid3{}, pose.centre);
    if (chi_square(misfit(pose, placed.target_from_source), pose.covariance + around) > kChiSquareBound)
      return;
    if (!knows_more(pose.covariance, around)) return;
    pose.covariance += wrong * around;
    graph_.measured_in_place.push_back({link.source, link.target, pose});
    pair_in_place_.push_back(static_cast<int>(k));
  }

  /// Poses nearer to each other than places repeat are one place, which is known no better than they agree:
  /// their second moment about the likelier is its covariance. What is open is no place at all.
  static void add_alternative(const LinkPose& other, GraphLink& link) {
    if (other.covariance.diagonal().tail<3>().maxCoeff() > square(kOtherPlaceM)) return;
    for (LinkPose& known : link.poses) {
      const Vector6d apart = misfit(known, other.target_from_source);
      if (!is_one_place(apart)) continue;
      const double both = known.probability + other.probability;
      const double share = other.probability / both;
      known.covariance =
          (1.0 - share) * known.covariance +
          share * (moved_covariance(other, Rigid3{}, known.centre) + apart * apart.transpose());
      known.probability = both;
      return;
    }
    link.poses.push_back(other);
  }

  /// Poses that lay floors on other storeys fall away where a user says that they are of one height; if the
  /// best does, the next is no surer than it was.
  void keep_floor(GraphLink& link) const {
    const auto apart = [&](const LinkPose& pose) {
      const std::optional<double> metres =
          floors_apart(digest(link.source), digest(link.target), pose.target_from_source);
      return metres && std::abs(*metres) > kStoreyM;
    };
    const auto kept = std::find_if_not(link.poses.begin(), link.poses.end(), apart);
    if (kept == link.poses.end() || kept == link.poses.begin()) return;
    put_first(static_cast<int>(kept - link.poses.begin()), link);
  }

  /// `pose`: where it is among the link's poses. What was put first before goes back.
  static void put_first(int pose, GraphLink& link) {
    const int number = link.number_of(pose);
    std::swap(link.poses.front(), link.poses[static_cast<std::size_t>(link.best)]);
    std::swap(link.poses.front(), link.poses[static_cast<std::size_t>(number)]);
    link.best = number;
  }

  /// The pose that a user says is right becomes the first, as sure as a user is. Of the others each is as
  /// likely as before, against none: if the word is wrong it says nothing of them.
  static void heed(const PairWord& word, GraphLink& link) {
    const auto number = static_cast<std::size_t>(word.pose);
    if (number >= link.poses.size()) return;
    put_first(link.number_of(word.pose), link);
    link.accepted = true;
    link.look_alike = std::min(link.look_alike, kWordWrong);
    link.poses.front().look_alike.reset();
    if (link.chance > kWordWrong) {
      for (LinkPose& pose : link.poses) pose.probability *= kWordWrong / link.chance;
      link.chance = kWordWrong;
    }
    link.poses.front().probability = std::max(link.poses.front().probability, 1.0 - kWordWrong);
  }

  /// What a pair calls open may be known well enough to distinguish places: the covariance says how well.
  [[nodiscard]] static LinkTrust trust_of(const RegistrationResult& found) {
    return !found.unobserved.empty() && !tells_places_apart(found.sigma) ? LinkTrust::weak
                                                                         : LinkTrust::measured;
  }

  [[nodiscard]] static bool tells_places_apart(const PoseSigma& sigma) {
    return sigma.translation_m.maxCoeff() < kPlaceSigmaM && sigma.rotation_rad.maxCoeff() < kPlaceSigmaRad;
  }

  /// What is known of how trajectories drift beyond what the pair took for it.
  struct Drift {
    double more_m2 = 0.0;  ///< per axis; less than nothing where the pair took too much
    [[nodiscard]] double turn_rad2() const { return std::max(0.0, more_m2) / square(kDriftLengthM); }
  };
  [[nodiscard]] Drift drift_of(const GraphLink& link) const {
    const auto more_m2 = [&](int n) {
      const ProjectNode& node = nodes_[static_cast<std::size_t>(n)];
      return node.drift ? square(node.drift->strays_m) - square(node.digest.drift_m) : 0.0;
    };
    return {more_m2(link.source) + more_m2(link.target)};
  }

  [[nodiscard]] LinkPose pose_of(const GraphLink& link, const RegistrationResult& found,
                                 const Hypothesis& pose, double looser) const {
    const ScanDigest& source = digest(link.source);
    const ScanDigest& target = digest(link.target);
    LinkPose kept;
    kept.target_from_source = to_local(pose.target_from_source, source.local_origin, target.local_origin);
    const Rigid3 best = to_local(found.best.target_from_source, source.local_origin, target.local_origin);
    kept.centre = kept.target_from_source * (inverse(best) * (found.sigma.centre - target.local_origin));
    kept.agreeing_m2 = pose.agreeing_m2;
    kept.probability = pose.probability.value_or(1.0 / (1.0 + static_cast<double>(found.rivals)));
    kept.look_alike = pose.look_alike;
    const Drift drift = drift_of(link);
    if (!pose.sigma.covariance.isZero()) {
      kept.centre = pose.sigma.centre - target.local_origin;
      Matrix6d own = pose.sigma.covariance;
      own.diagonal().tail<3>().array() += drift.more_m2;
      own.diagonal().head<3>().array() += drift.turn_rad2();
      kept.covariance = with_floor(own, source.model || target.model);
      open_up(found.unobserved, kept.covariance);
      return kept;
    }
    const double floor = source.model || target.model ? kModelDrawnM : kFloorM;
    Vector3d turn;
    Vector3d shift;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double turned = std::hypot(found.sigma.rotation_rad[axis], std::sqrt(drift.turn_rad2()));
      const double shifted = square(found.sigma.translation_m[axis]) + drift.more_m2;
      turn[axis] = std::hypot(looser * std::min(turned, 3.0), kFloorRad);
      shift[axis] = std::hypot(looser * std::min(std::sqrt(std::max(0.0, shifted)), 100.0), floor);
    }
    kept.covariance = diagonal(turn, shift).array().square().matrix().asDiagonal();
    open_up(found.unobserved, kept.covariance);
    return kept;
  }

  /// What files say of their own scans: each against the first of its file.
  void add_given() {
    std::map<std::size_t, int> first;
    for (int n = 0; n < graph_.nodes; ++n) {
      const ProjectNode& node = nodes_[static_cast<std::size_t>(n)];
      if (!node.grouped) continue;
      const auto [known, fresh] = first.emplace(node.file, n);
      if (fresh) continue;
      GraphLink link;
      link.source = n;
      link.target = known->second;
      link.trust = LinkTrust::given;
      LinkPose pose;
      pose.target_from_source.translation = digest(n).local_origin - digest(link.target).local_origin;
      pose.centre = pose.target_from_source * digest(n).middle;
      pose.covariance = diagonal(Vector3d::Constant(kGivenRad), Vector3d::Constant(kGivenM))
                            .array()
                            .square()
                            .matrix()
                            .asDiagonal();
      link.poses.push_back(pose);
      graph_.links.push_back(std::move(link));
      pair_of_.push_back(-1);
    }
  }

  const std::vector<ProjectNode>& nodes_;
  const std::vector<TriedPair>& pairs_;
  const UserWords& words_;
  PoseGraph graph_;
  std::vector<int> pair_of_;
  std::vector<int> pair_in_place_;
};

}  // namespace

bool makes_link(const RegistrationResult& found, bool spoken) {
  if (by_chance(found) <= kMostChance) return true;
  return spoken && found.outcome != Outcome::no_match;
}

ProjectGraph make_graph(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                        const UserWords& words) {
  return GraphMaker(nodes, pairs, words).run();
}

}  // namespace limen
