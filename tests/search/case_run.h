// SPDX-License-Identifier: BSD-3-Clause
// Simulates a case, measures the overlap after every step, and saves the case as a scene file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "case.h"
#include "dynamics/engine.h"
#include "vps/mesh_overlap.h"

namespace vps::search {

struct RunSettings {
  dynamics::Mode mode = dynamics::Mode::Constraint;
  double step_s = 1e-3;
  double bound_m = 10e-6;       ///< greatest overlap that is allowed
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
  bool has_tunnelled =
      false;  ///< an overlap is deeper than kLost_m, or a vertex went through another body within a step
  std::string refusal;     ///< the engine's reason for refusing the meshes, or what went wrong
  std::uint64_t hash = 0;  ///< hash of all states
  /// State before the first step after which the bound is exceeded, and up to kKept - 1 states before it, the
  /// latest last. Empty if no step exceeds the bound.
  std::vector<std::vector<BodyMotion>> before;
  double before_s = 0;  ///< time of the latest of the states in `before`
};

/// A body that is deeper than this in another one counts as on its wrong side: parts are at least 2 mm thick.
inline constexpr double kLost_m = 1e-3;
/// Margin of hasPassedThrough(): a corner moves along an arc, which deviates from its chord by up to 0.2 mm
/// at 30 rad/s, 20 mm and 10 ms.
inline constexpr double kPassed_m = 0.2e-3;
inline constexpr std::size_t kKept = 16;

/// Simulates a case; the same case and settings give the same bits. A refusal by the engine is returned, not
/// thrown.
CaseResult runCase(const Case& made, const RunSettings& settings);

/// True if a vertex of `a`, outside `b` before and after, went through more than margin_m of b's material on
/// a straight path from one pose to the other.
/// @param X_BA_before, X_BA_after  poses of a in b
bool hasPassedThrough(const OverlapMesh& a, const OverlapMesh& b, const Pose& X_BA_before,
                      const Pose& X_BA_after, double margin_m);

/// Writes scene.toml and an STL file for each body (as the engine got it) into a new folder. The scene starts
/// from the latest state from which the overlap appears without the hand, or, if there is none, from the
/// state just before the overlap.
/// @param command  command that repeats the run with the hand; a comment at the top of the scene file
/// @return the scene file. Throws std::runtime_error if a file cannot be written.
std::filesystem::path saveCase(const std::filesystem::path& folder, const Case& made,
                               const RunSettings& settings, const CaseResult& result,
                               const std::string& command);

}  // namespace vps::search
