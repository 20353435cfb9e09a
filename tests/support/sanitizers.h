// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which sanitizer the tests are built with, if any: clang 14 tells it otherwise than GCC.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define LIMEN_SANITIZES_THREADS
#endif
#if __has_feature(address_sanitizer)
#define LIMEN_SANITIZES_ADDRESSES
#endif
#elif defined(__SANITIZE_THREAD__)
#define LIMEN_SANITIZES_THREADS
#elif defined(__SANITIZE_ADDRESS__)
#define LIMEN_SANITIZES_ADDRESSES
#endif
