// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/workspace_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vps_device/loop.h"
#include "vps_device/operator.h"

namespace vps::device {
namespace {

constexpr double kPeriod_s = 1e-3;

// A handle that the test moves.
class Led final : public Device {
 public:
  DeviceSample read() noexcept override { return sample; }
  void write(const Wrench& F) noexcept override { written = F; }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return {}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "led"; }
  void lead(const Vec3& p_DH) {
    sample.V_DH.v = (p_DH - sample.X_DH.p) / kPeriod_s;
    sample.X_DH.p = p_DH;
    sample.time_s += kPeriod_s;
  }
  DeviceSample sample;
  Wrench written;
};

// Handle, loop, and a part that hangs on the coupling by its weight: physics is in equilibrium at every tick.
struct Hanging {
  Led device;
  CouplingPort port;
  HapticLoop loop;
  Vec3 weight_N;
  double most_jump_N = 0;
  Vec3 force_before_N = Vec3::Zero();

  explicit Hanging(const LoopSettings& settings, const Vec3& weight_N = Vec3(0, 0, -6))
      : loop(device, port, settings), weight_N(weight_N) {}

  static LoopSettings settings() {
    LoopSettings s;
    s.gains.b_Ns_per_m = 0;
    s.safety.jump_m = 1;
    s.safety.slew_N_per_s = 1e9;
    s.has_passivity_controller = false;
    return s;
  }
  [[nodiscard]] double k() const { return loop.settings().gains.k_N_per_m; }

