// SPDX-License-Identifier: BSD-3-Clause
#include "support/hostile_world.h"

#include <array>
#include <cmath>

namespace vps_test {

using namespace vps;
using bullet::toBt;

namespace {

constexpr std::size_t kSlots = 7;

const bullet::ShapeModels& models(int which) {
  static const auto build = [](const Mesh& mesh, double spacing_m) {
    VoxMapSettings voxels;
    voxels.voxel_m = 1e-3;
    PointShellSettings points;
    points.spacing_m = spacing_m;
    return bullet::makeModels(*buildPartModel("", mesh, voxels, points));
  };
  static const std::array<bullet::ShapeModels, 3> all = {build(makeBox(Vec3::Constant(0.008)), 2e-3),
                                                         build(makeBox(Vec3(0.03, 0.03, 0.004)), 2.5e-3),
                                                         build(makeTube(0.010, 0.006, 0.008, 16), 1.5e-3)};
  return all[static_cast<std::size_t>(which)];
}

btVector3 vec(double x, double y, double z) {
  return toBt(Vec3(x, y, z));
}

void addCube(btTriangleMesh& to, double size_m) {
  const Mesh cube = makeBox(Vec3::Constant(size_m));
  for (const auto& t : cube.triangles)
    to.addTriangle(toBt(cube.vertices[t[0]]), toBt(cube.vertices[t[1]]), toBt(cube.vertices[t[2]]));
}

bool isFinite(const btTransform& X) {
  return bullet::fromBt(X).isFinite();
}

struct Count : btCollisionWorld::ContactResultCallback {
  int points = 0;
  btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    ++points;
    return 0;
  }
};

}  // namespace

HostileWorld::Owned HostileWorld::make(int kind) {
  Owned owned;
  const auto hull = [&](std::initializer_list<btVector3> points) {
    auto shape = std::make_unique<btConvexHullShape>();
    for (const btVector3& p : points) shape->addPoint(p);
    shape->setMargin(toBt(1e-3));
    owned.shape = std::move(shape);
  };
  const double h = 0.004;
  switch (kind) {
    case 0:
    case 1:
    case 2:
      owned.shape = std::make_unique<bullet::Shape>(models(kind));
      break;
    case 3:
      owned.shape = std::make_unique<btBoxShape>(vec(h, h, h));
      break;
    case 4:
      owned.shape = std::make_unique<btSphereShape>(toBt(h));
      break;
    case 5:  // this hull and the next one have the same bounding box
      hull({vec(h, h, h), vec(-h, h, -h), vec(-h, -h, h), vec(h, -h, -h)});
      break;
    case 6:
      hull({vec(h, 0, 0), vec(-h, 0, 0), vec(0, h, 0), vec(0, -h, 0), vec(0, 0, h), vec(0, 0, -h)});
      break;
    case 7:
      owned.shape = std::make_unique<btCylinderShape>(vec(h, h, h));
      break;
    case 8:
      owned.shape = std::make_unique<btCapsuleShape>(toBt(0.002), toBt(0.004));
      break;
    case 9:
      owned.mesh = std::make_unique<btTriangleMesh>();
      addCube(*owned.mesh, 0.02);
      owned.shape = std::make_unique<btBvhTriangleMeshShape>(owned.mesh.get(), true);
      break;
    case 10:
      owned.shape = std::make_unique<btStaticPlaneShape>(vec(0, 0, 1), toBt(0.002));
      break;
    case 11:
    case 12: {
      auto compound = std::make_unique<btCompoundShape>();
      for (int i = 0; i < 2; ++i) {
        if (kind == 11 && i == 0)
          owned.children.push_back(std::make_unique<bullet::Shape>(models(0)));
        else
          owned.children.push_back(std::make_unique<btBoxShape>(vec(h, h, h)));
        compound->addChildShape(toBt(Pose::translation(Vec3(0.008 * i, 0, 0))), owned.children.back().get());
      }
      owned.shape = std::move(compound);
      break;
    }
    default:
      owned.shape = std::make_unique<btEmptyShape>();
  }
  return owned;
}

