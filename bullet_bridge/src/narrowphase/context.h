// SPDX-License-Identifier: BSD-3-Clause
// What all pairs of one installation share: settings, counters, and four stores that are declared only.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "vps_bullet/settings.h"

namespace vps::bullet {

class NativeShapeCache;
class PenaltyContacts;
class StepChecks;
struct TurnReports;

struct Context {
  Settings settings;
  std::shared_ptr<NativeShapeCache> native_shapes;
  std::shared_ptr<PenaltyContacts> penalty_contacts;
  std::shared_ptr<StepChecks> step_checks;
  std::shared_ptr<TurnReports> turn_reports;
  // Atomic: btCollisionDispatcherMt processes pairs in parallel.
  std::atomic<std::size_t> pair_updates{0}, points_tested{0}, candidates{0}, contacts{0}, left_out{0},
      overlapping_starts{0};
  std::atomic<double> deepest_start_m{0};
};

}  // namespace vps::bullet
