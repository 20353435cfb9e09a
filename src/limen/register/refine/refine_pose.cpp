// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/refine_pose.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/geometry/linear.h"
#include "limen/register/refine/built_offsets.h"
#include "limen/register/refine/planes_by_wall.h"
#include "limen/register/refine/pose_contacts.h"

namespace limen {
namespace {

constexpr double kWeakShare = 1e-4;     // of the information: less is the planes' error
constexpr double kMaxCentreM = 20.0;    // the best known point is sought this far from the matched surface
constexpr int kLeastTilted = 8;         // tiles of a pair whose slopes are looked at
constexpr double kMovedGateM = 0.06;    // as far as walls are looked for that were moved
constexpr double kBesideGateM = 0.15;   // the same in two scans: two walls may both be lined
constexpr double kBesideM2 = 1.0;       // less may be a piece of furniture
constexpr double kBesideSigmas = 3.0;   // of the pose: what lies beside by less may be met under a near one
constexpr double kBesideRad = 0.02;     // a plane that was moved keeps its direction
constexpr double kBesideShare = 0.3;    // of it: so much that is met where it is was not moved
constexpr double kOpeningErrsM = 0.02;  // how far windows and doors are from where a model has them: 1 sigma
constexpr double kWholePlaneM2 = 5.0;   // one observation of how a building was built
constexpr double kOneOffsetM = 0.006;   // parts of one plane that differ by less were moved together
constexpr double kGateSigma = 0.2;      // deviation of a tile far from the goal, as a share of the gate

/// Sums of one kind of evidence about a small turn and shift.
struct NormalEquations {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();

  void add(const Vector6d& row, double residual, double weight) {
    normal += weight * row * row.transpose();
    right += weight * residual * row;
  }
};

/// How well planes hold a pose, direction by direction. Turns are measured by what they move at the typical
/// lever, so that they compare with shifts.
struct HeldFreedoms {
  Vector6d unit;
  Spectrum6 spectrum;
  double trace = 0.0;

  explicit HeldFreedoms(const Matrix6d& information) {
    const double lever = std::sqrt(information.topLeftCorner<3, 3>().trace() /
                                   std::max(1e-12, information.bottomRightCorner<3, 3>().trace()));
    unit << Vector3d::Constant(1.0 / std::max(0.1, lever)), Vector3d::Ones();
    const Matrix6d scaled = unit.asDiagonal() * information * unit.asDiagonal();
    spectrum = spectrum_of(scaled);
    trace = scaled.trace();
  }
  [[nodiscard]] bool is_weak(Eigen::Index k) const { return spectrum.values[k] < kWeakShare * trace; }
};

class Refiner {
 public:
  Refiner(const ScanView& source, const ScanView& target, const RefineOptions& options)
      : source_(source), target_(target), options_(options), contacts_(source, target, options) {}

  [[nodiscard]] RefinedPose run(const Rigid3& start) const {
    RefinedPose refined;
    refined.target_from_source = start;
    for (int round = 0; round < options_.rounds; ++round) {
      CancelScope::check();
      const double share = static_cast<double>(round) / std::max(1, options_.rounds - 1);
      const double gate =
          options_.first_gate_m * std::pow(options_.last_gate_m / options_.first_gate_m, share);
      const double opening_gate =
          options_.first_opening_gate_m *
          std::pow(options_.last_opening_gate_m / options_.first_opening_gate_m, share);
      const Contacts contacts = contacts_.near(refined.target_from_source, {gate, opening_gate});
      if (contacts.all.size() < 4) break;
      adjust(contacts.all, kGateSigma * (gate - options_.last_gate_m), refined);
    }
    std::optional<Settled> settled;
    // Few samples do not show which walls were moved.
    if ((source_.model || target_.model) && options_.samples == 0) settled = settle(refined);
    summarise(refined);
    if (settled) {
      refined.information = about(settled->information, settled->centre, refined.centre);
      refined.moved = settled->moved;
    }
    return refined;
  }

