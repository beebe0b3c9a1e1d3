// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "rows.h"
#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/random.h"

namespace vps::bench {

namespace {

constexpr double kTilt_rad =
    0.785;  // rotation of the handle about any axis, at which the corners of the workspace are reachable

Pose anyPose(device::Random& random, const device::DualArmParameters& p) {
  const Vec3 place(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
  const Vec3 axis = random.normal3().normalized();
  return {rotationFromVector(kTilt_rad * random.uniform() * axis), Vec3(p.workspace_m.cwiseProduct(place))};
}

int poses(const HapticOptions& options) {
  return options.is_short ? 2000 : 200000;
}

// Calls `at` with poses over the whole workspace; at(pose, random) returns whether the device reaches the
// pose.
template <typename At>
int countRefused(const HapticOptions& options, unsigned seed, const device::DualArmParameters& p, At&& at) {
  device::Random random(seed);
  int refused = 0;
  for (int i = 0; i < poses(options); ++i)
    if (!at(anyPose(random, p), random)) ++refused;
  return refused;
}

}  // namespace

void kinematicsRow(const HapticOptions& options, Table& table) {
  const device::DualArmParameters p;
  double worst_m = 0, worst_rad = 0;
  const int refused = countRefused(options, 1, p, [&](const Pose& X_DH, device::Random&) {
    device::DualArmJoints joints;
    Pose back;
    if (device::handleJoints(p, X_DH, joints) != Status::Ok ||
        device::handlePose(p, joints, back) != Status::Ok)
      return false;
    worst_m = std::max(worst_m, (back.p - X_DH.p).norm());
    worst_rad = std::max(worst_rad, rotationVector(back.R * X_DH.R.transpose()).norm());
    return true;
  });
  table.add({"kinematics there and back",
             text("%d poses, workspace, tilt to 45 deg", poses(options)),
             {atMost("position", worst_m, 1e-9, 1, "m"), atMost("angle", worst_rad, 1e-9, 1, "rad"),
              atMost("refused", refused, 0, 1, "poses")},
             ""});
}

void staticsRow(const HapticOptions& options, Table& table) {
  const device::DualArmParameters p;
  double worst_power = 0, worst_wrench = 0;
  const int refused = countRefused(options, 2, p, [&](const Pose& X_DH, device::Random& random) {
    const Wrench F{random.normal3(), 10 * random.normal3()};
    const Twist V{random.normal3(), 0.1 * random.normal3()};
    Eigen::Matrix<double, 6, 1> v;
    v << V.w, V.v;
    device::JointVector efforts;
    device::JointMatrix J;
    Wrench back;
    if (device::motorEfforts(p, X_DH, F, efforts) != Status::Ok ||
        device::handleJacobian(p, X_DH, J) != Status::Ok ||
        device::handleWrench(p, X_DH, efforts, back) != Status::Ok)
      return false;
    const device::JointVector powers = efforts.cwiseProduct(J * v);
    worst_power = std::max(worst_power, std::abs(powers.sum() - power(F, V)) / powers.cwiseAbs().sum());
    worst_wrench = std::max(
        {worst_wrench, (back.f - F.f).norm() / F.f.norm(), (back.tau - F.tau).norm() / F.tau.norm()});
    return true;
  });
  table.add({"statics",
             text("%d poses and wrenches", poses(options)),
             {atMost("power, motors against handle", worst_power, 1e-9, 1, "relative"),
              atMost("wrench asked for and got", worst_wrench, 1e-9, 1, "relative"),
              atMost("refused", refused, 0, 1, "poses")},
             ""});
}

}  // namespace vps::bench
