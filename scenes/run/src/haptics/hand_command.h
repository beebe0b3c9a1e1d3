// SPDX-License-Identifier: BSD-3-Clause
// What the physics thread tells the hand and the haptic loop to do, one thing at a time.
#pragma once

#include <cstddef>

#include "haptics/hand.h"
#include "vps_device/loop.h"
#include "vps_device/run_log.h"

namespace vps::scenes {

struct HandCommand {
  device::SyncEventKind what = device::SyncEventKind::Tick;  ///< from Begin on
  Pose X_WG;                                                 ///< of HandOver
  std::size_t step = 0;                                      ///< of Begin, and of GoBack: the next one
  double now_s = 0;                                          ///< of Begin
  device::OperatorTask task;                                 ///< of Begin
};

/// Allocates what a command needs, on any thread, before carryOut().
void prepare(Hand& hand, const HandCommand& command);
/// On the thread that runs the loop. Never allocates.
void carryOut(Hand& hand, device::HapticLoop& loop, const HandCommand& command) noexcept;

}  // namespace vps::scenes
