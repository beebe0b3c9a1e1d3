// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulation.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "models/scene_models.h"
#include "vps/box.h"
#include "vps/errors.h"
#include "vps/friction.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"
#include "vps_bullet/install.h"
#include "vps_bullet/shape.h"
#include "vps_bullet/solver.h"
#include "vps_bullet/turn.h"
#include "vps_scenes/scene/scene_parts.h"

namespace vps::scenes {

namespace {

struct DynamicBody {
  std::unique_ptr<bullet::Shape> shape;
  std::unique_ptr<btRigidBody> body;
  bullet::BodyFrame frame;
};

bullet::Settings bulletSettings(const Scene& scene) {
  const Fidelity& fidelity = scene.fidelity;
  bullet::Settings settings;
  settings.contact_method = fidelity.contact_method;
  settings.contact_limit = fidelity.contact_limit;
  settings.sides = fidelity.sides;
  settings.gradient = fidelity.gradient;
  settings.warns_of_turns = false;  // fastTurns() names the parts
  return settings;
}

bullet::SolverSettings solverSettings(const Fidelity& fidelity) {
  bullet::SolverSettings settings;
  settings.iteration_limit = fidelity.solver_iterations;
  return settings;
}

/// Collects the greatest rotations of bodies that turn too far in a step.
class Turns {
 public:
  /// @param dt_s  duration of the step
  void add(const bullet::BodyTurn& turn, double dt_s) {
    const auto part = static_cast<std::size_t>(turn.body->getUserIndex());
    if (lasts(part, turn.is_in_contact && isTooFar(turn, dt_s) &&
                        0.5 * turn.leaving_m_s2 * dt_s * dt_s > bullet::kContactSagitta_m))
      return note(part, turn, dt_s);
    const bullet::BodyTurn alone{turn.body, false, turn.body->getAngularVelocity().length()};
    if (isTooFar(alone, dt_s)) note(part, alone, dt_s);
  }
  [[nodiscard]] const std::map<std::size_t, FastTurn>& byPart() const { return by_part_; }

 private:
  static bool isTooFar(const bullet::BodyTurn& turn, double dt_s) {
    constexpr double kRounding =
        1e-9;  // tolerance for a step that was divided so that the limit is met exactly
    return turn.w_rad_s * dt_s > turn.limit_rad() * (1 + kRounding);
  }

  /// Teeth that skip are in contact in only some steps. A step with contact therefore counts as one of the
  /// steps in a row (bullet::kTurnsInRow), and each step without contact subtracts a quarter of one: contact
  /// in more than a fifth of the steps is reported, and impacts of a tumbling part are not.
  bool lasts(std::size_t part, bool is_now) {
    constexpr int kOne = 4;
    const auto known = quarters_.find(part);
    if (!is_now) {
      if (known != quarters_.end()) known->second = std::max(0, known->second - 1);
      return false;
    }
    int& quarters = known != quarters_.end() ? known->second : quarters_[part];
    quarters = std::min(quarters + kOne, kOne * bullet::kTurnsInRow);
    return quarters == kOne * bullet::kTurnsInRow;
  }

  void note(std::size_t part, const bullet::BodyTurn& turn, double dt_s) {
    FastTurn& known = by_part_[part];
    if (!(turn.rate_hz() > known.needed_hz)) return;
    known = {"", turn.is_in_contact, turn.w_rad_s, turn.w_rad_s * dt_s, turn.limit_rad(), turn.rate_hz()};
  }

  std::map<std::size_t, FastTurn> by_part_;
  std::map<std::size_t, int> quarters_;  // number of steps in a row, in quarters, by part
};

void setMaterial(btRigidBody& body, const Material& material) {
  body.setFriction(bullet::toBt(frictionFactor(material.friction)));
  body.setRestitution(bullet::toBt(material.restitution));
}

}  // namespace

struct Simulation::World {
  const Scene& scene;
  const ModelPlan& plan;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  bullet::Solver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};

  std::map<std::size_t, DynamicBody> bodies;
  std::shared_ptr<const ShellSet> shells;  // shells that replace the parts' own; null: none
  double dt_s;                             // duration of the last step or substep
  Turns turns;
  std::vector<bullet::BodyTurn> body_turns;  // reused memory of noteTurns()
  int most_substeps = 1;
  CookedField field;
  std::unique_ptr<btRigidBody> fixed_body;
  std::unique_ptr<bullet::CouplingConstraint> coupling;
  std::size_t grasped = 0;
  Pose X_PG;
  std::optional<CouplingState> target;       // the proxy's state at the end of the last step
  std::optional<CouplingState> next_target;  // the proxy's state at the end of the coming step
  Wrench push_G_W;                           // wrench of push() for the coming step

