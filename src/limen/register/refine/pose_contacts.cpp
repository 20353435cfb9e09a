// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/pose_contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/register/prepare/asked_samples.h"
#include "limen/sight/surface_columns.h"

namespace limen {
namespace {

constexpr double kLeastRevealSigmaM = 0.01;
constexpr double kHoldingShare = 0.15;   // of an opening's area: the surface its edges are worth as a hold
constexpr double kAnglePerGate = 2.0;    // rad/m: how far the normals of one surface may differ
constexpr double kLeastAngleRad = 0.07;  // the normals of small planes are not better than this
constexpr double kMostAngleRad = 0.3;
constexpr double kTurnGateRad = 0.15;

// Openings above one another in one wall.
constexpr double kOneWallCosine = 0.99;
constexpr double kOneWallM = 0.3;
constexpr double kOneColumnM = 0.15;
constexpr double kFlatnessM = 0.001;       // real walls are not flatter than this: least deviation of a tile
constexpr double kParallelRad = 0.003;     // by how much the two faces of a wall may not be parallel, 1 sigma
constexpr double kThicknessSigmaM = 0.01;  // of a wall's thickness as the user knows it

/// The planar samples that one scan is asked about, gathered.
struct AskedSurface {
  std::vector<std::uint32_t> indices;
  SurfaceColumns columns;
  double factor = 1.0;  ///< surface that each represents, as a multiple of its own
};

AskedSurface asked_surface(const ScanView& scan, const ScanView& judge, const Rigid3& judge_from_scan,
                           std::size_t most) {
  const std::vector<SurfaceSample>& samples = scan.features->samples;
  AskedSamples all = asked_samples(scan, judge, judge_from_scan, most);
  AskedSurface asked;
  asked.factor = all.factor;
  asked.indices = std::move(all.indices);
  // Clutter follows the planes.
  const auto clutter = std::find_if(asked.indices.begin(), asked.indices.end(),
                                    [&](std::uint32_t i) { return samples[i].plane < 0; });
  asked.indices.erase(clutter, asked.indices.end());
  asked.columns.reserve(asked.indices.size());
  for (const std::uint32_t i : asked.indices) asked.columns.add(*scan.features, i);
  return asked;
}

}  // namespace

class ContactFinder::Collector {
 public:
  Collector(const ScanView& source, const ScanView& target, const RefineOptions& options)
      : source_(source), target_(target), options_(options), openings_(*source.features, *target.features) {
    if (!options.planes) return;
    // Of a model only what comes within the scan's reach is asked, which the pose decides.
    if (!source.model) of_source_ = asked_surface(source, target, {}, options.samples);
    if (!target.model) of_target_ = asked_surface(target, source, {}, options.samples);
  }

  [[nodiscard]] Contacts run(const Rigid3& pose, const ContactGates& gates) const {
    Contacts contacts;
    if (options_.planes) {
      collect(source_, target_, of_source_, pose, gates.plane_m, true, pose, contacts.all);
      collect(target_, source_, of_target_, inverse(pose), gates.plane_m, false, pose, contacts.all);
    }
    if (!options_.openings) return contacts;
    contacts.openings = openings_.under(pose, gates.opening_m);
    for (std::size_t k = 0; k < contacts.openings.size(); ++k)
      add_opening(k, pose, gates.opening_m, contacts);
    return contacts;
  }

 private:
  [[nodiscard]] double sigma_of(const SurfaceSample& sample, double noise_m) const {
    return std::sqrt(noise_m * noise_m / static_cast<double>(sample.count) + kFlatnessM * kFlatnessM);
  }

  void collect(const ScanView& scan, const ScanView& judge, const AskedSurface& fixed,
               const Rigid3& judge_from_scan, double gate, bool forth, const Rigid3& target_from_source,
               std::vector<Contact>& contacts) const {
    if (judge.space == nullptr) return;
    if (!scan.model)
      return collect_of(fixed, scan, judge, judge_from_scan, gate, forth, target_from_source, contacts);
    collect_of(asked_surface(scan, judge, judge_from_scan, options_.samples), scan, judge, judge_from_scan,
               gate, forth, target_from_source, contacts);
  }

  void collect_of(const AskedSurface& asked, const ScanView& scan, const ScanView& judge,
                  const Rigid3& judge_from_scan, double gate, bool forth, const Rigid3& target_from_source,
                  std::vector<Contact>& contacts) const {
    const double noise = std::max(scan.features->noise_m, 0.0005);
    // The nearer the planes, the better their normals have to agree.
    const double least_cosine = std::cos(std::clamp(kAnglePerGate * gate, kLeastAngleRad, kMostAngleRad));
    const LookTolerances tolerances{gate, gate, 1e9};
    Looks looks;
    for (std::size_t begin = 0; begin < asked.indices.size(); begin += kLookBatch) {
      const std::size_t size = std::min(kLookBatch, asked.indices.size() - begin);
      judge.space->look_at_surface(asked.columns, begin, size, judge_from_scan, tolerances, looks);
      for (std::size_t k = 0; k < size; ++k) {
        if (looks.kind[k] != static_cast<std::int32_t>(SightKind::surface) || looks.plane[k] < 0) continue;
        const SurfaceSample& sample = scan.features->samples[asked.indices[begin + k]];
        const Plane& plane = judge.features->planes[static_cast<std::size_t>(looks.plane[k])].plane;
        if (std::abs((judge_from_scan.rotation * sample.normal).dot(plane.normal)) < least_cosine) continue;
        const Vector3d at = judge_from_scan * sample.mean;
        Contact contact;
        contact.sigma_m = sigma_of(sample, noise);
        contact.gate_m = gate;
        contact.area_m2 = static_cast<double>(sample.area_m2) * asked.factor;
        contact.at = forth ? at : sample.mean;
        contact.normal = forth ? plane.normal : target_from_source.rotation * plane.normal;
        contact.residual_m = (forth ? -1.0 : 1.0) * plane.signed_distance(at);
        contact.source_plane = forth ? sample.plane : looks.plane[k];
        contact.target_plane = forth ? looks.plane[k] : sample.plane;
        contacts.push_back(contact);
      }
    }
  }

