// SPDX-License-Identifier: BSD-3-Clause
// Simulates a case and measures the overlap after every step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "case.h"
#include "dynamics/engine.h"

namespace vps::search {

struct RunSettings {
  dynamics::Mode mode = dynamics::Mode::Constraint;
  double step_s = 1e-3;
  double bound_m = 10e-6;       ///< deepest overlap that is right
  bool stops_at_bound = false;  ///< ends the run some steps after the bound is exceeded
};

/// Poses of the parts and velocities of their centres of mass.
struct BodyMotion {
  Pose X_WP;
  Twist V_W;
};

struct CaseResult {
  double simulated_s = 0;
  CaseOverlap deepest;
  double deepest_at_s = 0;
  bool has_tunnelled = false;  ///< see kLost_m; or a vertex went through another body within a step
  std::string refusal;         ///< the engine's reason for refusing the meshes, or what went wrong
  std::uint64_t hash = 0;      ///< of all states
  /// State before the first step after which the bound is exceeded, and up to kKept - 1 states before it, the
  /// latest last. Empty if none was.
  std::vector<std::vector<BodyMotion>> before;
  double before_s = 0;  ///< time of the latest of them
};

/// A body that is so deep in another one has lost its side: parts are at least 2 mm thick.
inline constexpr double kLost_m = 1e-3;
/// A corner moves along an arc; its chord leaves the arc by up to 0.2 mm at 30 rad/s, 20 mm and 10 ms.
inline constexpr double kPassed_m = 0.2e-3;
inline constexpr std::size_t kKept = 16;

/// Same case and settings, same bits. Does not throw for what the engine refuses.
CaseResult runCase(const Case& made, const RunSettings& settings);

}  // namespace vps::search
