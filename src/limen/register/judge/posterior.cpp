// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "limen/base/error.h"

namespace limen {

void PosteriorOptions::check() const {
  if (!(nats_per_m2 > 0)) throw_bad_option("nats_per_m2", nats_per_m2, "more than 0");
  if (!(nats_per_m2_through_wall > 0))
    throw_bad_option("nats_per_m2_through_wall", nats_per_m2_through_wall, "more than 0");
  if (!(search_nats >= 0)) throw_bad_option("search_nats", search_nats, "0 or more");
  if (!(search_nats_through_wall >= 0))
    throw_bad_option("search_nats_through_wall", search_nats_through_wall, "0 or more");
  if (!(prior_shared > 0 && prior_shared < 1))
    throw_bad_option("prior_shared", prior_shared, "within (0, 1)");
  if (!(unlisted >= 0 && unlisted < 1)) throw_bad_option("unlisted", unlisted, "within [0, 1)");
}

double chance_of(const PosteriorEvidence& evidence, const PosteriorOptions& options) {
  if (evidence.log_odds_of_model) return std::exp(-*evidence.log_odds_of_model);
  const double nats_per_m2 = evidence.through_wall ? options.nats_per_m2_through_wall : options.nats_per_m2;
  const double search_nats = evidence.through_wall ? options.search_nats_through_wall : options.search_nats;
  return std::exp(search_nats - evidence.things_nats -
                  nats_per_m2 * (evidence.best_value_m2 - evidence.things_m2));
}

namespace {

constexpr double kClearLeadM2 = 4.0;  // by so much what tells two poses apart settles which one leads

/// Chance against the best pose. Where what tells two poses apart speaks for another one chance is asked of
/// that one, as far as it leads: what the best has more of does not count.
double chance_of_leader(const PosteriorEvidence& evidence, const PosteriorOptions& options) {
  const double of_best = chance_of(evidence, options);
  if (evidence.log_odds_of_model) return of_best;
  const double nats_per_m2 = evidence.through_wall ? options.nats_per_m2_through_wall : options.nats_per_m2;
  const double search_nats = evidence.through_wall ? options.search_nats_through_wall : options.search_nats;
  double most = of_best;
  for (std::size_t k = 0; k < std::min(evidence.leads_m2.size(), evidence.values_m2.size()); ++k) {
    const double lead_m2 = -evidence.leads_m2[k];
    if (lead_m2 <= 0.0) continue;
    const double share = std::min(1.0, lead_m2 / kClearLeadM2);
    const double nats = (1.0 - share) * std::log(of_best) +
                        share * (search_nats - nats_per_m2 * evidence.values_m2[k]) + nats_per_m2 * lead_m2;
    most = std::max(most, std::exp(nats));
  }
  return most;
}

}  // namespace

Posterior posterior(const PosteriorEvidence& evidence, const PosteriorOptions& options) {
  options.check();
  // Weights against the best pose, whose likelihood is 1; the best wrong pose is as likely as the right one
  // where its value is what a search reaches by chance.
  const double nats_per_m2 = evidence.through_wall ? options.nats_per_m2_through_wall : options.nats_per_m2;
  const double chance = chance_of_leader(evidence, options);
  Posterior posterior;
  double total = 0.0;
  const auto add_pose = [&](double lead_m2) {
    const std::size_t k = posterior.poses.size();
    const double log_prior = k < evidence.log_priors.size() ? evidence.log_priors[k] : 0.0;
    const double weight =
        options.prior_shared * (1.0 - options.unlisted) * std::exp(log_prior - nats_per_m2 * lead_m2);
    posterior.poses.push_back(weight * (1.0 - evidence.twin));
    posterior.others.twin += weight * evidence.twin;
    total += weight;
  };
  add_pose(0.0);
  for (const double lead : evidence.leads_m2) add_pose(lead);
  posterior.others.unlisted_pose = options.prior_shared * options.unlisted * chance;
  posterior.others.nothing_shared = (1.0 - options.prior_shared) * chance;
  total += posterior.others.unlisted_pose + posterior.others.nothing_shared;
  for (double& pose : posterior.poses) pose /= total;
  posterior.others.twin /= total;
  double elsewhere = 1.0;  // of the weights of where a place is whose twin was seen: nowhere that was seen
  for (const double odds : evidence.odds_of_twins) elsewhere += 1.0 / (1.0 + odds);
  const double twin = posterior.others.twin;
  for (const double odds : evidence.odds_of_twins) {
    posterior.poses.push_back(twin / (1.0 + odds) / elsewhere);
    posterior.others.twin -= posterior.poses.back();
  }
  posterior.others.unlisted_pose /= total;
  posterior.others.nothing_shared /= total;
  return posterior;
}

double Posterior::elsewhere() const {
  return poses.empty() ? 0.0 : std::accumulate(poses.begin() + 1, poses.end(), 0.0) - slid;
}

Outcome outcome_of(const Posterior& posterior, const std::vector<UnobservedFreedom>& open,
                   const VerdictOptions& options) {
  const double chance = posterior.by_chance();
  if (posterior.poses.empty() || chance > posterior.place() + posterior.elsewhere() + posterior.others.twin)
    return Outcome::no_match;
  const double probable = 1.0 - options.probable_risk;
  if (!open.empty()) return posterior.place() >= probable ? Outcome::under_constrained : Outcome::ambiguous;
  if (posterior.best() >= 1.0 - options.risk) return Outcome::registered;
  return posterior.best() >= probable ? Outcome::probable : Outcome::ambiguous;
}

namespace {

/// The likeliest of what else may be. `judged`: what made the verdict ambiguous before probabilities were
/// known, poses where it has rivals and else chance; empty: nothing did.
std::string what_else(const Verdict& verdict, const Posterior& posterior, const std::string& twin,
                      const std::string& judged) {
  const double chance = posterior.by_chance();
  if (posterior.others.twin >= std::max(chance, posterior.elsewhere()) && !twin.empty()) return twin;
  const bool by_chance = chance > posterior.elsewhere();
  if (!judged.empty() && by_chance == verdict.rivals.empty()) return judged;
  return by_chance
             ? fmt::format("so little surface agrees that it may be chance ({:.1f} %)", 100.0 * chance)
             : fmt::format("too little speaks against the other poses: one of them may be right ({:.1f} %)",
                           100.0 * posterior.elsewhere());
}

/// Cut, not rounded: what is below a limit does not read as if it reached it.
std::string placed_words(double probability, double risk) {
  const int digits = probability < 0.99 ? 1 : 2;
  const double scale = probability < 0.99 ? 1e3 : 1e4;
  return fmt::format("placed, {:.{}f} % sure; the limit for registered is {:g} %",
                     100.0 * std::floor(scale * probability + 1e-9) / scale, digits, 100.0 * (1.0 - risk));
}

std::string reason_of(const Verdict& verdict, const Posterior& posterior, const OpenFreedoms& open,
                      const std::string& twin, const std::string& judged, const VerdictOptions& options) {
  switch (verdict.outcome) {
    case Outcome::registered:
      return verdict.reason;
    case Outcome::probable:
      return placed_words(posterior.best(), options.risk) + ": " + what_else(verdict, posterior, twin, {});
    case Outcome::under_constrained:
      return (open.by_drift ? "the trajectory drifts, which leaves open the "
                            : "the common surface does not fix the ") +
             open.list.front().name;
    case Outcome::ambiguous:
      if (verdict.unsure) return verdict.reason;
      return what_else(verdict, posterior, twin, judged);
    case Outcome::no_match:
      break;
  }
  return fmt::format("it is likelier that they share nothing ({:.0f} %) than that they share any place",
                     100.0 * posterior.by_chance());
}

}  // namespace

Verdict decided(Verdict verdict, const Posterior& posterior, const OpenFreedoms& open,
                const std::string& twin, const VerdictOptions& options) {
  if (verdict.outcome == Outcome::no_match) return verdict;
  const std::string judged = verdict.outcome == Outcome::ambiguous ? verdict.reason : std::string();
  verdict.outcome = outcome_of(posterior, open.list, options);
  if (verdict.unsure && verdict.outcome != Outcome::no_match) verdict.outcome = Outcome::ambiguous;
  verdict.reason = reason_of(verdict, posterior, open, twin, judged, options);
  verdict.unobserved = verdict.outcome == Outcome::no_match ? std::vector<UnobservedFreedom>{} : open.list;
  return verdict;
}

}  // namespace limen