  void find_moved(RefinedPose& refined) const {
    const double gate = std::max(kBesideGateM, 2.0 * options_.last_gate_m);
    std::vector<Contact> contacts;
    for (const Contact& contact :
         contacts_.near(refined.target_from_source, {gate, options_.last_opening_gate_m}).all) {
      if (contact.source_plane >= 0) contacts.push_back(contact);
    }
    PairMap pairs = pairs_of(contacts, refined.centre);
    MetAreas met;
    for (const auto& [key, pair] : pairs) {
      if (!is_met(pair)) continue;
      met.source[key.first] += pair.area_m2;
      met.target[key.second] += pair.area_m2;
    }
    for (auto it = pairs.begin(); it != pairs.end();)
      it = is_met(it->second) || lies_beside(*it, met, refined) ? std::next(it) : pairs.erase(it);
    const Matrix6d covariance = covariance_of(refined);
    for (const auto& [key, pair] : pairs) {
      if (!is_met(pair) && pair.area_m2 >= kBesideM2 &&
          std::abs(pair.mean_m()) > kBesideSigmas * pair.sigma_m(covariance))
        refined.moved.push_back(
            {key.first, key.second, pair.distance / pair.area_m2, angle_of(key, refined), pair.area_m2});
    }
    by_overlap(refined.moved);
    if (refined.moved.empty()) return;
    const double factor = scatter_of(pairs);
    Matrix6d planes = Matrix6d::Zero();
    for (const auto& [key, pair] : pairs) planes += pair.information / factor;
    refined.spread = settled_among(pairs, {}, factor, stay_where_weak(planes)).spread;
  }

 private:
  /// Surface of each plane that is met where it is.
  struct MetAreas {
    std::map<int, double> source;
    std::map<int, double> target;
  };

  static Vector3d middle_of(const std::vector<Contact>& contacts) {
    Vector3d sum = Vector3d::Zero();
    for (const Contact& contact : contacts) sum += contact.at;
    return sum / static_cast<double>(contacts.size());
  }

  static Vector6d row_of(const Contact& contact, const Vector3d& centre) {
    Vector6d row;
    if (contact.turn) {
      row << contact.normal, Vector3d::Zero();
    } else {
      row << (contact.at - centre).cross(contact.normal), contact.normal;
    }
    return row;
  }

  /// Tukey's weight: nothing counts beyond the gate.
  static double robust_weight(double residual, double gate) {
    const double x = residual / gate;
    return std::abs(x) >= 1.0 ? 0.0 : (1.0 - x * x) * (1.0 - x * x);
  }

  /// Planes of one direction seem to hold the others a little, by the errors of their normals: what is that
  /// weak is left out, so that the pose stays where it is there, or goes where openings want it.
  static NormalEquations without_weak(const NormalEquations& planes) {
    const HeldFreedoms held(planes.normal);
    NormalEquations kept;
    for (Eigen::Index k = 0; k < 6; ++k) {
      if (held.is_weak(k)) continue;
      const Vector6d d = held.spectrum.vectors.col(k);
      const Vector6d back = d.cwiseQuotient(held.unit);
      kept.normal += held.spectrum.values[k] * back * back.transpose();
      kept.right += d.dot(held.unit.cwiseProduct(planes.right)) * back;
    }
    return kept;
  }

  /// Information that keeps a pose where it is along what `planes` hardly hold.
  static Matrix6d stay_where_weak(const Matrix6d& planes) {
    const HeldFreedoms held(planes);
    Matrix6d stay = Matrix6d::Zero();
    for (Eigen::Index k = 0; k < 6; ++k) {
      if (!held.is_weak(k)) continue;
      const Vector6d back = held.spectrum.vectors.col(k).cwiseQuotient(held.unit);
      stay += held.trace * back * back.transpose();
    }
    return stay;
  }

  /// One Gauss-Newton step. Far from the goal a tile says no more than `plane_sigma_m` allows: else the first
  /// ones that happen to meet would outweigh every opening.
  static void adjust(const std::vector<Contact>& contacts, double plane_sigma_m, RefinedPose& refined) {
    const Vector3d centre = middle_of(contacts);
    NormalEquations planes;
    NormalEquations openings;
    for (const Contact& contact : contacts) {
      const bool plane = contact.source_plane >= 0;
      const double variance =
          contact.sigma_m * contact.sigma_m + (plane ? plane_sigma_m * plane_sigma_m : 0.0);
      (plane ? planes : openings)
          .add(row_of(contact, centre), contact.residual_m,
               robust_weight(contact.residual_m, contact.gate_m) / variance);
    }
    const NormalEquations held = without_weak(planes);
    const Matrix6d normal = held.normal + openings.normal;
    const double damping = 1e-9 * normal.trace();
    const Vector6d step = solve_symmetric(Matrix6d(normal + damping * Matrix6d::Identity()),
                                          Vector6d(held.right + openings.right));
    move_by(step, centre, refined.target_from_source);
  }

