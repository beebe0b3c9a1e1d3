// SPDX-License-Identifier: BSD-3-Clause
// The part in hand between two physics snapshots: a small implicit step against the fixed voxmap, in the
// haptic thread, so that contact stays crisp where physics is slower than the loop.
#pragma once

#include <optional>

#include "vps/coupling_law.h"
#include "vps/query.h"
#include "vps_device/export.h"

namespace vps::device {

struct LocalContactSettings {
  double hold_limit_s = 0.05;  ///< without a new snapshot for longer, the part stands still. assumed: five
                               ///< steps of 100 Hz physics
  std::size_t contact_limit = 4096;  ///< near points; with more the snapshot is held
  std::size_t solve_limit = 64;  ///< of these enter the step; of more every second, third, ... for as many
  double margin_m = 50e-6;       ///< points so near may touch within the tick, besides what the speed tells.
                                 ///< assumed: 50 mm/s at 1 kHz
};

/// What is in hand and what it may touch. Map and shell outlive their use.
struct LocalPart {
  const VoxMap* map = nullptr;        ///< of what is fixed
  const PointShell* shell = nullptr;  ///< of the part
  Pose X_WM;
  Pose X_PG;                      ///< the grasp frame, at the centre of mass
  double mass_kg = 0;             ///< > 0
  Mat3 inertia_G = Mat3::Zero();  ///< about G, in G [kg m^2], positive
  Vec3 gravity_W = Vec3::Zero();
  double friction = 0;
  double k_N_per_m3 = 1e12;  ///< contact stiffness per area
};

/// One thread at a time; take() and letGo() while the loop stands still. follow() never throws, allocates,
/// locks.
///
/// Each tick is one backward-Euler step of the part under the coupling, gravity, the fixed map's contacts
/// (penalty along their normals, linear in the step) and friction (viscous, up to the cone), as one 6 x 6
/// system. Each of these only stores or dissipates, and backward Euler adds to what is dissipated: between
/// snapshots the model gives the hand no energy of its own. What a new snapshot adds by moving the part is
/// told by jump_J.
class VPS_DEVICE_API LocalContact {
 public:
  explicit LocalContact(const LocalContactSettings& settings = {});

  void take(const LocalPart& part);
  void letGo() noexcept { part_.reset(); }

  /// Where the part is now. Once a tick.
  /// @param snapshot  of physics, the same until there is a new one (by its time stamp)
  CouplingState follow(const CouplingGains& gains, const CouplingState& proxy, const CouplingState& snapshot,
                       double dt_s) noexcept;

  struct Report {
    std::size_t contacts = 0;  ///< of the last tick, touching
    std::uint64_t held =
        0;              ///< ticks in which the part was held instead: too many contacts, too old, no number
    double jump_J = 0;  ///< sum of what snapshots added to the coupling's springs
    double greatest_jump_m = 0;
  };
  [[nodiscard]] const Report& report() const noexcept { return report_; }

 private:
  [[nodiscard]] bool step(const CouplingGains& gains, const CouplingState& proxy, double dt_s) noexcept;
  void startFrom(const CouplingGains& gains, const CouplingState& proxy,
                 const CouplingState& snapshot) noexcept;

  LocalContactSettings settings_;
  std::optional<LocalPart> part_;
  std::optional<QueryMemory> memory_;
  ContactSet near_;
  CouplingState now_;
  double snapshot_time_s_ = 0, age_s_ = 0;
  bool has_snapshot_ = false;
  Report report_;
};

}  // namespace vps::device
