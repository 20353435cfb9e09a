// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// limen serve as a program meets it that does not mean well: who is let in, what can be reached, what is too
// much, and how it ends. What a browser does with its page is in tests/browser/serve_test.mjs.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <memory>
#include <sstream>
#include <thread>

#include "running_server.h"

#include "limen/base/random.h"
#include "limen/cli/serve/server.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

TEST_F(ServeTest, LetsInOnlyWhoKnowsTheAddress) {
  EXPECT_EQ(status_in(server().ask("GET", "")), 200);
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
  EXPECT_EQ(status_in(server().say("GET / HTTP/1.1\r\n" + server().host() + "\r\n")), 404);
  EXPECT_EQ(status_in(server().say("GET /state HTTP/1.1\r\n" + server().host() + "\r\n")), 404);
  EXPECT_EQ(status_in(server().say("GET /" + std::string(32, '0') + "/state HTTP/1.1\r\n" + server().host() +
                                   "\r\n")),
            404);
  EXPECT_EQ(
      status_in(server().say("GET /" + server().token() + "/state HTTP/1.1\r\nHost: evil.example\r\n\r\n")),
      403);
  EXPECT_EQ(status_in(server().say("GET /" + server().token() + "/state HTTP/1.1\r\n\r\n")), 403);
  EXPECT_EQ(status_in(server().ask("POST", "jobs", "{}", "Origin: http://evil.example\r\n")), 403);
  EXPECT_EQ(status_in(server().ask("PUT", "files/a", "x", "Sec-Fetch-Site: cross-site\r\n")), 403);
  EXPECT_FALSE(fs::exists(work() / "site" / "files" / "a"));
}

TEST_F(ServeTest, ListensOnThisMachineAlone) {
  // The kernel's own list: the address 127.0.0.1, as it writes it, and in no other line that port.
  char port[8];
  std::snprintf(port, sizeof port, ":%04X", server().port());
  std::istringstream table(read_whole("/proc/net/tcp"));
  int listening = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string number;
    std::string local;
    std::string remote;
    std::string state;
    words >> number >> local >> remote >> state;
    if (state != "0A" || local.size() < 5 || local.substr(local.size() - 5) != port) continue;
    ++listening;
    EXPECT_EQ(local, std::string("0100007F") + port);
  }
  EXPECT_EQ(listening, 1);
}

TEST_F(ServeTest, NothingButItsFilesCanBeReached) {
  write_whole(work() / "secret", "the secret");
  write_whole(work() / "site" / "files" / "a.ply", "of a file");
  fs::create_symlink(work() / "secret", work() / "site" / "files" / "link");
  fs::create_directories(work() / "site" / "results" / "1" / "store");
  write_whole(work() / "site" / "results" / "1" / "store" / "x", "the secret");
  fs::create_directory_symlink(work(), work() / "site" / "results" / "7");
  EXPECT_NE(server().ask("GET", "files/a.ply").find("of a file"), std::string::npos);
  for (const std::string path : {"files/../../secret",
                                 "files/..%2f..%2fsecret",
                                 "files/%2e%2e/%2e%2e/secret",
                                 "../secret",
                                 "files/link",
                                 "results/../secret",
                                 "results/1/../../../secret",
                                 "results/1/store",
                                 "results/1/store/x",
                                 "results/1/store%2fx",
                                 "results/7/secret",
                                 "results/-1/x",
                                 "results/1x/x",
                                 "files//a.ply",
                                 "files/",
                                 "files",
                                 "results",
                                 "secret",
                                 "files/.",
                                 "files/..",
                                 "files/%00",
                                 "files/a.ply%00.txt",
                                 "results/99999999999999999999/x"}) {
    const std::string answer = server().ask("GET", path);
    EXPECT_GE(status_in(answer), 400) << path;
    EXPECT_EQ(answer.find("the secret"), std::string::npos) << path;
  }
  EXPECT_GE(status_in(server().ask("DELETE", "files/..%2fresults")), 400);
  EXPECT_GE(status_in(server().ask("DELETE", "files/link")), 400);
  EXPECT_TRUE(fs::exists(work() / "secret"));
  EXPECT_EQ(status_in(server().ask("DELETE", "files/a.ply")), 200);
  EXPECT_FALSE(fs::exists(work() / "site" / "files" / "a.ply"));
}

