// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <vector>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"

// M-estimator sample consensus (Torr and Zisserman 2000; 2021, section 2.2) as estimator x score x sampler:
// the estimator makes a model from a few items and tells how far each item is from a model, the score sums
// what the items say, the sampler chooses the few. Nothing here knows what an item is.
//
// Departure from 2021: equations 1 and 2 are costs while the text takes the highest; the score here is the
// unitless one of 2022, equation 2, higher is better.

namespace limen {

/// What fits models to items 0 .. size() - 1. `estimate` gives nothing for a degenerate sample. An item may
/// stand for several: `weight(item)`, if there is one, says for how many.
template <typename Type>
concept Estimator = requires(const Type& type, const typename Type::Model& model, std::uint32_t item,
                             const std::array<std::uint32_t, Type::kSampleSize>& sample) {
  { type.size() } -> std::convertible_to<std::size_t>;
  { type.estimate(sample) } -> std::same_as<std::optional<typename Type::Model>>;
  { type.residual(model, item) } -> std::convertible_to<double>;
};

template <typename Type>
double weight_of(const Type& estimator, std::uint32_t item) {
  if constexpr (requires { estimator.weight(item); }) {
    return estimator.weight(item);
  } else {
    return 1.0;
  }
}

/// The score of 2022, equation 2: an item at distance e adds max(0, 1 - e^2 / t^2), times its weight.
struct MsacScore {
  double threshold = 1.0;  ///< t > 0, in the unit of the residuals

  [[nodiscard]] double of(double residual) const {
    const double ratio = residual / threshold;
    return std::max(0.0, 1.0 - ratio * ratio);
  }
};

/// Every `stride`-th item's score of `model`, summed in the items' order. Stops as soon as what is left
/// cannot lift the sum above `to_beat`: the sum is then below the true one, but so is the true one below
/// `to_beat`. `all_weight`: the weights of these items together.
template <Estimator Type>
double score_of(const Type& estimator, const typename Type::Model& model, const MsacScore& score,
                double all_weight, double to_beat = -1.0, std::size_t stride = 1) {
  constexpr std::size_t kBlock = 512;
  double sum = 0.0;
  double left = all_weight;
  std::size_t in_block = 0;
  for (std::size_t i = 0; i < estimator.size(); i += stride) {
    const auto item = static_cast<std::uint32_t>(i);
    const double weight = weight_of(estimator, item);
    sum += weight * score.of(estimator.residual(model, item));
    left -= weight;
    if (++in_block < kBlock) continue;
    in_block = 0;
    if (sum + left < to_beat) return sum;
  }
  return sum;
}

/// Draws all items of a sample from the whole, each at most once where there are enough.
class UniformSampler {
 public:
  UniformSampler(std::size_t size, std::uint64_t seed) : size_(size), seed_(seed) {}

  /// The sample of one trial: always the same for the same trial.
  template <std::size_t kCount>
  [[nodiscard]] std::array<std::uint32_t, kCount> sample(std::uint64_t trial) const {
    RandomStream random(seed_, trial);
    std::array<std::uint32_t, kCount> chosen{};
    for (std::size_t k = 0; k < kCount; ++k) {
      const auto end = chosen.begin() + static_cast<std::ptrdiff_t>(k);
      do {
        chosen[k] = random.below(static_cast<std::uint32_t>(size_));
      } while (size_ > k && std::find(chosen.begin(), end, chosen[k]) != end);
    }
    return chosen;
  }

 private:
  std::size_t size_;
  std::uint64_t seed_;
};

/// Trials after which one sample without outliers was drawn with probability `confidence` (in (0, 1)), where
/// a share `inlier_ratio` of the items are inliers: log(1 - confidence) / log(1 - inlier_ratio^sample_size),
/// rounded up (Fischler and Bolles 1981). At least 1, at most `most`, which is also the answer for ratio 0.
inline std::size_t trial_count(double inlier_ratio, std::size_t sample_size, double confidence,
                               std::size_t most) {
  if (!(confidence > 0.0 && confidence < 1.0)) throw_bad_option("confidence", confidence, "in (0, 1)");
  const double good = std::pow(std::clamp(inlier_ratio, 0.0, 1.0), static_cast<double>(sample_size));
  if (good >= 1.0) return 1;
  // log1p keeps what 1 - good would lose for a ratio of a thousandth.
  const double trials = std::ceil(std::log1p(-confidence) / std::log1p(-good));
  if (!(trials < static_cast<double>(most))) return std::max<std::size_t>(1, most);
  return std::max<std::size_t>(1, static_cast<std::size_t>(trials));
}

struct MsacOptions {
  double threshold = 1.0;          ///< of the residuals, > 0
  double confidence = 0.99;        ///< of having drawn one good sample, in (0, 1)
  std::size_t most_trials = 1000;  ///< >= 1
  std::size_t judges = 0;          ///< items, evenly chosen, that score a model; 0: all of them

  void check() const {
    if (!(threshold > 0.0)) throw_bad_option("threshold", threshold, "more than 0");
    if (!(confidence > 0.0 && confidence < 1.0)) throw_bad_option("confidence", confidence, "in (0, 1)");
    if (most_trials < 1) throw_bad_option("most_trials", static_cast<double>(most_trials), "1 or more");
  }
};

template <typename Model>
struct MsacResult {
  std::optional<Model> model;  ///< none: every sample was degenerate
  double score = 0.0;          ///< of the judges, at most their weight
  double judged = 0.0;         ///< the judges' weight
  std::size_t trials = 0;
};

/// The model with the highest score among random samples. Trials go in rounds of a fixed size, so that
/// neither the answer nor the number of trials depends on the threads; after each round the number still
/// needed follows from the best score, which is below the inlier ratio and so errs on the safe side.
template <Estimator Type, typename Sampler>
MsacResult<typename Type::Model> msac(const Type& estimator, const Sampler& sampler,
                                      const MsacOptions& options) {
  using Model = typename Type::Model;
  constexpr std::size_t kRound = 32;
  options.check();
  MsacResult<Model> best;
  if (estimator.size() < Type::kSampleSize) return best;
  const MsacScore score{options.threshold};
  const std::size_t stride =
      options.judges == 0 ? 1 : std::max<std::size_t>(1, estimator.size() / options.judges);
  for (std::size_t i = 0; i < estimator.size(); i += stride)
    best.judged += weight_of(estimator, static_cast<std::uint32_t>(i));

  struct Trial {
    std::optional<Model> model;
    double score = 0.0;
  };
  std::size_t needed = options.most_trials;
  while (best.trials < needed) {
    std::vector<Trial> round(std::min(kRound, options.most_trials - best.trials));
    parallel_for(round.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const auto sample = sampler.template sample<Type::kSampleSize>(best.trials + k);
        round[k].model = estimator.estimate(sample);
        if (!round[k].model) continue;
        round[k].score = score_of(estimator, *round[k].model, score, best.judged, best.score, stride);
      }
    });
    for (const Trial& trial : round) {
      if (!trial.model || (best.model && trial.score <= best.score)) continue;
      best.model = trial.model;
      best.score = trial.score;
    }
    best.trials += round.size();
    needed =
        trial_count(best.score / best.judged, Type::kSampleSize, options.confidence, options.most_trials);
  }
  return best;
}

}  // namespace limen
