// SPDX-License-Identifier: BSD-3-Clause
#include "vps/query_team.h"

#include <system_error>

namespace vps {
namespace {

constexpr int kBusyTurns = 20000;  // assumed: longer than the pause between ticks of a loaded loop is waste

void rest() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

QueryTeam::QueryTeam(int threads) : shares_(kMostGroups) {
  try {
    for (int i = 1; i < threads; ++i) others_.emplace_back([this, i] { wait(i); });
  } catch (const std::system_error&) {  // as many as there are
  } catch (...) {
    stop();
    throw;
  }
}

QueryTeam::~QueryTeam() {
  stop();
}

void QueryTeam::stop() noexcept {
  is_over_ = true;
  round_.fetch_add(1);
  round_.notify_all();
  for (std::thread& other : others_) other.join();
}

void QueryTeam::run(void (*task)(void*, int), void* context) noexcept {
  task_ = task;
  context_ = context;
  at_work_.fetch_and(~kClosed);
  round_.fetch_add(1);
  round_.notify_all();
  task(context, 0);
  at_work_.fetch_or(kClosed);
  while (at_work_.load() != kClosed) rest();
}

void QueryTeam::wait(int index) noexcept {
  std::uint32_t seen = 0;
  while (true) {
    for (int turn = 0; turn < kBusyTurns && round_.load() == seen; ++turn) rest();
    round_.wait(seen);
    seen = round_.load();
    if (is_over_) return;
    // The task is there to read for whoever finds the round open, and stays until all have left.
    if ((at_work_.fetch_add(1) & kClosed) == 0) task_(context_, index);
    at_work_.fetch_sub(1);
  }
}

}  // namespace vps
