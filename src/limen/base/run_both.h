// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace limen {

/// Runs both, at once where there are two threads or more: `second` on a thread of its own. Parallel work
/// within either takes the threads that the other leaves. The exception of `first` is rethrown, else that of
/// `second`; both have ended by then. The second heeds the calling thread's CancelScope too.
void run_both(const std::function<void()>& first, const std::function<void()>& second);

}  // namespace limen
