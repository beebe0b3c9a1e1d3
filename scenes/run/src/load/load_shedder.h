// SPDX-License-Identifier: BSD-3-Clause
// Load shedding of a run in real time: changes the load level (vps_scenes/run/load_level.h) so that physics
// holds its rate.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <vector>

#include "haptics/haptic_driver.h"
#include "load/load_governor.h"
#include "simulation/simulation.h"
#include "vps_scenes/run/load_level.h"

namespace vps::scenes {

struct LoadLimits {
  bool may_slow = true;                     ///< simulated time may run slower than real time
  const std::atomic<bool>* stop = nullptr;  ///< when set, resampling ends early; null: never
};

/// Used by the physics thread. New shells are made on another thread and put in place between two steps when
/// they are ready; until then no further decision is made. Rates decrease at once. Rates increase only while
/// no part is held, because a coupling that becomes stiffer would push the hand. With a lower rate, the
/// coupling gets gains that are passive at that rate. No level is taken at which the watchdog would see
/// physics as stalled.
class LoadShedder {
 public:
  /// Returns the gains that are passive at a physics rate [Hz].
  using GainsAt = std::function<CouplingGains(double rate_hz)>;
  /// Replaces the fixed field.
  using SetField = std::function<void(CookedField field)>;

  /// Scene, plan, simulation and driver must outlive this object.
  LoadShedder(const Scene& scene, const ModelPlan& plan, Simulation& simulation, HapticDriver& driver,
              const LoadLimits& limits, GainsAt gains_at, SetField set_field);

  /// Call update() after each step.
  /// @param busy_s      time that the physics thread was busy since the last step
  /// @param part        the body that moves
  /// @param is_holding  true while the part is coupled to the hand
  void update(double busy_s, double time_s, std::size_t part, bool is_holding);
  /// Waits for resampling that is in progress and puts its result in place. Call finish() before the fixed
  /// field or the moving body changes.
  void finish(double time_s);
  /// False while resampling is in progress.
  [[nodiscard]] bool isReady() const;
  /// Call these functions before and after the scene's models are replaced: shells made from the old models
  /// are discarded, and shells of the new models are made if the level needs them.
  void beforeNewModels(double time_s);
  void afterNewModels(double time_s, std::size_t part);

  /// Duration of a physics step in simulated time.
  [[nodiscard]] double dt_s() const { return dt_s_; }
  /// Real time divided by simulated time: speeds in simulated time are greater by this factor.
  [[nodiscard]] double timeDivisor() const;
  [[nodiscard]] const CouplingGains& gains() const { return gains_; }
  /// Reports that the driver's gains have changed to `own`. No part may be held.
  void setOwnGains(const CouplingGains& own);
  [[nodiscard]] const std::vector<LoadLevelChange>& changes() const { return changes_; }

 private:
  struct Resampled {
    ResampledShells shells;
    double wall_s = 0;
  };

  [[nodiscard]] bool mayRise(bool is_holding) const;
  [[nodiscard]] LoadLevelChange changeTo(int level, double time_s) const;
  void startResampling(LoadLevelChange change, std::size_t part);
  void setRate(LoadLevelChange change);
  void reportLastLevel(double time_s);

  const Scene& scene_;
  const ModelPlan& plan_;
  Simulation& simulation_;
  HapticDriver& driver_;
  LoadLimits limits_;
  GainsAt gains_at_;
  SetField set_field_;
  LoadGovernor governor_;
  double dt_s_;
  CouplingGains gains_;
  int level_ = 0;  ///< level in effect
  std::map<double, std::shared_ptr<const ShellSet>>
      shells_;  ///< existing shells, by LoadLevel::spacing_factor
  std::future<Resampled> resampling_;
  LoadLevelChange pending_;  ///< the change that resampling_ is for
  bool has_reported_last_level_ = false;
  std::vector<LoadLevelChange> changes_;
};

}  // namespace vps::scenes
