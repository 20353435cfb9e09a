// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "limen/cli/program.h"

namespace {

/// Scans come and go as blocks of many megabytes: memory touched once is used again, rather than given back
/// and zeroed anew by the system at every block (a third of all page faults). The library leaves its host's
/// allocator alone.
void keep_memory() {
#ifdef __GLIBC__
  constexpr int kMostOfHeapBytes = 8 << 20;  // larger blocks are the system's own: whole clouds, few and long
  constexpr int kKeptBytes = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, kMostOfHeapBytes);
  mallopt(M_TRIM_THRESHOLD, kKeptBytes);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory();
  return limen::run_program(argc, argv);
}
