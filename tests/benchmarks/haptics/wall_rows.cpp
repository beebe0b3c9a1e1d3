// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "rows.h"
#include "support/device/sampled_wall.h"

namespace vps::bench {

using test::SampledWall;

// The wall as the loop renders it, over all frequencies: a hand moves the handle, and a damper must dissipate
// the wall's work.
void passivityRow(const HapticOptions& options, Table& table) {
  double most = 0, least_sharp = 1e9, least = 1e9;
  const int stride = options.is_short ? 10 : 1;
  for (const double T : {0.25e-3, 1e-3, 4e-3})
    for (const double K : {200.0, 2000.0, 20000.0})
      for (const double share : {0.0, 0.1, 0.5, 1.0})
        for (const int delay : {0, 1, 3}) {
          const SampledWall w{K, share * K * T, T, delay * T};
          double need = 0;
          for (int i = 0; i <= test::kSineSamples / 2; i += stride)
            need = std::max(need, test::measuredPassiveDamping(w, std::max(1, i)));
          const double ratio = need / test::passiveDampingFormula(w);
          most = std::max(most, ratio);
          least = std::min(least, ratio);
          if (w.B_Ns_per_m == 0 || delay == 0) least_sharp = std::min(least_sharp, ratio);
        }
  table.add(
      {"wall: damping it needs to be passive",
       "our loop, T 0.25-4 ms, K 0.2-20 kN/m, B 0-K T, 0-3 ticks",
       {within("t_d = 0 or B = 0: least", least_sharp, 1, 0.05, 1, "of the formula"),
        atMost("all: most", most, 1.0001, 1, "of the formula"),
        reported("t_d and B together: least", least, 1, "of the formula")},
       "with both, spring and damper are worst at different frequencies: the formula is safe, not sharp"});
}

void ringingRow(const HapticOptions& options, Table& table) {
  double low = 1e9, high = 0;
  for (const double T : {0.25e-3, 1e-3, 2e-3})
    for (const double b : {2.0, 5.0, 10.0})
      for (const double share : {0.0, 0.2, 1.0})
        for (const int delay : {0, 1, 3}) {
          if (options.is_short && b != 5) continue;
          const SampledWall w{1, share * b, T, delay * T};
          const double K = test::ringingFormula(w, b), t_s = T / 2 + w.delay_s;
          const double ratio = test::measuredRinging(w, std::max(0.5, 9 * K * t_s * t_s), b) / K;
          low = std::min(low, ratio);
          high = std::max(high, ratio);
        }
  table.add({"wall: stiffness that rings",
             "our loop, T 0.25-2 ms, b 2-10, B 0-b, 0-3 ticks",
             {within("least", low, 1, 0.05, 1, "of the formula"),
              within("most", high, 1, 0.05, 1, "of the formula")},
             ""});
}

// Abbott and Okamura's number assumes that the least friction and the worst encoder error coincide.
void stiffestWallRow(const HapticOptions& options, Table& table) {
  for (const double rate_hz : {1000.0, 4000.0}) {
    device::SimulatedDualArmSettings device;
    device.rate_hz = rate_hz;
    const device::DeviceLimits limits = device::dualArmLimits(device.arms, rate_hz, true);
    const CouplingGains gains = device::deriveGains(limits, {rate_hz, 1e9, 0, 1, 1});
    const auto stiffest = [&](const device::SimulatedDualArmSettings& d) {
      double least = 1e9;
      for (const Vec3& along_D : {Vec3(0, 0, -1), Vec3(0, 1, 0), Vec3(1, 0, 0)}) {
        test::WallPress press;
        press.along_D = along_D;
        least = std::min(least, test::stiffestWall(d, gains, gains.k_N_per_m / 2, press));
        if (options.is_short) break;
      }
      return least;
    };
    const double theory =
        std::min(2 * limits.damping_Ns_per_m * rate_hz, 2 * limits.coulomb_N / limits.resolution_m);
    table.add(
        {text("stiffest wall without limit cycle, %.0f kHz", rate_hz / 1000),
         "dual arm, unchanged",
         {reported("ours", stiffest(device), 1e-3, "kN/m"),
          reported("min(2b/T, 2 f_c/D)", theory, 1e-3, "kN/m"),
          reported("2b/T", 2 * limits.damping_Ns_per_m * rate_hz, 1e-3, "kN/m"),
          reported("derived gains", gains.k_N_per_m, 1e-3, "kN/m")},
         "a cycle: the handle moves by more than half an encoder error. The plant's dry friction fades below "
         "2 mm/s, which damps small cycles"});
  }
}

}  // namespace vps::bench