TEST_F(ServeTest, UploadsHaveBoundsAndAppearWhole) {
  std::string bytes;
  while (bytes.size() < 300000) bytes += "1.25 2.5 3.75\n";
  EXPECT_EQ(status_in(server().ask("PUT", "files/a.xyz", bytes)), 201);
  EXPECT_EQ(read_whole(work() / "site" / "files" / "a.xyz"), bytes);
  EXPECT_EQ(status_in(server().ask("PUT", "files/a.xyz", "other")), 409);
  EXPECT_EQ(status_in(server().ask("PUT", "files/junk.bin", std::string(3000, 'a'))), 415);
  EXPECT_EQ(status_in(server().ask("PUT", "files/large.bin", std::string(1000001, 'b'))), 413);
  EXPECT_EQ(status_in(server().ask("PUT", "files/b%20c.bin", "x")), 400);
  EXPECT_EQ(status_in(server().ask("PUT", "results/1/x", "x")), 405);
  EXPECT_EQ(status_in(server().say("PUT /" + server().token() + "/files/c.bin HTTP/1.1\r\n" +
                                   server().host() + "\r\n")),
            411);
  // Who goes in the middle leaves nothing.
  const int descriptor = server().connected();
  const std::string half = "PUT /" + server().token() + "/files/half.bin HTTP/1.1\r\n" + server().host() +
                           "Content-Length: 1000\r\n\r\nonly this";
  ASSERT_EQ(send(descriptor, half.data(), half.size(), MSG_NOSIGNAL), static_cast<ssize_t>(half.size()));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  close(descriptor);
  // Of two uploads of one name the first that is whole counts.
  const int late = server().connected();
  const std::string begun = "PUT /" + server().token() + "/files/race.xyz HTTP/1.1\r\n" + server().host() +
                            "Content-Length: 12\r\n\r\n1 2 3\n";
  ASSERT_EQ(send(late, begun.data(), begun.size(), MSG_NOSIGNAL), static_cast<ssize_t>(begun.size()));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(status_in(server().ask("PUT", "files/race.xyz", "7 8 9\n")), 201);
  ASSERT_EQ(send(late, "4 5 6\n", 6, MSG_NOSIGNAL), 6);
  std::string reply(64, '\0');
  ASSERT_GT(recv(late, reply.data(), reply.size(), 0), 0);
  EXPECT_EQ(status_in(reply), 409);
  close(late);
  EXPECT_EQ(read_whole(work() / "site" / "files" / "race.xyz"), "7 8 9\n");
  EXPECT_EQ(status_in(server().ask("DELETE", "files/race.xyz")), 200);
  server().state_with("a.xyz");
  for (int k = 0; k < 100 && std::distance(fs::directory_iterator(work() / "site" / "files"), {}) > 1; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(std::distance(fs::directory_iterator(work() / "site" / "files"), {}), 1);
  EXPECT_EQ(status_in(server().ask("POST", "jobs", std::string(70000, ' '))), 413);
}

TEST_F(ServeTest, WorkIsMadeOfItsOwnFilesAlone) {
  for (const char* name : {"a.xyz", "b.xyz"}) write_whole(work() / "site" / "files" / name, "0 0 0\n");
  for (
      const std::string work_asked :
      {"",
       "x",
       "[]",
       "{}",
       R"({"kind": 1})",
       R"({"kind": "simulate"})",
       R"({"kind": "register"})",
       R"({"kind": "register", "source": "a.xyz", "target": "a.xyz"})",
       R"({"kind": "register", "source": "a.xyz", "target": "../a.xyz"})",
       R"({"kind": "register", "source": "a.xyz", "target": "--help"})",
       R"({"kind": "project", "files": []})",
       R"({"kind": "project", "files": ["missing"]})",
       R"({"kind": "project", "files": "a.xyz"})",
       R"({"kind": "project", "files": ["a.xyz", "b.xyz"], "control": "../a.xyz"})",
       R"({"kind": "project", "files": ["a.xyz", "b.xyz"], "poses": "--help"})",
       R"({"kind": "project", "files": ["a.xyz", "b.xyz"], "sphere": 199})",
       R"({"kind": "project", "files": ["a.xyz", "b.xyz"], "board": "300"})",
       R"({"kind": "register", "source": "a.xyz", "target": "b.xyz", "no_repeats": "none"})",
       R"({"kind": "deviation", "of": 1})",
       R"({"kind": "view", "files": [7]})",
       R"({"kind": "view", "of": 5})",
       R"({"kind": "again", "of": "x"})",
       R"({"kind": "place", "of": -1})",
       R"({"kind": "decide", "of": 1e99})",
       R"({"kind": "plan", "scan": "../a.xyz"})",
       R"({"kind": "link", "source": "a.xyz", "target": "b.xyz"})",
       R"({"kind": "link", "source": "a.xyz", "target": "b.xyz", "points": [["--help"]]})",
       R"({"kind": "link", "source": "a.xyz", "target": "b.xyz", "points": [[0,0,0,0,0,0],[1,0,0,1,0,0],[2,0,0,2,0,0]]})",
       R"({"kind": "decide", "of": 1, "link": 1})"}) {
    const int status = status_in(server().ask("POST", "jobs", work_asked));
    EXPECT_TRUE(status >= 400 && status < 500) << work_asked << " " << status;
  }
  EXPECT_EQ(status_in(server().ask("POST", "jobs/1/stop")), 404);
  EXPECT_NE(server().ask("GET", "state").find("\"jobs\": []"), std::string::npos);
}

TEST_F(ServeTest, WorkIsDoneAndFoundAgainByTheNext) {
  ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "2000"}).status, 0);
  for (const std::string name : {"indoor_00.ply", "indoor_01.ply"})
    EXPECT_EQ(status_in(server().ask("PUT", "files/" + name, read_whole(work() / "room" / name))), 201);
  const std::string asked = R"({"kind": "register", "source": "indoor_00.ply", "target": "indoor_01.ply"})";
  EXPECT_EQ(status_in(server().ask("POST", "jobs", asked)), 202);
  EXPECT_NE(server().state_with("\"state\": \"done\"").find("result.json"), std::string::npos);
  EXPECT_EQ(server().ask("GET", "results/1/result.json").substr(0, 12), "HTTP/1.1 200");
  const std::string report = server().ask("GET", "results/1/report.html");
  EXPECT_NE(report.find("Content-Security-Policy: sandbox"), std::string::npos);
  EXPECT_EQ(server().end(SIGINT), 0);
  EXPECT_NE(server().said().find("ended"), std::string::npos);
  const RunningServer next(work(), "site");
  EXPECT_NE(next.ask("GET", "state").find("indoor_00.ply into indoor_01.ply"), std::string::npos);
  EXPECT_NE(next.token(), server().token());
}

