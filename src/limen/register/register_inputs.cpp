// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/progress.h"
#include "limen/extract/model/sample_model.h"
#include "limen/model/plausible_size.h"
#include "limen/register/prepare/prepare_group.h"
#include "limen/register/prepare/prepare_model.h"
#include "limen/register/prepare/prepared_pair.h"
#include "limen/register/prepare/stage_clock.h"
#include "limen/register/published/register_published.h"
#include "limen/register/register.h"

namespace limen {
namespace {

PreparedScan prepare(const BimModel& model, const PrepareOptions& options, Monitor& monitor) {
  PreparedScan prepared = prepare_model(model, monitor);
  if (options.sampled_model) prepared.extracted.features.segments = sampled_model_segments(model);
  return prepared;
}

PreparedScan prepare(const RegisterInput& input, const PrepareOptions& options, Monitor& monitor) {
  if (input.model) return prepare(*input.model, options, monitor);
  return prepare_group(input.scans, options, monitor);
}

PreparedScan prepare(RegisterInput&& input, const PrepareOptions& options, Monitor& monitor) {
  if (input.model) return prepare(*input.model, options, monitor);
  return prepare_group(std::move(input.scans), options, monitor);
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

void note_up(const PreparedScan& side, const char* name, Monitor& monitor) {
  const std::string hint = up_hint(side.upright_from_scan.row(2).transpose());
  if (side.upright && !side.model && !hint.empty()) monitor.note(fmt::format("{}: {}", name, hint));
}

template <typename Source, typename Target>
PreparedPair prepare_in_turn(Source&& source, Target&& target, const RegisterOptions& options,
                             std::vector<StageTime>& stages, Monitor& monitor) {
  StageClock clock(stages, monitor);
  PreparedPair pair;
  clock.begin("source features");
  pair.source = prepare(std::forward<Source>(source), prepare_options(options), monitor);
  clock.end();
  clock.begin("target features");
  pair.target = prepare(std::forward<Target>(target), prepare_options(options), monitor);
  clock.end();
  return pair;
}

/// Each on a thread of its own: neither waits for the parts of the other that only one thread can do.
template <typename Source, typename Target>
PreparedPair prepare_at_once(Source&& source, Target&& target, const RegisterOptions& options,
                             std::vector<StageTime>& stages, Monitor& monitor) {
  StageClock clock(stages, monitor);
  clock.begin("source features, target features");
  PreparedPair pair;
  StageShares shares(monitor, 2);
  run_both(
      [&] {
        pair.source = prepare(std::forward<Source>(source), prepare_options(options), shares.worker(0));
      },
      [&] {
        pair.target = prepare(std::forward<Target>(target), prepare_options(options), shares.worker(1));
      });
  clock.end();
  return pair;
}

template <typename Source, typename Target>
PreparedPair prepare_pair(Source&& source, Target&& target, const RegisterOptions& options,
                          std::vector<StageTime>& stages, Monitor& monitor) {
  if (thread_count() == 1)
    return prepare_in_turn(std::forward<Source>(source), std::forward<Target>(target), options, stages,
                           monitor);
  return prepare_at_once(std::forward<Source>(source), std::forward<Target>(target), options, stages,
                         monitor);
}

RegistrationResult register_and_picture(PreparedPair&& pair, const std::vector<StageTime>& stages,
                                        const RegisterOptions& options, Monitor& monitor) {
  note_up(pair.source, "SOURCE", monitor);
  note_up(pair.target, "TARGET", monitor);
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
RegistrationResult prepare_and_register_once(const Source& source, const Target& target,
                                             const RegisterOptions& options, Monitor& monitor) {
  std::vector<StageTime> stages;
  PreparedPair pair = prepare_pair(source, target, options, stages, monitor);
  return register_and_picture(std::move(pair), stages, options, monitor);
}

/// Whether the scans are laid in their frame, and given up, before the other side is read.
bool is_large(const RegisterInput& input) {
  constexpr std::size_t kLargePoints = 6'000'000;
  std::size_t points = 0;
  for (const PlacedScan& placed : input.scans) points += placed.scan.size();
  return points > kLargePoints;
}

void check_inputs(const RegisterInput& source, const RegisterInput& target, const RegisterOptions& options) {
  if (source.model && target.model) {
    throw Error("both sides are building models", source.model->name + " and " + target.model->name,
                "give a scan as one of them");
  }
  if (options.as_published) check_sides(*options.as_published, source.model || target.model);
}

/// Registers what is read, once; tells whether a model was among it.
class ReadingRun {
 public:
  ReadingRun(const RegisterOptions& options, Monitor& monitor) : options_(options), monitor_(monitor) {}

  RegistrationResult operator()(const InputReader& source, const InputReader& target) {
    PreparedPair pair;
    RegisterInput from = read(source);
    const bool first = is_large(from);
    if (first) {
      pair.source = prepared("source features", std::move(from));
      from = {};
    }
    RegisterInput to = read(target);
    check_inputs(from, to, options_);
    if (!first && !is_large(to)) {
      pair = prepare_pair(std::move(from), std::move(to), options_, stages_, monitor_);
    } else {
      if (!first) pair.source = prepared("source features", std::move(from));
      pair.target = prepared("target features", std::move(to));
    }
    return register_and_picture(std::move(pair), stages_, options_, monitor_);
  }

  [[nodiscard]] bool has_model() const { return has_model_; }

 private:
  RegisterInput read(const InputReader& reader) {
    StageClock clock(stages_, monitor_);
    clock.begin("reading");
    RegisterInput input = reader();
    clock.end();
    require_plausible_size(input);
    has_model_ = has_model_ || input.model.has_value();
    return input;
  }

  PreparedScan prepared(const char* stage, RegisterInput&& input) {
    StageClock clock(stages_, monitor_);
    clock.begin(stage);
    PreparedScan side = prepare(std::move(input), prepare_options(options_), monitor_);
    clock.end();
    return side;
  }

  const RegisterOptions& options_;
  Monitor& monitor_;
  std::vector<StageTime> stages_;
  bool has_model_ = false;
};

/// `once` registers with the options it is given. Where planes propose no place at all in a model, edges are
/// tried.
template <typename Once>
RegistrationResult by_planes_or_edges(const Once& once, const RegisterOptions& options,
                                      const bool& in_model) {
  RegistrationResult result = once(options);
  const bool planes_alone = !options.as_published && options.method == Method::automatic;
  if (!in_model || !planes_alone || result.judged_poses > 0) return result;
  RegisterOptions by_edges = options;
  by_edges.method = Method::segments;
  RegistrationResult second = once(by_edges);
  second.stages.insert(second.stages.begin(), result.stages.begin(), result.stages.end());
  return second;
}

template <typename Source, typename Target>
RegistrationResult prepare_and_register(const Source& source, const Target& target,
                                        const RegisterOptions& options, Monitor& monitor) {
  options.check();
  require_plausible_size(source);
  require_plausible_size(target);
  const CancelScope scope(monitor);
  const bool in_model = is_model(source) || is_model(target);
  if (options.as_published) check_sides(*options.as_published, in_model);
  const auto once = [&](const RegisterOptions& with) {
    return prepare_and_register_once(source, target, with, monitor);
  };
  return by_planes_or_edges(once, options, in_model);
}

}  // namespace

RegistrationResult register_inputs(const RegisterInput& source, const RegisterInput& target,
                                   const RegisterOptions& options, Monitor& monitor) {
  check_inputs(source, target, options);
  return prepare_and_register(source, target, options, monitor);
}

RegistrationResult register_inputs(const InputReader& source, const InputReader& target,
                                   const RegisterOptions& options, Monitor& monitor) {
  options.check();
  const CancelScope scope(monitor);
  bool in_model = false;
  const auto once = [&](const RegisterOptions& with) {
    ReadingRun run(with, monitor);
    RegistrationResult result = run(source, target);
    in_model = run.has_model();
    return result;
  };
  return by_planes_or_edges(once, options, in_model);
}

RegistrationResult register_scans(const Scan& source, const Scan& target, const RegisterOptions& options,
                                  Monitor& monitor) {
  return prepare_and_register(source, target, options, monitor);
}

RegistrationResult register_scans(std::vector<Vector3d> source, std::vector<Vector3d> target,
                                  const RegisterOptions& options, Monitor& monitor) {
  return register_scans(scan_of_points(std::move(source)), scan_of_points(std::move(target)), options,
                        monitor);
}

RegistrationResult register_to_model(const Scan& scan, const BimModel& model, const RegisterOptions& options,
                                     Monitor& monitor) {
  return prepare_and_register(scan, model, options, monitor);
}

}  // namespace limen
