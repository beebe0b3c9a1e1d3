// SPDX-License-Identifier: BSD-3-Clause
// Rigid contact with Coulomb friction, joints and motors of a whole island as a sequence of convex problems.
//
// A round minimises, over the velocities u of the island's bodies,
//
//     1/2 (u - u0)' M (u - u0)  +  sum over contacts  1/(2 s) | P( s p + t n - v(u) ) |^2
//
// where v is a contact's relative velocity, p the impulse found so far, t the least normal velocity, s the
// contact's compliance [m/s per N s] and P the projection onto Coulomb's cone |x_t| <= mu x_n. The impulses
// at the minimum, p = P(s p + t n - v) / s, are those of the next round. So the compliance is only the weight
// of a proximal step (the method of multipliers) and leaves no error. Newton's method with an exact line
// search finds the minimum from any start, since the function is convex and once differentiable; sticking and
// slipping need no case of their own.
//
// The minimum of the convex problem lets a contact that slides rise by mu |v_t|: its force would otherwise
// not be along its cone. Its target is therefore lower by that much, with the slip of the round before. A
// contact that sticks has no such term, so that what is wedged is solved in one sequence.
//
// Sources: De Saxce and Feng 1998 for the term of slip; Acary, Cadoux, Lemarechal and Malick 2011 for the
// sequence of convex problems; Castro, Permenter and Han 2022 for Newton's method on it; Rockafellar 1976 for
// the proximal steps.
#pragma once

#include <span>
#include <vector>

#include "solver/contact_sweeps.h"
#include "solver/fixed_point.h"
#include "solver/island_matrix.h"

namespace vps::bullet::inline v0 {

class SymmetricSum;

class ContactNewton {
 public:
  ContactNewton(Island& island, JointRows& joints) : island_(island), joints_(joints) {}

  /// Updates the impulses of contacts and joints and the bodies' velocities. The contacts' rows must be
  /// prepared. Where it does not converge, the impulses are within their cones all the same. Cost of a step:
  /// a factorisation of 6n x 6n for n bodies, sparse if n is large, and about 0.1 us a contact.
  /// @param residual_m_s  converged: no contact misses its law by a tenth of this velocity, and no slip
  ///                      changes by more, nor does any point of a body when it gets the impulses' velocity
  /// @param step_limit    Newton's steps, over all rounds
  SolveOutcome solve(std::span<RigidContact> contacts, double residual_m_s, int step_limit);

 private:
  /// A contact; impulses are those on body 0, in W.
  struct Point {
    Vec3 r, n;        ///< position from the patch's centre; normal
    double mu;        ///< friction
    double W;         ///< inverse mass
    double softness;  ///< s
    double target;    ///< t [m/s], without the term of slip
    double slip;      ///< mu |v_t| of the round before [m/s]
    Vec3 impulse;     ///< p
    Vec3 next;        ///< p at the velocities that were evaluated last
  };
  /// Consecutive contacts of one pair of bodies.
  struct Patch {
    int body[2] = {-1, -1};
    Vec3 center = Vec3::Zero();
    Mat6 X[2];  ///< twist of a body about its own centre -> its share in the relative one about `center`
    Vec6 fixed = Vec6::Zero();       ///< share of a body that the solver does not move
    std::size_t first = 0, end = 0;  ///< in points_
    Mat6 hessian;
  };
  /// A row of a joint.
  struct Joint {
    JointRow* row;
    double softness, next_Ns;  ///< velocity per impulse; impulse at the velocities that were evaluated last
    bool is_free;              ///< within its limits there
  };
  void start(std::span<const RigidContact> contacts);
  void gather(std::span<const RigidContact> contacts);
  void setCompliance(double compliance);
  void addPatch(const RigidContact& first);
  [[nodiscard]] Vec6 twistOf(const Patch& patch, const std::vector<Vec6>& u) const;
  void evaluate(const std::vector<Vec6>& u, bool with_hessian, std::vector<Vec6>& gradient);
  static void project(Point& point, const Vec3& v, SymmetricSum* hessian);
  void evaluateJoints(const std::vector<Vec6>& u, std::vector<Vec6>& gradient);
  bool findStep();
  bool findStepOfOne();
  bool findStepOfAll();
  [[nodiscard]] double shareOfStep(double slope);
  [[nodiscard]] double imbalance_m_s();
  SolveOutcome minimise(double near_m_s, int step_limit);
  /// How far the round's laws were missed [m/s].
  struct Miss {
    double law_m_s = 0, slip_m_s = 0;

    [[nodiscard]] bool isOfSlip(const Miss& last) const;
  };
  [[nodiscard]] static double slipOf(const Point& point, const Vec6& twist);
  void startSlips();
  Miss endRound();
  void updateSlips();
  void writeImpulses(std::span<RigidContact> contacts) const;

  Island& island_;
  JointRows& joints_;
  IslandMatrix matrix_;
  std::vector<Point> points_;
  std::vector<Patch> patches_;
  std::vector<Joint> joint_states_;
  double off_m_s_ = 0;  // imbalance at the end of the round
  std::vector<Vec6> u_, gradient_, step_, trial_, trial_gradient_, scratch_;
  FixedPoint extrapolation_;  // of slips
  Eigen::VectorXd slips_;     // at the end of the last round
  std::vector<std::pair<int, int>> touching_;
};

}  // namespace vps::bullet::inline v0