  World(const Scene& s, const ModelPlan& p)
      : scene(s), plan(p), solver(solverSettings(s.fidelity)), dt_s(1 / s.fidelity.physics_rate_hz) {
    bullet::install(dispatcher, bulletSettings(scene));
    bullet::tuneWorld(world, scene.fidelity.solver_iterations);
    world.setGravity(bullet::toBt(scene.gravity_W));
  }
  ~World() {
    uncouple();
    while (!bodies.empty()) remove(bodies.begin()->first);
    if (fixed_body) world.removeRigidBody(fixed_body.get());
    bullet::uninstall(dispatcher);
  }

  /// A part's models with the shell that is in use.
  [[nodiscard]] std::shared_ptr<const PartModel> modelOf(std::size_t part) const {
    const std::shared_ptr<const PartModel>& own = scene.parts[part].model;
    return shells && (*shells)[part] ? withShell(*own, (*shells)[part]) : own;
  }

  void uncouple() {
    target.reset();
    next_target.reset();
    push_G_W = {};
    if (!coupling) return;
    world.removeConstraint(coupling.get());
    coupling.reset();
  }

  /// The coupling's target at the end of the next substep; the proxy moves by the same amount in each
  /// substep.
  /// @param share  share of the step that has passed at the end of the substep
  void aimCoupling(double share) {
    if (!coupling || !next_target) return;
    CouplingState at = *next_target;
    if (target && share < 1) at.X_W = interpolate(target->X_W, at.X_W, share);
    coupling->setTarget(at);
  }

  /// Applies the wrench of push() again, since Bullet clears them after each of its steps.
  void applyPush() {
    if (!coupling || (push_G_W.f.isZero(0) && push_G_W.tau.isZero(0))) return;
    const DynamicBody& held = bodies.at(grasped);
    const Pose X_WP = bullet::fromBt(held.body->getWorldTransform()) * held.frame.X_PB.inverse();
    const Vec3 p_BG_W = X_WP * X_PG.p - X_WP * held.frame.X_PB.p;
    held.body->applyCentralForce(bullet::toBt(push_G_W.f));
    held.body->applyTorque(bullet::toBt(Vec3(push_G_W.tau + p_BG_W.cross(push_G_W.f))));
  }

  void noteTurns() {
    body_turns.clear();
    bullet::findTurns(world, body_turns);
    for (const bullet::BodyTurn& turn : body_turns) turns.add(turn, dt_s);
  }

  void requireFinite() const {
    for (const auto& [part, b] : bodies)
      if (!bullet::fromBt(b.body->getWorldTransform()).isFinite())
        throw LoadError(scene.file, scene.parts[part].part.name,
                        "its pose is no longer finite; check its mass and size, or choose a finer "
                        "fidelity");
  }

  void remove(std::size_t part) {
    const auto found = bodies.find(part);
    if (found == bodies.end()) return;
    if (coupling && grasped == part) uncouple();
    world.removeRigidBody(found->second.body.get());
    bodies.erase(found);
  }
};

Simulation::Simulation(const Scene& scene, const ModelPlan& plan)
    : world_(std::make_unique<World>(scene, plan)) {}
Simulation::~Simulation() = default;

bool Simulation::needsField(const std::vector<FixedPart>& parts, const FieldPlan& step) const {
  const CookedField& now = world_->field;
  if (!std::ranges::equal(parts, now.parts, {}, &FixedPart::part, &FixedPart::part)) return true;
  if (parts.empty() || !now.region_W) return false;
  return !step.region_W || !isWithin(*step.region_W, *now.region_W);
}

FieldOrder Simulation::orderField(const std::vector<FixedPart>& parts, const FieldPlan& step, bool rebuilds) {
  World& w = *world_;
  FieldOrder order;
  order.region_W = step.region_W;
  order.has_shell = step.has_shell;
  order.has_mesh = order.rebuilds_maps = w.plan.models_everything;
  order.fidelity = w.scene.fidelity;
  for (const FixedPart& placed : parts)
    order.parts.push_back({placed, w.modelOf(placed.part), w.plan.parts[placed.part].kept_P});
  if (hasFixed() && !rebuilds) {
    order.below = w.field.shape->models().map;
    order.below_count = w.field.parts.size();
  }
  return order;
}

