// SPDX-License-Identifier: BSD-3-Clause
// Predicts the part in hand between two physics states: one small implicit step per tick against the fixed
// voxmap, in the haptic thread, for contact forces without delay where physics is slower than the loop.
// Its limits are in HAPTIC_LOOP.md.
#pragma once

#include <optional>
#include <vector>

#include "vps/coupling_law.h"
#include "vps/query.h"
#include "vps_device/export.h"

namespace vps::device {

struct LocalContactSettings {
  /// Once the last physics state is older than this limit, the part stands still. assumed: five steps of 100
  /// Hz physics
  double hold_limit_s = 0.05;
  /// Greatest number of near points; if there are more, the last state is held.
  std::size_t contact_limit = 4096;
  /// Greatest number of contacts in the step. If there are more contacts, only every second, third, ...
  /// contact enters the step.
  std::size_t solve_limit = 64;
  /// Points within this distance may touch within the tick. assumed: 50 mm/s at 1 kHz
  double margin_m = 50e-6;
};

/// The held part and the map that it may touch. Map and shell must outlive their use.
struct LocalPart {
  const VoxMap* map = nullptr;        ///< voxmap of the fixed parts
  const PointShell* shell = nullptr;  ///< pointshell of the held part
  Pose X_WM;
  Pose X_PG;                      ///< the grasp frame, at the centre of mass
  double mass_kg = 0;             ///< > 0
  Mat3 inertia_G = Mat3::Zero();  ///< moment of inertia about G, in G [kg m^2], positive
  Vec3 gravity_W = Vec3::Zero();
  /// Contact parameters against one part of the map.
  struct Material {
    double friction = 0;       ///< coefficient between both parts
    double k_N_per_m3 = 1e12;  ///< contact stiffness per area
  };
  Material material;               ///< material of parts that are not in `of_owner`
  std::vector<Material> of_owner;  ///< materials by the map's owner (Contact::owner)

  [[nodiscard]] const Material& materialAt(const Contact& contact) const noexcept {
    return contact.owner < of_owner.size() ? of_owner[contact.owner] : material;
  }
};

/// One thread at a time; take() and letGo() only while the loop is stopped. follow() never throws, allocates
/// or locks.
///
/// Each tick is one backward-Euler step of the part under the coupling, gravity, the fixed map's contacts
/// (penalty along their normals, linear in the step) and friction (viscous, up to the cone), as one 6 x 6
/// system. Each of these terms only stores or dissipates energy, and backward Euler dissipates more: between
/// physics states the model adds no energy. The energy that a new state adds by moving the part is reported
/// as jump_J.
class VPS_DEVICE_API LocalContact {
 public:
  explicit LocalContact(const LocalContactSettings& settings = {});

  void take(const LocalPart& part);
  void letGo() noexcept { part_.reset(); }

  /// The predicted state of the part; call once per tick.
  /// @param snapshot  latest physics state; a state with another time stamp is a new state
  CouplingState follow(const CouplingGains& gains, const CouplingState& proxy, const CouplingState& snapshot,
                       double dt_s) noexcept;

  struct Report {
    std::size_t contacts = 0;  ///< touching contacts in the last tick
    /// Ticks in which the part was held still instead of being predicted: too many contacts, state too old,
    /// or result not finite.
    std::uint64_t held = 0;
    double jump_J = 0;  ///< sum of the energy that new states added to the coupling's springs
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
