// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "limen/base/progress.h"
#include "limen/base/system.h"

namespace limen {
namespace {

thread_local bool inside_parallel = false;

const int kMachineThreads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
std::atomic<int> wanted_threads{kMachineThreads};

/// One call of parallel_for: workers claim pieces until none is left.
struct Job {
  std::size_t size = 0;
  std::size_t grain = 1;
  const std::function<void(std::size_t, std::size_t)>* body = nullptr;
  const Monitor* monitor = CancelScope::current();
  std::atomic<std::size_t> next_piece{0};
  std::mutex failure_mutex;
  std::size_t failed_piece = 0;
  std::exception_ptr failure;

  void run() {
    const std::size_t pieces = (size + grain - 1) / grain;
    const CancelScope scope(monitor);
    inside_parallel = true;
    for (std::size_t piece = next_piece++; piece < pieces; piece = next_piece++) run_piece(piece);
    inside_parallel = false;
  }

  void run_piece(std::size_t piece) {
    try {
      CancelScope::check();
      (*body)(piece * grain, std::min(size, (piece + 1) * grain));
    } catch (...) {
      next_piece = size;  // pieces nobody has begun are higher than this one: they would change nothing
      const std::scoped_lock lock(failure_mutex);
      if (!failure || piece < failed_piece) {
        failure = std::current_exception();
        failed_piece = piece;
      }
    }
  }
};

/// Threads that wait for the current job; they live as long as the process.
class Pool {
 public:
  Pool() = default;
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// False, and nothing done, where the threads work for another caller.
  bool run(Job& job, int helpers) {
    const std::unique_lock only_one(caller_mutex_, std::try_to_lock);
    if (!only_one) return false;
    {
      const std::scoped_lock lock(mutex_);
      while (static_cast<int>(threads_.size()) < helpers) {
        const int index = static_cast<int>(threads_.size());
        threads_.emplace_back([this, index](const std::stop_token& stop) { serve(stop, index); });
      }
      job_ = &job;
      helpers_ = helpers;
      busy_ = helpers;
      ++generation_;
    }
    wake_.notify_all();
    job.run();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    job_ = nullptr;
    return true;
  }

  ~Pool() {
    for (std::jthread& thread : threads_) thread.request_stop();
    wake_.notify_all();
  }

 private:
  void serve(const std::stop_token& stop, int index) {
    std::size_t seen = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
      if (!wake_.wait(lock, stop, [&] { return generation_ != seen; })) return;
      seen = generation_;
      if (index >= helpers_ || job_ == nullptr) continue;
      Job* job = job_;
      lock.unlock();
      job->run();
      lock.lock();
      if (--busy_ == 0) done_.notify_all();
    }
  }

  std::mutex caller_mutex_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable done_;
  Job* job_ = nullptr;
  std::size_t generation_ = 0;
  int helpers_ = 0;
  int busy_ = 0;
  std::vector<std::jthread> threads_;
};

/// The process's pool. A forked child has none of its parent's threads, and its parent's locks in whatever
/// state they were: it begins with a pool of its own and leaves the inherited one alone. The pool is made
/// when the program is loaded, not at first use: a fork amid a first use would leave the child waiting for
/// it.
class PoolOfProcess {
 public:
  PoolOfProcess() {
    after_fork([] { current = new Pool; });
  }
  PoolOfProcess(const PoolOfProcess&) = delete;
  PoolOfProcess& operator=(const PoolOfProcess&) = delete;
  ~PoolOfProcess() { delete current; }

  static inline Pool* current = new Pool;
};
const PoolOfProcess pool_of_process;

}  // namespace

int thread_count() {
  return wanted_threads;
}

void set_thread_count(int count) {
  wanted_threads = count > 0 ? count : kMachineThreads;
}

void parallel_for(std::size_t size, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  if (size == 0) return;
  grain = std::max<std::size_t>(1, grain);
  const std::size_t pieces = (size + grain - 1) / grain;
  const int helpers =
      static_cast<int>(std::min<std::size_t>(pieces, static_cast<std::size_t>(thread_count()))) - 1;
  if (!inside_parallel && helpers > 0) {
    Job job;
    job.size = size;
    job.grain = grain;
    job.body = &body;
    if (PoolOfProcess::current->run(job, helpers)) {
      if (job.failure) std::rethrow_exception(job.failure);
      return;
    }
  }
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    CancelScope::check();
    body(piece * grain, std::min(size, (piece + 1) * grain));
  }
}

void run_both(const std::function<void()>& first, const std::function<void()>& second) {
  if (thread_count() < 2 || inside_parallel) {
    first();
    second();
    return;
  }
  const auto caught = [](const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      return std::current_exception();
    }
    return std::exception_ptr{};
  };
  const Monitor* const monitor = CancelScope::current();
  std::exception_ptr of_second;
  std::jthread other([&] {
    const CancelScope scope(monitor);
    of_second = caught(second);
  });
  const std::exception_ptr of_first = caught(first);
  other.join();
  if (of_first) std::rethrow_exception(of_first);
  if (of_second) std::rethrow_exception(of_second);
}

}  // namespace limen
