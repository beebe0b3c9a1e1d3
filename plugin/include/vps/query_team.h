// SPDX-License-Identifier: BSD-3-Clause
// Threads that share one query.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "vps/export.h"

namespace vps {

/// A few threads that wait for queries to share, the caller being one of them. Made once; sharing a query
/// does not allocate or lock: the others watch a counter, for some ten thousand turns busily (about 50 us),
/// then asleep until they are called. Worth it above about 30 us a query; serves one query at a time.
class VPS_API QueryTeam {
 public:
  /// Groups of 4096 points that one shared query can have; a larger shell is queried by the caller alone.
  static constexpr std::size_t kMostGroups = 8192;
  /// A group's share of the answer, see src/query_wrench.cpp.
  using GroupShare = std::array<double, 12>;

  /// @param threads  how many work on a query, the caller included; fewer if the system gives no more
  explicit QueryTeam(int threads);
  ~QueryTeam();
  QueryTeam(const QueryTeam&) = delete;
  QueryTeam& operator=(const QueryTeam&) = delete;

  [[nodiscard]] int threads() const noexcept { return static_cast<int>(others_.size()) + 1; }
  /// Calls task(context, index) on the caller's thread, index 0, and on those of the others that are awake
  /// before that is done; returns when all that began have ended. A task takes what work is left from a
  /// counter: a thread that sleeps, or that the system lets wait, is not waited for.
  void run(void (*task)(void*, int), void* context) noexcept;
  [[nodiscard]] GroupShare& share(std::size_t group) noexcept { return shares_[group]; }

 private:
  static constexpr int kClosed = 1 << 30;
  void wait(int index) noexcept;
  void stop() noexcept;

  std::vector<GroupShare> shares_;
  void (*task_)(void*, int) = nullptr;
  void* context_ = nullptr;
  std::atomic<std::uint32_t> round_ = 0;  ///< counts calls
  std::atomic<int> at_work_ = kClosed;    ///< others that have begun; kClosed more: nobody may begin
  std::atomic<bool> is_over_ = false;
  std::vector<std::thread> others_;
};

}  // namespace vps
