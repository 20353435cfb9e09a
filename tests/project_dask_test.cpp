// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// limen project --engine dask from outside: the same bytes as the local engine, whatever happens to workers,
// scheduler and folder on the way. Skipped where python3-distributed is not installed.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "run_program.h"
#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace limen {
namespace {

namespace fs = std::filesystem;

/// A program of its own process group, ended with this object.
class DaskProcess {
 public:
  explicit DaskProcess(const std::string& shell_command) {
    id_ = fork();
    if (id_ != 0) return;
    setpgid(0, 0);
    execl("/bin/sh", "sh", "-c", shell_command.c_str(), nullptr);
    _exit(127);
  }
  ~DaskProcess() { end(); }
  DaskProcess(const DaskProcess&) = delete;
  DaskProcess& operator=(const DaskProcess&) = delete;

  void end() {
    if (id_ <= 0) return;
    kill(-id_, SIGKILL);
    waitpid(id_, nullptr, 0);
    id_ = -1;
  }

 private:
  pid_t id_ = -1;
};

class ProjectDask : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const char* probe =
        "python3 -c 'import distributed' 2> /dev/null || /usr/bin/python3 -c 'import distributed' 2> "
        "/dev/null";
    if (std::system(probe) != 0)
      GTEST_SKIP() << "python3-distributed is not installed: scripts/install_dependencies test";
    const ProgramRun made = run({"simulate", "museum", "--project", "--stations", "3", "--passes", "0",
                                 "--points-indoor", "15000", "--seed", "1", "-o", "case", "--quiet"});
    ASSERT_EQ(made.status, 0) << made.err;
    write_whole(work() / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\n");
  }
  void TearDown() override {
    unsetenv("LIMEN_PROGRAM");
    forget_certificate();
    ProgramTest::TearDown();
  }

  [[nodiscard]] ProgramRun project(const std::string& out, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"project",
                                       "case/station_001.ply",
                                       "case/station_002.ply",
                                       "broken.ply",
                                       "case/station_003.ply",
                                       "-o",
                                       out,
                                       "--threads",
                                       "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] std::string text_of(const std::string& out) const {
    return read_whole(work() / out / "project.json");
  }

  /// Workers run this shell script in place of limen: it may do harm before, or instead.
  void workers_run(const std::string& harm) const {
    const fs::path script = work() / "worker_limen";
    const std::string head = "#!/bin/sh\ncd " + work().string() + "\n";
    write_whole(script, head + harm + "\nexec " + LIMEN_PROGRAM + " \"$@\"\n");
    fs::permissions(script, fs::perms::owner_all);
    setenv("LIMEN_PROGRAM", script.c_str(), 1);
  }

  /// A certificate that signs itself, and Dask's configuration that names it.
  void make_certificate() const {
    const std::string made = "cd " + work().string() +
                             " && /usr/bin/python3 -c 'from distributed.security import Security\n"
                             "made = Security.temporary()\nopen(\"ca.pem\", \"w\").write(made.tls_ca_file)\n"
                             "open(\"key.pem\", \"w\").write(made.tls_client_key)'";
    ASSERT_EQ(std::system(made.c_str()), 0);
    const std::string pem = (work() / "ca.pem").string();
    const std::string key = (work() / "key.pem").string();
    setenv("DASK_DISTRIBUTED__COMM__TLS__CA_FILE", pem.c_str(), 1);
    for (const std::string role : {"CLIENT", "WORKER", "SCHEDULER"}) {
      setenv(("DASK_DISTRIBUTED__COMM__TLS__" + role + "__CERT").c_str(), pem.c_str(), 1);
      setenv(("DASK_DISTRIBUTED__COMM__TLS__" + role + "__KEY").c_str(), key.c_str(), 1);
    }
  }
  static void forget_certificate() {
    unsetenv("DASK_DISTRIBUTED__COMM__TLS__CA_FILE");
    for (const std::string role : {"CLIENT", "WORKER", "SCHEDULER"}) {
      unsetenv(("DASK_DISTRIBUTED__COMM__TLS__" + role + "__CERT").c_str());
      unsetenv(("DASK_DISTRIBUTED__COMM__TLS__" + role + "__KEY").c_str());
    }
  }

