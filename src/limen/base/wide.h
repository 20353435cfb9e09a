// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// A function of LIMEN_WIDE is compiled twice, and the processor's own way is taken as the program starts: its
// loops take eight numbers at a time where the processor can, else four. They are written for it: no
// branches, no calls. Results do not depend on it: no sum runs across pieces, and products are not
// contracted. The sources that hold them are listed in CMakeLists.txt.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LIMEN_WIDE __attribute__((target_clones("default", "avx2")))
#else
#define LIMEN_WIDE
#endif
