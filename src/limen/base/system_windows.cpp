// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>

#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#include <windows.h>

#include "limen/base/system.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr int kOwn = _O_BINARY | _O_NOINHERIT;

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(_get_osfhandle(descriptor));
}

/// The system's functions take no more at a time.
unsigned piece_of(std::size_t size) {
  return static_cast<unsigned>(std::min(size, std::size_t{1} << 30U));
}

int open_file(const fs::path& path, int flags) {
  std::error_code ignored;
  const int descriptor = _wopen(path.c_str(), flags | kOwn, _S_IREAD | _S_IWRITE);
  if (descriptor < 0 && errno == EACCES && fs::is_directory(path, ignored)) errno = EISDIR;
  return descriptor;
}

/// A name that no file has yet: of this process, and counted.
std::wstring own_name(const wchar_t* beginning) {
  static std::atomic<unsigned> counter{0};
  return beginning + std::to_wstring(GetCurrentProcessId()) + L"-" + std::to_wstring(counter++);
}

fs::path file_of(HMODULE module) {
  std::wstring name(32768, L'\0');
  name.resize(GetModuleFileNameW(module, name.data(), static_cast<DWORD>(name.size())));
  return name;
}

}  // namespace

int open_to_read(const fs::path& path) {
  return open_file(path, _O_RDONLY);
}

int open_to_write(const fs::path& path) {
  return open_file(path, _O_WRONLY);
}

int make_file(const fs::path& path) {
  return open_file(path, _O_WRONLY | _O_CREAT | _O_EXCL);
}

int make_nameless_file() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  return open_file(folder / own_name(L"limen-"), _O_RDWR | _O_CREAT | _O_EXCL | _O_TEMPORARY);
}

int open_nowhere() {
  return open_file(L"NUL", _O_RDWR);
}

std::ptrdiff_t read_some(int descriptor, char* bytes, std::size_t size) {
  return _read(descriptor, bytes, piece_of(size));
}

std::ptrdiff_t write_some(int descriptor, std::string_view bytes) {
  return _write(descriptor, bytes.data(), piece_of(bytes.size()));
}

std::ptrdiff_t write_at(int descriptor, std::string_view bytes, std::uint64_t offset) {
  const __int64 before = _telli64(descriptor);
  if (before < 0 || _lseeki64(descriptor, static_cast<__int64>(offset), SEEK_SET) < 0) return -1;
  const std::ptrdiff_t written = write_some(descriptor, bytes);
  return _lseeki64(descriptor, before, SEEK_SET) < 0 ? -1 : written;
}

bool flush_to_disk(int descriptor) {
  return _commit(descriptor) == 0;
}

void keep_bytes(int descriptor) {
  _setmode(descriptor, _O_BINARY);
}

int duplicate(int descriptor) {
  const int other = _dup(descriptor);
  keep_bytes(other);
  keep_from_children(other);
  return other;
}

bool keep_from_children(int descriptor) {
  return SetHandleInformation(handle_of(descriptor), HANDLE_FLAG_INHERIT, 0) != 0;
}

bool hold(int /*descriptor*/) {
  return true;  // a file that is open cannot be removed
}

void remove_unless_held(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(fs::symlink_status(path, ignored))) fs::remove(path, ignored);
}

bool rename_over(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) errno = error.default_error_condition().value();
  return !error;
}

fs::path make_scratch_folder(const fs::path& beginning) {
  std::error_code error;
  const fs::path made = beginning.wstring() + own_name(L"-");
  if (fs::create_directory(made, error)) return made;
  errno = error ? error.default_error_condition().value() : EEXIST;
  return {};
}

unsigned mode_of(const fs::path& path) {
  struct _stat64 status {};
  return _wstat64(path.c_str(), &status) == 0 ? status.st_mode : 0;
}

bool may_read(const fs::path& path) {
  return _waccess(path.c_str(), 4) == 0;
}

bool may_run(const fs::path& path) {
  std::error_code ignored;
  return !path.empty() && fs::is_regular_file(path, ignored);
}

fs::path own_program() {
  return file_of(nullptr);
}

fs::path own_library() {
  HMODULE module = nullptr;
  constexpr DWORD kFlags =
      GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
  if (GetModuleHandleExW(kFlags, reinterpret_cast<const wchar_t*>(&own_library), &module) == 0) return {};
  return file_of(module);
}

std::vector<fs::path> program_folders() {
  std::vector<fs::path> folders;
  // Where Windows has its browsers, which are in no PATH.
  for (const wchar_t* root : {L"ProgramFiles", L"ProgramFiles(x86)", L"LocalAppData"}) {
    const wchar_t* named = _wgetenv(root);
    if (named == nullptr) continue;
    folders.push_back(fs::path(named) / "Google/Chrome/Application");
    folders.push_back(fs::path(named) / "Microsoft/Edge/Application");
  }
  const wchar_t* path = _wgetenv(L"PATH");
  const std::wstring all = path == nullptr ? L"" : path;
  for (std::size_t at = 0; at <= all.size();) {
    const std::size_t end = std::min(all.find(L';', at), all.size());
    folders.emplace_back(all.substr(at, end - at));
    at = end + 1;
  }
  return folders;
}

std::string_view program_ending() {
  return ".exe";
}

bool end_with_parent(const std::string& /*number*/) {
  return true;
}

bool is_administrator() {
  return false;
}

void after_fork(void (* /*action*/)()) {}

std::optional<PipeEnds> make_pipe() {
  std::array<int, 2> ends{};
  if (_pipe(ends.data(), 1U << 16U, kOwn) != 0) return {};
  return PipeEnds{ends[0], ends[1]};
}

bool wait_to_read(int descriptor, int milliseconds) {
  constexpr int kLook_ms = 5;
  for (int waited = 0;; waited += kLook_ms) {
    DWORD there = 0;
    // A pipe whose other end is closed cannot be looked into: its end is to be read.
    if (PeekNamedPipe(handle_of(descriptor), nullptr, 0, nullptr, &there, nullptr) == 0 || there > 0)
      return true;
    if (waited >= milliseconds) return false;
    Sleep(kLook_ms);
  }
}

double log_gamma(double x) {
  return std::lgamma(x);  // of numbers above 0 only: all write the same sign
}

void* load_library(const char* name) {
  return reinterpret_cast<void*>(LoadLibraryExA(name, nullptr, LOAD_LIBRARY_SEARCH_DEFAULT_DIRS));
}

void* function_in(void* library, const char* name) {
  return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(library), name));
}

}  // namespace limen
