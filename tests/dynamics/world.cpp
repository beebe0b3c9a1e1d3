// SPDX-License-Identifier: BSD-3-Clause
#include "world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <numeric>

#include "vps_bullet/convert.h"
#include "vps_bullet/solver.h"

namespace vps::dynamics {

namespace {

// Bullet's callbacks have no context argument; a step runs on one thread.
thread_local double t_narrow_s = 0, t_solve_s = 0;

void timedNearCallback(btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
                       const btDispatcherInfo& info) {
  const double start_s = threadTime_s();
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
  t_narrow_s += threadTime_s() - start_s;
}

/// A solver whose processor time is measured.
template <typename Solver>
struct Timed : Solver {
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw,
                      btDispatcher* dispatcher) override {
    const double start_s = threadTime_s();
    const btScalar residual = Solver::solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                                                 constraint_count, info, draw, dispatcher);
    t_solve_s += threadTime_s() - start_s;
    return residual;
  }
};

std::unique_ptr<btSequentialImpulseConstraintSolver> makeSolver(Mode mode) {
  if (mode == Mode::ConstraintStock) return std::make_unique<Timed<btSequentialImpulseConstraintSolver>>();
  return std::make_unique<Timed<bullet::Solver>>();
}

}  // namespace

double threadTime_s() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double StepTimes::mean_s() const {
  if (step_s.empty()) return 0;
  return std::accumulate(step_s.begin(), step_s.end(), 0.0) / static_cast<double>(step_s.size());
}

double StepTimes::percentile_s(double share) const {
  if (step_s.empty()) return 0;
  std::vector<double> sorted = step_s;
  std::sort(sorted.begin(), sorted.end());
  const double at = std::ceil(share * static_cast<double>(sorted.size())) - 1;
  return sorted[static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(sorted.size() - 1)))];
}

Pose Placed::pose() const {
  return bullet::fromBt(body->getWorldTransform()) * part.frame.X_PB.inverse();
}

double Placed::speed_m_s() const {
  btVector3 center;
  btScalar radius_m = 0;
  body->getCollisionShape()->getBoundingSphere(center, radius_m);
  return body->getLinearVelocity().length() +
         body->getAngularVelocity().length() * (center.length() + radius_m);
}

World::World(const SceneSettings& settings)
    : engine_(settings.engine),
      solver_(makeSolver(settings.mode)),
      world_(std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(), &config_)) {
  engine_.install(dispatcher_, settings.mode);
  dispatcher_.setNearCallback(timedNearCallback);
  bullet::tuneWorld(*world_);
  setGravity(Vec3(0, 0, -kGravity_m_s2));
}

World::~World() {
  for (auto& constraint : constraints_) world_->removeConstraint(constraint.get());
  for (auto& body : bodies_) world_->removeRigidBody(body.get());
  engine_.uninstall(dispatcher_);
}

Placed World::add(const PartMesh& part, const Pose& X_WP, bool is_fixed, double friction) {
  bullet::BodyFrame frame = part.frame;
  if (is_fixed) frame.mass_kg = 0;
  return {addShape(engine_.makeShape(part, is_fixed), frame, X_WP * part.frame.X_PB, friction), part};
}

btRigidBody* World::addShape(ShapeHandle shape, const bullet::BodyFrame& frame, const Pose& X_WB,
                             double friction) {
  btRigidBody::btRigidBodyConstructionInfo info(
      bullet::toBt(frame.mass_kg), nullptr, shape.get(),
      frame.mass_kg > 0 ? bullet::toBt(frame.inertia_kg_m2) : btVector3(0, 0, 0));
  info.m_startWorldTransform = bullet::toBt(X_WB);
  info.m_friction = bullet::toBt(std::sqrt(friction));
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  shapes_.push_back(std::move(shape));
  btRigidBody* body = bodies_.back().get();
  body->setActivationState(DISABLE_DEACTIVATION);
  world_->addRigidBody(body);
  return body;
}

void World::addConstraint(std::unique_ptr<btTypedConstraint> constraint) {
  world_->addConstraint(constraint.get(), true);
  constraints_.push_back(std::move(constraint));
}

void World::removeBody(btRigidBody* body) {
  world_->removeRigidBody(body);
  std::erase_if(bodies_, [&](const auto& owned) { return owned.get() == body; });
}

void World::step(int count, double dt_s) {
  for (int i = 0; i < count; ++i) {
    t_narrow_s = t_solve_s = 0;
    const double start_s = threadTime_s();
    world_->stepSimulation(btScalar(dt_s), 0);
    times_.step_s.push_back(threadTime_s() - start_s);
    times_.narrow_s += t_narrow_s;
    times_.solve_s += t_solve_s;
    addToHash();
  }
}

int World::contactCount() const {
  int count = 0;
  btDispatcher& dispatcher = *world_->getDispatcher();
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m)
    count += dispatcher.getManifoldByIndexInternal(m)->getNumContacts();
  return count;
}

// FNV-1a over the bits.
void World::addToHash() {
  for (const auto& body : bodies_) {
    const Pose X = bullet::fromBt(body->getWorldTransform());
    double values[18];
    std::memcpy(values, X.R.data(), sizeof(double) * 9);
    std::memcpy(values + 9, X.p.data(), sizeof(double) * 3);
    const Vec3 v = bullet::fromBt(body->getLinearVelocity()), w = bullet::fromBt(body->getAngularVelocity());
    std::memcpy(values + 12, v.data(), sizeof(double) * 3);
    std::memcpy(values + 15, w.data(), sizeof(double) * 3);
    unsigned char bytes[sizeof values];
    std::memcpy(bytes, values, sizeof values);
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 1099511628211ull;
  }
}

double kineticEnergy_J(const btRigidBody& body) {
  if (!(body.getInvMass() > 0)) return 0;
  const Vec3 w_B = bullet::fromBt(body.getWorldTransform().getBasis()).transpose() *
                   bullet::fromBt(body.getAngularVelocity());
  const Vec3 I = bullet::fromBt(body.getInvInertiaDiagLocal()).cwiseInverse();
  return 0.5 * (bullet::fromBt(body.getLinearVelocity()).squaredNorm() / body.getInvMass() +
                w_B.cwiseAbs2().dot(I));
}

double heightEnergy_J(const btRigidBody& body) {
  if (!(body.getInvMass() > 0)) return 0;
  return World::kGravity_m_s2 * body.getWorldTransform().getOrigin().z() / body.getInvMass();
}

}  // namespace vps::dynamics
