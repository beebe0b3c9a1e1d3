// SPDX-License-Identifier: BSD-3-Clause
// What one installation shares among its pairs.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "native_shapes/native_shape_adapter.h"
#include "solver/penalty_pair.h"
#include "vps_bullet/install.h"

class btDispatcher;

namespace vps::bullet {

struct Context {
  Settings settings;
  NativeShapeCache partners;
  // Atomic: a thread-safe Bullet runs pairs side by side.
  std::atomic<std::size_t> pair_updates{0}, points_tested{0}, candidates{0}, contacts{0}, left_out{0},
      overlapping_starts{0};
  std::atomic<double> deepest_start_m{0};
  PenaltyRegistry penalty;
};

/// Of the installation on a dispatcher; null without one.
std::shared_ptr<Context> contextOf(const btDispatcher* dispatcher);

}  // namespace vps::bullet
