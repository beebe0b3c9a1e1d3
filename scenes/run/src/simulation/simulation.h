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

/// Joins plugin, bridge and coupling; knows no device and no procedure. Not thread-safe. Bullet's types stay
/// behind a pointer.
class Simulation {
 public:
  /// The parts have the models that the plan says (buildModels()). Bodies are added one by one. Both
  /// arguments outlive it.
  Simulation(const Scene& scene, const ModelPlan& plan);
  ~Simulation();

  /// False if the field in place serves a step with these parts. Of the parts in place, those that are among
  /// them come first.
  [[nodiscard]] bool needsField(const std::vector<FixedPart>& parts, const FieldPlan& step) const;
  /// What cookField() reads to make a field of these parts, on any thread. If the field in place holds the
  /// first of them, in this order, and nothing else, the new map is built on its map, unless `rebuilds`.
  FieldOrder orderField(const std::vector<FixedPart>& parts, const FieldPlan& step, bool rebuilds = false);
  /// Replaces the field between two steps. The field's parts are no longer bodies of their own. O(1) except
  /// for freeing. The field is one Bullet body; contacts with it have the material of the part that they
  /// touch.
  void setField(CookedField field);
  /// Removes the field between two steps.
  void clearField();
  /// The field in place; it has no parts if nothing is fixed.
  [[nodiscard]] const CookedField& field() const;
  [[nodiscard]] bool hasFixed() const;

  /// What resampleShells() reads to make this body and the field in place again, on any thread.
  [[nodiscard]] ResampleOrder orderResampling(std::size_t part);
  /// Replaces the body's shape between two steps. Bodies and fields that are made later take the same shells.
  /// The field itself goes to setField(). Without a shape, only later bodies and fields are affected. O(1)
  /// except for freeing.
  void setShells(ResampledShells resampled);

  /// Adds a part as a dynamic body at rest, without sleeping and damping. Throws LoadError for a mass that is
  /// not positive.
  /// @param most_kg  a heavier part becomes a body of this mass, with its inertia in proportion, as if it
  /// were
  ///                 less dense
  /// @return the part's own mass [kg]
  double addBody(std::size_t part, const Pose& X_WP,
                 double most_kg = std::numeric_limits<double>::infinity());
  void removeBody(std::size_t part);
  /// From now on the body stays where it is, whatever touches it.
  void hold(std::size_t part);
  /// Velocity of the part's origin, in W.
  void setTwist(std::size_t part, const Twist& V_WP_W);

  /// Couples the proxy to the part at grasp frame G; one part at a time.
  void grasp(std::size_t part, const Pose& X_PG, const CouplingGains& gains);
  /// Gains of the coupling from the next step on.
  void setGains(const CouplingGains& gains);
  void release();
  /// A wrench on the part in hand at its grasp frame, in W, for the coming step only.
  void push(const Wrench& F_G_W);
  /// Pose of the proxy at the end of the coming step.
  void setProxy(const CouplingState& proxy);
  /// The part's grasp frame now, to which the haptic loop couples.
  [[nodiscard]] CouplingState graspState() const;

  /// Called after each part of a step, with its number from 1 on and how many there are.
  using AfterPart = std::function<void(int number, int parts)>;
  /// In as many parts of equal length as Fidelity::substeps says. The proxy moves evenly from part to part.
  /// Throws LoadError naming the part whose pose is not finite any more.
  void step(double dt_s, const AfterPart& after = {});

  [[nodiscard]] Pose pose(std::size_t part) const;
  /// Velocity of the part's origin, in W.
  [[nodiscard]] Twist twist(std::size_t part) const;
  [[nodiscard]] double kineticEnergy() const;
  /// Kinetic and potential energy of all dynamic bodies; its zero is arbitrary but fixed for a set of bodies.
  [[nodiscard]] double mechanicalEnergy() const;
  [[nodiscard]] double mass(std::size_t part) const;
  /// About the centre of mass, in the part's frame [kg m^2].
  [[nodiscard]] Mat3 inertia(std::size_t part) const;
  /// Of contacts between the part and each part of the field, in the field's order.
  struct FieldContact {
    double friction = 0;  ///< coefficient
    double stiffness_N_per_m3 = 0;
  };
  [[nodiscard]] std::vector<FieldContact> fieldContacts(std::size_t part) const;
  /// The cooked field, in W, valid until the next setField(); null if nothing is fixed.
  [[nodiscard]] const VoxMap* fixedMap() const;
  /// Centre of mass in the part's frame.
  [[nodiscard]] Vec3 centreOfMass(std::size_t part) const;
  [[nodiscard]] TouchState touch() const;
  /// Sum of the forces of contacts from the sides, which guide a part along a unit axis: whose normal is more
  /// than 30 degrees off it (of all contacts where it is zero). Without friction.
  [[nodiscard]] double forceAcross_N(const Vec3& axis_W) const;
  void contactMarks(std::vector<ContactMark>& marks) const;
  /// Number of near points so far that exceeded a query's contact limit.
  [[nodiscard]] std::size_t contactsLeftOut() const;
  /// How often bodies were stopped within a step so far, see bullet::Solver.
  [[nodiscard]] std::size_t shortenedSteps() const;
  /// Parts that turned farther in a step, or part of one, than it can hold; one entry for each, by part. Of
  /// bodies in contact only where that lasts and the contact leaves its plane by more than
  /// bullet::kContactSagitta_m. Where Fidelity::substeps is "auto" speeds at the start of each part count:
  /// those at its end are what the next step is divided by.
  [[nodiscard]] std::vector<FastTurn> fastTurns() const;
  /// Greatest number of parts of a step so far.
  [[nodiscard]] int mostSubsteps() const;
  /// Adds the field's map and points, without what it shares with the parts' own models.
  void addField(ModelledCost& cost) const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace vps::scenes
