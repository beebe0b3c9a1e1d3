// SPDX-License-Identifier: BSD-3-Clause
// Stage 3 of PairCheck: keeps corners, sharp edges and facets of two bodies apart, by their exact motion in
// a solved step.
#pragma once

#include <cstdint>
#include <vector>

#include "narrowphase/check/step_path.h"
#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"
#include "solver/rigid/step_check.h"

namespace vps::bullet {

/// True if both bodies have exact surfaces with features.
bool hasFeatures(const PairView& pair, const Settings& settings);
/// Gap at which features of both bodies rest. For bodies without features, the gap of large parts.
double restGap_m(const PairView& pair, const Settings& settings);

/// Adds the feature contacts that were missed in earlier steps and are still near, in key order; at most 16,
/// beyond the contact limit. Without this call a part that rests on features would be solved twice in each
/// step, first without the missed contacts.
void addMissedFeatures(const PairView& pair, const Settings& settings, PairState& state,
                       std::vector<Candidate>& contacts);

/// Sets the rest gap of contacts of sharp features and of flat faces. If the contacts of a face lay deeper
/// than the contacts of its edges, the edges would carry the load alone. Bullet's own solvers keep the
/// friction of contacts that lose their load while they iterate. With Bullet's solvers all contacts except
/// flush ones on curved faces get the rest gap, so that none lies deeper.
/// @param is_own  true if bullet::Solver solves the pair, false for one of Bullet's solvers
void markSharp(const PairView& pair, const Settings& settings, bool is_own, std::vector<Candidate>& contacts);

/// Poses of both shapes at the end of a step.
struct EndPoses {
  Pose X_WS[2];
  StepPath path = {};
  bool turns_far = false;  ///< the bodies turn by more than kContactTurn_rad against each other
};

/// True if the bodies turn about an axis, or rest, in a place where their surfaces have room around that axis
/// at any angle. The axis is assumed to move along a straight line in the step, even if the bodies' centres
/// lie beside it, as with a crank.
bool spinsFreely(const PairView& start, const Pose (&X_WS_end)[2], PairState& state);

/// Appends a contact for each pair of features that the motion brings too close together, up to kMostAdded.
/// @param start  the pair at the start of the step
/// @param round  number of the check: the first check restores small gaps too (FeatureMotion::check()); late
///   checks ignore gaps from which the next step can restore the rest gap
void addFeatureContacts(const PairView& start, const EndPoses& end, CheckRound round, PairState& state,
                        std::vector<MissedContact>& out);

/// Which rows of contacts are computed again, from the bodies' end poses.
struct Relinearising {
  enum class Rows : std::uint8_t {
    Predicted,  ///< before the solve: all rows, for motion at the last velocities
    Loaded,     ///< after the solve: rows with load whose contacts end the step apart
    Others      ///< after the solve: rows that predict too small a gap and would get the load next
  };
  Rows rows = Rows::Predicted;
  double apart_m = 0;  ///< smaller gaps are ignored

  [[nodiscard]] bool isBefore() const { return rows == Rows::Predicted; }
  [[nodiscard]] bool isOfLoad() const { return rows == Rows::Loaded; }
};

/// True if the row of a contact must be computed again, from the end poses of the step. False if the bodies
/// would overlap at the end poses, which are then meaningless.
bool isOutOfPlace(const Candidate& start, const Candidate& end, const StepPath& path,
                  const Relinearising& which, const Settings& settings);

/// Appends the feature contacts whose rows must be computed again, from the end poses of the step.
void lineariseFeatures(const PairView& start, const EndPoses& end, const Relinearising& which,
                       PairState& state, std::vector<MissedContact>& out);

/// Greatest share of the motion during which no features come too close together; 1 if none do.
double freeShareOf(const PairView& start, const EndPoses& end, PairState& state);

}  // namespace vps::bullet
