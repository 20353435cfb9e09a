// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// How the program behaves on a terminal: the progress line, Ctrl-C, a terminal that is closed, a reader that
// leaves. The terminal is a real one, a pseudo-terminal of the system.
#include <chrono>
#include <csignal>
#include <ctime>
#include <thread>

#include "run_program.h"
#include <poll.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>

namespace limen {
namespace {

/// limen at work on a terminal of its own.
class OnTerminal {
 public:
  struct Setting {
    std::string folder;
    std::string term = "xterm";
    std::string locale = "C.UTF-8";
    unsigned short columns = 80;
  };

  OnTerminal(const Setting& setting, std::vector<std::string> arguments) {
    struct winsize size = {24, setting.columns, 0, 0};
    arguments.insert(arguments.begin(), LIMEN_PROGRAM);
    std::vector<char*> words;
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    process_ = forkpty(&terminal_, nullptr, nullptr, &size);
    if (process_ == 0) {
      // As a terminal starts it: the tests may run where these are ignored.
      for (const int number : {SIGHUP, SIGINT, SIGTERM}) std::signal(number, SIG_DFL);
      setenv("TERM", setting.term.c_str(), 1);
      setenv("LC_ALL", setting.locale.c_str(), 1);
      if (chdir(setting.folder.c_str()) == 0) execv(LIMEN_PROGRAM, words.data());
      _exit(127);
    }
  }
  ~OnTerminal() {
    hang_up();
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  /// Reads what is shown until it contains `text`, or the program ends; tells whether it was seen.
  bool wait_for(const std::string& text) {
    while (shown_.find(text) == std::string::npos) {
      if (!read_some()) return false;
    }
    return true;
  }

  void type(const std::string& keys) const {
    EXPECT_EQ(write(terminal_, keys.data(), keys.size()), ssize_t(keys.size()));
  }
  void signal(int number) const { kill(process_, number); }
  void hang_up() {
    if (terminal_ >= 0) close(terminal_);
    terminal_ = -1;
  }

  /// Seconds of processor time that the program has used so far.
  [[nodiscard]] double cpu_s() const {
    timespec used{};
    clockid_t clock{};
    if (process_ <= 0 || clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &used) != 0)
      return 0.0;
    return double(used.tv_sec) + 1e-9 * double(used.tv_nsec);
  }

  /// The same over its whole life, once it has finished.
  [[nodiscard]] double whole_cpu_s() const { return whole_cpu_s_; }

  /// Waits for the end; the exit status, or 128 + signal.
  int finish() {
    while (terminal_ >= 0 && read_some()) {
    }
    int status = 0;
    rusage used{};
    wait4(process_, &status, 0, &used);
    whole_cpu_s_ = double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                   1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  [[nodiscard]] const std::string& shown() const { return shown_; }

 private:
  bool read_some() {
    pollfd wanted{terminal_, POLLIN, 0};
    if (poll(&wanted, 1, 60000) <= 0) return false;
    char piece[4096];
    const ssize_t got = read(terminal_, piece, sizeof piece);
    if (got <= 0) return false;
    shown_.append(piece, static_cast<std::size_t>(got));
    return true;
  }

  int terminal_ = -1;
  pid_t process_ = -1;
  double whole_cpu_s_ = 0.0;
  std::string shown_;
};

class TerminalManners : public ProgramTest {
 protected:
  void make_case(const std::string& points) const {
    ASSERT_EQ(run({"simulate", "room", "-o", "case", "--points-indoor", points, "--stations", "2"}).status,
              0);
  }
  [[nodiscard]] OnTerminal::Setting here() const { return {work().string()}; }

  /// Everything in work() but the case itself, hidden files too.
  [[nodiscard]] std::vector<std::string> left_behind() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(work())) {
      if (entry.path().filename() != "case") names.push_back(entry.path().filename().string());
    }
    return names;
  }

