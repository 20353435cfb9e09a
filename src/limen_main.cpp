// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#include "limen/cli/program.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

// Scans come and go as blocks of many megabytes. Without these two measures the system's work to make and to
// zero their pages is a third of a pair's time. The library leaves its host's allocator alone.

namespace {

/// Memory touched once is used again; it is not given back.
void keep_memory() {
#ifdef __GLIBC__
  constexpr int kMostOfHeapBytes = 8 << 20;  // larger blocks are the system's own: whole clouds, few and long
  constexpr int kKeptBytes = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, kMostOfHeapBytes);
  mallopt(M_TRIM_THRESHOLD, kKeptBytes);
#endif
}

}  // namespace

// The address sanitizer has its own.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
#include <sys/mman.h>

namespace {

constexpr std::size_t kHugePageBytes = std::size_t{2} << 20U;

/// Asks for huge pages under large blocks: those that lie whole within one. Advice only: no harm where it is
/// not taken.
void* new_block(std::size_t size) noexcept {
  void* const block = std::malloc(size > 0 ? size : 1);
  void* first = block;
  std::size_t space = size;
  if (block != nullptr && size >= kHugePageBytes &&
      std::align(kHugePageBytes, kHugePageBytes, first, space) != nullptr)
    madvise(first, space / kHugePageBytes * kHugePageBytes, MADV_HUGEPAGE);
  return block;
}

}  // namespace

void* operator new(std::size_t size) {
  if (void* const block = new_block(size)) return block;
  throw std::bad_alloc();
}

void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return new_block(size);
}

void operator delete(void* block) noexcept {
  std::free(block);
}

void operator delete(void* block, std::size_t /*size*/) noexcept {
  std::free(block);
}

void operator delete(void* block, const std::nothrow_t& /*tag*/) noexcept {
  std::free(block);
}
#endif

int main(int argc, char** argv) {
  keep_memory();
  return limen::run_program(argc, argv);
}
