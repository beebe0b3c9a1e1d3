// SPDX-License-Identifier: BSD-3-Clause
// Statics leaves open how the contacts of a flush face share its load. The pressure that a solver starts from
// is made the even one.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/rigid/contact_sweeps.h"

namespace vps::bullet {

/// Spreads the normal impulses of each pair of bodies over its contacts that touch, so that force and moment
/// stay and the sum of p^2 / area is least: as under a body on an even, soft layer. Friction is spread
/// likewise. A solver that starts from them goes to the solution nearest to them, so that the even pressure
/// stays wherever it is one. Where contacts hold bodies in a single way, or no such impulses all
/// press, they stay. Cost: some 50 ns a contact and 1 us a pair.
class EvenPressure {
 public:
  explicit EvenPressure(const Island& island) : island_(island) {}
  void spread(std::span<RigidContact> contacts);

 private:
  void spreadPair(std::span<RigidContact> contacts);
  bool spreadFriction(std::span<RigidContact> contacts, const Vec3& center, double length_m);

  /// Contacts of one pair that follow each other.
  struct Run {
    std::size_t first, end;
  };
  const Island& island_;
  std::vector<Run> runs_;
  std::vector<std::size_t> group_;  // indices of the contacts of one pair that touch
  std::vector<Vec6> rows_;          // wrench of a unit impulse on each
  std::vector<double> impulses_Ns_;
  std::vector<std::array<double, 2>> friction_Ns_;
};

}  // namespace vps::bullet
