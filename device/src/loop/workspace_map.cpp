// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/workspace_map.h"

namespace vps::device {

Pose WorkspaceMap::toScene(const Pose& X_DH) const noexcept {
  return {Mat3(X_WD.R * X_DH.R), X_WD * Vec3(scale * X_DH.p)};
}
Pose WorkspaceMap::toDevice(const Pose& X_WH) const noexcept {
  const Mat3 R_DW = X_WD.R.transpose();
  return {Mat3(R_DW * X_WH.R), Vec3(R_DW * (X_WH.p - X_WD.p) / scale)};
}
Twist WorkspaceMap::toScene(const Twist& V_D) const noexcept {
  return {X_WD.R * V_D.w, scale * (X_WD.R * V_D.v)};
}
Twist WorkspaceMap::toDevice(const Twist& V_W) const noexcept {
  return {X_WD.R.transpose() * V_W.w, X_WD.R.transpose() * V_W.v / scale};
}
Wrench WorkspaceMap::toScene(const Wrench& F_D) const noexcept {
  return rotated(X_WD.R, F_D) * (1 / force_scale);
}
Wrench WorkspaceMap::toDevice(const Wrench& F_W) const noexcept {
  return rotated(X_WD.R.transpose(), F_W) * force_scale;
}

Grasp Grasp::between(const Pose& X_WH, const Pose& X_WG) noexcept {
  return {X_WG.p - X_WH.p, X_WH.R.transpose() * X_WG.R};
}
Pose Grasp::toGrasp(const Pose& X_WH) const noexcept {
  return {Mat3(X_WH.R * R_HG), Vec3(X_WH.p + offset_W)};
}
Pose Grasp::toHandle(const Pose& X_WG) const noexcept {
  return {Mat3(X_WG.R * R_HG.transpose()), Vec3(X_WG.p - offset_W)};
}

}  // namespace vps::device
