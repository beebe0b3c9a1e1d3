// SPDX-License-Identifier: BSD-3-Clause
// Requests to a run in real time: to take the next part, to release the part in hand, to change gains.
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
  Settling,   ///< the part was released and is being judged; afterwards the next part is taken
};

/// Any thread writes requests and reads phase and step; the physics thread reads requests and writes phase
/// and step. A recording holds the requests that were carried out, so that it replays bit for bit.
class RunRequests {
 public:
  /// Whether each step waits for take(); if not, each step begins as soon as the previous step has ended.
  void setWaiting(bool waits) { waits_ = waits; }
  [[nodiscard]] bool isWaiting() const { return waits_; }
  /// Lets one step begin.
  void take() { may_take_ = true; }
  [[nodiscard]] bool mayTake() const { return !waits_ || may_take_; }
  /// Requests that the run release the part in hand at its present place and end the step.
  void release() { releases_ = true; }
  [[nodiscard]] bool isReleaseWanted() const { return releases_; }
  /// Sets the gains from the next part on. The gains change while no part is held, so that the force does not
  /// jump.
  void setGains(const CouplingGains& gains) {
    const std::lock_guard lock(mutex_);
    gains_ = gains;
  }

  /// After a safety fault, lets the force return to the hand gradually.
  void rearm() { rearms_ = true; }
  [[nodiscard]] bool isFaulted() const { return is_faulted_; }

  [[nodiscard]] RunPhase phase() const { return phase_; }
  /// Index of the step that is in progress or was last; -1: no step has begun.
  [[nodiscard]] int step() const { return step_; }

  // The run calls the functions below.
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
  /// Returns the gains of each setGains() once only.
  std::optional<CouplingGains> takeGains() {
    const std::lock_guard lock(mutex_);
    return std::exchange(gains_, std::nullopt);
  }

 private:
  std::atomic<bool> waits_{false}, may_take_{false}, releases_{false}, rearms_{false}, is_faulted_{false};
  std::atomic<RunPhase> phase_{RunPhase::Preparing};
  std::atomic<int> step_{-1};
  std::mutex mutex_;  ///< protects gains_; the physics thread locks it once in a step of the procedure
  std::optional<CouplingGains> gains_;
};

}  // namespace vps::scenes
