// SPDX-License-Identifier: BSD-3-Clause
// Keeps corners, sharp edges and facets of two bodies apart, by the exact motion of a solved step.
#pragma once

#include <cstdint>
#include <vector>

#include "narrowphase/check/step_path.h"
#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"
#include "solver/rigid/step_check.h"

namespace vps::bullet {

/// True if both bodies have exact surfaces, whose features can be compared.
bool hasFeatures(const PairView& pair, const Settings& settings);
/// The gap at which features of both bodies rest; of bodies without, that of large parts.
double restGap_m(const PairView& pair, const Settings& settings);

/// Adds the contacts of features that earlier steps lacked and that are still as near, in key order; at most
/// 16, beyond the contact limit, which the selection has used up where a part lies on faces. Parts that rest
/// on features that are not among their other contacts would otherwise be solved twice in each step: once
/// without these.
void addMissedFeatures(const PairView& pair, const Settings& settings, PairState& state,
                       std::vector<Candidate>& contacts);

/// Marks the contacts that are kept at a rest gap: those of sharp features and those of flat faces.
/// Where contacts of a face lay deeper than those of its edges, the edges would carry its load alone.
/// Bullet's own solvers keep the friction of contacts that lose their load while they iterate: with these,
/// all have the rest gap that are not flush on curved faces, so that none lies deeper.
/// @param is_own  bullet::Solver solves the pair, not one of Bullet's
void markSharp(const PairView& pair, const Settings& settings, bool is_own, std::vector<Candidate>& contacts);

/// Both bodies' shapes at the end of a step.
struct EndPoses {
  Pose X_WS[2];
  StepPath path = {};
  bool turns_far = false;  ///< the bodies turn by more than kContactTurn_rad against each other
};

/// True if no surfaces of the bodies come to overlap where these turn about an axis with room around it at
/// any angle, or rest there. The axis is taken to move on a straight way in the step, also where the bodies'
/// centres are beside it, as a crank's.
bool spinsFreely(const PairView& start, const Pose (&X_WS_end)[2], PairState& state);

/// Appends a contact for each pair of features that the motion brings too near to each other, up to a limit.
/// @param start  at the start of the step
/// @param round  in the first, small gaps are restored too (FeatureMotion::check()); in late ones, gaps from
///               which the next step can restore the rest gap are left
void addFeatureContacts(const PairView& start, const EndPoses& end, CheckRound round, PairState& state,
                        std::vector<MissedContact>& out);

/// Which rows are taken where the bodies end a step.
struct Relinearising {
  enum class Rows : std::uint8_t {
    Predicted,  ///< the step is not solved yet: rows of the motion that goes on as it is
    Loaded,     ///< it is: rows with load whose contacts end the step apart
    Others      ///< and those whose rows tell a smaller gap there than there is: they would get the load next
  };
  Rows rows = Rows::Predicted;
  double apart_m = 0;  ///< a smaller gap does not matter

  [[nodiscard]] bool isBefore() const { return rows == Rows::Predicted; }
  [[nodiscard]] bool isOfLoad() const { return rows == Rows::Loaded; }
};

/// True if the row of a contact is to be taken at the end of the step. Where the bodies would go on into each
/// other, the end is no place to look at.
bool isOutOfPlace(const Candidate& start, const Candidate& end, const StepPath& path,
                  const Relinearising& which, const Settings& settings);

/// Appends the contacts of features whose rows are to be taken at the end of the step.
void lineariseFeatures(const PairView& start, const EndPoses& end, const Relinearising& which,
                       PairState& state, std::vector<MissedContact>& out);

/// The share of the motion up to which no features come too near; 1 if none do.
double freeShareOf(const PairView& start, const EndPoses& end, PairState& state);

}  // namespace vps::bullet
