// SPDX-License-Identifier: BSD-3-Clause
// The Bullet world of a scene: one cooked fixed body, dynamic parts, and the coupling to the device's proxy.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "models/fixed_field.h"
#include "models/resampled_shells.h"
#include "vps/coupling_law.h"
#include "vps/mesh_distance.h"
#include "vps_scenes/plan.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

/// What touched in the last step.
struct TouchState {
  int contacts = 0;    ///< contacts that carry force
  double depth_m = 0;  ///< deepest contact as the solver saw it, at the step's start
  double force_N = 0;  ///< sum of contact force magnitudes
};

/// Joins plugin, bridge and port; knows no device and no procedure. Not thread-safe. Bullet stays behind the
/// pointer.
class Simulation {
 public:
  /// Parts must have the models that the plan says (buildModels()). Bodies are added one by one. Both outlive
  /// it.
  Simulation(const Scene& scene, const Plan& plan);
  ~Simulation();

  /// Whether the field in place will not do for a step that wants these parts, the first of them being those
  /// in place.
  [[nodiscard]] bool needsField(const std::vector<FixedPart>& parts, const PlannedStep& step) const;
  /// What cookField() needs to make a field of these parts, on any thread. Where the field in place holds the
  /// first of them, in this order, its map is built upon, unless `is_anew`.
  FieldOrder orderField(const std::vector<FixedPart>& parts, const PlannedStep& step, bool is_anew = false);
  /// Puts a field in the place of the one before, between two steps. Its parts are no bodies any more. O(1)
  /// but for freeing. One body, one friction in Bullet: `material`'s, usually the housing.
  void setField(CookedField field, std::size_t material);
  /// In place; without parts where nothing is fixed.
  [[nodiscard]] const CookedField& field() const;
  [[nodiscard]] bool hasFixed() const;

  /// What resampleShells() needs to make this body and the field in place again, on any thread.
  [[nodiscard]] ResampleOrder orderResampling(std::size_t part);
  /// Puts them in place between two steps, all else as it is. Bodies and fields that come later take the same
  /// points. The field goes to setField(). Without a shape: only what comes later. O(1) but for freeing.
  void setShells(ResampledShells points);

  /// Adds a part as a dynamic body at rest. Sleeping off, no damping. Throws LoadError where its mass makes
  /// no sense.
  void addBody(std::size_t part, const Pose& X_WP);
  void removeBody(std::size_t part);

  /// Couples the proxy to the part at grasp frame G; one part at a time.
  void grasp(std::size_t part, const Pose& X_PG, const CouplingGains& gains);
  /// Of the grasp, from the next step on.
  void setGains(const CouplingGains& gains);
  void release();
  /// Where the proxy will be at the end of the coming step.
  void setProxy(const CouplingState& proxy);
  /// The part's grasp frame now: what the haptic side couples to.
  [[nodiscard]] CouplingState graspState() const;

  /// Throws LoadError naming the part whose pose is no longer a number.
  void step(double dt_s);

  [[nodiscard]] Pose pose(std::size_t part) const;
  /// Velocity of the part's origin, in W.
  [[nodiscard]] Twist twist(std::size_t part) const;
  [[nodiscard]] double kineticEnergy() const;
  /// Kinetic energy and height of all dynamic bodies; its zero is arbitrary but fixed for a set of bodies.
  [[nodiscard]] double mechanicalEnergy() const;
  [[nodiscard]] double mass(std::size_t part) const;
  /// About its centre of mass, in the part's frame [kg m^2].
  [[nodiscard]] Mat3 inertia(std::size_t part) const;
  /// Of the part against what is fixed.
  [[nodiscard]] double friction(std::size_t part) const;
  /// The cooked field, in W, until the next setField(); null if nothing is fixed.
  [[nodiscard]] const VoxMap* fixedMap() const;
  /// Centre of mass in the part's frame.
  [[nodiscard]] Vec3 centreOfMass(std::size_t part) const;
  /// The part's models with its exact surface, shared with the world.
  [[nodiscard]] std::shared_ptr<const MeshDistance> surface(std::size_t part) const;
  [[nodiscard]] TouchState touch() const;
  void contactMarks(std::vector<ContactMark>& marks) const;
  /// Near points that did not fit a query's limit, so far.
  [[nodiscard]] std::size_t contactsLeftOut() const;
  /// Adds the cooked field and its points, beside the parts' own models.
  void addField(ModelledCost& cost) const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace vps::scenes