  /// How many matches lie above one another in one wall, this one counted. A scanner sweeps upright: the same
  /// of its columns met the sides of all of them, and what lies between two columns errs for all alike.
  static double stacked_with(const OpeningMatch& match, const std::vector<OpeningMatch>& matches) {
    return static_cast<double>(std::count_if(matches.begin(), matches.end(), [&](const OpeningMatch& other) {
      const Vector3d apart = other.at - match.at;
      return other.opposite == match.opposite && std::abs(other.across.dot(match.across)) > kOneWallCosine &&
             std::abs(apart.dot(match.across)) < kOneColumnM &&
             std::abs(apart.dot(match.across.cross(match.up))) < kOneWallM;
    }));
  }

  /// What matched openings say: shifts within the wall, turns by the parallel faces, the gap between them.
  void add_opening(std::size_t k, const Rigid3& pose, double gate, Contacts& contacts) const {
    const OpeningMatch& match = contacts.openings[k];
    const double spread = 1.0 / match.trust;
    Contact contact;
    contact.opening = static_cast<int>(k);
    contact.at = match.at;
    contact.area_m2 = kHoldingShare * match.trust * match.area_m2;
    contact.gate_m = gate;
    if (match.sigma_across_m < 0.5) {
      contact.normal = match.across;
      contact.residual_m = match.shift_across_m;
      contact.sigma_m = spread * match.sigma_across_m * std::sqrt(stacked_with(match, contacts.openings));
      contacts.all.push_back(contact);
    }
    if (match.sigma_up_m < 0.5) {
      contact.normal = match.up;
      contact.residual_m = match.shift_up_m;
      contact.sigma_m = spread * match.sigma_up_m;
      contacts.all.push_back(contact);
    }
    add_faces(match, pose, contact, contacts.all);
  }

  /// The two faces of the wall of a matched opening.
  void add_faces(const OpeningMatch& match, const Rigid3& pose, Contact contact,
                 std::vector<Contact>& contacts) const {
    const Vector3d normal = match.across.cross(match.up);
    const Opening& source = source_.features->openings[static_cast<std::size_t>(match.source)];
    const Opening& target = target_.features->openings[static_cast<std::size_t>(match.target)];
    if (source.facade < 0 || target.facade < 0) return;
    const double sign = match.opposite ? -1.0 : 1.0;
    const Vector3d turned =
        sign * pose.rotation * source_.features->planes[static_cast<std::size_t>(source.facade)].plane.normal;
    const Vector3d turn =
        turned.cross(target_.features->planes[static_cast<std::size_t>(target.facade)].plane.normal);
    contact.turn = true;
    contact.gate_m = kTurnGateRad;
    contact.sigma_m = kParallelRad;
    for (const Vector3d& axis : {match.across, match.up}) {
      contact.normal = axis;
      contact.residual_m = turn.dot(axis);
      contacts.push_back(contact);
    }
    // Openings stand upright, in either scan.
    contact.normal = normal;
    contact.residual_m = match.tilt_rad;
    contacts.push_back(contact);
    const Thickness thickness = thickness_of(source, target, match);
    if (thickness.sigma_m <= 0.0) return;
    contact.turn = false;
    contact.normal = normal;
    contact.residual_m = match.gap_m - thickness.value_m;
    contact.sigma_m = thickness.sigma_m;
    contact.gate_m = 0.25;
    contacts.push_back(contact);
  }

  struct Thickness {
    double value_m = 0.0;
    double sigma_m = 0.0;  // 0: not known
  };

  /// What is known of a wall's thickness before the pose: nothing between rectangles of one face but that the
  /// face is one.
  [[nodiscard]] Thickness thickness_of(const Opening& source, const Opening& target,
                                       const OpeningMatch& match) const {
    if (!match.opposite) return {0.0, 0.005};
    Thickness best;
    if (options_.wall_thickness_m > 0.0) best = {options_.wall_thickness_m, kThicknessSigmaM};
    for (const Opening* opening : {&source, &target}) {
      if (!opening->reveal_complete || !(opening->reveal_depth_m > 0.0)) continue;
      const double sigma = std::max(opening->reveal_sigma_m, kLeastRevealSigmaM);
      if (best.sigma_m <= 0.0 || sigma < best.sigma_m) best = {opening->reveal_depth_m, sigma};
    }
    return best;
  }

  const ScanView& source_;
  const ScanView& target_;
  const RefineOptions& options_;
  OpeningMatching openings_;
  AskedSurface of_source_;
  AskedSurface of_target_;
};

ContactFinder::ContactFinder(const ScanView& source, const ScanView& target, const RefineOptions& options)
    : collector_(std::make_unique<Collector>(source, target, options)) {}

ContactFinder::~ContactFinder() = default;

Contacts ContactFinder::near(const Rigid3& target_from_source, const ContactGates& gates) const {
  return collector_->run(target_from_source, gates);
}

}  // namespace limen
