// SPDX-License-Identifier: BSD-3-Clause
// The rounds of a step (solver/contact_loop.h) for worlds whose solver has none: a pair of bodies runs them
// alone.
#pragma once

#include "narrowphase/pair_state.h"
#include "narrowphase/pair_view.h"

class btDispatcher;

namespace vps::bullet {

/// True if bullet::Solver asks the pair for its missing contacts.
bool isCheckedBySolver(const PairView& pair, const PairState& state);

/// True if, moreover, nothing suggests that the solver may leave the pair's island to Bullet's own: no body
/// with anisotropic friction, and no island that was left to it before. Contacts that arise because other
/// bodies push this pair are found then, so that the first guess need not have them. False for sensors.
bool isSurelyChecked(const PairView& pair, const PairState& state);

/// True if no solver asks the pair for its missing contacts: in a world that bullet::Solver does not solve,
/// and for bodies with linear or angular factors, or without inertia, which it passes to Bullet's. In the
/// first step of a world that tuneWorld() has not seen the solver is not known yet. False for links of a
/// btMultiBody and for anisotropic friction.
bool checksAlone(const PairView& pair, const PairState& state);

/// Where checksAlone(), solves the step for the pair's two bodies alone, with the contacts in its manifolds,
/// asks state.check which contacts the solution lacks, and adds them to the manifolds, until none is missing
/// or the rounds are used up. The distances in the manifolds are then those for which a solver whose rows are
/// linear ends the step with the gaps that were found, less the contacts' rest gaps.
///
/// Gravity, the user's forces and the pull of couplings act as they were predicted. Other bodies and joints
/// are not known, so that a contact is missed to which only these lead. Bodies are left as they were, and so
/// are the impulses of all contacts that the last step had.
void addMissedAlone(btDispatcher& dispatcher, const PairView& pair, PairState& state);

}  // namespace vps::bullet
