// SPDX-License-Identifier: BSD-3-Clause
// Constraint contacts of many bodies: heaps.
//
// The alternating direction method of multipliers. Contacts are first seen as springs that hold in all
// directions, balanced over the whole island; then each impulse is projected onto its cone by itself, and
// what was cut off is the next springs' offset. The springs do not change, so that the island's matrix is
// factorised once, and an iteration costs as much as two sweeps; but a sweep carries a load from a body to
// its neighbour, and an iteration to all. Newton's method, which is exact for a few bodies, finds no set of
// sticking and slipping contacts in a heap whose parts all move. Sources: Boyd et al. 2011 for the method;
// Tasora, Mangoni, Benatti and Garziera 2021 for contact and friction with it. They project onto the convex
// cone, which lets a sliding contact rise; here the normal impulse is limited first and friction by it, as in
// sweeps, which has Coulomb's law as its only solution but no proof of convergence.
#pragma once

#include <span>
#include <vector>

#include "solver/contact_sweeps.h"
#include "solver/island_matrix.h"

namespace vps::bullet::inline v0 {

class RigidAdmm {
 public:
  explicit RigidAdmm(Island& island) : island_(island) {}

  /// Improves the impulses of contacts, whose rows must be prepared; the bodies' velocities have to be
  /// computed from them anew. There must be no joints. Impulses stay as they are if a velocity is not finite.
  /// Cost: a factorisation of 6n x 6n for n bodies; measured for 50 bodies and 1300 contacts: 80 us for each
  /// iteration.
  /// @param residual_m_s  converged: no impulse changes, or differs from its spring's, by more than gives a
  /// contact this velocity
  SolveOutcome solve(std::span<RigidContact> contacts, double residual_m_s, int limit);

 private:
  /// A contact; impulses are those on body 0, in W.
  struct Point {
    Vec3 r, n;                 // position from the patch's centre; normal
    double W, mu;              // inverse mass; friction
    double softness;           // of the spring: velocity per impulse
    Vec3 shift;                // offset of the spring, from the velocity that the contact asks for
    Vec3 impulse;              // within the cone
    Vec3 pull = Vec3::Zero();  // the scaled dual variable: all that the cone has cut off
  };
  /// Consecutive contacts of one pair of bodies.
  struct Patch {
    int body[2] = {-1, -1};
    Vec3 center;
    Mat6 X[2];  // twist of a body about its own centre -> its share in the relative twist about `center`
    std::size_t first = 0, end = 0;  // in points_
  };
  void gather(std::span<const RigidContact> contacts);
  [[nodiscard]] Vec6 twistOf(const Patch& patch, const Eigen::VectorXd& u) const;
  void start();
  [[nodiscard]] bool factorise();
  void balance();
  [[nodiscard]] double cut();
  void writeImpulses(std::span<RigidContact> contacts) const;

  Island& island_;
  IslandMatrix matrix_;
  std::vector<Point> points_;
  std::vector<Patch> patches_;
  Eigen::VectorXd momentum_, u_;  // of all bodies
};

}  // namespace vps::bullet::inline v0