  static void move_by(const Vector6d& step, const Vector3d& centre, Rigid3& pose) {
    const Matrix3d turn = rotation_exp(step.head<3>());
    pose.rotation = nearest_rotation(turn * pose.rotation);
    pose.translation = turn * (pose.translation - centre) + centre + step.tail<3>();
  }

  /// What the tiles of one pair of planes say together.
  struct PairSums : PlaneSums {
    Vector3d middle = Vector3d::Zero();
    double area_m2 = 0.0;
    double distance = 0.0;  // area times distance
    int tiles = 0;

    /// How well a pose of this covariance knows its mean residual.
    [[nodiscard]] double sigma_m(const Matrix6d& covariance) const {
      const Vector6d row = shared.col(0) / weight;
      return std::sqrt(std::max(0.0, row.dot(covariance * row)));
    }
    /// What the residuals would lose, were the pair freely tilted.
    [[nodiscard]] double stated_by_slopes() const {
      const Eigen::Vector2d by_slopes = residuals.tail<2>();
      const Eigen::Matrix2d moments = common.bottomRightCorner<2, 2>();
      const Eigen::Matrix2d damped = moments + 1e-9 * (1e-12 + moments.trace()) * Eigen::Matrix2d::Identity();
      return by_slopes.dot(damped.inverse() * by_slopes);
    }
  };
  using PairMap = std::map<std::pair<int, int>, PairSums>;

  /// Deviation common to all tiles of a pair of planes: the planes' own errors, a scanner's drift. Taken from
  /// how the pairs' mean residuals scatter, not less than a tenth of the noise, or than builders err.
  [[nodiscard]] double pair_offset_m(const PairMap& pairs) const {
    double squares = 0.0;
    double areas = 0.0;
    for (const auto& [key, pair] : pairs) {
      const double mean = pair.residuals[0] / pair.weight;
      squares += pair.area_m2 * mean * mean;
      areas += pair.area_m2;
    }
    const auto count = static_cast<double>(pairs.size());
    const double freedoms = count / std::max(1.0, count - 3.0);
    const double noise = std::max(source_.features->noise_m, target_.features->noise_m);
    const double least = source_.model || target_.model ? kLeastBuilderErrsM : 0.1 * noise;
    return std::max(std::sqrt(freedoms * squares / areas), least);
  }

  /// Slopes common to all tiles of a pair: what the pairs' residuals would lose by tilting freely, beyond
  /// what scatter that is `factor` times the weights' would explain.
  static double pair_slope(const PairMap& pairs, double factor) {
    double stated = 0.0;
    double levers = 0.0;
    double slopes = 0.0;
    for (const auto& [key, pair] : pairs) {
      if (pair.tiles < kLeastTilted) continue;
      stated += pair.stated_by_slopes();
      levers += pair.common.bottomRightCorner<2, 2>().trace();
      slopes += 2.0;
    }
    if (slopes <= 3.0) return 0.0;
    // A turn of the pose has taken three of them.
    const double freedoms = slopes / (slopes - 3.0);
    return std::sqrt(std::max(0.0, freedoms * stated - slopes * factor) / levers);
  }

  /// What is known of a pose about a centre.
  struct Settled {
    Matrix6d information;
    Vector3d centre;
    std::vector<PlaneMatch> moved;
  };

  template <typename Pair>
  [[nodiscard]] bool is_met(const Pair& pair) const {
    return std::abs(pair.mean_m()) <= options_.last_gate_m;
  }