void Simulation::clearField() {
  World& w = *world_;
  if (w.fixed_body) w.world.removeRigidBody(w.fixed_body.get());
  w.fixed_body.reset();
  w.field = {};
}

void Simulation::setField(CookedField field) {
  World& w = *world_;
  for (const FixedPart& placed : field.parts) w.remove(placed.part);
  clearField();
  w.field = std::move(field);
  w.fixed_body = std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(0, nullptr, w.field.shape.get()));
  // Contacts have the material of the surface that they touch; this material is for surfaces without one.
  if (!w.field.parts.empty())
    setMaterial(*w.fixed_body, w.scene.parts[w.field.parts.front().part].part.material);
  w.world.addRigidBody(w.fixed_body.get());
}

ResampleOrder Simulation::orderResampling(std::size_t part) {
  World& w = *world_;
  ResampleOrder order;
  if (hasFixed()) {
    FieldPlan current;
    current.region_W = w.field.region_W;
    order.field_before = w.field.shape->models().shell;
    current.has_shell = order.field_before != nullptr;
    order.field = orderField(w.field.parts, current);
    for (FieldPart& fixed : order.field.parts) fixed.model = w.scene.parts[fixed.placed.part].model;
  }
  const DynamicBody& body = w.bodies.at(part);
  order.part = part;
  order.model = w.scene.parts[part].model;
  order.part_before = body.shape->models().shell;
  order.X_SM = body.shape->X_SM();
  order.X_WP = pose(part);
  order.sides = w.scene.fidelity.sides;
  return order;
}

void Simulation::setShells(ResampledShells resampled) {
  World& w = *world_;
  w.shells = std::move(resampled.shells);
  const auto found = w.bodies.find(resampled.part);
  if (found == w.bodies.end() || !resampled.shape) return;
  DynamicBody& body = found->second;
  // Removing and adding the body discards its pairs, which refer to points of the old shell.
  w.world.removeRigidBody(body.body.get());
  std::swap(body.shape, resampled.shape);
  body.body->setCollisionShape(body.shape.get());
  w.world.addRigidBody(body.body.get());
}

const CookedField& Simulation::field() const {
  return world_->field;
}

bool Simulation::hasFixed() const {
  return world_->field.shape != nullptr;
}

double Simulation::addBody(std::size_t part, const Pose& X_WP, double most_kg) {
  World& w = *world_;
  w.remove(part);
  const ScenePart& scene_part = w.scene.parts[part];
  DynamicBody added;
  const MassProperties mass = partMass(scene_part);
  if (!(mass.volume_m3 > 0))
    throw LoadError(
        scene_part.file, scene_part.part.name,
        "its volume is not positive, so it has no mass: the mesh is open or inside out; repair it, or mark "
        "the part as fixed");
  const double density_kg_m3 = scene_part.part.material.density_kg_m3;
  const double own_kg = density_kg_m3 * mass.volume_m3;
  added.frame =
      bullet::makeBodyFrame(mass, own_kg > most_kg ? density_kg_m3 * (most_kg / own_kg) : density_kg_m3);
  added.shape = std::make_unique<bullet::Shape>(shapeModels(*w.modelOf(part)), added.frame.X_PB.inverse());
  added.body = std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(static_cast<btScalar>(added.frame.mass_kg), nullptr,
                                               added.shape.get(), bullet::toBt(added.frame.inertia_kg_m2)));
  // setCenterOfMassTransform() also sets the interpolated pose, and the inertia about W's axes.
  added.body->setCenterOfMassTransform(bullet::toBt(X_WP * added.frame.X_PB));
  setMaterial(*added.body, scene_part.part.material);
  added.body->setActivationState(DISABLE_DEACTIVATION);
  added.body->setUserIndex(static_cast<int>(part));
  w.world.addRigidBody(added.body.get());
  w.bodies.emplace(part, std::move(added));
  return own_kg;
}

void Simulation::removeBody(std::size_t part) {
  world_->remove(part);
}

void Simulation::hold(std::size_t part) {
  btRigidBody& body = *world_->bodies.at(part).body;
  world_->world.removeRigidBody(&body);
  body.setMassProps(0, btVector3(0, 0, 0));
  body.setLinearVelocity(btVector3(0, 0, 0));
  body.setAngularVelocity(btVector3(0, 0, 0));
  world_->world.addRigidBody(&body);
}

