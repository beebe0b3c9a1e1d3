// SPDX-License-Identifier: BSD-3-Clause
// An ordinary Bullet world for the scenes of this folder, with the contacts of any engine, the solver of any
// mode, and the processor time of its steps.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "engine.h"
#include "part.h"

namespace vps::dynamics {

/// Processor time of this thread [s]; other programs on the machine affect it only through the caches.
double threadTime_s();

struct StepTimes {
  std::vector<double> step_s;
  double narrow_s = 0, solve_s = 0;  ///< summed over all steps

  [[nodiscard]] double mean_s() const;
  /// @param share  0 to 1: 0.5 the median, 0.99 the time that one step in a hundred exceeds
  [[nodiscard]] double percentile_s(double share) const;
};

/// The input of every scene.
struct SceneSettings {
  Mode mode = Mode::Constraint;
  bool is_short = false;  ///< a few seconds of work, for tests; otherwise the whole case
  Engine engine = vpsEngine();
};

/// A body and its part.
struct Placed {
  btRigidBody* body = nullptr;
  PartMesh part;
  [[nodiscard]] Pose pose() const;  ///< of the part's frame, in W
  /// Upper bound of the speed of the part's points.
  [[nodiscard]] double speed_m_s() const;
};

/// Sums a part's rotation about z over more than a turn. Call update() at least every half turn.
class TurnCounter {
 public:
  explicit TurnCounter(const Placed& placed) : placed_(placed), last_rad_(now()) {}
  /// @return the rotation since construction [rad], counter-clockwise positive
  double update() {
    const double at_rad = now();
    sum_rad_ += std::remainder(at_rad - last_rad_, 2 * std::numbers::pi);
    last_rad_ = at_rad;
    return sum_rad_;
  }

 private:
  [[nodiscard]] double now() const {
    const Mat3 R = placed_.pose().R;
    return std::atan2(R(1, 0), R(0, 0));
  }
  Placed placed_;
  double last_rad_, sum_rad_ = 0;
};

/// A Bullet world (double or single precision) with gravity 9.81 m/s^2 along -z and steps of 1 ms. Sleeping
/// is disabled and Bullet's damping zero unless a scene changes them.
class World {
 public:
  explicit World(const SceneSettings& settings);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// @param friction  coefficient of friction between this body and a body with the same value
  Placed add(const PartMesh& part, const Pose& X_WP, bool is_fixed = false, double friction = 0.15);
  btRigidBody* addShape(ShapeHandle shape, const bullet::BodyFrame& frame, const Pose& X_WB,
                        double friction = 0.15);
  void addConstraint(std::unique_ptr<btTypedConstraint> constraint);
  void removeBody(btRigidBody* body);
  void setGravity(const Vec3& g_W) {
    world_->setGravity({btScalar(g_W.x()), btScalar(g_W.y()), btScalar(g_W.z())});
  }

  void step(int count = 1, double dt_s = kStep_s);
  [[nodiscard]] const StepTimes& times() const { return times_; }
  void resetTimes() { times_ = {}; }
  [[nodiscard]] btDiscreteDynamicsWorld& bullet() { return *world_; }
  [[nodiscard]] int contactCount() const;
  /// Hash of the bits of all bodies' poses and velocities, over all steps so far.
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

  static constexpr double kStep_s = 1e-3;
  static constexpr double kGravity_m_s2 = 9.81;

 private:
  void addToHash();

  Engine engine_;
  btDefaultCollisionConfiguration config_;
  btCollisionDispatcher dispatcher_{&config_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<ShapeHandle> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  StepTimes times_;
  std::uint64_t hash_ = 14695981039346656037ull;
};

/// Kinetic energy [J] and potential energy m g z [J] of a body.
double kineticEnergy_J(const btRigidBody& body);
double heightEnergy_J(const btRigidBody& body);

}  // namespace vps::dynamics