HostileWorld::HostileWorld(Require require, bool parallel)
    : require_(require),
      dispatcher_(parallel ? std::make_unique<bullet::Dispatcher>(&config_, 2)
                           : std::make_unique<btCollisionDispatcher>(&config_)),
      world_(dispatcher_.get(), &broadphase_, &solver_, &config_),
      slots_(kSlots) {
  bullet::install(*dispatcher_);
  bullet::tuneWorld(world_);
  world_.setGravity(vec(0, 0, -9.81));
  add(slots_[0], 1, 0);  // a plate, and a cube that slides on it
  slots_[0].body->setMassProps(0, btVector3(0, 0, 0));
  add(slots_[1], 0, 6);
  slots_[1].body->setLinearVelocity(vec(0.1, 0.05, 0));
}

HostileWorld::~HostileWorld() {
  for (Slot& slot : slots_) remove(slot);
  bullet::uninstall(*dispatcher_);
}

void HostileWorld::add(Slot& slot, int kind, unsigned where) {
  remove(slot);
  slot.body.reset();
  slot.owned = make(kind);
  const bool is_fixed = kind == 9 || kind == 10;
  slot.body = std::make_unique<btRigidBody>(toBt(is_fixed ? 0 : 0.01), nullptr, slot.owned.shape.get(),
                                            is_fixed ? btVector3(0, 0, 0) : vec(1e-7, 1e-7, 1e-7));
  const Vec3 p(0.003 * (where % 5), 0.004 * (where % 3), 0.001 * (where % 16));
  slot.body->setWorldTransform(toBt(Pose(rotationFromVector(Vec3(0.1 * (where % 7), 0, 0)), p)));
  world_.addRigidBody(slot.body.get());
  slot.is_in_world = true;
}

void HostileWorld::remove(Slot& slot) {
  if (slot.is_in_world) world_.removeRigidBody(slot.body.get());
  slot.is_in_world = false;
}

// Bullet's own algorithms do not support a swap of shapes. If neither the old nor the new shape is a Shape,
// or if a body has two swaps between steps, the body is removed and added again, as Bullet requires.
void HostileWorld::swap(Slot& slot, int kind, bool deletes_first) {
  if (!slot.body) return;
  Owned next = make(kind);
  const bool is_safe = (slot.owned.isVps() && !slot.was_swapped) || next.isVps();
  slot.was_swapped = true;
  const bool was_in_world = slot.is_in_world;
  if (!is_safe) remove(slot);
  if (deletes_first) {
    const bool is_same = kind < kVpsKinds && slot.owned.isVps();
    slot.owned = Owned();
    if (is_same) next = make(kind);  // often at the address of the deleted shape
  }
  slot.body->setCollisionShape(next.shape.get());
  if (!deletes_first) retired_.push_back(std::move(slot.owned));
  slot.owned = std::move(next);
  if (was_in_world && !slot.is_in_world) {
    world_.addRigidBody(slot.body.get());
    slot.is_in_world = true;
  }
}

void HostileWorld::query(unsigned detail) {
  Count count;
  count.m_closestDistanceThreshold = toBt(detail % 3 == 0 ? 0 : 5e-4);
  Slot &a = slots_[detail % kSlots], &b = slots_[detail / 16 % kSlots];
  if (a.body && b.body && &a != &b) world_.contactPairTest(a.body.get(), b.body.get(), count);
  if (a.is_in_world) world_.contactTest(a.body.get(), count);
  const btVector3 from = vec(0, 0.002, 0.1), to = vec(0.001, 0, -0.1);
  btCollisionWorld::ClosestRayResultCallback ray(from, to);
  world_.rayTest(from, to, ray);
  btSphereShape ball(toBt(0.002));
  btCollisionWorld::ClosestConvexResultCallback sweep(from, to);
  world_.convexSweepTest(&ball, toBt(Pose::translation(Vec3(0, 0, 0.1))), toBt(Pose()), sweep);
}

