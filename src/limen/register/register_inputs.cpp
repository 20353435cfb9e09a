// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/run_both.h"
#include "limen/base/stage_shares.h"
#include "limen/extract/model/sample_model.h"
#include "limen/model/plausible_size.h"
#include "limen/register/prepare/prepare_model.h"
#include "limen/register/prepare/stage_clock.h"
#include "limen/register/published/register_published.h"
#include "limen/register/register.h"

namespace limen {
namespace {

PreparedScan prepare(const BimModel& model, const PrepareOptions& options, Monitor& monitor) {
  PreparedScan prepared = prepare_model(model, {}, monitor);
  if (options.sampled_model) prepared.extracted.features.segments = sampled_model_segments(model);
  return prepared;
}

PreparedScan prepare(const RegisterInput& input, const PrepareOptions& options, Monitor& monitor) {
  if (input.model) return prepare(*input.model, options, monitor);
  return prepare_group(input.scans, options, monitor);
}

PreparedScan prepare(const Scan& scan, const PrepareOptions& options, Monitor& monitor) {
  return prepare_scan(scan, options, monitor);
}

bool is_model(const RegisterInput& input) {
  return input.model.has_value();
}
bool is_model(const Scan& /*scan*/) {
  return false;
}
bool is_model(const BimModel& /*model*/) {
  return true;
}

PicturedSide pictured(PreparedScan&& prepared) {
  PicturedSide side;
  side.upright = prepared.upright;
  if (prepared.upright) side.up = prepared.upright_from_scan.row(2).transpose();
  side.features = in_own_frame(std::move(prepared));
  return side;
}

void require_plausible_size(const RegisterInput& input) {
  if (input.model) limen::require_plausible_size(*input.model);
  for (const PlacedScan& placed : input.scans) limen::require_plausible_size(placed.scan);
}

template <typename Source, typename Target>
PreparedPair prepare_in_turn(const Source& source, const Target& target, const RegisterOptions& options,
                             std::vector<StageTime>& stages, Monitor& monitor) {
  StageClock clock(stages, monitor);
  PreparedPair pair;
  clock.begin("source features");
  pair.source = prepare(source, prepare_options(options), monitor);
  clock.end();
  clock.begin("target features");
  pair.target = prepare(target, prepare_options(options), monitor);
  clock.end();
  return pair;
}

/// Each on a thread of its own: neither waits for the parts of the other that only one thread can do.
template <typename Source, typename Target>
PreparedPair prepare_at_once(const Source& source, const Target& target, const RegisterOptions& options,
                             std::vector<StageTime>& stages, Monitor& monitor) {
  StageClock clock(stages, monitor);
  clock.begin("source features, target features");
  PreparedPair pair;
  StageShares shares(monitor, 2);
  run_both([&] { pair.source = prepare(source, prepare_options(options), shares.worker(0)); },
           [&] { pair.target = prepare(target, prepare_options(options), shares.worker(1)); });
  clock.end();
  return pair;
}

template <typename Source, typename Target>
RegistrationResult prepare_and_register_once(const Source& source, const Target& target,
                                             const RegisterOptions& options, Monitor& monitor) {
  std::vector<StageTime> stages;
  PreparedPair pair = thread_count() > 1 ? prepare_at_once(source, target, options, stages, monitor)
                                         : prepare_in_turn(source, target, options, stages, monitor);
  RegistrationResult result = register_prepared(pair, options, monitor);
  result.source_place = pair.source.place;
  result.target_place = pair.target.place;
  result.stages.insert(result.stages.begin(), stages.begin(), stages.end());
  if (options.picture) {
    result.picture = std::make_shared<const RegistrationPicture>(
        RegistrationPicture{pictured(std::move(pair.source)), pictured(std::move(pair.target))});
  }
  return result;
}

template <typename Source, typename Target>
RegistrationResult prepare_and_register(const Source& source, const Target& target,
                                        const RegisterOptions& options, Monitor& monitor) {
  options.check();
  require_plausible_size(source);
  require_plausible_size(target);
  const CancelScope scope(monitor);
  const bool in_model = is_model(source) || is_model(target);
  if (options.as_published) {
    check_sides(*options.as_published, in_model);
    return prepare_and_register_once(source, target, options, monitor);
  }
  RegistrationResult result = prepare_and_register_once(source, target, options, monitor);
  if (!in_model || options.method != Method::automatic || result.judged_poses > 0) return result;
  RegisterOptions by_edges = options;
  by_edges.method = Method::segments;
  RegistrationResult second = prepare_and_register_once(source, target, by_edges, monitor);
  second.stages.insert(second.stages.begin(), result.stages.begin(), result.stages.end());
  return second;
}

}  // namespace

RegistrationResult register_inputs(const RegisterInput& source, const RegisterInput& target,
                                   const RegisterOptions& options, Monitor& monitor) {
  if (source.model && target.model) {
    throw Error("both sides are building models", source.model->name + " and " + target.model->name,
                "give a scan as one of them");
  }
  return prepare_and_register(source, target, options, monitor);
}

RegistrationResult register_scans(const Scan& source, const Scan& target, const RegisterOptions& options,
                                  Monitor& monitor) {
  return prepare_and_register(source, target, options, monitor);
}

RegistrationResult register_to_model(const Scan& scan, const BimModel& model, const RegisterOptions& options,
                                     Monitor& monitor) {
  return prepare_and_register(scan, model, options, monitor);
}

}  // namespace limen
