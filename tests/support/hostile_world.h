// SPDX-License-Identifier: BSD-3-Clause
// A Bullet world whose bodies and shapes are swapped, scaled, deleted and added again in a sequence given by
// bytes, and a check of the properties that must always hold. A test with fixed seeds and a fuzz program use
// it.
#pragma once

#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "vps/mesh.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/dispatcher.h"
#include "vps_bullet/install.h"
#include "vps_bullet/shape.h"
#include "vps_bullet/solver.h"

namespace vps_test {

/// A function that is called with each claim. A test reports a claim that does not hold, a fuzz program
/// aborts.
using Require = void (*)(bool claim, const char* promise);

/// Each operation is a pair of bytes: the kind of operation, and the body or number to which it applies.
class HostileWorld {
 public:
  /// @param parallel  uses bullet::Dispatcher with two threads
  explicit HostileWorld(Require require, bool parallel = false);
  ~HostileWorld();
  HostileWorld(const HostileWorld&) = delete;
  HostileWorld& operator=(const HostileWorld&) = delete;

  void run(const std::uint8_t* data, std::size_t size);
  /// Requires that, after all operations, a part still falls on a plate and rests there.
  void finish();
  static constexpr int kOperations = 22;

 private:
  struct Owned {
    std::unique_ptr<btTriangleMesh> mesh;
    std::vector<std::unique_ptr<btCollisionShape>> children;
    std::unique_ptr<btCollisionShape> shape;
    [[nodiscard]] bool isVps() const {
      return dynamic_cast<const vps::bullet::Shape*>(shape.get()) != nullptr;
    }
  };
  struct Slot {
    std::unique_ptr<btRigidBody> body;
    Owned owned;
    bool is_in_world = false;
    bool was_swapped = false;  ///< its shape was swapped since the last step
  };
  static constexpr int kKinds = 14, kVpsKinds = 3;

  [[nodiscard]] static Owned make(int kind);
  void add(Slot& slot, int kind, unsigned where);
  void remove(Slot& slot);
  void swap(Slot& slot, int kind, bool deletes_first);
  void operate(int operation, unsigned detail);
  void query(unsigned detail);
  void requireFinite();

  Require require_;
  btDefaultCollisionConfiguration config_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  btDbvtBroadphase broadphase_;
  vps::bullet::Solver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<Slot> slots_;
  std::vector<Owned> retired_;  // shapes that no body uses any more; they are kept alive
  vps::bullet::Settings settings_;
};

}  // namespace vps_test
