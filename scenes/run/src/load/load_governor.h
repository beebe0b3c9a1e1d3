// SPDX-License-Identifier: BSD-3-Clause
// Decides when a run that cannot hold its rate changes to a cheaper load level, and when it changes back. The
// governor uses neither a clock nor models: it receives the duration of each step and returns a level.
#pragma once

#include <vector>

namespace vps::scenes {

struct GovernorSettings {
  double window_s =
      0.25;  ///< length of the window that a decision is based on. assumed: a delay that a person accepts
  double lost_limit = 0.05;  ///< share of a window's time that may be lost. assumed: the part is 5 % too slow
  int late_limit =
      5;  ///< with fewer late steps, the lost time of a window is a stall, which no level prevents. assumed
  int calm_windows =
      8;  ///< calm windows before a change to level - 1. assumed: 2 s, longer than a brief contact
  int most_calm_windows = 256;  ///< limit of calm_windows, which doubles after each relapse. assumed: 64 s
};

/// Level 0 has the scene's own settings; each further level is cheaper. The class is not thread-safe. It
/// allocates only in its constructor.
///
/// Steps that take longer than their period delay the steps after them, which then follow at once. Periods
/// are lost where a step would begin later than mostLate_s() of physics_clock.h.
/// - The governor changes to the next cheaper level after a window in which at least late_limit steps lost
/// more than lost_limit of the time. A level that slows time down is taken only if simulated time then runs
/// faster than now with its lost periods: at half speed half of the time is lost.
/// - The governor changes back to the level before it (level - 1) after the required number of calm windows
/// in a row. A window is calm when no more than half of lost_limit would have been lost (without stalls) if
/// every step had taken as much longer as it may at level - 1. The gap between the two conditions is the
/// hysteresis: neither a single late step nor a load near the limit changes the level, and a load that comes
/// and goes changes the level less and less often.
class LoadGovernor {
 public:
  /// @param cost_ratios  for each level but 0, >= 1: the greatest ratio of the load (duration of a step by
  /// its period) at level - 1 to the load at the level
  /// @param speeds  simulated time divided by real time for each level from level 0 on, at most 1; empty: all
  /// 1
  explicit LoadGovernor(std::vector<double> cost_ratios, const GovernorSettings& settings = {},
                        std::vector<double> speeds = {});

  /// Adds one step to the window.
  /// @param busy_s    duration of the step; NaN or a negative value counts as 0
  /// @param period_s  period of the step, > 0
  /// @param may_rise  false: level - 1 is not possible now, and the governor waits to change to it
  /// @return the level from now on, which differs from the last level by at most one. O(1).
  int add(double busy_s, double period_s, bool may_rise = true) noexcept;
  /// Reports that the last change to a less cheap level failed. The governor stays at `level` and waits
  /// longer before the next such change.
  void stayAt(int level) noexcept;
  [[nodiscard]] int level() const noexcept { return level_; }
  [[nodiscard]] int lastLevel() const noexcept { return static_cast<int>(cost_ratios_.size()); }

  struct Window {
    double elapsed_s = 0;  ///< length of all periods that began in the window
    double lost_s = 0;     ///< length of the periods in the window that had no step
    double busy_s = 0;     ///< mean duration of a step
    int late = 0;          ///< number of steps after which periods were lost
    [[nodiscard]] double lostShare() const noexcept { return elapsed_s > 0 ? lost_s / elapsed_s : 0; }
  };
  /// The last complete window.
  [[nodiscard]] const Window& last() const noexcept { return last_; }
  /// True if too much time was lost in the last complete window.
  [[nodiscard]] bool isOverloaded() const noexcept;

 private:
  /// Sums of the present window for steps of one cost: the measured cost, or the cost at level - 1.
  struct Course {
    double elapsed_s = 0, lost_s = 0;
    int late = 0;
    double behind_s = 0;  ///< lateness of the next step, kept from window to window
    void add(double busy_s, double period_s) noexcept;
    void beginWindow() noexcept { *this = {0, 0, 0, behind_s}; }
  };
  int decide(bool may_rise) noexcept;
  [[nodiscard]] bool isFasterBelow() const noexcept;
  void moveTo(int level) noexcept;
  void waitLonger() noexcept;

  std::vector<double> cost_ratios_, speeds_;
  GovernorSettings settings_;
  Course now_, above_;  ///< now_: with measured costs; above_: with the costs at level - 1
  double busy_s_ = 0;
  int steps_ = 0;
  Window last_;
  int level_ = 0;
  int calm_ = 0;            ///< number of calm windows in a row
  int wait_;                ///< number of calm windows required for a change to level - 1
  bool has_risen_ = false;  ///< last change: to level - 1, so that a change back is a relapse
};

}  // namespace vps::scenes
