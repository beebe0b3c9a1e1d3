// SPDX-License-Identifier: BSD-3-Clause
// Contacts at other poses of their bodies: carried along with the bodies, or measured again.
#pragma once

#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"

namespace vps::bullet {

/// Rigid motions of both bodies between two instants, in W.
struct Displacement {
  Pose D[2];

  [[nodiscard]] Vec3 normal(const Candidate& c) const;
  /// The contact after both bodies have moved: its points and its plane move with the bodies.
  [[nodiscard]] Candidate moved(const Candidate& c) const;
  [[nodiscard]] Displacement inverse() const { return {{D[0].inverse(), D[1].inverse()}}; }
};

/// Updates an edge crossing to the present poses. Returns false if the edges cross beyond the end of one of
/// them.
bool crossAt(Candidate& c, const SideView& body0, const SideView& body1);

/// Overlap of a contact at the pair's poses, as a distance <= 0; 0 for edges that do not cross at these
/// poses.
double overlapOf(Candidate c, const PairView& pair);

/// True if a point is deeper inside the other body than `tolerated_m`. Always true if the other body is not a
/// solid.
/// @param near_m  search radius for the other body's surface
bool isInside(const Vec3& p_W, const SideView& other, double near_m, double tolerated_m);

/// Measures the contact of a shell point again at the pair's poses. Returns false if its distance is not less
/// than max_m.
bool refineAt(const PairView& pair, double max_m, const Settings& settings, Candidate& c);

/// True if both shapes have curved faces. Curved faces may lie flush in each other, as in threads and
/// bearings. The gaps between such faces differ from facet to facet by more than the motion changes them, and
/// solver rows that follow the facets would drive a screw.
bool areBothCurved(const PairView& pair, PairState& state);

/// Lists the contacts of shell points twice: `now` as the step has them, `ends` measured at the poses of
/// `there`. A contact that is out of reach at the poses of `there` has a zero normal in `ends`.
/// @param only_loaded  list only the contacts that carry load
void findThere(const PairView& there, const PairState& state, bool only_loaded, std::vector<Candidate>& now,
               std::vector<Candidate>& ends);

}  // namespace vps::bullet