  /// A pair of planes seen from the same side, of which neither is met elsewhere.
  [[nodiscard]] bool lies_beside(const PairMap::value_type& pair, MetAreas& met,
                                 const RefinedPose& refined) const {
    const auto& [source, target] = pair.first;
    const PlanarPolygon& first = source_.features->planes[static_cast<std::size_t>(source)];
    const PlanarPolygon& second = target_.features->planes[static_cast<std::size_t>(target)];
    const double cosine = (refined.target_from_source.rotation * first.plane.normal).dot(second.plane.normal);
    return first.oriented && second.oriented && cosine > 0.0 && angle_of(pair.first, refined) < kBesideRad &&
           std::max(met.source[source], met.target[target]) < kBesideShare * pair.second.area_m2;
  }

  /// Variance of the tiles about the mean of their pair, in those that the weights state.
  static double scatter_of(const PairMap& pairs) {
    double squares = 0.0;
    double tiles = 0.0;
    for (const auto& [key, pair] : pairs) {
      squares += pair.squares - pair.residuals[0] * pair.residuals[0] / pair.weight;
      tiles += pair.tiles;
    }
    const double freedoms = 0.5 * tiles - static_cast<double>(pairs.size());
    return std::max(squares / std::max(1.0, freedoms), 1e-6);
  }

  /// The likeliest pose near the one under which `pairs` were found, given that some planes may have been
  /// moved. `openings`: what these say of shifts; `factor`: of the variances that the weights are made with.
  /// `stay`: as in settle_among_moved.
  static SettledPose settled_among(const PairMap& pairs, const std::vector<PlaneSums>& openings,
                                   double factor, const Matrix6d& stay = Matrix6d::Zero()) {
    std::vector<PlaneSums> planes;
    for (const auto& [key, pair] : pairs) {
      planes.push_back(pair);
      planes.back().counts = std::min(1.0, pair.area_m2 / kWholePlaneM2);
    }
    planes.insert(planes.end(), openings.begin(), openings.end());
    return settle_among_moved(planes, pair_slope(pairs, factor), factor, stay);
  }

  [[nodiscard]] const Features& model_features() const {
    return *(source_.model ? source_ : target_).features;
  }

  /// A direction of the model's frame, in the target's.
  [[nodiscard]] Vector3d to_target(const Vector3d& of_model, const Rigid3& target_from_source) const {
    return source_.model ? Vector3d(target_from_source.rotation * of_model) : of_model;
  }

