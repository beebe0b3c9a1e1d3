// SPDX-License-Identifier: BSD-3-Clause
// Contacts that go with their bodies: where their points, planes and edges are at other poses.
#pragma once

#include "narrowphase/contact_candidate.h"
#include "narrowphase/pair_view.h"

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

}  // namespace vps::bullet