void Simulation::setTwist(std::size_t part, const Twist& V_WP_W) {
  const DynamicBody& b = world_->bodies.at(part);
  const Vec3 p_PB_W = pose(part).R * b.frame.X_PB.p;
  b.body->setLinearVelocity(bullet::toBt(Vec3(V_WP_W.v + V_WP_W.w.cross(p_PB_W))));
  b.body->setAngularVelocity(bullet::toBt(V_WP_W.w));
}

void Simulation::grasp(std::size_t part, const Pose& X_PG, const CouplingGains& gains) {
  World& w = *world_;
  w.uncouple();
  DynamicBody& held = w.bodies.at(part);
  w.coupling =
      std::make_unique<bullet::CouplingConstraint>(*held.body, held.frame.X_PB.inverse() * X_PG, gains);
  w.world.addConstraint(w.coupling.get(), true);
  w.grasped = part;
  w.X_PG = X_PG;
}

void Simulation::release() {
  world_->uncouple();
}

void Simulation::setGains(const CouplingGains& gains) {
  if (world_->coupling) world_->coupling->setGains(gains);
}

void Simulation::push(const Wrench& F_G_W) {
  if (!world_->coupling) return;
  world_->push_G_W.f += F_G_W.f;
  world_->push_G_W.tau += F_G_W.tau;
}

void Simulation::setProxy(const CouplingState& proxy) {
  if (world_->coupling) world_->next_target = proxy;
}

CouplingState Simulation::graspState() const {
  return world_->coupling ? world_->coupling->partState() : CouplingState{};
}

void Simulation::step(double dt_s, const AfterPart& after) {
  World& w = *world_;
  constexpr int kMost = 10'000;  // most substeps, as for the setting `substeps`
  const int set = w.scene.fidelity.substeps;
  const int parts = set > 0 ? set : bullet::substepsFor(w.world, dt_s, kMost);
  w.most_substeps = std::max(w.most_substeps, parts);
  w.dt_s = dt_s / parts;
  for (int k = 1; k <= parts; ++k) {
    w.aimCoupling(static_cast<double>(k) / parts);
    w.applyPush();
    if (set == 0) w.noteTurns();
    // Bullet makes no substeps of its own: each call of stepSimulation() is exactly one step, so that a run
    // is a fixed sequence.
    w.world.stepSimulation(static_cast<btScalar>(w.dt_s), 0);
    if (set > 0) w.noteTurns();
    w.requireFinite();
    if (after) after(k, parts);
  }
  if (w.next_target) w.target = w.next_target;
  w.push_G_W = {};
}

Pose Simulation::pose(std::size_t part) const {
  const DynamicBody& b = world_->bodies.at(part);
  return bullet::fromBt(b.body->getWorldTransform()) * b.frame.X_PB.inverse();
}

Twist Simulation::twist(std::size_t part) const {
  const DynamicBody& b = world_->bodies.at(part);
  Twist V;
  V.w = bullet::fromBt(b.body->getAngularVelocity());
  const Vec3 p_BP_W = bullet::fromBt(b.body->getWorldTransform()).R * b.frame.X_PB.inverse().p;
  V.v = bullet::fromBt(b.body->getLinearVelocity()) + V.w.cross(p_BP_W);
  return V;
}

double Simulation::kineticEnergy() const {
  double energy_J = 0;
  for (const auto& [part, b] : world_->bodies) {
    const Vec3 w_B = bullet::fromBt(b.body->getWorldTransform()).R.transpose() *
                     bullet::fromBt(b.body->getAngularVelocity());
    energy_J += 0.5 * b.frame.mass_kg * bullet::fromBt(b.body->getLinearVelocity()).squaredNorm() +
                0.5 * w_B.cwiseProduct(b.frame.inertia_kg_m2).dot(w_B);
  }
  return energy_J;
}

double Simulation::mechanicalEnergy() const {
  double energy_J = kineticEnergy();
  for (const auto& [part, b] : world_->bodies)
    energy_J -= b.frame.mass_kg * world_->scene.gravity_W.dot(bullet::fromBt(b.body->getWorldTransform()).p);
  return energy_J;
}

double Simulation::mass(std::size_t part) const {
  return world_->bodies.at(part).frame.mass_kg;
}

Vec3 Simulation::centreOfMass(std::size_t part) const {
  return world_->bodies.at(part).frame.X_PB.p;
}

Mat3 Simulation::inertia(std::size_t part) const {
  const bullet::BodyFrame& frame = world_->bodies.at(part).frame;
  return frame.X_PB.R * frame.inertia_kg_m2.asDiagonal() * frame.X_PB.R.transpose();
}

