// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/start_program.h"
#include "limen/base/text.h"

extern char** environ;

namespace limen {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kTick_ms = 50;
constexpr int kNotStarted = 127;

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

/// The bytes as a nameless file at its beginning: a pipe would have to be filled while the answer is read.
class NamelessFile {
 public:
  explicit NamelessFile(std::string_view bytes) : file_(std::tmpfile(), std::fclose) {
    if (!file_) cannot_start("no temporary file: " + reason_of(errno));
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
        std::fflush(file_.get()) != 0)
      cannot_start("a temporary file cannot be written: " + reason_of(errno));
    std::rewind(file_.get());
    fcntl(descriptor(), F_SETFD, FD_CLOEXEC);
  }
  [[nodiscard]] int descriptor() const { return fileno(file_.get()); }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// A started process; killed and waited for with the object.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ > 0) end();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void kill() const { ::kill(id_, SIGKILL); }

  /// Waits for the end and tells how it was.
  int wait() {
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  void end() {
    kill();
    wait();
  }

  pid_t id_;
};

/// What the child may take, worked out beforehand: between fork and exec hardly anything may be called.
struct Bounds {
  rlim_t memory_bytes = 0;
  rlim_t cpu_s = 0;
};

/// In the child, before the program runs: its ends, its bounds, and that it dies with us. Calls only what may
/// be called after a fork of a process with threads.
[[noreturn]] void become(char* const* words, int input, int output, const Bounds& bounds, pid_t parent) {
  // A process group of its own: the terminal's interrupt reaches limen, which then stops the child.
  setpgid(0, 0);
  const rlimit memory{bounds.memory_bytes, bounds.memory_bytes};
  const rlimit cpu{bounds.cpu_s, bounds.cpu_s};
  const rlimit none{0, 0};
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const bool ready = prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && setrlimit(RLIMIT_CPU, &cpu) == 0 &&
                     setrlimit(RLIMIT_CORE, &none) == 0 && dup2(input, STDIN_FILENO) >= 0 &&
                     dup2(output, STDOUT_FILENO) >= 0 && dup2(nowhere, STDERR_FILENO) >= 0 &&
                     setrlimit(RLIMIT_AS, &memory) == 0;
  // Whoever dies before we asked for its end is no parent any more.
  if (ready && getppid() == parent) execve(words[0], words, environ);
  _exit(kNotStarted);
}

pid_t start(const fs::path& program, const std::vector<std::string>& arguments, int input, int output,
            const Bounds& bounds) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::vector<char*> pointers = exec_pointers(words);
  const pid_t parent = getpid();
  const pid_t id = fork();
  if (id < 0) cannot_start(reason_of(errno));
  if (id == 0) become(pointers.data(), input, output, bounds, parent);
  return id;
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
    pollfd wanted{descriptor, POLLIN, 0};
    const int ready = poll(&wanted, 1, kTick_ms);
    if (ready < 0 && errno != EINTR) return "could not be read from";
    if (ready <= 0) {
      if (std::chrono::duration<double>(Clock::now() - queried).count() > patience.silence_s)
        return fmt::format("was stopped after {:.0f} s without progress", patience.silence_s);
      continue;
    }
    const ssize_t got = read(descriptor, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return {};
    queried = Clock::now();
    output.append(piece, 0, static_cast<std::size_t>(got));
    if (static_cast<double>(output.size()) > patience.output_bytes)
      return fmt::format("was stopped because it wrote more than {:.0f} MB", 1e-6 * patience.output_bytes);
  }
}

std::string how_ended(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("was ended by signal {} ({})", signal, strsignal(signal));
  }
  return fmt::format("ended with status {}", WIFEXITED(status) ? WEXITSTATUS(status) : status);
}

/// The folder of the running program, and that of the library this code lies in (a Python module, say).
std::vector<fs::path> own_folders() {
  std::vector<fs::path> folders;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) folders.push_back(program.parent_path());
  Dl_info here{};
  if (dladdr(reinterpret_cast<const void*>(&find_ifc_helper), &here) != 0 && here.dli_fname != nullptr) {
    const fs::path library = fs::weakly_canonical(here.dli_fname, ignored);
    if (!library.empty()) folders.push_back(library.parent_path());
  }
  return folders;
}

/// A bound of the system's; nobody may ask for more than was given to us.
rlim_t within_own(int resource, double wanted) {
  rlimit own{};
  const auto most = static_cast<rlim_t>(std::ceil(wanted));
  return getrlimit(static_cast<__rlimit_resource_t>(resource), &own) == 0 ? std::min(most, own.rlim_max)
                                                                          : most;
}

Bounds bounds_of(const IfcProcessOptions& options, double megabytes) {
  return {within_own(RLIMIT_AS, 1e6 * (options.memory_mb + options.memory_mb_per_mb * megabytes)),
          within_own(RLIMIT_CPU, options.cpu_s + options.cpu_s_per_mb * megabytes)};
}

Patience patience_of(const IfcProcessOptions& options, double megabytes) {
  const double output_mb =
      std::min(options.output_mb + options.output_mb_per_mb * megabytes, options.most_output_mb);
  return {options.silence_s + options.silence_s_per_mb * megabytes, output_mb * 1e6};
}

bool runs(const fs::path& path) {
  return !path.empty() && access(path.c_str(), X_OK) == 0 && fs::is_regular_file(path);
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
    if (runs(named)) return named;
    throw Error("there is no such program", fmt::format("LIMEN_IFC_HELPER={}", named),
                "name the program limen_ifc, or unset the variable");
  }
  for (const fs::path& folder : own_folders()) {
    for (const fs::path& place :
         {folder / "limen_ifc", folder.parent_path() / "libexec" / "limen" / "limen_ifc"}) {
      if (runs(place)) return place;
    }
  }
  if (runs(LIMEN_INSTALLED_IFC_HELPER)) return LIMEN_INSTALLED_IFC_HELPER;
  throw Error("limen_ifc, the program that reads IFC shapes, was not found", "the folder of limen",
              "install it with limen (LIMEN_BUILD_IFC), name it in LIMEN_IFC_HELPER, or export the model as "
              "OBJ or PLY");
}

IfcRun run_ifc_helper(std::string_view bytes, const std::vector<std::int64_t>& skip,
                      const IfcProcessOptions& options, Monitor& monitor) {
  options.check();
  const fs::path program = find_ifc_helper();
  const NamelessFile input(bytes);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) cannot_start(reason_of(errno));
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  std::vector<std::string> arguments;
  for (const std::int64_t id : skip) {
    arguments.emplace_back("--skip");
    arguments.push_back(fmt::format("{}", id));
  }
  const double megabytes = static_cast<double>(bytes.size()) * 1e-6;
  Child child(start(program, arguments, input.descriptor(), in.value(), bounds_of(options, megabytes)));
  in.reset();
  IfcRun run;
  const std::string given_up = read_all(out.value(), patience_of(options, megabytes), monitor, run.output);
  if (!given_up.empty()) child.kill();
  const int status = child.wait();
  if (run.output.empty() && WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted)
    cannot_start(program.string() + " cannot be run");
  run.ended_how = given_up.empty() ? how_ended(status) : given_up;
  run.finished = given_up.empty() && WIFEXITED(status);
  return run;
}

}  // namespace limen
