// SPDX-License-Identifier: BSD-3-Clause
// Contacts at other poses of their bodies: carried along with the bodies, or measured again.
#pragma once

#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"

namespace vps::bullet {

/// Displacements of both bodies.
struct Displacement {
  Pose D[2];

  [[nodiscard]] Vec3 normal(const Candidate& c) const;
  /// The contact where its points and its plane go.
  [[nodiscard]] Candidate moved(const Candidate& c) const;
  [[nodiscard]] Displacement inverse() const { return {{D[0].inverse(), D[1].inverse()}}; }
};

/// Sets a crossing to where its two edges cross now. False: beyond the end of one of them.
bool crossAt(Candidate& c, const SideView& body0, const SideView& body1);

/// How deep a contact overlaps where the bodies are; 0 or less. Edges that cross later may not cross yet.
double overlapOf(Candidate c, const PairView& pair);

/// True if a point is deeper than tolerated in the other side; where that is no solid, always.
/// @param near_m  how far the other's surface is searched for
bool isInside(const Vec3& p_W, const SideView& other, double near_m, double tolerated_m);

/// Sets the contact of a shell point to the one that it has where the bodies are, if its distance is less
/// than max_m; else false.
bool refineAt(const PairView& pair, double max_m, const Settings& settings, Candidate& c);

/// True if both shapes have curved faces. Where these may lie flush in each other, as in threads and
/// bearings, gaps differ from facet to facet by more than the motion bends them, and rows that follow them
/// would drive a screw.
bool areBothCurved(const PairView& pair, PairState& state);

/// The contacts of shell points, as they are in the step and where the bodies are `there`. A point that is
/// out of reach there has no normal.
/// @param only_loaded  those that carry load
void findThere(const PairView& there, const PairState& state, bool only_loaded, std::vector<Candidate>& now,
               std::vector<Candidate>& ends);

}  // namespace vps::bullet
