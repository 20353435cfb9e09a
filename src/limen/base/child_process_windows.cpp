// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cwctype>
#include <system_error>

#include <fmt/format.h>
#include <io.h>
#include <windows.h>

#include "limen/base/child_process.h"
#include "limen/base/system.h"

namespace limen {
namespace {

constexpr DWORD kKilled = 0xC000013A;
/// What a crash ends with is of this size, and what exceeds its time ends with the number after.
constexpr DWORD kFirstFault = 0x80000000;
constexpr DWORD kOutOfTime = ERROR_NOT_ENOUGH_QUOTA;

/// A word of a command line, quoted as the C runtime reads it.
std::wstring quoted(const std::string& word) {
  std::wstring text = L"\"";
  std::size_t slashes = 0;
  for (const wchar_t c : std::filesystem::path(word).wstring()) {
    if (c == L'"') text.append(slashes + 1, L'\\');
    slashes = c == L'\\' ? slashes + 1 : 0;
    text += c;
  }
  return text.append(slashes, L'\\') + L"\"";
}

/// The same file, for the child.
HANDLE inherited(int descriptor) {
  HANDLE copy = nullptr;
  HANDLE self = GetCurrentProcess();
  DuplicateHandle(self, reinterpret_cast<HANDLE>(_get_osfhandle(descriptor)), self, &copy, 0, TRUE,
                  DUPLICATE_SAME_ACCESS);
  return copy;
}

/// Its processes end with its handle.
HANDLE make_job(const ChildOptions& options) {
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
  limits.BasicLimitInformation.LimitFlags =
      JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE | JOB_OBJECT_LIMIT_DIE_ON_UNHANDLED_EXCEPTION;
  if (options.memory_bytes > 0.0) {
    limits.BasicLimitInformation.LimitFlags |= JOB_OBJECT_LIMIT_PROCESS_MEMORY;
    limits.ProcessMemoryLimit = static_cast<SIZE_T>(options.memory_bytes);
  }
  if (options.cpu_s > 0.0) {
    limits.BasicLimitInformation.LimitFlags |= JOB_OBJECT_LIMIT_PROCESS_TIME;
    limits.BasicLimitInformation.PerProcessUserTimeLimit.QuadPart =
        static_cast<LONGLONG>(1e7 * options.cpu_s);
  }
  HANDLE job = CreateJobObjectW(nullptr, nullptr);
  SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limits, sizeof limits);
  return job;
}

}  // namespace

struct ChildProcess::Handles {
  HANDLE job = nullptr;
  HANDLE process = nullptr;
};

ChildProcess::ChildProcess(const std::vector<std::string>& words, const ChildOptions& options)
    : handles_(new Handles{make_job(options), nullptr}) {
  std::wstring line;
  for (const std::string& word : words) line += (line.empty() ? L"" : L" ") + quoted(word);
  const int nowhere = open_nowhere();
  STARTUPINFOW start{};
  start.cb = sizeof start;
  start.dwFlags = STARTF_USESTDHANDLES;
  start.hStdInput = inherited(options.input < 0 ? nowhere : options.input);
  start.hStdOutput = inherited(options.output < 0 ? nowhere : options.output);
  start.hStdError = inherited(nowhere);
  PROCESS_INFORMATION made{};
  const std::wstring program = std::filesystem::path(words.front()).wstring();
  if (CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE,
                     CREATE_NO_WINDOW | CREATE_SUSPENDED, nullptr, nullptr, &start, &made) != 0) {
    handles_->process = made.hProcess;
    AssignProcessToJobObject(handles_->job, made.hProcess);
    ResumeThread(made.hThread);
    CloseHandle(made.hThread);
  } else {
    problem_ = std::system_category().message(static_cast<int>(GetLastError()));
  }
  for (HANDLE handle : {start.hStdInput, start.hStdOutput, start.hStdError}) CloseHandle(handle);
  _close(nowhere);
}

ChildProcess::~ChildProcess() {
  if (problem_.empty()) {
    kill();
    wait();
    CloseHandle(handles_->process);
  }
  CloseHandle(handles_->job);
  delete handles_;
}

void ChildProcess::kill() {
  TerminateJobObject(handles_->job, kKilled);
}

bool ChildProcess::ended() {
  return WaitForSingleObject(handles_->process, 0) == WAIT_OBJECT_0;
}

ChildEnd ChildProcess::wait() {
  DWORD status = 0;
  WaitForSingleObject(handles_->process, INFINITE);
  GetExitCodeProcess(handles_->process, &status);
  if (status >= kFirstFault || status == kOutOfTime)
    return {false, 0, fmt::format("was ended by the system with 0x{:08X}", status)};
  return {true, static_cast<int>(status), fmt::format("ended with status {}", status)};
}

}  // namespace limen
