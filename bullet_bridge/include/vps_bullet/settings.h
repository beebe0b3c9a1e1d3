// SPDX-License-Identifier: BSD-3-Clause
// Settings of VPS contact in one dispatcher, and the counters that it reports.
#pragma once

#include <cstddef>

#include "vps/fidelity.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

struct Settings {
  /// Penalty needs bullet::Solver. Any other solver takes the contacts as rigid, as with Constraint; a
  /// message (log.h) then says so, once. Penalty contact has no restitution.
  ContactMethod contact_method = ContactMethod::Constraint;
  double stiffness_N_per_m3 = 1e12;  ///< of penalty contact, per area; assumed: steel, 0.2 m thick
  int contact_limit = 32;            ///< contacts of each pair, >= 4; checks of steps add up to 16
  /// A point is a contact if it can come within this distance during the step. 20 um: measured. A larger
  /// value gives the solver contacts that do not act; a smaller one misses points that rotation and the
  /// solver's residual bring into contact.
  double contact_margin_m = 20e-6;
  Sides sides = Sides::Both;
  Gradient gradient = Gradient::Continuous;
  bool use_surfaces = true;  ///< refine contacts by ShapeModels::surfaces, where a shape has them
  /// Near points of one side of a pair, and crossings of edges, that are examined, lowest ids first; 0: all.
  /// Bounds the time of a step, but leaves a patch without contact where points are left out. At least
  /// contact_limit.
  int candidate_limit = 0;
  /// A message (log.h) says once for each cause that bodies turn farther in a step than it can hold (turn.h).
  bool warns_of_turns = true;
};

/// Counters since installation, over all pairs of a dispatcher.
struct Stats {
  std::size_t pair_updates = 0;  ///< pairs whose points were queried
  std::size_t points_tested = 0;
  /// Points and crossings that could touch within the step. Where very many points are near a map, only the
  /// representative point of each surface tile is counted.
  std::size_t candidates = 0;
  std::size_t contacts = 0;  ///< candidates that were given to the solver
  std::size_t left_out = 0;  ///< candidates beyond candidate_limit: raise it
  /// Pairs that overlapped at their first query by more than their motion explains. They separate at 0.05
  /// m/s. The first such pair is named (log.h).
  std::size_t overlapping_starts = 0;
  double deepest_start_m = 0;  ///< the deepest of these overlaps
};

}  // namespace vps::bullet