  void expect_bytes_of_the_local_run(const std::string& out, const ProgramRun& done) const {
    const ProgramRun local = project("local", {});
    EXPECT_EQ(done.status, local.status) << done.err;
    const std::string log = read_whole(work() / out / "store" / "dask.log");
    ASSERT_FALSE(text_of("local").empty());
    EXPECT_EQ(text_of(out), text_of("local")) << done.err << log.substr(0, 4000);
  }
};

TEST_F(ProjectDask, WorkersThatAreKilledAreMadeGood) {
  // Each kind of job kills its first worker, as the kernel does where memory ends.
  workers_run("if mkdir killed_at_$4 2> /dev/null; then kill -9 $PPID; sleep 1; fi");
  const ProgramRun done = project("dask", {"--engine", "dask"});
  EXPECT_TRUE(fs::exists(work() / "killed_at_features"));
  EXPECT_TRUE(fs::exists(work() / "killed_at_pair"));
  expect_bytes_of_the_local_run("dask", done);
  // The other engine goes on where one ended.
  EXPECT_EQ(project("dask", {}).status, done.status);
  EXPECT_EQ(text_of("dask"), text_of("local"));
}

TEST_F(ProjectDask, AJobThatKillsItsWorkersIsStatedByNameAndTheRestFinishes) {
  workers_run(
      "if [ \"$4\" = pair ] && mkdir first 2> /dev/null; then echo \"$5\" > victim; fi\n"
      "if [ \"$4\" = pair ] && [ \"$5 $6\" = \"$(cat victim) $6\" ] && [ -e victim ]; then\n"
      "  echo . >> starts; kill -9 $PPID; sleep 1\nfi");
  const ProgramRun done = project("dask", {"--engine", "dask"});
  const nlohmann::json stated = nlohmann::json::parse(text_of("dask"));
  int not_compared = 0;
  for (const nlohmann::json& note : stated["notes"]) {
    const auto text = note.get<std::string>();
    if (text.find("could not be compared (it ended its worker repeatedly)") == std::string::npos) continue;
    EXPECT_NE(text.find("case/station_00"), std::string::npos) << text;
    ++not_compared;
  }
  // The scan that came first in a pair is that of one or two pairs, of three.
  EXPECT_GE(not_compared, 1);
  EXPECT_LE(not_compared, 2);
  EXPECT_NE(done.err.find("given up"), std::string::npos) << done.err;
  std::string victim = read_whole(work() / "victim");
  while (!victim.empty() && victim.back() == '\n') victim.pop_back();
  int kept = 0;
  for (const auto& entry : fs::directory_iterator(work() / "dask" / "store" / "pairs")) {
    EXPECT_NE(entry.path().filename().string().rfind(victim, 0), 0U) << entry.path();
    ++kept;
  }
  EXPECT_GE(kept, 3 - not_compared);
  // What is run again without the harm is whole.
  unsetenv("LIMEN_PROGRAM");
  expect_bytes_of_the_local_run("dask", project("dask", {"--engine", "dask"}));
}

TEST_F(ProjectDask, AFullDiskAndAFolderThatVanishesAreWaitedFor) {
  workers_run(
      "if mkdir full_at_$4 2> /dev/null; then ulimit -f 0; fi\n"
      "if [ -e full_at_pair ] && mkdir vanished 2> /dev/null; then\n"
      "  mv dask/store/orders dask/store/away; (sleep 4; mv dask/store/away dask/store/orders) &\nfi");
  const ProgramRun done = project("dask", {"--engine", "dask"});
  EXPECT_TRUE(fs::exists(work() / "vanished"));
  EXPECT_NE(done.err.find("has to wait"), std::string::npos) << done.err;
  expect_bytes_of_the_local_run("dask", done);
}