  /// Contacts whose pairs of planes lie in one wall of the model, and are equally far from it, get the same
  /// pair: a wall that was moved is moved with all its parts.
  void join_pairs(std::vector<Contact>& contacts, const Vector3d& centre, PlanesByWall& walls) const {
    struct Part {
      std::size_t wall;
      double offset_m;
      std::pair<int, int> pair;
    };
    std::vector<Part> parts;
    for (const auto& [key, pair] : pairs_of(contacts, centre))
      parts.push_back({walls.wall_of(source_.model ? key.first : key.second), pair.mean_m(), key});
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
      return std::tie(a.wall, a.offset_m, a.pair) < std::tie(b.wall, b.offset_m, b.pair);
    });
    std::map<std::pair<int, int>, std::pair<int, int>> joined;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const bool same = k > 0 && parts[k].wall == parts[k - 1].wall &&
                        parts[k].offset_m - parts[k - 1].offset_m < kOneOffsetM;
      joined[parts[k].pair] = same ? joined.at(parts[k - 1].pair) : parts[k].pair;
    }
    for (Contact& contact : contacts)
      std::tie(contact.source_plane, contact.target_plane) =
          joined.at({contact.source_plane, contact.target_plane});
  }

  /// A contact along the normal of the model's wall: the tiles of both its faces, and of both sides, then say
  /// the same of a shift.
  [[nodiscard]] Contact along_wall(Contact contact, const Rigid3& target_from_source,
                                   PlanesByWall& walls) const {
    const std::size_t wall = walls.wall_of(source_.model ? contact.source_plane : contact.target_plane);
    const Vector3d normal = to_target(walls.normal(wall), target_from_source);
    if (normal.dot(contact.normal) < 0.0) contact.residual_m = -contact.residual_m;
    contact.normal = normal;
    return contact;
  }

  /// What the openings of each wall say together of shifts across and up. Where its faces lie is said by its
  /// planes.
  [[nodiscard]] std::vector<PlaneSums> opening_sums(const Contacts& found, const Rigid3& target_from_source,
                                                    const Vector3d& centre, double factor,
                                                    PlanesByWall& walls) const {
    std::map<std::pair<std::size_t, bool>, PlaneSums> sums;
    for (const Contact& contact : found.all) {
      if (contact.opening < 0 || contact.turn) continue;
      const OpeningMatch& match = found.openings[static_cast<std::size_t>(contact.opening)];
      const Vector3d outward = match.across.cross(match.up);
      const int opening = source_.model ? match.source : match.target;
      const int facade = model_features().openings[static_cast<std::size_t>(opening)].facade;
      if (facade < 0 || std::abs(contact.normal.dot(outward)) > 0.5) continue;
      const std::size_t wall = walls.wall_of(facade);
      const bool upright = std::abs(contact.normal.dot(match.up)) > 0.5;
      // Seen from the two faces of a wall, what is right for one is left for the other.
      const double side = outward.dot(to_target(walls.normal(wall), target_from_source));
      const double sign = upright || side > 0.0 ? 1.0 : -1.0;
      const double residual_m = sign * contact.residual_m;
      const Vector6d row = sign * row_of(contact, centre);
      const double weight = factor / (contact.sigma_m * contact.sigma_m + kOpeningErrsM * kOpeningErrsM);
      PlaneSums& sum = sums[{wall, upright}];
      sum.weight += weight;
      sum.add(row, residual_m, Vector3d::UnitX(), weight);
    }
    std::vector<PlaneSums> all;
    for (const auto& [wall, sum] : sums) all.push_back(sum);
    return all;
  }

  /// Moves a pose in a model to where it is likeliest, given that some walls may have been moved.
  [[nodiscard]] std::optional<Settled> settle(RefinedPose& refined) const {
    const Contacts found =
        contacts_.near(refined.target_from_source, {kMovedGateM, options_.last_opening_gate_m});
    PlanesByWall walls(model_features().planes);
    std::vector<Contact> contacts;
    for (const Contact& contact : found.all) {
      if (contact.source_plane >= 0)
        contacts.push_back(along_wall(contact, refined.target_from_source, walls));
    }
    if (contacts.size() < 4) return std::nullopt;
    const Vector3d centre = middle_of(contacts);
    join_pairs(contacts, centre, walls);
    const PairMap pairs = pairs_of(contacts, centre);
    const double factor = scatter_of(pairs);
    const SettledPose settled =
        settled_among(pairs, opening_sums(found, refined.target_from_source, centre, factor, walls), factor);
    move_by(settled.step, centre, refined.target_from_source);
    Settled known{settled.information, centre, {}};
    std::size_t k = 0;
    for (const auto& [key, pair] : pairs) {
      const double sign = walls.sign_of(source_.model ? key.first : key.second);
      const double off_m = sign * (-pair.mean_m() + pair.shared.col(0).dot(settled.step) / pair.weight);
      if (settled.moved[k++] > 0.5)
        known.moved.push_back({key.first, key.second, off_m, angle_of(key, refined), pair.area_m2});
    }
    by_overlap(known.moved);
    return known;
  }

  void summarise(RefinedPose& refined) const {
    const Contacts found =
        contacts_.near(refined.target_from_source, {options_.last_gate_m, options_.last_opening_gate_m});
    refined.openings = found.openings;
    if (found.all.empty()) return;
    refined.centre = middle_of(found.all);
    std::vector<Contact> contacts;
    std::vector<Contact> others;
    for (const Contact& contact : found.all)
      (contact.source_plane >= 0 ? contacts : others).push_back(contact);
    add_openings(others, refined);
    if (!contacts.empty()) add_planes(contacts, refined);
    move_centre(refined);
  }

  /// What is known of a pose about a centre, from what is known about another one.
  static Matrix6d about(const Matrix6d& information, const Vector3d& from, const Vector3d& to) {
    Matrix6d move = Matrix6d::Identity();
    move.bottomLeftCorner<3, 3>() = skew(to - from);
    return move.transpose() * information * move;
  }

  /// Moves `centre` to the point whose place is known best: there turns and shifts hardly depend on each
  /// other, so that a far-off patch of ground does not make a well-held shift look open.
  static void move_centre(RefinedPose& refined) {
    const Matrix6d covariance = covariance_of(refined);
    const Matrix3d turns = covariance.topLeftCorner<3, 3>();
    const Matrix3d mixed = covariance.bottomLeftCorner<3, 3>();  // shifts by turns
    // The mean square of shift + turn x c is least at:
    const Vector3d twist(mixed(1, 2) - mixed(2, 1), mixed(2, 0) - mixed(0, 2), mixed(0, 1) - mixed(1, 0));
    const Matrix3d square = turns.trace() * Matrix3d::Identity() - turns;
    Vector3d c = -solve_symmetric(square, twist);
    if (!c.allFinite()) return;
    if (c.norm() > kMaxCentreM) c *= kMaxCentreM / c.norm();
    const Vector3d centre = refined.centre + c;
    for (Matrix6d* held : {&refined.information, &refined.formal_information, &refined.geometry_m2})
      *held = about(*held, refined.centre, centre);
    refined.centre = centre;
  }

  /// What openings and faces of walls hold, each on its own deviation; more where they disagree among
  /// themselves.
  static void add_openings(const std::vector<Contact>& contacts, RefinedPose& refined) {
    double squares = 0.0;
    for (const Contact& contact : contacts)
      squares += std::pow(std::min(3.0, std::abs(contact.residual_m) / contact.sigma_m), 2);
    const double factor =
        std::max(1.0, squares / std::max<double>(1.0, static_cast<double>(contacts.size()) - 3.0));
    for (const Contact& contact : contacts) {
      const Vector6d row = row_of(contact, refined.centre);
      const Matrix6d information = row * row.transpose() / (contact.sigma_m * contact.sigma_m);
      refined.information += information / factor;
      refined.formal_information += information;
      refined.geometry_m2 += contact.area_m2 * row * row.transpose();
    }
  }

  /// Each piece of surface is met twice, once from either scan.
  static double weight_of(const Contact& contact) { return 0.5 / (contact.sigma_m * contact.sigma_m); }

  [[nodiscard]] PairMap pairs_of(const std::vector<Contact>& contacts, const Vector3d& centre) const {
    PairMap pairs;
    for (const Contact& contact : contacts) {
      PairSums& pair = pairs[{contact.source_plane, contact.target_plane}];
      pair.weight += weight_of(contact);
      pair.middle += weight_of(contact) * contact.at;
    }
    for (auto& [key, pair] : pairs) pair.middle /= pair.weight;
    for (const Contact& contact : contacts) {
      const double weight = weight_of(contact);
      const Vector6d row = row_of(contact, centre);
      PairSums& pair = pairs.at({contact.source_plane, contact.target_plane});
      const Vector3d& normal =
          target_.features->planes[static_cast<std::size_t>(contact.target_plane)].plane.normal;
      const Vector3d across = normal.unitOrthogonal();
      const Vector3d from_middle = contact.at - pair.middle;
      const Vector3d whole(1.0, from_middle.dot(across), from_middle.dot(normal.cross(across)));
      pair.add(row, contact.residual_m, whole, weight);
      pair.area_m2 += 0.5 * contact.area_m2;
      pair.distance += 0.5 * contact.area_m2 * -contact.residual_m;
      ++pair.tiles;
    }
    return pairs;
  }

  /// What the tiles of matched planes hold.
  void add_planes(const std::vector<Contact>& contacts, RefinedPose& refined) const {
    const PairMap pairs = pairs_of(contacts, refined.centre);
    double sum = 0.0;
    double weights = 0.0;
    for (const Contact& contact : contacts) {
      const double weight = weight_of(contact);
      const Vector6d row = row_of(contact, refined.centre);
      refined.geometry_m2 += 0.5 * contact.area_m2 * row * row.transpose();
      sum += weight * contact.residual_m * contact.residual_m;
      weights += weight;
    }
    refined.rms_m = std::sqrt(sum / weights);
    // The residuals themselves say how good the weights were.
    const double factor =
        std::max(sum / std::max(1.0, 0.5 * static_cast<double>(contacts.size()) - 6.0), 1e-6);
    const PlaneErrors errors{pair_offset_m(pairs), pair_slope(pairs, factor)};
    for (const auto& [key, pair] : pairs) {
      refined.formal_information += pair.information / factor;
      refined.information += information_of(pair, errors, factor);
    }
    for (const auto& [key, pair] : pairs) {
      if (pair.tiles < 2) continue;
      refined.matches.push_back(
          {key.first, key.second, pair.distance / pair.area_m2, angle_of(key, refined), pair.area_m2});
    }
    by_overlap(refined.matches);
  }

  /// Between the normals of a pair.
  [[nodiscard]] double angle_of(const std::pair<int, int>& pair, const RefinedPose& refined) const {
    const Vector3d turned = refined.target_from_source.rotation *
                            source_.features->planes[static_cast<std::size_t>(pair.first)].plane.normal;
    const Vector3d& normal = target_.features->planes[static_cast<std::size_t>(pair.second)].plane.normal;
    return std::acos(std::min(1.0, std::abs(turned.dot(normal))));
  }

  static void by_overlap(std::vector<PlaneMatch>& matches) {
    std::stable_sort(matches.begin(), matches.end(),
                     [](const PlaneMatch& a, const PlaneMatch& b) { return a.overlap_m2 > b.overlap_m2; });
  }

  const ScanView& source_;
  const ScanView& target_;
  const RefineOptions& options_;
  ContactFinder contacts_;
};

