// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// What limen asks of the operating system beyond the standard library: system_posix.cpp and
// system_windows.cpp. Descriptors are those of POSIX, and are not inherited. Where nothing else is said, what
// fails returns -1 or false and sets errno.
namespace limen {

/// Waits for nobody who would write to a pipe.
int open_to_read(const std::filesystem::path& path);
/// A file that is there.
int open_to_write(const std::filesystem::path& path);
/// A file that was not there.
int make_file(const std::filesystem::path& path);
/// A file without a name, to be written and read; it goes with its descriptor.
int make_nameless_file();
/// Takes what is written, and has nothing to read.
int open_nowhere();

std::ptrdiff_t read_some(int descriptor, char* bytes, std::size_t size);
std::ptrdiff_t write_some(int descriptor, std::string_view bytes);
/// At `offset` from the beginning.
std::ptrdiff_t write_at(int descriptor, std::string_view bytes, std::uint64_t offset);
bool flush_to_disk(int descriptor);
/// A descriptor that this process was given: its bytes are not changed (as the ends of lines are on Windows).
void keep_bytes(int descriptor);
int duplicate(int descriptor);
/// False also where it is not open.
bool keep_from_children(int descriptor);

/// Locks a file that make_file() made; false where another process took it for one that was left behind.
bool hold(int descriptor);
/// Removes a regular file of this user that nobody holds.
void remove_unless_held(const std::filesystem::path& path);
/// Whether a file that is open can be given another name.
#ifdef _WIN32
inline constexpr bool kRenamesHeldFiles = false;
#else
inline constexpr bool kRenamesHeldFiles = true;
#endif
/// Gives a file another name, also that of a file that is there.
bool rename_over(const std::filesystem::path& from, const std::filesystem::path& to);
/// A new folder of this user alone, whose name begins with `beginning`; empty where it fails.
std::filesystem::path make_scratch_folder(const std::filesystem::path& beginning);

/// The kind of a file, as st_mode; 0 where it fails.
unsigned mode_of(const std::filesystem::path& path);
bool may_read(const std::filesystem::path& path);
bool may_run(const std::filesystem::path& path);

/// The file of this program; and that of the library this code lies in, where that is another.
std::filesystem::path own_program();
std::filesystem::path own_library();
/// The folders of PATH.
std::vector<std::filesystem::path> program_folders();
/// What the name of a program ends with.
std::string_view program_ending();

/// The kernel ends this process with its parent. False where the parent is not (any more) the process of this
/// number.
bool end_with_parent(const std::string& number);
bool is_administrator();
/// Done in each child that is a copy of this process.
void after_fork(void (*action)());

/// Two descriptors: what is written to the second can be read from the first.
struct PipeEnds {
  int read = -1;
  int write = -1;
};
std::optional<PipeEnds> make_pipe();
/// Whether there is something to read, or the end; waits so long for it.
bool wait_to_read(int descriptor, int milliseconds);

/// std::lgamma, which any number of threads may call at once: that may write the sign to a global variable.
double log_gamma(double x);

/// A library that is looked for as the system does, and a function in it; null where there is none.
void* load_library(const char* name);
void* function_in(void* library, const char* name);

}  // namespace limen
