// SPDX-License-Identifier: BSD-3-Clause
#include "vps/stoppable.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace vps {

namespace {
thread_local StoppableWork* work_of_thread = nullptr;
thread_local unsigned polls_of_thread = 0;
}  // namespace

StoppableWork::StoppableWork(const Progress& progress, std::string_view doing, double share)
    : progress_(progress), enclosing_(work_of_thread), doing_(doing), share_(share) {
  if (progress_) work_of_thread = this;
}

StoppableWork::~StoppableWork() {
  work_of_thread = enclosing_;
  if (!progress_ || enclosing_ == nullptr || &enclosing_->progress_ != &progress_) return;
  // The enclosing work would otherwise repeat a report that is older than those of this work.
  const std::lock_guard lock(enclosing_->lock_);
  enclosing_->doing_ = std::move(doing_);
  enclosing_->share_ = share_;
}

void StoppableWork::report(std::string_view doing, double share) {
  if (!progress_) return;
  const std::lock_guard lock(lock_);
  share_ = doing == doing_ ? std::max(share, share_) : share;
  doing_ = doing;
  call();
}

void StoppableWork::poll() {
  if (is_stopped_.load(std::memory_order_acquire)) std::rethrow_exception(stop_);
  // While another thread is in the callback, that thread polls for all.
  const std::unique_lock lock(lock_, std::try_to_lock);
  if (lock.owns_lock()) call();
}

void StoppableWork::call() {
  if (stop_) std::rethrow_exception(stop_);
  const WorkOnThread none(nullptr);  // the callback may itself call functions that poll
  called_.store(Clock::now(), std::memory_order_relaxed);
  try {
    progress_(doing_, share_);
  } catch (...) {
    stop_ = std::current_exception();
    is_stopped_.store(true, std::memory_order_release);
    throw;
  }
}

void pollStop() {
  StoppableWork* const work = work_of_thread;
  if (work == nullptr) return;
  const bool is_due =
      ++polls_of_thread % StoppableWork::kPollsPerCall == 0 ||
      work->is_stopped_.load(std::memory_order_relaxed) ||
      StoppableWork::Clock::now() - work->called_.load(std::memory_order_relaxed) > StoppableWork::kLongest;
  if (is_due) work->poll();
}

StoppableWork* WorkOnThread::current() {
  return work_of_thread;
}

WorkOnThread::WorkOnThread(StoppableWork* work) : before_(work_of_thread) {
  work_of_thread = work;
}

WorkOnThread::~WorkOnThread() {
  work_of_thread = before_;
}

void onAllCores(std::size_t count, const std::function<void(std::size_t)>& work) {
  StoppableWork* const own = work_of_thread;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    // A thread that waits in a loop may take a task of other work.
    const WorkOnThread on_thread(own);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      pollStop();
      work(i);
    }
  });
}

}  // namespace vps