  /// Presses Ctrl-C when the given stage is shown, and looks how the program ends: always well. Tells whether
  /// the key was obeyed: on a busy machine the work may be over, and its numbers be written whole, before it
  /// is pressed, in which case it is tried again, a few times.
  [[nodiscard]] bool interrupt_in(const std::string& stage, const std::vector<std::string>& arguments) const {
    SCOPED_TRACE(stage);
    for (int trial = 0; trial < 5; ++trial) {
      OnTerminal limen(here(), arguments);
      double before_s = 0.0;
      if (limen.wait_for(stage)) {
        before_s = limen.cpu_s();
        limen.type("\x03");
      }
      const int status = limen.finish();
      const bool written = read_whole(work() / "result" / "result.json").find("\n}") != std::string::npos;
      if (status == 0 || (status == 130 && written)) {
        for (const std::string& name : left_behind()) std::filesystem::remove_all(work() / name);
        continue;
      }
      EXPECT_EQ(status, 130) << limen.shown();
      EXPECT_NE(limen.shown().find("limen: error: interrupted"), std::string::npos) << limen.shown();
      EXPECT_EQ(left_behind(), std::vector<std::string>{});
      // At once, in work: what a busy machine takes for it is not the program's.
      EXPECT_LT(limen.whole_cpu_s() - before_s, 1.0);
      return true;
    }
    return false;
  }
};

/// Planes by the slow detector: the others are done before a bar is worth drawing.
std::vector<std::string> slow_planes() {
  return {"planes", "case/indoor_00.ply", "-o", "planes.json", "--detector", "msac", "--threads", "1"};
}

const std::vector<std::string> kLongWork = {"simulate", "museum", "-o", "made", "--points-indoor", "3000000"};

TEST_F(TerminalManners, ABarIsDrawnAndWiped) {
  OnTerminal limen(here(), {"simulate", "room", "-o", "made", "--points-indoor", "1000000"});
  EXPECT_EQ(limen.finish(), 0);
  const std::string& shown = limen.shown();
  EXPECT_NE(shown.find("simulating"), std::string::npos);
  const std::size_t last_wipe = shown.rfind("\r\x1b[K");
  ASSERT_NE(last_wipe, std::string::npos) << shown;
  EXPECT_EQ(shown.find("simulating", last_wipe), std::string::npos) << "the summary stands alone";
  EXPECT_NE(shown.find("written to made", last_wipe), std::string::npos);
}

TEST_F(TerminalManners, ReadingAndPlanesTellHowFarTheyAre) {
  make_case("1000000");
  OnTerminal limen(here(), slow_planes());
  EXPECT_EQ(limen.finish(), 0);
  EXPECT_NE(limen.shown().find("planes"), std::string::npos);
  EXPECT_NE(limen.shown().find(" %"), std::string::npos) << limen.shown();
  EXPECT_NE(limen.shown().find("█"), std::string::npos) << limen.shown();
}

TEST_F(TerminalManners, WithoutUtf8TheLineIsAsciiAndNeverWiderThanTheTerminal) {
  make_case("1000000");
  OnTerminal::Setting narrow = here();
  narrow.locale = "C";
  narrow.columns = 50;
  OnTerminal limen(narrow, slow_planes());
  EXPECT_EQ(limen.finish(), 0);
  std::string line;
  bool stated = false;
  for (const char c : limen.shown()) {
    EXPECT_GE(c, 0) << "a sign beyond ASCII";
    if (c == '\r' || c == '\x1b') line.clear();
    line += c;
    if (line.find("planes ") == 1) {
      stated = true;
      EXPECT_LE(line.size(), 50U) << line;
    }
    if (c == '\n') break;
  }
  EXPECT_TRUE(stated) << limen.shown();
}

TEST_F(TerminalManners, NothingIsDrawnInAPipeOrWhenAskedNotTo) {
  EXPECT_EQ(run({"simulate", "room", "-o", "one", "--points-indoor", "200000"}).err, "");
  OnTerminal quiet(here(), {"simulate", "room", "-o", "two", "--points-indoor", "200000", "--quiet"});
  EXPECT_EQ(quiet.finish(), 0);
  EXPECT_EQ(quiet.shown(), "");
  OnTerminal::Setting dumb = here();
  dumb.term = "dumb";
  OnTerminal plain(dumb, {"simulate", "room", "-o", "three", "--points-indoor", "200000"});
  EXPECT_EQ(plain.finish(), 0);
  EXPECT_EQ(plain.shown().find('\x1b'), std::string::npos);
  EXPECT_EQ(plain.shown().find("simulating"), std::string::npos);
}

TEST_F(TerminalManners, CtrlCEndsSimulateCleanly) {
  EXPECT_TRUE(interrupt_in("simulating", kLongWork));
}

TEST_F(TerminalManners, CtrlCEndsRegisterCleanlyInAnyStage) {
  make_case("1000000");
  // Not the hypotheses and their scoring: they may be over before the line is drawn again. Whether the key is
  // in time in each of the others is not in this test's hands, but that all ends well is.
  int obeyed = 0;
  for (const std::string stage : {"reading", "source features", "target features", "refinement"}) {
    const bool in_time =
        interrupt_in(stage, {"register", "case/indoor_00.ply", "case/indoor_01.ply", "-o", "result"});
    obeyed += in_time ? 1 : 0;
  }
  EXPECT_GT(obeyed, 0);
}

TEST_F(TerminalManners, TerminationIsHeardToo) {
  for (const int number : {SIGTERM, SIGHUP}) {
    OnTerminal limen(here(), kLongWork);
    ASSERT_TRUE(limen.wait_for("simulating"));
    limen.signal(number);
    EXPECT_EQ(limen.finish(), 130);
    EXPECT_EQ(left_behind(), std::vector<std::string>{});
  }
}

TEST_F(TerminalManners, AClosedTerminalLeavesNothing) {
  OnTerminal limen(here(), kLongWork);
  ASSERT_TRUE(limen.wait_for("simulating"));
  limen.hang_up();
  EXPECT_EQ(limen.finish(), 130);
  EXPECT_EQ(left_behind(), std::vector<std::string>{});
}

TEST_F(TerminalManners, TheSecondCtrlCEndsAtOnce) {
  OnTerminal limen(here(), kLongWork);
  ASSERT_TRUE(limen.wait_for("simulating"));
  // Two at once: the second may arrive before the work has seen the first, or after it has ended cleanly.
  limen.signal(SIGINT);
  limen.signal(SIGTERM);
  const int status = limen.finish();
  EXPECT_TRUE(status == 130 || status == 128 + SIGTERM || status == 128 + SIGINT) << status;
}

TEST_F(TerminalManners, AReaderThatLeavesIsNoFault) {
  const std::string command = "cd '" + work().string() +
                              "' && { '" LIMEN_PROGRAM
                              "' man; echo $? > status; } 2> err | head -c 10 > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read_whole(work() / "err"), "");
  // All of the page may have found room before the reader left.
  const std::string status = read_whole(work() / "status");
  EXPECT_TRUE(status == "0\n" || status == "141\n") << status;
}

TEST_F(TerminalManners, AReaderThatIsGoneIsNoFault) {
  // The reader closes its end before anything is written.
  const std::string command = "cd '" + work().string() +
                              "' && { sleep 0.3; '" LIMEN_PROGRAM "' man; echo $? > status; } 2> err | true";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (int k = 0; k < 100 && read_whole(work() / "status").empty(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(read_whole(work() / "status"), "141\n");
  EXPECT_EQ(read_whole(work() / "err"), "");
}

}  // namespace
}  // namespace limen
