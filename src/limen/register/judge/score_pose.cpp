// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/score_pose.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/base/progress.h"
#include "limen/match/openings/match_openings.h"
#include "limen/register/judge/weigh_looks.h"
#include "limen/register/prepare/asked_samples.h"
#include "limen/sight/surface_columns.h"

namespace limen {
namespace {

constexpr double kClutterWeight = 0.5;  // clutter moves, and its cubes meet less sharply than planes

/// What is asked of one scan, gathered: the samples that a look asks lie far apart in memory.
struct Gathered {
  SurfaceColumns columns;
  std::vector<std::int32_t> planes;  ///< of each sample, or -1
  std::vector<float> areas_m2;       ///< clutter's weighed
  double factor = 1.0;               ///< surface that each represents, as a multiple of its own
};

/// Of each plane itself, or the first one that is the same plane, continued elsewhere; nothing between scans.
/// In a model walls of storeys above each other and pieces of a façade are one plane: that two of them meet
/// is no coincidence once one does.
std::vector<std::int32_t> same_planes(const ScanView& scan, const ScanView& judge) {
  constexpr double kSameOffsetM = 0.05;
  if (!scan.model && !judge.model) return {};
  const double same_cosine = std::cos(radians(1.0));
  const std::vector<PlanarPolygon>& planes = scan.features->planes;
  std::vector<std::int32_t> first(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    first[i] = static_cast<std::int32_t>(i);
    for (std::size_t j = 0; j < i; ++j) {
      if (first[j] != static_cast<std::int32_t>(j) ||
          std::abs(planes[i].plane.normal.dot(planes[j].plane.normal)) < same_cosine ||
          std::abs(planes[j].plane.signed_distance(planes[i].centroid)) > kSameOffsetM)
        continue;
      first[i] = static_cast<std::int32_t>(j);
      break;
    }
  }
  return first;
}

/// `same`: as same_planes() gives them.
Gathered gathered(const ScanView& scan, AskedSamples asked, const std::vector<std::int32_t>& same) {
  const std::vector<SurfaceSample>& samples = scan.features->samples;
  const auto plane_of = [&](const SurfaceSample& sample) {
    if (sample.plane < 0) return -1;
    return same.empty() ? sample.plane : same[static_cast<std::size_t>(sample.plane)];
  };
  if (!same.empty()) {
    // Plane by plane, clutter last.
    const auto place = [&](std::uint32_t i) { return static_cast<std::uint32_t>(plane_of(samples[i])); };
    std::stable_sort(asked.indices.begin(), asked.indices.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  }
  Gathered all;
  all.factor = asked.factor;
  all.columns.reserve(asked.indices.size());
  all.planes.reserve(asked.indices.size());
  all.areas_m2.reserve(asked.indices.size());
  for (const std::uint32_t i : asked.indices) {
    const SurfaceSample& sample = samples[i];
    const bool planar = sample.plane >= 0;
    all.columns.add(*scan.features, i);
    all.planes.push_back(plane_of(sample));
    all.areas_m2.push_back(planar ? sample.area_m2 : static_cast<float>(kClutterWeight) * sample.area_m2);
  }
  return all;
}

/// Asks `judge` about all of them, in order, batch by batch: `use(begin, size, answers)`.
template <typename Use>
void ask_all(const Gathered& all, const ScanView& judge, const Rigid3& judge_from_scan,
             const ScoreOptions& options, const Use& use) {
  const LookTolerances tolerances{options.surface_m, 1.5 * options.surface_m, options.free_m};
  const std::size_t count = all.planes.size();
  Looks looks;
  Answers answers;
  for (std::size_t begin = 0; begin < count; begin += kLookBatch) {
    const std::size_t size = std::min(kLookBatch, count - begin);
    judge.space->look_at_surface(all.columns, begin, size, judge_from_scan, tolerances, looks);
    weigh_looks(looks, all.areas_m2.data() + begin, all.columns.planar.data() + begin, tolerances, size,
                answers);
    use(begin, size, answers);
  }
}

/// One plane counts for no more than this, m^2, however large: that two large planes meet is one coincidence,
/// not many.
constexpr double kPlaneLimit_m2 = 5.0;

double saturated(double area_m2) {
  if (area_m2 == 0.0) return 0.0;  // of most planes under most poses
  return kPlaneLimit_m2 * (1.0 - std::exp(-area_m2 / kPlaneLimit_m2));
}

/// What a scanner says to one sample after the other: they come plane by plane, clutter last.
struct Tally {
  std::int32_t plane = -1;
  double of_plane = 0.0;
  double planar = 0.0;
  double clutter = 0.0;
  double contradicted = 0.0;
  double evidence_m2 = 0.0;

  void end_plane(double factor) {
    planar += of_plane;
    evidence_m2 += saturated(factor * of_plane);
    of_plane = 0.0;
  }
};

/// By value, so that the sums stay out of memory.
Tally added(Tally tally, const std::int32_t* planes, std::size_t size, const Answers& answers,
            double factor) {
  for (std::size_t k = 0; k < size; ++k) {
    tally.contradicted += static_cast<double>(answers.contradicted_m2[k]);
    if (planes[k] != tally.plane) {
      tally.end_plane(factor);
      tally.plane = planes[k];
    }
    const double gain = static_cast<double>(answers.gain_m2[k]);
    tally.of_plane += tally.plane >= 0 ? gain : 0.0;
    tally.clutter += tally.plane >= 0 ? 0.0 : gain;
  }
  return tally;
}

/// Asks `judge` about what was gathered of a scan.
PoseScore one_way(const Gathered& asked, const ScanView& judge, const Rigid3& judge_from_scan,
                  const ScoreOptions& options) {
  CancelScope::check();
  const double factor = asked.factor;
  Tally tally;
  ask_all(asked, judge, judge_from_scan, options,
          [&](std::size_t begin, std::size_t size, const Answers& answers) {
            tally = added(tally, asked.planes.data() + begin, size, answers, factor);
          });
  tally.end_plane(factor);
  PoseScore score;
  score.evidence_m2 = tally.evidence_m2 + factor * tally.clutter;
  score.agreeing_m2 = factor * (tally.planar + tally.clutter);
  score.contradicted_m2 = factor * tally.contradicted;
  return score;
}

/// The area of a source opening that meets one of the target, clipped as surface is.
struct OpeningGain {
  double m2 = 0.0;
  double unsure_m2 = 0.0;  ///< more, by two deviations of its place
};

/// Of each source opening.
std::vector<OpeningGain> opening_gains(const OpeningMatching& openings, std::size_t sources,
                                       const Rigid3& pose, const ScoreOptions& options) {
  std::vector<OpeningGain> gains(sources);
  if (!options.openings) return gains;
  for (const OpeningMatch& match : openings.under(pose, options.opening_m)) {
    const double area_m2 = match.trust * match.area_m2;
    const double off = std::hypot(match.shift_across_m, match.shift_up_m) / options.opening_m;
    const auto beyond = [](double shift_m, double sigma_m) {
      return std::max(0.0, std::abs(shift_m) - 2.0 * sigma_m);
    };
    const double surely = std::hypot(beyond(match.shift_across_m, match.sigma_across_m),
                                     beyond(match.shift_up_m, match.sigma_up_m)) /
                          options.opening_m;
    gains[static_cast<std::size_t>(match.source)] = {area_m2 * (1.0 - off * off),
                                                     area_m2 * (off * off - surely * surely)};
  }
  return gains;
}

void add_lead(double lead, PoseContrast& contrast) {
  (lead > 0 ? contrast.for_first_m2 : contrast.for_second_m2) += std::abs(lead);
}

void add_contradiction(double of_second_m2, PoseContrast& contrast) {
  (of_second_m2 > 0 ? contrast.against_second_m2 : contrast.against_first_m2) += std::abs(of_second_m2);
}

/// What one scan says of the other under one pose, to be set against what it says under others.
class WayContrast {
 public:
  WayContrast(const ScanView& scan, const ScanView& judge, const Rigid3& judge_from_scan,
              const ScoreOptions& options)
      : scan_(scan),
        judge_(judge),
        first_(judge_from_scan),
        options_(options),
        same_(same_planes(scan, judge)) {
    // Of a model only what comes within the scan's reach is asked, which both poses decide.
    if (judge.space != nullptr && !scan.model)
      known_ = ask_first(asked_samples(scan, judge, first_, options.samples));
  }

  void add(const Rigid3& second, PoseContrast& contrast) const {
    CancelScope::check();
    if (judge_.space == nullptr) return;
    if (scan_.model)
      add(ask_first(near_either(second)), second, contrast);
    else
      add(known_, second, contrast);
  }

 private:
  struct Stated {
    Gathered asked;
    std::vector<float> gains;
    std::vector<float> contradictions;
  };

  [[nodiscard]] AskedSamples near_either(const Rigid3& second) const {
    AskedSamples asked = asked_samples(scan_, judge_, first_, options_.samples);
    const AskedSamples more = asked_samples(scan_, judge_, second, options_.samples);
    std::vector<std::uint32_t> both;
    std::set_union(asked.indices.begin(), asked.indices.end(), more.indices.begin(), more.indices.end(),
                   std::back_inserter(both));
    asked.indices = std::move(both);
    return asked;
  }

  [[nodiscard]] Stated ask_first(const AskedSamples& samples) const {
    Stated stated{gathered(scan_, samples, same_), {}, {}};
    stated.gains.resize(stated.asked.planes.size());
    stated.contradictions.resize(stated.asked.planes.size());
    ask_all(stated.asked, judge_, first_, options_,
            [&](std::size_t begin, std::size_t size, const Answers& answers) {
              const auto at = static_cast<std::ptrdiff_t>(begin);
              std::copy_n(answers.gain_m2.begin(), size, stated.gains.begin() + at);
              std::copy_n(answers.contradicted_m2.begin(), size, stated.contradictions.begin() + at);
            });
    return stated;
  }

  void add(const Stated& stated, const Rigid3& second, PoseContrast& contrast) const {
    // Both ways are averaged, as in the score.
    const double share = 0.5 * stated.asked.factor;
    std::vector<PoseContrast> planes(scan_.features->planes.size());
    ask_all(stated.asked, judge_, second, options_,
            [&](std::size_t begin, std::size_t size, const Answers& answers) {
              for (std::size_t k = 0; k < size; ++k) {
                const std::int32_t plane = stated.asked.planes[begin + k];
                const float agreeing = stated.gains[begin + k] - answers.gain_m2[k];
                const float contradicted = answers.contradicted_m2[k] - stated.contradictions[begin + k];
                add_lead(share * static_cast<double>(agreeing),
                         plane >= 0 ? planes[static_cast<std::size_t>(plane)] : contrast);
                add_contradiction(share * static_cast<double>(contradicted), contrast);
              }
            });
    for (const PoseContrast& plane : planes) {
      contrast.for_first_m2 += saturated(plane.for_first_m2);
      contrast.for_second_m2 += saturated(plane.for_second_m2);
    }
  }

  ScanView scan_;
  ScanView judge_;
  Rigid3 first_;
  ScoreOptions options_;
  std::vector<std::int32_t> same_;
  Stated known_;
};

}  // namespace

struct PoseScorer::Asked {
  Gathered source;
  Gathered target;
  std::vector<std::int32_t> same_in_source;
  std::vector<std::int32_t> same_in_target;
  OpeningMatching openings;
};

PoseScorer::PoseScorer(const ScanView& source, const ScanView& target, const ScoreOptions& options)
    : source_(source),
      target_(target),
      options_(options),
      asked_(new Asked{{}, {}, {}, {}, {*source.features, *target.features}}) {
  // Of a model only what comes within the scan's reach is asked, which the pose decides.
  asked_->same_in_source = same_planes(source, target);
  asked_->same_in_target = same_planes(target, source);
  if (!source.model)
    asked_->source =
        gathered(source, asked_samples(source, target, {}, options.samples), asked_->same_in_source);
  if (!target.model)
    asked_->target =
        gathered(target, asked_samples(target, source, {}, options.samples), asked_->same_in_target);
}

PoseScorer::~PoseScorer() = default;

PoseScore PoseScorer::operator()(const Rigid3& target_from_source) const {
  const auto scored = [&](const ScanView& scan, const ScanView& judge, const Gathered& fixed,
                          const Rigid3& judge_from_scan) {
    if (judge.space == nullptr || (scan.model && !options_.ask_model)) return PoseScore{};
    if (!scan.model) return one_way(fixed, judge, judge_from_scan, options_);
    const AskedSamples asked = asked_samples(scan, judge, judge_from_scan, options_.samples);
    const auto& same = &scan == &source_ ? asked_->same_in_source : asked_->same_in_target;
    return one_way(gathered(scan, asked, same), judge, judge_from_scan, options_);
  };
  const PoseScore forth = scored(source_, target_, asked_->source, target_from_source);
  const PoseScore back = scored(target_, source_, asked_->target, inverse(target_from_source));
  PoseScore both;
  both.agreeing_m2 = 0.5 * (forth.agreeing_m2 + back.agreeing_m2);
  both.contradicted_m2 = 0.5 * (forth.contradicted_m2 + back.contradicted_m2);
  for (const OpeningGain& gain :
       opening_gains(asked_->openings, source_.features->openings.size(), target_from_source, options_)) {
    both.opening_m2 += gain.m2;
    both.unsure_opening_m2 += gain.unsure_m2;
  }
  both.agreeing_m2 += both.opening_m2;
  both.evidence_m2 = 0.5 * (forth.evidence_m2 + back.evidence_m2) + both.opening_m2;
  return both;
}

double nats_of_contradiction(double agreeing_m2, double contradicted_m2,
                             const evidence_table::Contradiction& table) {
  const double contradicted = contradicted_m2 / table.piece_m2;
  const double agreeing = agreeing_m2 / table.piece_m2;
  return log_beta_binomial(contradicted, agreeing, table.right) -
         log_beta_binomial(contradicted, agreeing, table.wrong);
}

PoseScore score_pose(const ScanView& source, const ScanView& target, const Rigid3& target_from_source,
                     const ScoreOptions& options) {
  return PoseScorer(source, target, options)(target_from_source);
}

struct PoseContrasts::Asked {
  WayContrast forth;
  WayContrast back;
  OpeningMatching openings;
  std::size_t source_openings;
  std::vector<OpeningGain> in_first;
};

PoseContrasts::PoseContrasts(const ScanView& source, const ScanView& target, const Rigid3& first,
                             const ScoreOptions& options)
    : options_(options),
      asked_(new Asked{{source, target, first, options},
                       {target, source, inverse(first), options},
                       {*source.features, *target.features},
                       source.features->openings.size(),
                       {}}) {
  asked_->in_first = opening_gains(asked_->openings, asked_->source_openings, first, options);
}

PoseContrasts::~PoseContrasts() = default;

PoseContrast PoseContrasts::operator()(const Rigid3& second) const {
  PoseContrast contrast;
  asked_->forth.add(second, contrast);
  asked_->back.add(inverse(second), contrast);
  const std::vector<OpeningGain> in_second =
      opening_gains(asked_->openings, asked_->source_openings, second, options_);
  for (std::size_t i = 0; i < in_second.size(); ++i)
    add_lead(asked_->in_first[i].m2 - in_second[i].m2, contrast);
  return contrast;
}

}  // namespace limen
