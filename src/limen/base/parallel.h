// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace limen {

/// Runs both, at once where there are two threads or more: `second` on a thread of its own. Parallel work
/// within either takes the threads that the other leaves. The exception of `first` is rethrown, else that of
/// `second`; both have ended by then. The second heeds the calling thread's CancelScope too.
void run_both(const std::function<void()>& first, const std::function<void()>& second);

/// Number of threads that parallel work uses (>= 1). The default is the machine's.
int thread_count();
/// Sets it for the process; 0 means the machine's. Results never depend on it.
void set_thread_count(int count);

/// Calls body(begin, end) over [0, size) in fixed pieces of `grain`, on all threads. The pieces do not depend
/// on the thread count. A call from inside another runs serially. The exception of the lowest piece is
/// rethrown. Between pieces it heeds the calling thread's CancelScope (progress.h).
void parallel_for(std::size_t size, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Maps each piece [begin, end) to a value and folds the values in index order: the same sum, bit for bit,
/// for any thread count.
template <typename Value, typename Map, typename Fold>
Value parallel_reduce(std::size_t size, std::size_t grain, Value start, const Map& map, const Fold& fold) {
  const std::size_t pieces = (size + grain - 1) / grain;
  std::vector<Value> partial(pieces, start);
  parallel_for(size, grain,
               [&](std::size_t begin, std::size_t end) { partial[begin / grain] = map(begin, end); });
  for (Value& value : partial) start = fold(std::move(start), std::move(value));
  return start;
}

}  // namespace limen
