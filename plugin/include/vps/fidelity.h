// SPDX-License-Identifier: BSD-3-Clause
// All settings that trade speed for accuracy.
#pragma once

#include <string_view>

#include "vps/export.h"
#include "vps/voxmap.h"

namespace vps {

/// Whether only one part's points are tested against the other part's field, or both parts' points.
enum class Sides { One, Both };

/// How contacts become motion.
enum class ContactMethod {
  Constraint,  ///< a few rigid contacts with a friction cone, for the solver
  Penalty,     ///< each touching point exerts stiffness times area times depth, solved implicitly
};

/// The name in scene files, JSON and tables.
inline const char* toText(Sides sides) {
  return sides == Sides::One ? "one" : "both";
}
/// The words in messages and reports.
inline const char* inWords(Sides sides) {
  return sides == Sides::One ? "one side" : "both sides";
}
inline const char* toText(Gradient gradient) {
  return gradient == Gradient::Continuous ? "continuous" : "trilinear";
}
inline const char* toText(ContactMethod method) {
  return method == ContactMethod::Constraint ? "constraint" : "penalty";
}

struct Fidelity {
  double voxel_m = 0.25e-3;   ///< grid step of voxmaps
  double spacing_m = 0.5e-3;  ///< distance between shell points
  Sides sides = Sides::Both;  ///< One: tests only the moving part's points against the fixed part's field
  Gradient gradient = Gradient::Continuous;
  int contact_limit = 32;  ///< contacts per pair for the solver; checks of solved steps add up to 16
  double haptic_rate_hz = 1000;
  double physics_rate_hz = 1000;
  /// Number of equal parts of each physics step. 0: in each step as many as the bodies' rotation needs.
  int substeps = 1;
  int solver_iterations = 100;
  ContactMethod contact_method = ContactMethod::Constraint;
};

/// The preset "fast", "normal" or "fine"; throws LoadError for another name.
VPS_API Fidelity fidelityPreset(std::string_view name);

}  // namespace vps