TEST_F(ProjectDask, NobodyElseReachesWhatRuns) {
  const std::string look = (fs::path(LIMEN_CORPUS).parent_path() / "tools" / "open_ports").string() + " " +
                           std::to_string(getpid());
  workers_run("if [ \"$4\" = pair ] && mkdir looked 2> /dev/null; then " + look + " > ports 2>&1; fi");
  const ProgramRun done = project("dask", {"--engine", "dask"});
  std::istringstream ports(read_whole(work() / "ports"));
  int closed = 0;
  for (std::string line; std::getline(ports, line);) {
    std::istringstream words(line);
    std::string address;
    std::string port;
    std::string found;
    words >> address >> port >> found;
    EXPECT_EQ(address, "127.0.0.1") << line;
    EXPECT_TRUE(found == "closed" || found == "empty") << line;
    closed += found == "closed" ? 1 : 0;
  }
  EXPECT_GE(closed, 3) << "a scheduler and two workers";
  unsetenv("LIMEN_PROGRAM");
  expect_bytes_of_the_local_run("dask", done);
}

TEST_F(ProjectDask, ASchedulerThatIsKilledAndStartedAgainCostsOnlyWhatRan) {
  make_certificate();
  const std::string cd = "cd " + work().string() + "; ";
  const std::string scheduler = cd +
                                "rm -f at; exec dask-scheduler --protocol tls --host 127.0.0.1 --port 0 "
                                "--no-dashboard --scheduler-file at 2> log";
  const std::string workers =
      cd +
      "while :; do dask-worker --scheduler-file at --nthreads 1 --no-dashboard --host 127.0.0.1 "
      "--death-timeout 5 2> /dev/null; sleep 1; done";
  workers_run("echo . >> started; sleep 1");
  DaskProcess first(scheduler);
  while (!fs::exists(work() / "at")) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const DaskProcess worker(workers);
  ProgramRun done;
  std::thread limen([&] { done = project("dask", {"--engine", "dask", "--scheduler-file", "at"}); });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(work() / "started") && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  first.end();
  const DaskProcess second(scheduler);
  limen.join();
  EXPECT_NE(done.err.find("the scheduler is back"), std::string::npos) << done.err;
  unsetenv("LIMEN_PROGRAM");
  expect_bytes_of_the_local_run("dask", done);
}

TEST_F(ProjectDask, WhatIsMissingOrUnsafeIsOneError) {
  write_whole(work() / "at", R"({"address": "tcp://127.0.0.1:8786"})");
  for (const std::string host : {"192.0.2.1", "127.0.0.1", "localhost", "127.evil.example", "[::1]"}) {
    const ProgramRun open = project("out", {"--engine", "dask", "--scheduler", "tcp://" + host + ":8786"});
    EXPECT_EQ(open.status, 2);
    EXPECT_NE(open.err.find("is not protected by TLS"), std::string::npos) << open.err;
  }
  EXPECT_EQ(project("out", {"--engine", "dask", "--scheduler-file", "at"}).status, 2);
  const ProgramRun unsigned_one = project("out", {"--engine", "dask", "--scheduler", "tls://127.0.0.1:8786"});
  EXPECT_EQ(unsigned_one.status, 2);
  EXPECT_NE(unsigned_one.err.find("distributed.comm.tls"), std::string::npos) << unsigned_one.err;
  EXPECT_EQ(project("out", {"--scheduler", "tcp://127.0.0.1:8786"}).status, 2);
  EXPECT_EQ(project("out", {"--engine", "dask", "--tls-ca", "ca.pem"}).status, 2);
  EXPECT_EQ(run({"project", "work", "nowhere", "features"}).status, 2);
  // A Python that sees no packages acts as one without Dask.
  fs::create_directories(work() / "bin");
  write_whole(work() / "bin" / "python3", "#!/bin/sh\nexec /usr/bin/python3 -S \"$@\"\n");
  fs::permissions(work() / "bin" / "python3", fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", ((work() / "bin").string() + ":" + path).c_str(), 1);
  const ProgramRun bare = project("out", {"--engine", "dask"});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(bare.status, 2);
  EXPECT_NE(bare.err.find("apt-get install python3-distributed"), std::string::npos) << bare.err;
}

}  // namespace
}  // namespace limen
