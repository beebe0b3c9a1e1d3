// SPDX-License-Identifier: BSD-3-Clause
#include "run/hand_mark.h"

#include <algorithm>
#include <cstdio>

#include "vps_device/pulled_handle.h"

namespace vps::viewer {

HandMark handMark(const scenes::Snapshot& shot) {
  const double force_N = shot.F_hand_W.f.norm(), torque_Nm = shot.F_hand_W.tau.norm();
  const device::PulledHandleSettings full;
  char words[64];
  std::snprintf(words, sizeof words, "%.1f N  %.2f N m", force_N, torque_Nm);
  return {words, std::max(force_N / full.force_N, torque_Nm / full.torque_Nm)};
}

std::vector<PixelPlace> handMarkPlaces(StereoMode mode, const Vec3& hand_W, const Camera& camera,
                                       PictureSize size) {
  constexpr double kBeside_px = 16, kAbove_px = 40;
  if (mode == StereoMode::Mono) {
    const auto [x, y] = camera.project(hand_W, size.width, size.height);
    return {{x + kBeside_px, y}};
  }
  const double x = kBeside_px, y = size.height - kAbove_px;
  if (mode == StereoMode::SideBySide) return {{x, y}, {x + 0.5 * size.width, y}};
  if (mode == StereoMode::TopBottom) return {{x, y - 0.5 * size.height}, {x, y}};
  return {{x, y}};
}

}  // namespace vps::viewer
