// SPDX-License-Identifier: BSD-3-Clause
// Keeps a run in real time at its rate: gives up what vps_scenes/pace.h says, in its order, and takes it
// back.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <map>
#include <vector>

#include "haptics/haptic_driver.h"
#include "haptics/load_governor.h"
#include "procedure/placed_parts.h"
#include "vps_scenes/load_level.h"

namespace vps::scenes {

struct LoadLimits {
  bool may_slow = true;                     ///< simulated time may go slower than the clock's
  const std::atomic<bool>* stop = nullptr;  ///< may be null; ends the making of points early
};

/// Of the physics thread. Fewer or more points are made on a thread of its own, and put in place between two
/// steps when they are ready; until then nothing further is decided. Rates change at once, downwards; upwards
/// only while nothing is held, since a coupling that turns stiffer would push. A lower rate takes gains that
/// are passive at it. No pace is taken at which physics would look stalled to the watchdog.
class LoadShedder {
 public:
  /// What gains a physics rate allows [Hz].
  using GainsAt = std::function<CouplingGains(double rate_hz)>;

  /// All but gains_at outlive it.
  LoadShedder(const Scene& scene, const Plan& plan, Simulation& simulation, PlacedParts& placed,
              HapticDriver& side, const LoadLimits& limits, GainsAt gains_at);

  /// After a step by the clock.
  /// @param busy_s  what the physics thread did since the last
  /// @param part    the body that moves
  void keep(double busy_s, double time_s, std::size_t part, bool is_holding);
  /// Puts in place what is under way, once it is ready: before what is fixed or moves becomes another.
  void finish(double time_s);
  [[nodiscard]] bool isReady() const;
  /// Around a change of the scene's models: what was made of the old ones is forgotten, and made again where
  /// it is needed.
  void beforeNewModels(double time_s);
  void afterNewModels(double time_s, std::size_t part);

  /// Of a step, in simulated time.
  [[nodiscard]] double dt_s() const { return dt_s_; }
  /// The clock's time by simulated time: a speed by the one is as much more by the other.
  [[nodiscard]] double slower() const;
  [[nodiscard]] const CouplingGains& gains() const { return gains_; }
  [[nodiscard]] const std::vector<LoadLevelChange>& changes() const { return changes_; }

 private:
  struct Made {
    ResampledShells points;
    double wall_s = 0;
  };

  [[nodiscard]] bool mayRise(bool is_holding) const;
  [[nodiscard]] LoadLevelChange changeTo(int level, double time_s) const;
  void order(LoadLevelChange change, std::size_t part);
  void setRate(LoadLevelChange change);
  void tellEnd(double time_s);

  const Scene& scene_;
  const Plan& plan_;
  Simulation& simulation_;
  PlacedParts& placed_;
  HapticDriver& driver_;
  LoadLimits limits_;
  GainsAt gains_at_;
  LoadGovernor governor_;
  double dt_s_;
  CouplingGains gains_;
  int level_ = 0;                                             ///< in place
  std::map<double, std::shared_ptr<const ShellSet>> shells_;  ///< made before, by LoadLevel::coarser
  std::future<Made> under_way_;
  LoadLevelChange ordered_;  ///< what is under way
  bool has_told_end_ = false;
  std::vector<LoadLevelChange> changes_;
};

}  // namespace vps::scenes
