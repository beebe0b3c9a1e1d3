// SPDX-License-Identifier: BSD-3-Clause
// Evens the pressure from which the solver starts. Statics does not determine how the contacts of a flush
// face share its load.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/rigid/contact_sweeps.h"

namespace vps::bullet {

/// Redistributes the normal impulses of each pair of bodies over its touching contacts: force and moment are
/// kept, and the sum of p^2 / area becomes least, as under a body on an even, soft layer. Friction is
/// redistributed likewise. The solver then converges to the solution nearest to this start, so the even
/// pressure remains wherever it is a solution. Impulses are not changed if the contacts determine them
/// uniquely, or if the even impulses would not all press. Cost: some 50 ns per contact and 1 us per pair.
class EvenPressure {
 public:
  explicit EvenPressure(const Island& island) : island_(island) {}
  void spread(std::span<RigidContact> contacts);

 private:
  void spreadPair(std::span<RigidContact> contacts);
  bool spreadFriction(std::span<RigidContact> contacts, const Vec3& center, double length_m);

  /// Consecutive contacts of one pair.
  struct Run {
    std::size_t first, end;
  };
  const Island& island_;
  std::vector<Run> runs_;
  std::vector<std::size_t> group_;  // indices of one pair's touching contacts
  std::vector<Vec6> rows_;          // wrench of a unit impulse at each contact of group_
  std::vector<double> impulses_Ns_;
  std::vector<std::array<double, 2>> friction_Ns_;
};

}  // namespace vps::bullet
