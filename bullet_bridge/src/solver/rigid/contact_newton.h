// SPDX-License-Identifier: BSD-3-Clause
// Rigid contact with Coulomb friction, joints and motors of a whole island by Newton's method.
//
// The method is an outer iteration; one pass of it is called a round. A round solves, for the velocities u of
// the island's bodies,
//
//     M (u - u0)  =  sum over contacts  J' P( p + (t n - v - mu |v_t| n) / s )
//
// where M is the mass matrix, u0 the velocities without contact, J the contact's Jacobian, v = J u its
// relative velocity with the tangential part v_t, n its normal, p its impulse from the round before, t the
// least normal velocity that the contact allows, s the contact's compliance [m/s per N s] and P the
// projection onto Coulomb's cone |x_t| <= mu x_n. The impulses P(...) at the round's solution become the
// impulses p of the next round. The compliance is only the weight of a proximal step (method of multipliers)
// and leaves no error. The first rounds use a great compliance, with which Newton's method converges well;
// later rounds use a smaller one. Sticking and slipping need no separate cases.
//
// The term mu |v_t| is De Saxce's. Without this term a sliding contact would separate at the speed mu |v_t|.
// The term makes the matrix of Newton's method unsymmetric, and the equation is not the condition of a
// minimum. A Newton step, or a fraction of it, is therefore accepted if it reduces the residual of the
// equation, a momentum, which is called the missing momentum. If no fraction reduces the residual, a step of
// the convex problem with the present value of the slip term is taken instead; its exact line search makes
// progress from any point. A round that still does not converge is repeated with more compliance.
//
// If the slip term were taken from the previous round, the rounds would converge linearly only: of 47
// problems of ten brackets that lie on each other, 30 were solved in 60 steps, instead of 46.
//
// Sources: De Saxce and Feng 1998 for the term of slip; Alart and Curnier 1991 for Newton's method with this
// term; Castro, Permenter and Han 2022 for the convex problem; Rockafellar 1976 for the proximal steps.
#pragma once

#include <span>
#include <vector>

#include "solver/island/island_matrix.h"
#include "solver/island/newton_math.h"
#include "solver/rigid/contact_sweeps.h"

namespace vps::bullet {

class ContactNewton {
 public:
  ContactNewton(Island& island, JointRows& joints) : island_(island), joints_(joints) {}

  /// Updates the impulses of contacts and joints and the bodies' velocities. The contacts' rows must be
  /// prepared. If the method does not converge, the impulses are still within their cones. Cost of a step: a
  /// factorisation (IslandMatrix), and about 0.2 us a contact.
  /// @param residual_m_s  converged if no contact misses its law by more than a tenth of this velocity, and
  ///   the impulses' velocities differ from the solution by no more than this at any point of a body
  /// @param step_limit  greatest number of Newton steps, over all rounds
  SolveOutcome solve(std::span<RigidContact> contacts, double residual_m_s, int step_limit);

 private:
  /// A contact. Impulses act on body 0, in W.
  struct Point {
    Vec3 r, n;        ///< position relative to the patch's centre; normal
    double mu;        ///< coefficient of friction
    double W;         ///< inverse mass
    double softness;  ///< s
    double target;    ///< t [m/s], without the term of slip
    double slip;      ///< mu |v_t|, at present or, in a convex step, at the start of the step [m/s]
    Vec3 impulse;     ///< p
    Vec3 next;        ///< p at the velocities evaluated last
  };
  /// Consecutive contacts of one pair of bodies.
  struct Patch {
    int body[2] = {-1, -1};
    Vec3 center = Vec3::Zero();
    Mat6
        X[2];  ///< maps a body's twist about its own centre to its share of the relative twist about `center`
    Vec6 fixed = Vec6::Zero();       ///< share of the relative twist of a body that the solver does not move
    std::size_t first = 0, end = 0;  ///< range in points_
    Mat6 jacobian;                   ///< derivative of the patch's missing wrench by the relative twist
  };
  /// Minus the derivative of a patch's wrench: springs of the sticking contacts, and the rest.
  struct Stiffness {
    SymmetricSum springs;
    Mat6 rest = Mat6::Zero();
  };
  /// Whether the slip terms are updated with the velocities or kept.
  enum class Slips : std::uint8_t { Follow, Stay };
  /// A row of a joint.
  struct Joint {
    JointRow* row;
    double softness, next_Ns;  ///< velocity per impulse; impulse at the velocities evaluated last
    bool is_free;              ///< next_Ns is within the row's limits
  };
  void start(std::span<const RigidContact> contacts);
  void gather(std::span<const RigidContact> contacts);
  void setCompliance(double compliance);
  void addPatch(const RigidContact& first);
  [[nodiscard]] Vec6 twistOf(const Patch& patch, const std::vector<Vec6>& u) const;
  void evaluate(const std::vector<Vec6>& u, Slips slips, bool with_jacobian, std::vector<Vec6>& missing);
  static void project(Point& point, const Vec3& v, Slips slips, Stiffness* stiffness);
  void evaluateJoints(const std::vector<Vec6>& u, std::vector<Vec6>& missing);
  bool findStep();
  [[nodiscard]] double sizeOf(const std::vector<Vec6>& missing);
  bool step();
  bool convexStep();
  void moveTo(double share);
  [[nodiscard]] double imbalance_m_s();
  SolveOutcome solveRound(double near_m_s, int step_limit);
  double endRound();
  void writeImpulses(std::span<RigidContact> contacts) const;

  Island& island_;
  JointRows& joints_;
  IslandMatrix matrix_;
  std::vector<Point> points_;
  std::vector<Patch> patches_;
  std::vector<Joint> joint_states_;
  double off_m_s_ = 0;  // imbalance at the end of the round
  std::vector<Vec6> u_, missing_, step_, trial_, trial_missing_, scratch_;
  std::vector<std::pair<int, int>> touching_;
};

}  // namespace vps::bullet
