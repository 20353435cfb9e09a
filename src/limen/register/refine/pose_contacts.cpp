// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/pose_contacts.h"

#include <algorithm>
#include <cmath>

#include "limen/register/prepare/asked_samples.h"
#include "limen/sight/ask_in_batches.h"

namespace limen {
namespace {

constexpr double kLeastRevealSigmaM = 0.01;
constexpr double kHoldingShare = 0.15;   // of an opening's area: the surface its edges are worth as a hold
constexpr double kAnglePerGate = 2.0;    // rad/m: how far the normals of one surface may differ
constexpr double kLeastAngleRad = 0.07;  // the normals of small planes are not better than this
constexpr double kMostAngleRad = 0.3;
constexpr double kTurnGateRad = 0.15;

class Collector {
 public:
  Collector(const ScanView& source, const ScanView& target, const RefineOptions& options)
      : source_(source), target_(target), options_(options) {}

  [[nodiscard]] Contacts run(const Rigid3& pose, const ContactGates& gates) const {
    Contacts contacts;
    if (options_.planes) {
      collect(source_, target_, pose, gates.plane_m, true, pose, contacts.all);
      collect(target_, source_, inverse(pose), gates.plane_m, false, pose, contacts.all);
    }
    if (!options_.openings) return contacts;
    OpeningMatchOptions matching;
    matching.gate_m = gates.opening_m;
    contacts.openings = match_openings(*source_.features, *target_.features, pose, matching);
    for (const OpeningMatch& match : contacts.openings)
      add_opening(match, pose, gates.opening_m, contacts.all);
    return contacts;
  }

 private:
  [[nodiscard]] double sigma_of(const SurfaceSample& sample, double noise_m) const {
    return std::sqrt(noise_m * noise_m / static_cast<double>(sample.count) +
                     options_.flatness_m * options_.flatness_m);
  }

  void collect(const ScanView& scan, const ScanView& judge, const Rigid3& judge_from_scan, double gate,
               bool forth, const Rigid3& target_from_source, std::vector<Contact>& contacts) const {
    if (judge.space == nullptr) return;
    const double noise = std::max(scan.features->noise_m, 0.0005);
    // The nearer the planes, the better their normals have to agree.
    const double least_cosine = std::cos(std::clamp(kAnglePerGate * gate, kLeastAngleRad, kMostAngleRad));
    const std::vector<SurfaceSample>& samples = scan.features->samples;
    const AskedSamples asked = asked_samples(scan, judge, judge_from_scan, options_.samples);
    const auto clutter = std::find_if(asked.indices.begin(), asked.indices.end(),
                                      [&](std::uint32_t i) { return samples[i].plane < 0; });
    const auto question = [&](std::size_t k) {
      const SurfaceSample& sample = samples[asked.indices[k]];
      SightQuery query;
      query.surface_m = gate;
      query.free_m = 1e9;
      query.at = judge_from_scan * sample.mean;
      query.normal = judge_from_scan.rotation * sample.normal;
      query.oriented = scan.features->planes[static_cast<std::size_t>(sample.plane)].oriented;
      return query;
    };
    const auto use = [&](std::size_t k, const SightQuery& query, const Sight& sight) {
      const SurfaceSample& sample = samples[asked.indices[k]];
      if (sight.kind != SightKind::surface || sight.plane < 0) return;
      const PlanarPolygon& plane = judge.features->planes[static_cast<std::size_t>(sight.plane)];
      if (std::abs(query.normal.dot(plane.plane.normal)) < least_cosine) return;
      Contact contact;
      contact.sigma_m = sigma_of(sample, noise);
      contact.gate_m = gate;
      contact.area_m2 = static_cast<double>(sample.area_m2) * asked.factor;
      if (forth) {
        contact.at = query.at;
        contact.normal = plane.plane.normal;
        contact.residual_m = -sight.distance_m;
        contact.source_plane = sample.plane;
        contact.target_plane = sight.plane;
      } else {
        contact.at = sample.mean;
        contact.normal = target_from_source.rotation * plane.plane.normal;
        contact.residual_m = sight.distance_m;
        contact.source_plane = sight.plane;
        contact.target_plane = sample.plane;
      }
      contacts.push_back(contact);
    };
    // Clutter follows the planes.
    ask_in_batches(*judge.space, static_cast<std::size_t>(clutter - asked.indices.begin()), question, use);
  }

  /// What matched openings say: shifts within the wall, turns by the parallel faces, the gap between them.
  void add_opening(const OpeningMatch& match, const Rigid3& pose, double gate,
                   std::vector<Contact>& contacts) const {
    const double spread = 1.0 / match.trust;
    Contact contact;
    contact.at = match.at;
    contact.area_m2 = kHoldingShare * match.trust * match.area_m2;
    contact.gate_m = gate;
    if (match.sigma_across_m < 0.5) {
      contact.normal = match.across;
      contact.residual_m = match.shift_across_m;
      contact.sigma_m = spread * match.sigma_across_m;
      contacts.push_back(contact);
    }
    if (match.sigma_up_m < 0.5) {
      contact.normal = match.up;
      contact.residual_m = match.shift_up_m;
      contact.sigma_m = spread * match.sigma_up_m;
      contacts.push_back(contact);
    }
    add_faces(match, pose, contacts);
  }

  /// The two faces of the wall of a matched opening.
  void add_faces(const OpeningMatch& match, const Rigid3& pose, std::vector<Contact>& contacts) const {
    const Vector3d normal = match.across.cross(match.up);
    const Opening& source = source_.features->openings[static_cast<std::size_t>(match.source)];
    const Opening& target = target_.features->openings[static_cast<std::size_t>(match.target)];
    if (source.facade < 0 || target.facade < 0) return;
    const double sign = match.opposite ? -1.0 : 1.0;
    const Vector3d turned =
        sign * pose.rotation * source_.features->planes[static_cast<std::size_t>(source.facade)].plane.normal;
    const Vector3d turn =
        turned.cross(target_.features->planes[static_cast<std::size_t>(target.facade)].plane.normal);
    Contact contact;
    contact.at = match.at;
    contact.turn = true;
    contact.gate_m = kTurnGateRad;
    contact.sigma_m = options_.parallel_rad;
    contact.area_m2 = kHoldingShare * match.trust * match.area_m2;
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
    if (options_.wall_thickness_m > 0.0) best = {options_.wall_thickness_m, options_.wall_thickness_sigma_m};
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
};

}  // namespace

Contacts find_contacts(const ScanView& source, const ScanView& target, const Rigid3& target_from_source,
                       const ContactGates& gates, const RefineOptions& options) {
  return Collector(source, target, options).run(target_from_source, gates);
}

}  // namespace limen