void HostileWorld::operate(int operation, unsigned detail) {
  Slot& slot = slots_[detail % kSlots];
  const unsigned high = detail / kSlots;
  auto* part = slot.body ? dynamic_cast<bullet::Shape*>(slot.owned.shape.get()) : nullptr;
  switch (operation) {
    case 0:
    case 1:
    case 2:
    case 3:
      for (unsigned i = 0; i <= detail % 4; ++i) world_.stepSimulation(toBt(1e-3), 0);
      for (Slot& each : slots_) each.was_swapped = false;
      break;
    case 4:
      add(slot, static_cast<int>(high % kKinds), detail);
      break;
    case 5:
      remove(slot);
      break;
    case 6:
      if (slot.body && !slot.is_in_world) world_.addRigidBody(slot.body.get());
      slot.is_in_world = slot.body != nullptr;
      break;
    case 7:
    case 8:
      swap(slot, static_cast<int>(high % kKinds), operation == 8);
      break;
    case 9:
    case 10:
      swap(slot, static_cast<int>(high % kVpsKinds), operation == 10);
      break;
    case 11:
      if (part) part->setLocalScaling(high % 3 == 0 ? btVector3(1, 1, 1) : vec(1.25, 1.25, 1.25));
      break;
    case 12:
      if (part) part->setModels(models(static_cast<int>(high % kVpsKinds)));
      break;
    case 13:
      query(detail);
      break;
    case 14:
      settings_.contact_method = high % 2 == 0 ? ContactMethod::Penalty : ContactMethod::Constraint;
      bullet::install(*dispatcher_, settings_);
      break;
    case 15:
      bullet::uninstall(*dispatcher_);
      if (high % 2 == 0) btGImpactCollisionAlgorithm::registerAlgorithm(dispatcher_.get());
      bullet::install(*dispatcher_, settings_);
      break;
    case 16:
      if (slot.body) {
        slot.body->setWorldTransform(
            toBt(Pose::translation(Vec3(0, 0.001 * (high % 9), 0.0005 * (high % 20)))));
        slot.body->setLinearVelocity(vec(0, 0.2, -0.3 * (high % 4)));
        slot.body->setAngularVelocity(btVector3(0, 0, 0));
      }
      break;
    case 17:
      if (slot.body) slot.body->setFriction(toBt(0.1 * (high % 10)));
      break;
    case 18:
      if (slot.body) slot.body->setRestitution(toBt(0.2 * (high % 4)));
      break;
    case 19:
      if (slot.body) slot.body->setActivationState(high % 2 == 0 ? DISABLE_DEACTIVATION : WANTS_DEACTIVATION);
      break;
    case 20: {
      const int flags = slot.body ? slot.body->getCollisionFlags() : 0;
      if (slot.body && slot.body->getInvMass() > 0)
        slot.body->setCollisionFlags(flags ^
                                     (high % 2 == 0 ? btCollisionObject::CF_NO_CONTACT_RESPONSE
                                                    : btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK));
      break;
    }
    default:
      if (slot.body) {
        Slot& other = slots_[(detail + 1) % kSlots];
        if (other.body) slot.body->setIgnoreCollisionCheck(other.body.get(), high % 2 == 0);
      }
  }
}

void HostileWorld::requireFinite() {
  for (const Slot& slot : slots_)
    require_(!slot.body || isFinite(slot.body->getWorldTransform()), "every pose stays finite");
}

void HostileWorld::run(const std::uint8_t* data, std::size_t size) {
  for (std::size_t i = 0; i + 1 < size; i += 2) {
    operate(data[i] % kOperations, data[i + 1]);
    requireFinite();
  }
}

void HostileWorld::finish() {
  for (Slot& slot : slots_) {
    remove(slot);
    slot.body.reset();
    slot.owned = Owned();
  }
  require_(dispatcher_->getNumManifolds() == 0, "no manifold stays when all bodies are gone");
  bullet::install(*dispatcher_);
  add(slots_[0], 1, 0);
  slots_[0].body->setMassProps(0, btVector3(0, 0, 0));
  slots_[0].body->setCollisionFlags(slots_[0].body->getCollisionFlags() |
                                    btCollisionObject::CF_STATIC_OBJECT);
  add(slots_[1], 0, 0);
  slots_[1].body->setWorldTransform(toBt(Pose::translation(Vec3(0, 0, 0.0062))));
  for (int i = 0; i < 40; ++i) world_.stepSimulation(toBt(1e-3), 0);
  const double z_m = slots_[1].body->getWorldTransform().getOrigin().z();
  // The expected height is half of both heights; sharp features rest at a gap of 0.1 um.
  require_(std::abs(z_m - 0.006) < 5e-6, "a part still rests on a plate");
}

}  // namespace vps_test
