// SPDX-License-Identifier: BSD-3-Clause
// When a run that cannot hold its rate gives something up, and when it takes that back. Knows neither clock
// nor models: what steps took goes in, a level comes out.
#pragma once

#include <vector>

namespace vps::scenes {

struct GovernorSettings {
  double window_s = 0.25;    ///< a decision looks at so much time. assumed: a person waits no longer
  double lost_limit = 0.05;  ///< share of a window's time that may be lost. assumed: a part 5 % too slow
  int late_limit = 5;        ///< fewer late steps in a window are a stall, which no level cures. assumed
  int calm_windows = 8;      ///< so many before it takes back. assumed: 2 s, longer than a touch in passing
  int most_calm_windows = 256;  ///< it waits twice as long after each relapse, but no longer. assumed: 64 s
};

/// Level 0 is what was asked for; each further one is cheaper. Not thread-safe; allocates in its constructor
/// alone.
///
/// A step that takes longer than its period loses the periods that begin meanwhile. Down: a window in which
/// more is lost than may be. Up: as many windows in a row as it must wait for, in each of which no more than
/// half of that would have been lost with every step as much dearer as the level above may be, stalls aside.
/// Between the two it stays: so neither a late step nor a load near the limit makes it move, and a load that
/// comes and goes moves it ever more seldom.
class LoadGovernor {
 public:
  /// @param dearer  for each level but 0: how many times as much a step may take of its period one level up,
  ///                >= 1
  explicit LoadGovernor(std::vector<double> dearer, const GovernorSettings& settings = {});

  /// One step.
  /// @param busy_s    what it took; what is no number or below 0 counts as 0
  /// @param period_s  what it had, > 0
  /// @param may_rise  false: the level above cannot be taken back now; it is once it can
  /// @return the level from now on, at most one from that before. O(1).
  int add(double busy_s, double period_s, bool may_rise = true) noexcept;
  /// The last rise could not be done: it was level `level`, and waits longer before it tries again.
  void stayAt(int level) noexcept;
  [[nodiscard]] int level() const noexcept { return level_; }
  [[nodiscard]] int lastLevel() const noexcept { return static_cast<int>(dearer_.size()); }

  /// The last whole window.
  struct Window {
    double elapsed_s = 0;  ///< all periods that began in it
    double lost_s = 0;     ///< of these, those without a step of their own
    double busy_s = 0;     ///< mean of a step
    int late = 0;          ///< steps that took longer than their period
    [[nodiscard]] double lostShare() const noexcept { return elapsed_s > 0 ? lost_s / elapsed_s : 0; }
  };
  [[nodiscard]] const Window& last() const noexcept { return last_; }
  /// Whether too much was lost in the last whole window.
  [[nodiscard]] bool isOverloaded() const noexcept;

 private:
  struct Counts {
    double elapsed_s = 0, lost_s = 0, busy_s = 0;
    double elapsed_above_s = 0, lost_above_s = 0;  ///< had each step been as much dearer as one level up
    int steps = 0, late = 0, late_above = 0;
  };
  int decide(bool may_rise) noexcept;
  void moveTo(int level) noexcept;
  void waitLonger() noexcept;

  std::vector<double> dearer_;
  GovernorSettings settings_;
  Counts now_;
  Window last_;
  int level_ = 0;
  int calm_ = 0;            ///< windows in a row
  int wait_;                ///< calm windows that it waits for
  bool has_risen_ = false;  ///< the next fall is a relapse
};

}  // namespace vps::scenes