  // The part's equilibrium under the proxy, with the energy of spring and height.
  void settle() {
    const Vec3 p_proxy = port.haptic.read().proxy.X_W.p, p_part = p_proxy + weight_N / k();
    port.physics.write({{Pose::translation(p_part), Twist{}, 0, true}, 0, {}, {}});
    loop.observeStoredEnergy(0.5 * weight_N.squaredNorm() / k() - weight_N.dot(p_part), 0);
  }
  void take(const Vec3& p_DH = Vec3::Zero()) {
    loop.grasp(Pose{});
    tick(p_DH);
  }
  void tick(const Vec3& p_DH) {
    device.lead(p_DH);
    loop.tick();
    settle();
    most_jump_N = std::max(most_jump_N, (device.written.f - force_before_N).norm());
    force_before_N = device.written.f;
  }
  [[nodiscard]] Vec3 proxy() { return port.haptic.read().proxy.X_W.p; }
};

// Moves the handle straight to a place at this average speed.
template <typename Visit>
void travel(const Vec3& from, const Vec3& to, double speed_m_s, const Visit& visit) {
  const int ticks = static_cast<int>(std::ceil((to - from).norm() / (speed_m_s * kPeriod_s)));
  for (int i = 1; i <= ticks; ++i)
    visit(Vec3(from + (to - from) * minimumJerk(static_cast<double>(i) / ticks)));
}

TEST(Clutch, PowerIsEqualOnBothSidesAtEveryRatio) {
  Clutch clutch;
  clutch.open();
  for (int i = 0; i < 7; ++i) clutch.advance(kPeriod_s, 10 * kPeriod_s);
  EXPECT_NEAR(clutch.ratio(), 0.3, 1e-12);
  const Twist step{Vec3(0.01, 0, 0.02), Vec3(1e-3, 2e-3, -1e-3)};
  const Pose X(rotationFromVector(Vec3(0.5, 1, 0)), Vec3(1, 2, 3)), Y = clutch.follow(X, step);
  const Wrench F{Vec3(0.1, 0.2, 0.3), Vec3(4, 5, 6)};
  const Twist proxy_step{rotationVector(Y.R * X.R.transpose()), Vec3(Y.p - X.p)};
  EXPECT_NEAR(power(F, proxy_step), power(F * clutch.ratio(), step), 1e-14);
}

TEST(Clutch, OpeningFreesTheHandWithoutAForceJumpAndThePartStays) {
  Hanging rig(Hanging::settings());
  rig.take();
  for (int i = 0; i < 10; ++i) rig.tick(Vec3::Zero());
  EXPECT_NEAR(rig.device.written.f.z(), -6, 1e-9);
  rig.most_jump_N = 0;
  rig.loop.disengage();
  for (int i = 0; i < 101; ++i) rig.tick(Vec3::Zero());
  EXPECT_TRUE(rig.loop.clutch().isOpen());
  EXPECT_EQ(rig.device.written.f, Vec3(Vec3::Zero()));
  EXPECT_NEAR(rig.most_jump_N, 6 * kPeriod_s / 0.1, 1e-9);  // 6 N over 0.1 s
  travel(Vec3::Zero(), Vec3(0.1, 0, 0.1), 0.5, [&](const Vec3& p) { rig.tick(p); });
  EXPECT_LT(rig.proxy().norm(), 1e-12);
  EXPECT_EQ(rig.device.written.f, Vec3(Vec3::Zero()));
  rig.loop.engage();
  for (int i = 0; i < 101; ++i) rig.tick(Vec3(0.1, 0, 0.1));
  EXPECT_NEAR(rig.device.written.f.z(), -6, 1e-9);
  EXPECT_LT(rig.proxy().norm(), 1e-12);
  rig.tick(Vec3(0.101, 0, 0.1));  // moves the handle again, from the same pose
  EXPECT_NEAR(rig.proxy().x(), 1e-3, 1e-12);
}

// A hand that repeatedly rises while the weight fades in and falls while the weight fades out: fading only
// the force would give the hand energy.
double madeByPumping_J(double scale, double force_scale) {
  LoopSettings settings = Hanging::settings();
  settings.map.scale = scale;
  settings.map.force_scale = force_scale;
  Hanging rig(settings);
  rig.device.lead(Vec3(0, 0, 0.02));
  rig.take(Vec3(0, 0, 0.02));
  for (int turn = 0; turn < 20; ++turn) {
    rig.loop.disengage();
    travel(Vec3(0, 0, 0.02), Vec3::Zero(), 0.2, [&](const Vec3& p) { rig.tick(p); });
    rig.loop.engage();
    travel(Vec3::Zero(), Vec3(0, 0, 0.02), 0.2, [&](const Vec3& p) { rig.tick(p); });
  }
  EXPECT_GT(rig.loop.passivity().from_hand_J, 0.1);
  return rig.loop.passivity().injected_J;
}

TEST(Clutch, APumpingHandGainsNoEnergyAtAnyScale) {
  // The weight's work is done and recovered through the same lever, except for one tick: 6 N in the scene
  // over the 0.4 mm that the hand moves at most in a tick.
  for (const auto& [scale, force_scale] : {std::pair{1.0, 1.0}, std::pair{2.5, 1.0}, std::pair{3.0, 0.5}})
    EXPECT_LT(madeByPumping_J(scale, force_scale), 6 * 0.4e-3 * scale) << scale << " " << force_scale;
}

TEST(Clutch, IndexingMovesAPartByAMetreWithADeviceOfFourTenths) {
  Hanging rig(Hanging::settings());
  rig.take();
  for (int i = 0; i < 10; ++i) rig.tick(Vec3::Zero());
  rig.most_jump_N = 0;
  const Vec3 left(-0.2, 0, 0), right(0.2, 0, 0);
  const double speed_m_s = 0.4;
  const auto tick = [&](const Vec3& p) {
    EXPECT_LE(std::abs(p.x()), 0.2);
    rig.tick(p);
  };
  travel(Vec3::Zero(), right, speed_m_s, tick);
  int segments = 1;
  for (; rig.proxy().x() < 1 && segments < 10; ++segments) {
    rig.loop.disengage();
    for (int i = 0; i < 100; ++i) tick(right);
    travel(right, left, speed_m_s, tick);
    rig.loop.engage();
    for (int i = 0; i < 100; ++i) tick(left);
    travel(left, right, speed_m_s, tick);
  }
  EXPECT_NEAR(rig.proxy().x(), 0.2 + 0.4 * (segments - 1), 1e-9);
  EXPECT_EQ(segments, 3);
  EXPECT_LT(std::abs(rig.proxy().z()), 1e-12);
  // Two changes per tick: the fade of the weight, and the spring to a part one tick behind, K a T^2 with
  // a <= 2.4 m/s^2.
  EXPECT_LT(rig.most_jump_N, 6 * kPeriod_s / 0.1 + 2000 * 2.4e-6);
  EXPECT_LT(rig.loop.passivity().injected_J, 1e-9);  // the travel is level, so the energy is only rounding
}

TEST(Clutch, HandOverToAnotherPartNeitherJumpsNorReturnsTheSpringsEnergy) {
  Hanging rig(Hanging::settings());
  rig.take();
  for (int i = 0; i < 10; ++i) rig.tick(Vec3::Zero());
  rig.loop.disengage();
  for (int i = 0; i < 101; ++i) rig.tick(Vec3::Zero());
  rig.loop.release();
  const double to_hand_J = rig.loop.passivity().to_hand_J;
  rig.most_jump_N = 0;
  rig.weight_N = Vec3(0, 2, -3);  // another part, elsewhere
  const Vec3 elsewhere(0.3, 0.2, 0.1);
  rig.port.physics.write({{Pose::translation(elsewhere), Twist{}, 0, true}, 0, {}, {}});
  rig.loop.handOver(Pose::translation(elsewhere));
  for (int i = 0; i < 120; ++i) rig.tick(Vec3::Zero());
  EXPECT_LT((rig.proxy() - elsewhere).norm(), 1e-12);
  EXPECT_LT((rig.device.written.f - rig.weight_N).norm(), 1e-9);
  // In the first tick the part does not hang yet, so the second tick adds the share of two ticks.
  EXPECT_LT(rig.most_jump_N, 2.01 * rig.weight_N.norm() * kPeriod_s / 0.1);
  EXPECT_EQ(rig.loop.passivity().to_hand_J, to_hand_J);
}

}  // namespace
}  // namespace vps::device
