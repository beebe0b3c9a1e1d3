// SPDX-License-Identifier: BSD-3-Clause
// Settings of VPS contact in one dispatcher, and the counters that it reports.
#pragma once

#include <cstddef>

#include "vps/fidelity.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

/// A law of dry friction. In each step the law gives the coefficient mu of every contact: the friction force
/// is at most mu times the normal force. A host may define its own model.
struct FrictionModel {
  const char* name = "";
  /// Returns the coefficient in a step, finite and >= 0. `mu` is the coefficient at rest, the product of both
  /// bodies' friction; `slip_m_s` >= 0 is the speed at which the two surfaces slide on each other at the
  /// start of the step. The function is called for each contact and step, from several threads with
  /// bullet::Dispatcher, and must not throw. Null: the coefficient is mu at every speed.
  double (*coefficient)(double mu, double slip_m_s) = nullptr;
  const char* description = "";
};

/// All friction models of this library. To add a model, add a row here.
inline constexpr FrictionModel kFrictionModels[] = {
    {"coulomb", nullptr, "the coefficient is the same at rest and at every speed"},
    // Dry steel on steel has 0.74 at rest and 0.57 in motion [Serway and Jewett, Physics for Scientists and
    // Engineers, table of coefficients of friction]. Below 1 mm/s a contact counts as resting.
    {"static_and_kinetic", [](double mu, double slip_m_s) { return slip_m_s > 1e-3 ? 0.57 / 0.74 * mu : mu; },
     "the coefficient falls to 0.77 of its value while the surfaces slide faster than 1 mm/s"},
};

struct Settings {
  /// Penalty requires bullet::Solver. With any other solver the contacts are rigid, as with Constraint, which
  /// a message (log.h) reports once. Penalty contact has no restitution.
  ContactMethod contact_method = ContactMethod::Constraint;
  double stiffness_N_per_m3 = 1e12;  ///< stiffness per area of penalty contact; assumed: steel, 0.2 m thick
  FrictionModel friction_model = kFrictionModels[0];  ///< Coulomb's law; kFrictionModels lists all models
  int contact_limit = 32;  ///< contacts of each pair, >= 4; the checks of a step may add 16
  /// A point is a contact if it can come within this distance during the step. With a larger value the solver
  /// gets contacts that do not act; with a smaller one points are missed that rotation and the solver's
  /// residual bring into contact. 20 um was chosen by measurement.
  double contact_margin_m = 20e-6;
  Sides sides = Sides::Both;
  Gradient gradient = Gradient::Continuous;
  bool use_surfaces = true;  ///< refine contacts by ShapeModels::surfaces, if a shape has them
  /// Greatest number of near points of one side of a pair, and of edge crossings, that are examined, lowest
  /// ids first; 0: all. The limit bounds the time of a step, but the area of the left-out points has no
  /// contact. Values other than 0 must be at least contact_limit.
  int candidate_limit = 0;
  /// Report (log.h), once per cause, that bodies turn farther in a step than contacts allow (turn.h).
  bool warns_of_turns = true;
};

/// Counters since installation, over all pairs of a dispatcher.
struct Stats {
  std::size_t pair_updates = 0;  ///< pairs whose points were queried
  std::size_t points_tested = 0;
  /// Points and crossings that could touch within the step. Where very many points are near a map, only the
  /// representative point of each surface tile is counted.
  std::size_t candidates = 0;
  std::size_t contacts = 0;  ///< candidates that the solver received
  std::size_t left_out = 0;  ///< candidates beyond candidate_limit, which should then be raised
  /// Pairs that overlapped at their first query by more than their motion explains. The bodies of such a pair
  /// are moved apart at 0.05 m/s. A message (log.h) names the first such pair.
  std::size_t overlapping_starts = 0;
  double deepest_start_m = 0;  ///< deepest overlap of the pairs in overlapping_starts
};

}  // namespace vps::bullet
