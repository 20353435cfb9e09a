// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <mutex>
#include <vector>

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/guarded_mapping.h"

namespace limen {
namespace {

/// What the signal handler may look at: no locks, no allocation. More mappings than this are not guarded.
struct Slot {
  std::atomic<bool> taken{false};
  std::atomic<std::uintptr_t> begin{0};
  std::atomic<std::uintptr_t> end{0};
  std::atomic<bool> broken{false};
};
constexpr std::size_t kSlots = 512;
std::array<Slot, kSlots> slots;
std::uintptr_t page_bytes = 4096;
struct sigaction previous_action {};

std::mutex live_mutex;
std::vector<const GuardedMapping*>& live_mappings() {
  static std::vector<const GuardedMapping*> live;
  return live;
}

/// Puts zeros where the file has no bytes any more, from the page of `address` to the mapping's end.
bool mended(std::uintptr_t address) {
  for (Slot& slot : slots) {
    const std::uintptr_t end = slot.end.load();
    if (address < slot.begin.load() || address >= end) continue;
    const std::uintptr_t page = address - address % page_bytes;
    void* at = reinterpret_cast<void*>(page);  // NOLINT(performance-no-int-to-ptr): a page of a known mapping
    slot.broken.store(true);
    return mmap(at, end - page, PROT_READ, MAP_FIXED | MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
  }
  return false;
}

/// A bus error that is not ours goes to whoever cared for it before us.
void on_bus_error(int signal, siginfo_t* information, void* context) {
  const int error_number = errno;
  const bool ours = mended(reinterpret_cast<std::uintptr_t>(information->si_addr));
  errno = error_number;
  if (ours) return;
  if ((previous_action.sa_flags & SA_SIGINFO) != 0) {
    previous_action.sa_sigaction(signal, information, context);
  } else if (previous_action.sa_handler != SIG_DFL && previous_action.sa_handler != SIG_IGN) {
    previous_action.sa_handler(signal);
  } else {
    sigaction(SIGBUS, &previous_action, nullptr);  // the faulty access is tried again, and ends the process
  }
}

void install_handler() {
  static std::once_flag once;
  std::call_once(once, [] {
    page_bytes = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    sigemptyset(&action.sa_mask);
    sigaction(SIGBUS, &action, &previous_action);
  });
}

/// kSlots where all are taken.
std::size_t take_slot(const char* data, std::size_t size) {
  const auto begin = reinterpret_cast<std::uintptr_t>(data);
  for (std::size_t i = 0; i < kSlots; ++i) {
    if (slots[i].taken.exchange(true)) continue;
    slots[i].broken.store(false);
    slots[i].begin.store(begin);
    slots[i].end.store(begin + (size + page_bytes - 1) / page_bytes * page_bytes);
    return i;
  }
  return kSlots;
}

void free_slot(std::size_t slot) {
  if (slot >= kSlots) return;
  slots[slot].end.store(0);
  slots[slot].begin.store(0);
  slots[slot].taken.store(false);
}

}  // namespace

GuardedMapping::GuardedMapping(int descriptor, std::size_t size, std::string name)
    : descriptor_(descriptor), size_(size), name_(std::move(name)), slot_(kSlots) {
  install_handler();
  void* address = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
  if (address == MAP_FAILED) return;
  data_ = static_cast<char*>(address);
  madvise(address, size_, MADV_SEQUENTIAL);  // advice only: no harm where it is not taken
  slot_ = take_slot(data_, size_);
  const std::scoped_lock lock(live_mutex);
  live_mappings().push_back(this);
}

GuardedMapping::~GuardedMapping() {
  if (data_ != nullptr) {
    const std::scoped_lock lock(live_mutex);
    std::erase(live_mappings(), this);
    free_slot(slot_);
    munmap(data_, size_);
  }
  close(descriptor_);
}

void GuardedMapping::forget() const {
  if (data_ != nullptr) madvise(data_, size_, MADV_DONTNEED);
}

bool GuardedMapping::whole() const {
  if (data_ == nullptr) return true;
  struct stat status {};
  if (slot_ < kSlots && slots[slot_].broken.load()) return false;
  return fstat(descriptor_, &status) != 0 || static_cast<std::size_t>(status.st_size) >= size_;
}

void require_inputs_whole() {
  const std::scoped_lock lock(live_mutex);
  for (const GuardedMapping* mapping : live_mappings()) {
    if (mapping->whole()) continue;
    throw Error("the file became shorter while it was read, or its disk failed", mapping->name(),
                "wait until the program that writes it has finished, and try again");
  }
}

}  // namespace limen