/// An opening of the target where the source has it, `back` being the pose of the target in the source.
OpeningMatch inverted(const OpeningMatch& match, const Rigid3& back) {
  OpeningMatch turned = match;
  std::swap(turned.source, turned.target);
  // Seen from the two sides of a wall, what is right for one is left for the other.
  const double same_way = match.opposite ? -1.0 : 1.0;
  turned.at = back * match.at;
  turned.across = same_way * (back.rotation * match.across);
  turned.up = back.rotation * match.up;
  turned.shift_across_m = -same_way * match.shift_across_m;
  turned.shift_up_m = -match.shift_up_m;
  turned.gap_m = -same_way * match.gap_m;
  turned.tilt_rad = -same_way * match.tilt_rad;
  return turned;
}

}  // namespace

void RefineOptions::check() const {
  if (!(last_gate_m > 0)) throw_bad_option("last_gate_m", last_gate_m, "more than 0");
  if (!(first_gate_m >= last_gate_m)) throw_bad_option("first_gate_m", first_gate_m, "at least last_gate_m");
  if (rounds < 0) throw_bad_option("rounds", rounds, "0 or more");
}

Matrix6d covariance_of(const RefinedPose& pose) {
  return damped_inverse(pose.information);
}

Matrix6d formal_covariance_of(const RefinedPose& pose) {
  return damped_inverse(pose.formal_information);
}

