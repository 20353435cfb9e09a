// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "limen/base/child_process.h"
#include "limen/base/error.h"
#include "limen/base/system.h"
#include "limen/base/text.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kTick_ms = 50;

[[noreturn]] void cannot_start(const std::string& what) {
  throw Error("the program that reads IFC shapes cannot be started: " + what, "limen_ifc",
              "check the installation and the machine's limits", Fault::internal);
}

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int value() const { return value_; }
  void reset() {
    if (value_ >= 0) close(value_);
    value_ = -1;
  }

 private:
  int value_;
};

/// Writes the bytes and goes back to their beginning: a pipe would have to be filled while the answer is
/// read.
void fill(const Descriptor& file, std::string_view bytes) {
  if (file.value() < 0) cannot_start("no temporary file: " + reason_of(errno));
  while (!bytes.empty()) {
    const std::ptrdiff_t written = write_some(file.value(), bytes);
    if (written < 0 && errno != EINTR)
      cannot_start("a temporary file cannot be written: " + reason_of(errno));
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  lseek(file.value(), 0, SEEK_SET);
}

/// How long the child may be silent and how much it may say.
struct Patience {
  double silence_s = 0.0;
  double output_bytes = 0.0;
};

/// Reads until the child closes its end. Returns why reading was given up, or nothing.
std::string read_all(int descriptor, const Patience& patience, Monitor& monitor, std::string& output) {
  std::string piece(std::size_t{1} << 16U, '\0');
  Clock::time_point queried = Clock::now();
  for (;;) {
    monitor.throw_if_cancelled();
    if (!wait_to_read(descriptor, kTick_ms)) {
      if (std::chrono::duration<double>(Clock::now() - queried).count() > patience.silence_s)
        return fmt::format("was stopped after {:.0f} s without progress", patience.silence_s);
      continue;
    }
    const std::ptrdiff_t got = read_some(descriptor, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return {};
    queried = Clock::now();
    output.append(piece, 0, static_cast<std::size_t>(got));
    if (static_cast<double>(output.size()) > patience.output_bytes)
      return fmt::format("was stopped because it wrote more than {:.0f} MB", 1e-6 * patience.output_bytes);
  }
}

Patience patience_of(const IfcProcessOptions& options, double megabytes) {
  const double output_mb =
      std::min(options.output_mb + options.output_mb_per_mb * megabytes, options.most_output_mb);
  return {options.silence_s + options.silence_s_per_mb * megabytes, output_mb * 1e6};
}

}  // namespace

void IfcProcessOptions::check() const {
  if (!(silence_s > 0.0)) throw_bad_option("silence_s", silence_s, "above 0");
  if (!(silence_s_per_mb >= 0.0)) throw_bad_option("silence_s_per_mb", silence_s_per_mb, "at least 0");
  if (!(cpu_s > 0.0)) throw_bad_option("cpu_s", cpu_s, "above 0");
  if (!(cpu_s_per_mb >= 0.0)) throw_bad_option("cpu_s_per_mb", cpu_s_per_mb, "at least 0");
  if (!(output_mb > 0.0)) throw_bad_option("output_mb", output_mb, "above 0");
  if (!(output_mb_per_mb >= 0.0)) throw_bad_option("output_mb_per_mb", output_mb_per_mb, "at least 0");
  if (!(most_output_mb > 0.0)) throw_bad_option("most_output_mb", most_output_mb, "above 0");
  if (!(memory_mb > 0.0)) throw_bad_option("memory_mb", memory_mb, "above 0");
  if (!(memory_mb_per_mb >= 0.0)) throw_bad_option("memory_mb_per_mb", memory_mb_per_mb, "at least 0");
}

fs::path find_ifc_helper() {
  const char* named = std::getenv("LIMEN_IFC_HELPER");
  if (named != nullptr && *named != '\0') {
    if (may_run(named)) return named;
    throw Error("there is no such program", fmt::format("LIMEN_IFC_HELPER={}", named),
                "name the program limen_ifc, or unset the variable");
  }
  const std::string name = fmt::format("limen_ifc{}", program_ending());
  // Beside the running program, and beside the library this code lies in (a Python module, say).
  for (const fs::path& file : {own_program(), own_library()}) {
    const fs::path folder = file.parent_path();
    for (const fs::path& place : {folder / name, folder.parent_path() / "libexec" / "limen" / name}) {
      if (!file.empty() && may_run(place)) return place;
    }
  }
  if (may_run(LIMEN_INSTALLED_IFC_HELPER)) return LIMEN_INSTALLED_IFC_HELPER;
  throw Error("limen_ifc, the program that reads IFC shapes, was not found", "the folder of limen",
              "install it with limen (LIMEN_BUILD_IFC), name it in LIMEN_IFC_HELPER, or export the model as "
              "OBJ or PLY");
}

IfcRun run_ifc_helper(std::string_view bytes, const std::vector<std::int64_t>& skip,
                      const IfcProcessOptions& options, Monitor& monitor) {
  options.check();
  const fs::path program = find_ifc_helper();
  const Descriptor input(make_nameless_file());
  fill(input, bytes);
  const std::optional<PipeEnds> ends = make_pipe();
  if (!ends) cannot_start(reason_of(errno));
  const Descriptor out(ends->read);
  Descriptor in(ends->write);
  std::vector<std::string> words{program.string()};
  for (const std::int64_t id : skip) {
    words.emplace_back("--skip");
    words.push_back(fmt::format("{}", id));
  }
  const double megabytes = static_cast<double>(bytes.size()) * 1e-6;
  ChildProcess child(
      words, {input.value(), in.value(), 1e6 * (options.memory_mb + options.memory_mb_per_mb * megabytes),
              options.cpu_s + options.cpu_s_per_mb * megabytes});
  if (!child.problem().empty()) cannot_start(child.problem());
  in.reset();
  IfcRun run;
  const std::string given_up = read_all(out.value(), patience_of(options, megabytes), monitor, run.output);
  if (!given_up.empty()) child.kill();
  const ChildEnd end = child.wait();
  if (run.output.empty() && end.by_itself && end.status == ChildProcess::kNotStarted)
    cannot_start(program.string() + " cannot be run");
  run.ended_how = given_up.empty() ? end.how : given_up;
  run.finished = given_up.empty() && end.by_itself;
  return run;
}

}  // namespace limen
