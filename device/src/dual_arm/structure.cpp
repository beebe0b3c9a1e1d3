// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/structure.h"

#include <cmath>

namespace vps::device {

JointVector structureStiffness(const DualArmParameters& p, const JointVector& joints) noexcept {
  const double gimbal = 1 / p.gimbal_N_per_m;
  JointVector k = jointVector(1 / p.plate_Nm_per_rad, 1 / p.link_N_per_m, 1 / p.rotor_Nm_per_rad);
  for (int arm = 0; arm < 6; arm += 3) {
    const double d = joints[arm + 2], lever = d * std::cos(joints[arm + 1]);
    k[arm] += gimbal / (lever * lever);
    k[arm + 1] += gimbal / (d * d);
    k[arm + 2] += gimbal;
  }
  return k.cwiseInverse();
}

JointVector structureDrift(const DualArmParameters& p, const JointVector& joints,
                           const JointVector& stretch) noexcept {
  const double gimbal = 1 / p.gimbal_N_per_m;
  const JointVector k = structureStiffness(p, joints);
  const JointVector load2 = k.cwiseProduct(stretch).cwiseAbs2();  // N^2 m^2, N^2
  JointVector drift = JointVector::Zero();
  for (int arm = 0; arm < 6; arm += 3) {
    // 1/K_1 = .. + g / (d c2)^2,  1/K_2 = .. + g / d^2; half of K^2 stretch^2 times their derivatives.
    const double d = joints[arm + 2], c2 = std::cos(joints[arm + 1]), lever2 = d * d * c2 * c2;
    drift[arm + 1] = gimbal / lever2 * std::tan(joints[arm + 1]) * load2[arm];
    drift[arm + 2] = -gimbal / d * (load2[arm] / lever2 + load2[arm + 1] / (d * d));
  }
  return drift;
}

}  // namespace vps::device