RefinedPose inverted(const RefinedPose& pose) {
  RefinedPose back = pose;
  back.target_from_source = inverse(pose.target_from_source);
  back.centre = back.target_from_source * pose.centre;
  // A small turn w and shift v of the one about `centre` is -R'w and -R'v of the other about the same point:
  // the adjoint of a pose has no mixed block there, and signs cancel.
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = back.target_from_source.rotation;
  turn.bottomRightCorner<3, 3>() = back.target_from_source.rotation;
  for (Matrix6d* held : about_centre(back)) *held = turn * *held * turn.transpose();
  for (std::vector<PlaneMatch>* matches : {&back.matches, &back.moved}) {
    for (PlaneMatch& match : *matches) {
      std::swap(match.source, match.target);
      match.distance_m = -match.distance_m;  // along the normal that both have
    }
  }
  for (OpeningMatch& match : back.openings) match = inverted(match, back.target_from_source);
  return back;
}

RefinedPose refine_pose(const ScanView& source, const ScanView& target, const Rigid3& start,
                        const RefineOptions& options) {
  options.check();
  return Refiner(source, target, options).run(start);
}

void find_moved(const ScanView& source, const ScanView& target, const RefineOptions& options,
                RefinedPose& pose) {
  options.check();
  Refiner(source, target, options).find_moved(pose);
}

}  // namespace limen
