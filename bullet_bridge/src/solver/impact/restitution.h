// SPDX-License-Identifier: BSD-3-Clause
// Restitution: the end velocities of bodies that met in a step.
//
// The step was solved without restitution, and its displacement is not changed, so that gaps are kept as
// without restitution, however narrow they are. Restitution only changes the velocities at the end pose, in
// three stages:
//
// 1. Group: bodies connected by contacts that touch at the end of the step, and by joints. Nothing happens
//    in a group without an impact. An impact is a contact with e > 0 that carried load in the step and whose
//    bodies approached each other before the step, faster than the threshold of Bullet's
//    btContactSolverInfo. The gravity of the step itself does not count as approach, so a body at rest does
//    not bounce.
// 2. Bounce: the velocities before the step, referred to the end pose and with the kick of the time up to the
//    impact, are reflected (reflections.h). The solution's impulses acted along lines at the start poses. The
//    angular momentum that the displacement changes thereby is given back as one rotation of the group. Given
//    back to single bodies, this momentum would make a light body between heavy ones spin without bound.
// 3. Settle: the external impulses are added again, and contacts that then approach (a part that rests on
//    another) are stopped, with Coulomb's friction, whose limit is that of the whole normal impulse of the
//    step. The sweeps start from the impulses of the solution. Friction only reduces slip.
//
// Time of the impact. Bullet adds the kick of gravity and other forces, dt f / m, to the velocity and then
// moves the body (symplectic Euler). The body's poses lie exactly on a parabola, whose velocity at each pose
// is the stored velocity plus half a kick. The velocity at an impact at time tau of the step is the stored
// velocity plus (1/2 + tau / dt) of the kick. The velocity at the impact is reflected, and half a kick is
// subtracted from the result, which gives the velocity to store. The rest of the step's kick, 1 - tau / dt,
// would only act after the displacement, which ends at the contact: contacts that were hit keep their
// velocities in this rest of the kick. A body therefore bounces e^2 times as high at each impact, for any
// step size. Bodies that rest on contacts or hang on joints do not approach by the kick, since these stop it.
//
// The impulses of the restitution act at the end pose, on both bodies along one line. Linear and angular
// momentum are therefore conserved to rounding, although the displacement does not match the end velocities.
// The line moves with the body that turns more easily, so that a box that bounces off a plate is not turned
// by it.
//
// Energy. At one pose, reflections keep the energy and settling reduces it. But the bounce happens at another
// pose than the one before the step, a difference of the order of the step. Therefore the group's change of
// velocities is scaled down where its energy, with half a kick, would be above what the bodies had before the
// step, plus the work of all other forces in the displacement (gravity, couplings, motors), plus the work of
// bodies that contact does not move. No group ever gains energy by restitution, even if an iteration has
// not converged. The masses are those of the bodies, not the effective ones: a coupling's spring and damper
// have no share in an impact.
//
// A shortened step (endEarly()) bounces as well. The end poses of such a step are not exactly those of the
// contacts, but a bounce needs only the velocities before the step and the loaded contacts. Momentum and
// energy are kept as above.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/impact/reflections.h"
#include "solver/island/island.h"
#include "solver/island/joint_rows.h"
#include "solver/rigid/contact_sweeps.h"

struct btContactSolverInfo;

namespace vps::bullet {

class Restitution {
 public:
  Restitution(const Island& island, JointRows& joints) : island_(island), joints_(joints) {}

  /// Changes the end velocities of groups with an impact, and adds the impulses to those of contacts and
  /// joints.
  /// @param contacts  contacts of the solved island
  /// @param solution  solution of the island. A shortened step has other displacements, but its end
  ///   velocities have the solution's momenta.
  /// @param ends  ends from Island::readEnds()
  void apply(std::span<RigidContact> contacts, const StepSolution& solution, std::span<BodyEnd> ends,
             const btContactSolverInfo& info);

 private:
  struct Contact {
    RigidContact* of = nullptr;
    ImpactRow tangent[2];
    double p_t[2] = {0, 0};  // total friction impulses
    double W_t = 0;          // upper bound of the greatest eigenvalue of the tangent block
    double touch_m = 0;      // gap at which the bodies count as touching
  };
  struct Group {
    std::vector<int> bodies;  // indices in the island
    std::vector<Mat6> inverse_mass;
    std::vector<Vec6> impulse;   // change of momentum in the step by all impulses of the solution
    std::vector<Vec6> external;  // change of velocity by everything except contacts and joints
    std::vector<Vec6> kick;      // change of velocity by gravity and the user's forces
    std::vector<Vec6> solved;    // end velocities of the solution
    std::vector<Vec6> v;         // end velocities with restitution, the result
    std::vector<Contact> contacts;
    std::vector<JointRow*> joints;
    std::vector<ImpactRow> rows;     // normals of the contacts, then rows of joints
    std::vector<double> solved_Ns;   // impulses of the rows in the solution
    std::vector<double> bounced_Ns;  // impulses of the impact alone
    std::vector<double> p_Ns;        // total impulses of the rows
  };

  [[nodiscard]] bool isImpact(const RigidContact& c, double threshold_m_s) const;
  void findTouch(std::span<const RigidContact> contacts);
  void connect(std::span<RigidContact> contacts, const StepSolution& solution, double dt_s);
  [[nodiscard]] int rootOf(int body) const;
  [[nodiscard]] Vec3 placeOf(const RigidContact& c, const StepSolution& solution,
                             std::span<const BodyEnd> ends) const;
  [[nodiscard]] ImpactRow rowOf(const ContactRow& row, const Vec3& at_W, const Vec3& d_W,
                                std::span<const BodyEnd> ends) const;
  void gather(int root, std::span<RigidContact> contacts, const StepSolution& solution,
              std::span<const BodyEnd> ends);
  void takeExternal(const StepSolution& solution);
  [[nodiscard]] std::vector<Vec6> beforeStep(std::span<const BodyEnd> ends, double dt_s) const;
  [[nodiscard]] double shareOfImpact(const std::vector<Vec6>& before, double dt_s) const;
  [[nodiscard]] double kickAlong(std::size_t row) const;
  [[nodiscard]] std::vector<std::uint8_t> holding(const std::vector<Vec6>& before, double dt_s) const;
  std::vector<Vec6> restOfKick(double share);
  void bounce(std::span<const BodyEnd> ends, double dt_s);
  void settle();
  void settleFriction(Contact& c, double limit_Ns, double& most_m_s);
  [[nodiscard]] double shareWithoutGain(std::span<const BodyEnd> ends) const;
  void write(double share, std::span<BodyEnd> ends);

  const Island& island_;
  JointRows& joints_;
  std::vector<int> parent_;            // parent of each body in the union-find forest of groups
  std::vector<int> local_;             // index of each body in group_; -1 for bodies of other groups
  std::vector<double> touch_m_;        // gap of each contact at which its bodies touch
  std::vector<std::uint8_t> touches_;  // whether the bodies of each contact touch
  Group group_;
};

}  // namespace vps::bullet
