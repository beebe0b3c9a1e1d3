// SPDX-License-Identifier: BSD-3-Clause
// What others ask of a run by the clock while it goes on.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "vps/coupling_law.h"

namespace vps::scenes {

enum class RunPhase {
  Preparing,  ///< no step has begun
  InHand,     ///< the hand works on the part of the step
  Settling,   ///< the part was let go of and is judged; the next one is taken then
};

/// Written by any thread, read by the physics thread, and phase and step the other way round. A run that is
/// recorded holds what was carried out, so that it replays bit for bit.
class RunRequests {
 public:
  /// Without waiting, each step is followed by the next one.
  void setWaiting(bool waits) { waits_ = waits; }
  [[nodiscard]] bool isWaiting() const { return waits_; }
  /// Lets one step begin.
  void take() { may_take_ = true; }
  [[nodiscard]] bool mayTake() const { return !waits_ || may_take_; }
  /// The hand lets go of the part where it is, and the step ends there.
  void release() { releases_ = true; }
  [[nodiscard]] bool isReleaseWanted() const { return releases_; }
  /// From the next part on that the hand takes: nothing is held then, so that no force steps.
  void setGains(const CouplingGains& gains) {
    const std::lock_guard lock(mutex_);
    gains_ = gains;
  }

  /// Force returns to the hand after a safety fault, gradually.
  void rearm() { rearms_ = true; }
  [[nodiscard]] bool isFaulted() const { return is_faulted_; }

  [[nodiscard]] RunPhase phase() const { return phase_; }
  /// Of the procedure, the one that is or was worked on; -1: none yet.
  [[nodiscard]] int step() const { return step_; }

  // By the run.
  void beginRun() {
    phase_ = RunPhase::Preparing;
    step_ = -1;
    may_take_ = releases_ = rearms_ = is_faulted_ = false;
    takeGains();
  }
  void beginStep(int step) {
    step_ = step;
    may_take_ = releases_ = false;
    phase_ = RunPhase::InHand;
  }
  bool takeRearm() { return rearms_.exchange(false); }
  void setFaulted(bool is_faulted) { is_faulted_ = is_faulted; }
  void endWork() { phase_ = RunPhase::Settling; }
  /// Each once.
  std::optional<CouplingGains> takeGains() {
    const std::lock_guard lock(mutex_);
    return std::exchange(gains_, std::nullopt);
  }

 private:
  std::atomic<bool> waits_{false}, may_take_{false}, releases_{false}, rearms_{false}, is_faulted_{false};
  std::atomic<RunPhase> phase_{RunPhase::Preparing};
  std::atomic<int> step_{-1};
  std::mutex mutex_;  ///< of the gains; the physics thread takes it once in a step of the procedure
  std::optional<CouplingGains> gains_;
};

}  // namespace vps::scenes
