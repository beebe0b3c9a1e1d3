// SPDX-License-Identifier: BSD-3-Clause
// Sizes of the headset of fake_headset.cpp: its eyes and its pictures.
#pragma once

namespace vps {

inline constexpr int kFakeWidth_px = 480, kFakeHeight_px = 400;
inline constexpr double kFakeEyes_m = 0.064, kFakePitch_rad = 0.6;  // the headset looks down
// Angles of view: to the nose, to the temple, up, down.
inline constexpr double kFakeInner_rad = 0.4, kFakeOuter_rad = 0.5, kFakeUp_rad = 0.35, kFakeDown_rad = 0.45;

}  // namespace vps
