// SPDX-License-Identifier: BSD-3-Clause
// Constraint contacts of many bodies: heaps.
//
// The alternating direction method of multipliers. Contacts are first seen as springs that hold in all
// directions, balanced over the whole island; then each force is cut to its cone by itself, and what was cut
// is the next springs' offset. The springs do not change, so that the island's matrix is factorised once, and
// an iteration costs little more than a sweep; but a sweep carries a load from a body to its neighbour, and
// an iteration to all. Newton's method, which is exact for a few bodies, finds no set of sticking and
// slipping contacts in a heap whose parts all move. Sources: Boyd et al. 2011 for the method; Tasora,
// Mangoni, Benatti and Garziera 2021 for contact and friction with it.
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
  /// computed from them anew. There must be no joints. Cost: a factorisation of 6n x 6n for n bodies, and for
  /// each iteration one solution with it and 0.03 us a contact.
  /// @param residual_m_s  converged: no velocity changes by more
  SolveOutcome solve(std::span<RigidContact> contacts, double residual_m_s, int limit);

 private:
  /// A contact; impulses are those on body 0, in W.
  struct Point {
    Vec3 r, n;                 // position from the patch's centre; normal
    double W, mu;              // inverse mass; friction
    double softness;           // of the spring: velocity per impulse
    Vec3 shift;                // impulse of the spring in rest, from the velocity that the contact asks for
    Vec3 impulse;              // within the cone
    Vec3 pull = Vec3::Zero();  // what the cone cut, which the spring gets in addition
  };
  /// Contacts of two bodies that follow each other.
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
