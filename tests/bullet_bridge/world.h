// SPDX-License-Identifier: BSD-3-Clause
// A small Bullet world with VPS installed, and the bodies the tests put into it.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "vps/friction.h"
#include "vps/solid.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/dispatcher.h"
#include "vps_bullet/install.h"
#include "vps_bullet/shape.h"
#include "vps_bullet/solver.h"

namespace vps::test {

/// Bullet's own solver, or bullet::Solver with one of the contact methods.
enum class SolverKind { Stock, Constraint, Penalty };

inline std::string nameOf(SolverKind solver) {
  return solver == SolverKind::Stock ? "Stock" : solver == SolverKind::Constraint ? "Constraint" : "Penalty";
}

struct Built {
  std::shared_ptr<bullet::Shape> shape;
  Mesh mesh;
  bullet::BodyFrame frame;
  std::shared_ptr<const Solid> exact;
};

/// Map, shell and exact surface of a mesh, as a shape whose frame is the principal one.
inline Built build(const Mesh& mesh, double density_kg_m3, double voxel_m = 0.25e-3,
                   double spacing_m = 0.5e-3) {
  Built built;
  VoxMapSettings voxels;
  voxels.voxel_m = voxel_m;
  PointShellSettings points;
  points.spacing_m = spacing_m;
  const std::shared_ptr<const PartModel> part = buildPartModel("", mesh, voxels, points);
  built.mesh = *part->mesh;
  built.frame = bullet::makeBodyFrame(massProperties(built.mesh), density_kg_m3);
  bullet::ShapeModels models = bullet::makeModels(*part);
  built.exact = models.surfaces[0].distance;
  built.shape = std::make_shared<bullet::Shape>(std::move(models), built.frame.X_PB.inverse());
  return built;
}

constexpr double kGravity = 9.81;
constexpr bool kIsDouble = sizeof(btScalar) == 8;

inline Built steelBox() {
  return build(makeBox(Vec3(0.02, 0.015, 0.01)), 7850, 0.5e-3, 1e-3);
}
inline Built plate() {
  return build(makeBox(Vec3(0.06, 0.06, 0.01)), 7850, 0.5e-3, 1e-3);
}
/// With its center of mass at the origin.
inline Mesh centered(Mesh mesh) {
  const Vec3 com = massProperties(mesh).com;
  for (Vec3& v : mesh.vertices) v -= com;
  return mesh;
}

/// A steel cube of 10 mm; its band is 2 mm.
inline const Built& cube() {
  static const Built built = build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  return built;
}
/// The same plate as plate(), built once in a program.
inline const Built& onePlate() {
  static const Built built = plate();
  return built;
}
/// A box of 20, 40 and 60 mm without a voxmap or points.
inline bullet::ShapeModels boxMesh() {
  bullet::ShapeModels models;
  models.mesh = std::make_shared<const Mesh>(makeBox(Vec3(0.02, 0.04, 0.06)));
  return models;
}

class World {
 public:
  /// @param threads  0: Bullet's own dispatcher
  explicit World(SolverKind solver = SolverKind::Constraint, const bullet::Settings& settings = {},
                 int iterations = 100, const bullet::SolverSettings& solver_settings = {}, int threads = 0)
      : dispatcher_(threads > 0 ? std::make_unique<bullet::Dispatcher>(&config, threads)
                                : std::make_unique<btCollisionDispatcher>(&config)),
        dispatcher(*dispatcher_) {
    if (solver == SolverKind::Stock)
      solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    else
      solver_ = std::make_unique<bullet::Solver>(solver_settings);
    bullet::Settings used = settings;
    if (solver == SolverKind::Penalty) used.contact_method = ContactMethod::Penalty;
    world = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, solver_.get(), &config);
    bullet::install(dispatcher, used);
    bullet::tuneWorld(*world, iterations);
    world->setGravity(btVector3(0, 0, bullet::toBt(-9.81)));
  }
  ~World() {
    for (auto& body : bodies) world->removeRigidBody(body.get());
    bullet::uninstall(dispatcher);
  }

  /// mass 0: fixed. X_WP is the pose of the part's own frame.
  btRigidBody& add(const Built& part, const Pose& X_WP, bool is_fixed = false, double friction = 0.15) {
    const double mass_kg = is_fixed ? 0 : part.frame.mass_kg;
    return addShape(*part.shape, mass_kg, part.frame.inertia_kg_m2, X_WP * part.frame.X_PB, friction);
  }
  btRigidBody& addShape(btCollisionShape& shape, double mass_kg, const Vec3& inertia, const Pose& X_WB,
                        double friction = 0.15) {
    btRigidBody::btRigidBodyConstructionInfo info(bullet::toBt(mass_kg), nullptr, &shape,
                                                  mass_kg > 0 ? bullet::toBt(inertia) : btVector3(0, 0, 0));
    info.m_startWorldTransform = bullet::toBt(X_WB);
    info.m_friction = bullet::toBt(frictionFactor(friction));
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world->addRigidBody(bodies.back().get());
    return *bodies.back();
  }
  void step(int count = 1, double dt_s = 1e-3) {
    for (int i = 0; i < count; ++i) world->stepSimulation(bullet::toBt(dt_s), 0);
  }

  btDefaultCollisionConfiguration config;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  btCollisionDispatcher& dispatcher;
  btDbvtBroadphase broadphase;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
};

/// Poses of the bodies after this number of steps.
inline std::vector<btTransform> placesAfter(World& world, int steps) {
  world.step(steps);
  std::vector<btTransform> places;
  for (const auto& body : world.bodies) places.push_back(body->getWorldTransform());
  return places;
}

/// Pose of the part's own frame.
inline Pose partPose(const btRigidBody& body, const Built& part) {
  return bullet::fromBt(body.getWorldTransform()) * part.frame.X_PB.inverse();
}

/// Greatest depth [m] of either part's vertices in the other, by exact distance; negative: the least gap.
inline double penetration_m(const Built& a, const Pose& X_WA, const Built& b, const Pose& X_WB) {
  double least = 1e300;
  const Pose X_AB = X_WA.inverse() * X_WB, X_BA = X_AB.inverse();
  for (const Vec3& p : b.mesh.vertices) least = std::min(least, a.exact->signedDistance(X_AB * p));
  for (const Vec3& p : a.mesh.vertices) least = std::min(least, b.exact->signedDistance(X_BA * p));
  return -least;
}

}  // namespace vps::test
