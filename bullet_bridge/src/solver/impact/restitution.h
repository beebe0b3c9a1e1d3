// SPDX-License-Identifier: BSD-3-Clause
// Restitution: the end velocities of bodies that met in a step.
//
// The step was solved without restitution, and its displacement stays that of this solution, so that gaps are
// kept as without restitution, however narrow they are. What remains is a problem of velocities at the end
// pose:
//
//   group     bodies that hang together by contacts that touch at the end of the step, and by joints. Nothing
//   happens
//             in a group without an impact: a contact with e > 0 that carried load in the step and whose
//             bodies approached each other before it, faster than the threshold of Bullet's
//             btContactSolverInfo. Gravity of the step itself is no approach, so a body at rest does not
//             bounce.
//   bounce    The velocities before the step, at the end pose, with the kick of the time up to the impact,
//             are reflected (reflections.h). The solution's impulses acted at the lines of the start: what
//             angular momentum the displacement changes by that is given back as one rotation of the group,
//             not to single bodies, of which a light one between heavy ones would spin without bound.
//   settle    The external impulses are given back, and what then approaches (a part that rests on another)
//   is stopped,
//             with Coulomb's friction, whose limit is that of the whole normal impulse of the step: sweeps
//             that start from the impulses of the solution. Friction only reduces slip.
//
// Time of the impact. Bullet adds the kick of gravity and other forces, dt f / m, to the velocity and then
// moves the body (symplectic Euler). Its poses lie exactly on a parabola, whose velocity there is the stored
// one plus half a kick. So the velocity at an impact, tau after the beginning of the step, is the stored one
// plus 1/2 + tau / dt of the kick; this is reflected, and half a kick is taken from it again. The rest of
// the step's kick, 1 - tau / dt, would only act after the displacement, which ends at the contact: contacts
// that were hit keep their velocities in it. So a body bounces e^2 times as high at each impact, whatever
// the step is. What rests on contacts or hangs on joints has no approach by the kick: these stop it before.
//
// The impulses that come on top of those of the solution act at the end pose, on both bodies in one line. So
// linear and angular momentum are kept to rounding, although the displacement is not that of the end
// velocities. The line goes with the body that turns more easily, so that a box that bounces off a plate is
// not turned by it.
//
// Energy. In one pose, reflections keep it and settling takes it. But the pose of the bounce is not that
// before the step, which is a difference of the order of the step. Therefore the group's change of velocities
// is scaled down where its energy, with half a kick, would be above what the bodies had before the step, plus
// the work in the displacement of all that is no contact (gravity, couplings, motors), plus that of bodies
// which contact does not move. So no group ever gains energy by restitution, whatever has not converged. The
// masses are those of the bodies, not the effective ones: a coupling's spring and damper have no share in an
// impact.
//
// A step that was cut short, because its solution would leave overlaps, bounces as well. Its end poses are
// not quite those of the contacts, but the velocities before the step and the contacts that carry load are
// known, and these are all that a bounce needs: momentum and energy are kept as above.
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
  /// @param contacts  of the solved island
  /// @param solution  of the island. A step that was cut short has other displacements, but the end
  /// velocities are those of the solution's momenta.
  /// @param ends      from Island::readEnds()
  void apply(std::span<RigidContact> contacts, const StepSolution& solution, std::span<BodyEnd> ends,
             const btContactSolverInfo& info);

 private:
  struct Contact {
    RigidContact* of = nullptr;
    ImpactRow tangent[2];
    double p_t[2] = {0, 0};  // in all
    double W_t = 0;          // at least the greatest eigenvalue of its tangent block
    double touch_m = 0;      // its bodies touch at this gap
  };
  struct Group {
    std::vector<int> bodies;  // of the island
    std::vector<Mat6> inverse_mass;
    std::vector<Vec6> impulse;   // change of momentum in the step, all impulses of the solution together
    std::vector<Vec6> external;  // change of velocity by what is no contact or joint
    std::vector<Vec6> kick;      // that by gravity and the user's forces
    std::vector<Vec6> solved;    // end velocities of the solution
    std::vector<Vec6> v;         // those that are sought
    std::vector<Contact> contacts;
    std::vector<JointRow*> joints;
    std::vector<ImpactRow> rows;     // normals of the contacts, then joints
    std::vector<double> solved_Ns;   // their impulses in the solution
    std::vector<double> bounced_Ns;  // in the impact alone
    std::vector<double> p_Ns;        // in all
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
  std::vector<int> parent_;            // of each body, towards the root of its group
  std::vector<int> local_;             // index of each body in group_; -1: of another group
  std::vector<double> touch_m_;        // of each contact, the gap at which its bodies touch
  std::vector<std::uint8_t> touches_;  // of each contact
  Group group_;
};

}  // namespace vps::bullet