std::vector<Simulation::FieldContact> Simulation::fieldContacts(std::size_t part) const {
  const Material& own = world_->scene.parts[part].part.material;
  std::vector<FieldContact> contacts;
  for (const FixedPart& placed : world_->field.parts) {
    const Material& fixed = world_->scene.parts[placed.part].part.material;
    contacts.push_back({combinedFriction(own.friction, fixed.friction),
                        std::min(own.stiffness_N_per_m3, fixed.stiffness_N_per_m3)});
  }
  return contacts;
}

const VoxMap* Simulation::fixedMap() const {
  return hasFixed() ? world_->field.shape->models().map.get() : nullptr;
}

namespace {

/// Calls visit(point, manifold) for every contact point of the last step.
template <typename Visit>
void forEachContactOfPair(btCollisionDispatcher& dispatcher, const Visit& visit) {
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    for (int j = 0; j < manifold.getNumContacts(); ++j) visit(manifold.getContactPoint(j), manifold);
  }
}
/// Calls visit(point) for every contact point of the last step.
template <typename Visit>
void forEachContact(btCollisionDispatcher& dispatcher, const Visit& visit) {
  forEachContactOfPair(dispatcher,
                       [&](const btManifoldPoint& point, const btPersistentManifold&) { visit(point); });
}

/// Velocity of the body at p_W.
Vec3 velocityAt(const btCollisionObject& object, const btVector3& p_W) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (body == nullptr) return Vec3::Zero();
  return bullet::fromBt(body->getVelocityInLocalPoint(p_W - body->getCenterOfMassPosition()));
}

}  // namespace

TouchState Simulation::touch() const {
  TouchState state;
  forEachContact(world_->dispatcher, [&](const btManifoldPoint& point) {
    state.depth_m = std::max(state.depth_m, -static_cast<double>(point.getDistance()));
    if (point.getAppliedImpulse() > 0) ++state.contacts;
    state.force_N += static_cast<double>(point.getAppliedImpulse()) / world_->dt_s;
  });
  return state;
}

double Simulation::forceAcross_N(const Vec3& axis_W) const {
  constexpr double kSide = 0.5;  // sine of 30 degrees
  double impulse_Ns = 0;
  forEachContact(world_->dispatcher, [&](const btManifoldPoint& point) {
    const Vec3 n = bullet::fromBt(point.m_normalWorldOnB);
    if ((n - axis_W * axis_W.dot(n)).norm() > kSide)
      impulse_Ns += static_cast<double>(point.getAppliedImpulse());
  });
  return impulse_Ns / world_->dt_s;
}

void Simulation::contactMarks(std::vector<ContactMark>& marks) const {
  marks.clear();
  forEachContactOfPair(
      world_->dispatcher, [&](const btManifoldPoint& point, const btPersistentManifold& pair) {
        if (point.getAppliedImpulse() <= 0) return;
        const btVector3& p_W = point.getPositionWorldOnB();
        const Vec3 n_W = bullet::fromBt(point.m_normalWorldOnB);
        const Vec3 v_W = velocityAt(*pair.getBody0(), p_W) - velocityAt(*pair.getBody1(), p_W);
        marks.push_back({bullet::fromBt(p_W), n_W, std::max(0.0, -static_cast<double>(point.getDistance())),
                         static_cast<double>(point.getAppliedImpulse()) / world_->dt_s,
                         v_W - n_W * n_W.dot(v_W)});
      });
}

std::size_t Simulation::contactsLeftOut() const {
  return bullet::stats(world_->dispatcher).left_out;
}

std::size_t Simulation::shortenedSteps() const {
  return world_->solver.shortenedSteps();
}

std::vector<FastTurn> Simulation::fastTurns() const {
  std::vector<FastTurn> turns;
  for (const auto& [part, turn] : world_->turns.byPart()) {
    turns.push_back(turn);
    turns.back().part = world_->scene.parts[part].part.name;
  }
  return turns;
}

int Simulation::mostSubsteps() const {
  return world_->most_substeps;
}

void Simulation::addField(ModelledCost& cost) const {
  if (!hasFixed()) return;
  std::vector<std::shared_ptr<const VoxMap>> own;
  for (const FixedPart& placed : world_->field.parts)
    own.push_back(world_->scene.parts[placed.part].model->map);
  const PointShell* shell = world_->field.shape->models().shell.get();
  cost.bytes += world_->field.memoryBytes(own);
  ++cost.voxmaps;
  cost.pointshells += shell != nullptr;
  cost.field_points = shell != nullptr ? shell->size() : 0;
}

}  // namespace vps::scenes
