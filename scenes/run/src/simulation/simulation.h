// SPDX-License-Identifier: BSD-3-Clause
// The Bullet world of a scene: one cooked fixed body, dynamic parts, and the coupling to the device's proxy.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "models/fixed_field.h"
#include "models/resampled_shells.h"
#include "vps/coupling_law.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/model_plan.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The contacts of the last step.
struct TouchState {
  int contacts = 0;    ///< contacts that carry force
  double depth_m = 0;  ///< deepest contact as the solver saw it, at the start of the step
  double force_N = 0;  ///< sum of contact force magnitudes
};

/// Combines plugin, Bullet bridge and coupling, without device and procedure. The class is not thread-safe.
/// Bullet's types are hidden behind a pointer.
class Simulation {
 public:
  /// The parts must have the models of the plan (buildModels()). Bodies are added one by one. Both arguments
  /// must outlive this object.
  Simulation(const Scene& scene, const ModelPlan& plan);
  ~Simulation();

  /// False if the field in place serves a step with these parts. Parts of the field in place must come first
  /// in `parts`.
  [[nodiscard]] bool needsField(const std::vector<FixedPart>& parts, const FieldPlan& step) const;
  /// Input for cookField(), which makes a field of these parts on any thread. If the field in place consists
  /// of the first of `parts`, in this order, the new map is built on the map in place, unless `rebuilds` is
  /// set.
  FieldOrder orderField(const std::vector<FixedPart>& parts, const FieldPlan& step, bool rebuilds = false);
  /// Replaces the field between two steps. The field's parts are no longer bodies of their own. O(1) except
  /// for freeing memory. The field is one Bullet body; each contact with the field has the material of the
  /// part that is touched.
  void setField(CookedField field);
  /// Removes the field between two steps.
  void clearField();
  /// The field in place; it has no parts if nothing is fixed.
  [[nodiscard]] const CookedField& field() const;
  [[nodiscard]] bool hasFixed() const;

  /// Input for resampleShells(), which makes new shells of this body and of the field, on any thread.
  [[nodiscard]] ResampleOrder orderResampling(std::size_t part);
  /// Replaces the body's shape between two steps. Bodies and fields that are made later use the same shells.
  /// The present field is replaced by setField(). If `resampled` has no shape, only later bodies and fields
  /// are affected. O(1) except for freeing memory.
  void setShells(ResampledShells resampled);

  /// Adds a part as a dynamic body at rest, without sleeping and damping. Throws LoadError for a mass that is
  /// not positive.
  /// @param most_kg  a heavier part is simulated with this mass, and its inertia is scaled in proportion
  /// @return the part's own mass [kg]
  double addBody(std::size_t part, const Pose& X_WP,
                 double most_kg = std::numeric_limits<double>::infinity());
  void removeBody(std::size_t part);
  /// From now on the body is fixed, whatever touches it.
  void hold(std::size_t part);
  /// Sets the velocity of the part's origin, in W.
  void setTwist(std::size_t part, const Twist& V_WP_W);

  /// Couples the proxy to the part at grasp frame G; only one part can be coupled at a time.
  void grasp(std::size_t part, const Pose& X_PG, const CouplingGains& gains);
  /// Gains of the coupling from the next step on.
  void setGains(const CouplingGains& gains);
  void release();
  /// Applies a wrench to the part in hand at its grasp frame, in W, in the coming step only.
  void push(const Wrench& F_G_W);
  /// Sets the proxy's state at the end of the coming step.
  void setProxy(const CouplingState& proxy);
  /// Present state of the part's grasp frame, to which the haptic loop couples.
  [[nodiscard]] CouplingState graspState() const;

  /// Called after each substep, with its number from 1 on and the number of substeps.
  using AfterPart = std::function<void(int number, int parts)>;
  /// Makes one step, in as many equal substeps as Fidelity::substeps states. The proxy moves by the same
  /// amount in each substep. Throws LoadError naming the part whose pose is no longer finite.
  void step(double dt_s, const AfterPart& after = {});

  [[nodiscard]] Pose pose(std::size_t part) const;
  /// Velocity of the part's origin, in W.
  [[nodiscard]] Twist twist(std::size_t part) const;
  [[nodiscard]] double kineticEnergy() const;
  /// Kinetic and potential energy of all dynamic bodies; the zero of the energy is arbitrary but fixed for a
  /// set of bodies.
  [[nodiscard]] double mechanicalEnergy() const;
  [[nodiscard]] double mass(std::size_t part) const;
  /// Inertia about the centre of mass, in the part's frame [kg m^2].
  [[nodiscard]] Mat3 inertia(std::size_t part) const;
  /// Material of contacts between the part and each part of the field, in the field's order.
  struct FieldContact {
    double friction = 0;  ///< coefficient of friction
    double stiffness_N_per_m3 = 0;
  };
  [[nodiscard]] std::vector<FieldContact> fieldContacts(std::size_t part) const;
  /// The cooked field, in W, valid until the next setField(); null if nothing is fixed.
  [[nodiscard]] const VoxMap* fixedMap() const;
  /// Centre of mass in the part's frame.
  [[nodiscard]] Vec3 centreOfMass(std::size_t part) const;
  [[nodiscard]] TouchState touch() const;
  /// Sum of the normal forces of the contacts that guide a part along the unit vector axis_W: the contacts
  /// whose normal is more than 30 degrees off the axis (all contacts if axis_W is zero). Friction is left
  /// out.
  [[nodiscard]] double forceAcross_N(const Vec3& axis_W) const;
  void contactMarks(std::vector<ContactMark>& marks) const;
  /// Number of near points so far that exceeded a query's contact limit.
  [[nodiscard]] std::size_t contactsLeftOut() const;
  /// Number of times that bodies were stopped within a step so far, see bullet::Solver.
  [[nodiscard]] std::size_t shortenedSteps() const;
  /// Parts that turned in a step or substep by more than the limit of rotation; one entry for each part,
  /// ordered by part. Bodies in contact count only if the rotation lasts and the contact leaves its plane by
  /// more than bullet::kContactSagitta_m. If Fidelity::substeps is "auto", the speeds at the start of each
  /// substep count, since the speeds at its end set the number of substeps of the next step.
  [[nodiscard]] std::vector<FastTurn> fastTurns() const;
  /// Greatest number of substeps of a step so far.
  [[nodiscard]] int mostSubsteps() const;
  /// Adds the cost of the field's map and points, without models that the field shares with its parts.
  void addField(ModelledCost& cost) const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace vps::scenes
