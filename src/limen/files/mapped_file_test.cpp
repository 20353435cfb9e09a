// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/mapped_file.h"

#include <numeric>
#include <string>

#include "support/test_support.h"
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

long sum_of(std::string_view bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), 0L);
}

constexpr std::size_t kBytes = 1 << 20;

TEST(MappedFile, AFileThatShrinksReadsAsZerosAndIsStatedOf) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.bin", std::string(kBytes, '\1'));
  const MappedFile file(path);
  EXPECT_NO_THROW(require_inputs_whole());
  ASSERT_EQ(truncate(path.c_str(), 8192), 0);
  EXPECT_EQ(sum_of(file.bytes()), 8192);  // where the system would end the process
  EXPECT_EQ(sum_of(file.bytes()), 8192);
  try {
    with_whole_inputs([] { return 1; });
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::input);
    EXPECT_EQ(error.where(), path.string());
    EXPECT_NE(error.problem().find("became shorter"), std::string::npos);
  }
}

TEST(MappedFile, WithinItsLastPageItIsStatedOfToo) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.bin", "0123456789");
  const MappedFile file(path);
  ASSERT_EQ(truncate(path.c_str(), 5), 0);
  EXPECT_THROW(require_inputs_whole(), Error);
}

TEST(MappedFile, ThatItShrankCountsBeforeWhatWasMadeOfIt) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.bin", std::string(kBytes, '\1'));
  const MappedFile file(path);
  const auto parse = [&](Fault fault) {
    return [&file, &path, fault] {
      EXPECT_EQ(truncate(path.c_str(), 1), 0);
      if (sum_of(file.bytes()) > 0) throw Error("line 7 holds no number", "a.bin", "mend it", fault);
      return 0;
    };
  };
  try {
    with_whole_inputs(parse(Fault::input));
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("became shorter"), std::string::npos);
  }
  try {
    with_whole_inputs(parse(Fault::cancelled));
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::cancelled);
  }
}

TEST(MappedFile, NothingThatWasMadeOfItIsPutInPlace) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.bin", std::string(kBytes, '\1'));
  {
    const MappedFile file(path);
    ASSERT_EQ(truncate(path.c_str(), 4096), 0);
    EXPECT_THROW(write_file(folder / "copy.bin", file.bytes()), Error);
    EXPECT_FALSE(std::filesystem::exists(folder / "copy.bin"));
  }
  EXPECT_NO_THROW(write_file(folder / "copy.bin", "later"));
}

TEST(MappedFile, ABusErrorElsewhereEndsTheProcessAsEver) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.bin", std::string(kBytes, '\1'));
  const MappedFile other(path);
  const pid_t child = fork();
  if (child == 0) {
    const int descriptor = memfd_create("none", MFD_CLOEXEC);
    const auto* bytes = static_cast<const char*>(mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE, descriptor, 0));
    _exit(bytes[0]);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) != 0);
}

TEST(MappedFile, APipeIsRefusedAndNotWaitedFor) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::filesystem::path& path : {folder / "pipe", std::filesystem::path("/dev/zero")}) {
    try {
      const MappedFile file(path);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::input);
      EXPECT_NE(error.problem().find("is a pipe or a device"), std::string::npos) << error.problem();
    }
  }
}

}  // namespace
}  // namespace limen
