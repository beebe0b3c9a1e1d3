// SPDX-License-Identifier: BSD-3-Clause
// Verifies the condition from which the coupling's gains are derived, on a wall of one direction: by the
// exact condition over all frequencies, and by the loop in simulated time.
#include <gtest/gtest.h>

#include <cmath>

#include "support/device/sampled_wall.h"
#include "vps_device/gains.h"

namespace vps::device {
namespace {

using namespace vps::test;

template <typename Visit>
void forEachWall(const Visit& visit) {
  for (const double T : {0.25e-3, 1e-3, 4e-3})
    for (const double K : {200.0, 2000.0, 20000.0})
      for (const double share : {0.0, 0.1, 0.5, 1.0, 4.0})  // of K T
        for (const int delay : {0, 1, 2, 5}) visit(SampledWall{K, share * K * T, T, delay * T});
}

TEST(SampledWall, TheLoopGeneratesTheEnergyOfTheFormulaAtEveryFrequency) {
  forEachWall([](const SampledWall& w) {
    // The error is the rounding of 400 terms, each at most that of K T and B.
    const double tol = 1e-10 * (w.K_N_per_m * (w.period_s + w.delay_s) + w.B_Ns_per_m);
    for (const int index : {1, 2, 7, 40, 99, 160, 200})
      EXPECT_NEAR(measuredPassiveDamping(w, index), passiveDampingAt(w, sineAngle_rad(index)), tol)
          << w.K_N_per_m << " " << w.B_Ns_per_m << " " << w.period_s << " " << w.delay_s << " " << index;
  });
}

TEST(SampledWall, RequiresExactlyTheDampingOfTheConditionWithoutDelayOrWithoutDamper) {
  forEachWall([](const SampledWall& w) {
    const double ratio = passiveDamping(w) / passiveDampingFormula(w);
    EXPECT_LE(ratio, 1 + 1e-12) << w.K_N_per_m << " " << w.B_Ns_per_m << " " << w.delay_s;
    if (w.B_Ns_per_m == 0 || w.delay_s == 0) {
      // The worst case is standstill; the grid's first frequency, pi/200, misses the worst case by (5.5
      // pi/200)^2 / 6.
      EXPECT_GT(ratio, 0.998);
    }
  });
}

TEST(SampledWall, WithDelayAndDamperRequiresAtMostTheSumAndAtLeastTheGreaterOfTheTwo) {
  // Spring and damper are at their worst at different frequencies, so the sum is safe and not sharp: at one
  // tick of delay and B = K T / 2 only 83% of the sum is needed.
  double least = 1;
  forEachWall([&](const SampledWall& w) {
    const double need = passiveDamping(w);
    if (w.delay_s > 0) least = std::min(least, need / passiveDampingFormula(w));
    EXPECT_GE(need, 0.999 * w.B_Ns_per_m - 1e-12);
    EXPECT_GE(need, 0.998 * w.K_N_per_m * (w.period_s / 2 + w.delay_s) - w.B_Ns_per_m);
  });
  EXPECT_NEAR(least, 0.53, 0.005);
}

// The hand motion that gains most energy moves faster while the smaller of a period's two forces acts.
double energyMade_J(const SampledWall& w, int index, double damping_Ns_per_m) {
  const double T = w.period_s, ticks = w.delay_s / T, whole = std::floor(ticks), phi = ticks - whole;
  const auto x_m = [&](double k) { return 1e-3 * std::sin(sineAngle_rad(index) * k + 0.3); };
  const auto F_N = [&](double k) { return -w.K_N_per_m * x_m(k) - w.B_Ns_per_m * (x_m(k) - x_m(k - 1)) / T; };
  double made_J = 0;
  for (int k = 0; k < kSineSamples; ++k) {
    const double step_m = x_m(k + 1) - x_m(k), F_a = F_N(k - whole - 1), F_b = F_N(k - whole);
    const double more_m = (F_a - F_b) * phi * (1 - phi) * T / (2 * damping_Ns_per_m);
    const double a_m = phi * step_m + more_m, b_m = (1 - phi) * step_m - more_m;
    made_J += F_a * a_m + F_b * b_m;
    made_J -= damping_Ns_per_m / T * (a_m * a_m / phi + b_m * b_m / (1 - phi));
  }
  return made_J;
}

TEST(SampledWall, AForceThatChangesWithinThePeriodRequiresUpToSixPercentMore) {
  for (const double ticks : {0.25, 0.5, 1.5, 2.7}) {
    const SampledWall w{2000, 1, 1e-3, ticks * 1e-3};
    for (const int index : {1, 20, 130, 200}) {
      const double b = passiveDampingAt(w, sineAngle_rad(index));
      // At the damping b no energy is generated; the rest is rounding of 400 terms of K x^2 = 2 mJ.
      EXPECT_NEAR(energyMade_J(w, index, b), 0, 1e-14 * 400) << ticks << " " << index;
      EXPECT_GT(energyMade_J(w, index, 0.99 * b), 1e-9);
    }
  }
  const SampledWall half{2000, 0, 1e-3, 0.5e-3};
  // The worst value is (1 + sqrt(5/4)) / 2 times the formula, at standstill; the first frequency of the grid
  // is 0.01% off.
  EXPECT_NEAR(passiveDamping(half) / passiveDampingFormula(half), (1 + std::sqrt(1.25)) / 2, 2e-4);
}

TEST(Gains, DerivedGainsArePassiveAtEveryFrequencyForEveryDeviceRateAndDelay) {
  for (const double haptic_hz : {1000.0, 4000.0})
    for (const double physics_hz : {100.0, 1000.0, 1600.0, 4000.0})
      for (const double damping : {0.5, 5.0, 50.0})
        for (const double own_ticks : {0.0, 0.5, 1.0, 3.0})
          for (const double network_s : {0.0, 0.3e-3, 3e-3}) {
            DeviceLimits limits;
            limits.damping_Ns_per_m = damping;
            limits.delay_s = own_ticks / haptic_hz;
            const CouplingTiming timing{haptic_hz, physics_hz, network_s, 1, 1};
            const CouplingGains gains = deriveGains(limits, timing);
            const SampledWall w{gains.k_N_per_m, gains.b_Ns_per_m, 1 / haptic_hz,
                                couplingDelay_s(timing) + limits.delay_s};
            // The formula gives 0.8 * 0.8 b + 0.2 b; 6% more is needed where forces change within a period.
            EXPECT_LE(passiveDamping(w), 0.9 * damping);
          }
}

TEST(SampledWall, OscillatesAboveTheStiffnessOfTheFormula) {
  // At the edge of stability bw = K sin(w t), so the edge is above the formula by (w t)^2 / 6, t = T/2 + t_d,
  // w = sqrt(K / m); the damper's difference lags by half a period more, which adds B w^2 T / 2 to the
  // inertia's side. Masses are such that w t stays below a third, as for a handle in a hand.
  for (const double T : {0.25e-3, 1e-3, 2e-3})
    for (const double b : {2.0, 5.0, 10.0})
      for (const double B : {0.0, 0.2 * b, b})
        for (const int delay : {0, 1, 3}) {
          const SampledWall w{1, B, T, delay * T};
          const double K = ringingFormula(w, b), t_s = T / 2 + w.delay_s;
          const double mass_kg = std::max(0.5, K * t_s * t_s * 9);
          EXPECT_NEAR(measuredRinging(w, mass_kg, b) / K, 1, 0.05)
              << T << " " << b << " " << B << " " << delay;
        }
}

// The dual arm with viscous damping only, so that dry friction does not hide the limit of stability.
SimulatedDualArmSettings withoutDryFriction() {
  SimulatedDualArmSettings device = idealDualArm();
  device.arms.plate_coulomb_Nm = device.arms.link_coulomb_N = device.arms.rotor_coulomb_Nm = 0;
  device.arms.delay_ticks = 1;
  return device;
}

// The wall does not move, so that there is no physics step to wait for.
CouplingGains gainsForAStillWall(const SimulatedDualArmSettings& device) {
  const DeviceLimits limits = dualArmLimits(device.arms, device.rate_hz, device.has_quantised_encoders);
  return deriveGains(limits, {device.rate_hz, 1e9, 0, 1, 1});
}

double dampingOfTheArm(const SimulatedDualArmSettings& device, const Vec3& along_D) {
  const DualArmParameters& p = device.arms;
  JointMatrix J;
  EXPECT_EQ(handleJacobian(p, Pose{}, J), Status::Ok);
  const JointVector rate = J.rightCols<3>() * along_D;
  return rate.cwiseAbs2().dot(jointVector(p.plate_damping_Nms, p.link_damping_Ns_per_m, p.rotor_damping_Nms));
}

TEST(Coupling, DerivedGainsSettleOnTheArmAndTwoToThreeTimesTheirStiffnessOscillates) {
  for (const double rate_hz : {1000.0, 4000.0})
    for (const Vec3& along_D : {Vec3(0, 0, -1), Vec3(0, 1, 0)}) {
      SimulatedDualArmSettings device = withoutDryFriction();
      device.rate_hz = rate_hz;
      const CouplingGains gains = gainsForAStillWall(device);
      WallPress press;
      press.hand_kg = 0.5;
      press.along_D = along_D;
      const Unrest rest = pressOnWall(device, gains, press);
      EXPECT_LT(rest.late_m, 0.5 * rest.early_m);
      double low = gains.k_N_per_m, high = 8 * low;
      CouplingGains stiffer = gains;
      while (high / low > 1.01) {
        stiffer.k_N_per_m = std::sqrt(low * high);
        const Unrest swing = pressOnWall(device, stiffer, press);
        (swing.late_m > swing.early_m ? high : low) = stiffer.k_N_per_m;
      }
      // The stability formula, with the arm's own damping along this direction; (w t)^2 / 6 and the plant's
      // sixteenth of a period, a 24th of t, lie above it.
      const double t_s = 1.5 / rate_hz, b = dampingOfTheArm(device, along_D) + gains.b_Ns_per_m;
      EXPECT_NEAR(low * t_s / b, 1, 0.05) << rate_hz;
      EXPECT_GT(low / gains.k_N_per_m, 1.5) << rate_hz;
      EXPECT_LT(low / gains.k_N_per_m, 3) << rate_hz;
    }
}

TEST(Coupling, DerivedGainsOnTheRealArmHaveNoLimitCycleInAnyDirection) {
  for (const double rate_hz : {1000.0, 4000.0})
    for (const Vec3& along_D : {Vec3(0, 0, -1), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
      SimulatedDualArmSettings device;
      device.rate_hz = rate_hz;
      WallPress press;
      press.along_D = along_D;
      const CouplingGains gains = gainsForAStillWall(device);
      // The bound is less than one encoder step of 60 um: a limit cycle spans a step or more.
      EXPECT_LT(pressOnWall(device, gains, press).late_m, device.arms.resolution_m / 2);
    }
}

}  // namespace
}  // namespace vps::device