TEST_F(ServeTest, AProjectTakesControlPointsAndIsComparedWithItsModel) {
  ASSERT_EQ(
      run({"simulate", "office", "--room", "unique", "-o", "office", "--points-indoor", "60000"}).status, 0);
  for (const std::string name : {"scan_01.ply", "model.ifc"})
    fs::copy(work() / "office" / name, work() / "site" / "files" / name);
  write_whole(work() / "site" / "files" / "at.csv", "file,x,y,z,sigma\nfiles/scan_01.ply,0,0,0,1000\n");
  const std::string asked =
      R"({"kind": "project", "files": ["scan_01.ply", "model.ifc"], "poses": "at.csv", "no_repeats": true})";
  EXPECT_EQ(status_in(server().ask("POST", "jobs", asked)), 202);
  EXPECT_NE(server().state_with("\"state\": \"done\"").find("project.json"), std::string::npos);
  const std::string project = read_whole(work() / "site" / "results" / "1" / "project.json");
  EXPECT_NE(project.find("\"repeats\": \"none\""), std::string::npos);
  EXPECT_NE(project.find("at.csv"), std::string::npos);
  EXPECT_EQ(status_in(server().ask("POST", "jobs", R"({"kind": "deviation", "of": 1})")), 202);
  EXPECT_NE(server().state_with("deviation.csv").find("\"state\": \"done\""), std::string::npos);
  // Where the model was the source, it is still the scan that is moved and measured.
  const std::string turned = R"({"kind": "register", "source": "model.ifc", "target": "scan_01.ply"})";
  EXPECT_EQ(status_in(server().ask("POST", "jobs", turned)), 202);
  EXPECT_NE(server().state_with("transform.txt").find("model.ifc into scan_01.ply"), std::string::npos);
  EXPECT_EQ(status_in(server().ask("POST", "jobs", R"({"kind": "place", "of": 3})")), 202);
  EXPECT_EQ(status_in(server().ask("POST", "jobs", R"({"kind": "deviation", "of": 3, "pdf": true})")), 202);
  EXPECT_NE(server().state_with("scan_01_placed.ply").find("deviation"), std::string::npos);
  for (int k = 0; k < 600 && !fs::exists(work() / "site" / "results" / "5.json"); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(fs::exists(work() / "site" / "results" / "5" / "deviation.csv"));
}

TEST_F(ServeTest, WhatRunsEndsWithIt) {
  // Work that by itself would not end within the test.
  write_whole(work() / "endless",
              "#!/bin/sh\necho $$ > \"" + (work() / "job").string() + "\"\nexec sleep 600\n");
  fs::permissions(work() / "endless", fs::perms::owner_all);
  setenv("LIMEN_PROGRAM_FILE", (work() / "endless").c_str(), 1);
  RunningServer endless(work(), "other");
  unsetenv("LIMEN_PROGRAM_FILE");
  ASSERT_EQ(endless.token().size(), 32U) << endless.said();
  for (const std::string name : {"a.xyz", "b.xyz"}) write_whole(work() / "other" / "files" / name, "0 0 0\n");
  const std::string asked = R"({"kind": "register", "source": "a.xyz", "target": "b.xyz"})";
  EXPECT_EQ(status_in(endless.ask("POST", "jobs", asked)), 202);
  EXPECT_EQ(status_in(endless.ask("POST", "jobs", asked)), 202);
  endless.state_with("\"state\": \"running\"");
  EXPECT_EQ(status_in(endless.ask("DELETE", "files/b.xyz")), 409);
  for (int k = 0; k < 600 && read_whole(work() / "job").find('\n') == std::string::npos; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const pid_t job = std::stoi(read_whole(work() / "job"));
  EXPECT_EQ(kill(job, 0), 0);
  EXPECT_EQ(endless.end(SIGTERM), 0);
  EXPECT_EQ(kill(job, 0), -1);
  EXPECT_NE(read_whole(work() / "other" / "results" / "1.json").find("\"stopped\""), std::string::npos);
  EXPECT_NE(read_whole(work() / "other" / "results" / "2.json").find("\"stopped\""), std::string::npos);
}

TEST_F(ServeTest, OneServerAFolder) {
  const ProgramRun second = run({"serve", "site"});
  EXPECT_EQ(second.status, 2);
  EXPECT_NE(second.err.find("is already served"), std::string::npos) << second.err;
}

TEST_F(ServeTest, KeptWorkOfSomebodyElseIsLookedAtAsNewWorkIs) {
  const fs::path site = work() / "hostile";
  fs::create_directories(site / "files");
  fs::create_directories(site / "results" / "4");
  fs::create_directories(work() / "outside");
  for (const std::string name : {"a.xyz", "b.xyz"}) write_whole(site / "files" / name, "0 0 0\n");
  fs::create_directory_symlink(work() / "outside", site / "results" / "4" / "store");
  const std::string rest = R"("title": "t", "status": 0, "seconds": 0.0, "said": "", )";
  const std::string words =
      R"("words": ["simulate", "room", "-o", "../outside/room", "--points-indoor", "2000"])";
  const auto keep = [&](int id, const std::string& more) {
    write_whole(site / "results" / (std::to_string(id) + ".json"),
                "{\"id\": " + std::to_string(id) + ", \"kind\": \"project\", " + rest + more + "}");
  };
  keep(1, R"("state": "queued", )" + words);
  keep(2, R"("state": "done", )" + words);
  keep(3, R"("state": "done", "asked": {"kind": "project", "files": ["../../outside/x", "--output"]})");
  keep(4, R"("state": "done", "asked": {"kind": "project", "files": ["a.xyz", "b.xyz"]})");
  keep(5, R"("state": "done", "asked": {"kind": "view", "files": ["a.xyz"]})");
  keep(6, R"("state": "done", "asked": )" + std::string(130000, '[') + std::string(130000, ']'));
  RunningServer server(work(), "hostile");
  ASSERT_EQ(server.token().size(), 32U) << server.said();
  EXPECT_EQ(server.ask("GET", "state").find("queued"), std::string::npos);
  for (int id = 1; id <= 6; ++id) {
    const std::string again = "{\"kind\": \"again\", \"of\": " + std::to_string(id) + "}";
    const int status = status_in(server.ask("POST", "jobs", again));
    EXPECT_TRUE(status >= 400 && status < 500) << id << " " << status;
  }
  // A place is never distinguished from kept words either.
  EXPECT_GE(status_in(server.ask("POST", "jobs", R"({"kind": "decide", "of": 4, "answer": "accept a b"})")),
            400);
  EXPECT_EQ(server.end(SIGINT), 0);
  EXPECT_TRUE(fs::is_empty(work() / "outside"));
}

bool is_closed(int descriptor) {
  char byte = 0;
  return recv(descriptor, &byte, 1, MSG_DONTWAIT | MSG_PEEK) == 0;
}

/// As many connections as there are places, each of which begins with these bytes and stops.
std::vector<int> that_fall_silent(const RunningServer& server, std::size_t count, const std::string& bytes) {
  std::vector<int> descriptors;
  for (std::size_t k = 0; k < count; ++k) {
    descriptors.push_back(server.connected());
    EXPECT_EQ(send(descriptors.back(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  return descriptors;
}

TEST_F(ServeTest, ASilentConnectionIsLeftForANewOne) {
  std::vector<int> silent = that_fall_silent(server(), kMostConnections, "");
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
  EXPECT_EQ(std::count_if(silent.begin(), silent.end(), is_closed), 1);
  EXPECT_TRUE(is_closed(silent.front()));
  for (const int descriptor : silent) close(descriptor);
}

TEST_F(ServeTest, OfUploadsThatStallOneIsLeftAndSilentStrangersGoFirst) {
  const std::string head = "PUT /" + server().token() + "/files/half.bin HTTP/1.1\r\n" + server().host() +
                           "Content-Length: 1000\r\n\r\nonly this";
  std::vector<int> stalled = that_fall_silent(server(), kMostConnections - 1, head);
  const std::vector<int> stranger = that_fall_silent(server(), 1, "GET ");
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
  EXPECT_EQ(std::count_if(stalled.begin(), stalled.end(), is_closed), 0);
  EXPECT_TRUE(is_closed(stranger.front()));
  stalled.push_back(server().connected());
  const std::string same = head;
  EXPECT_EQ(send(stalled.back(), same.data(), same.size(), MSG_NOSIGNAL), static_cast<ssize_t>(same.size()));
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
  EXPECT_EQ(std::count_if(stalled.begin(), stalled.end(), is_closed), 1);
  for (const int descriptor : stalled) close(descriptor);
  close(stranger.front());
}

TEST_F(ServeTest, NoBytesBringItDown) {
  RandomStream random(3, 0);
  const std::string good = "POST /" + server().token() + "/jobs HTTP/1.1\r\n" + server().host() +
                           "Content-Length: 16\r\n\r\n{\"kind\": \"view\"}";
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = good;
    for (int k = 0; k <= trial % 8; ++k) {
      const std::size_t at = random.below(static_cast<std::uint32_t>(bytes.size()));
      if (random.below(2) == 0)
        bytes[at] = static_cast<char>(random.below(256));
      else
        bytes.erase(at, 1);
    }
    const int descriptor = server().connected();
    if (send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) ADD_FAILURE();
    shutdown(descriptor, SHUT_WR);
    const int status = status_in(RunningServer::rest_of(descriptor));
    EXPECT_TRUE(status == 0 || (status >= 200 && status < 600 && status != 500)) << status;
    close(descriptor);
  }
  // As many as there are places, and more, that say nothing: who comes after them is served all the same.
  std::vector<int> silent;
  for (int k = 0; k < 30; ++k) silent.push_back(server().connected());
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
  for (const int descriptor : silent) close(descriptor);
  EXPECT_EQ(status_in(server().say("GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n")), 431);
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
}

}  // namespace
}  // namespace limen
