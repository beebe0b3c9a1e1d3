// SPDX-License-Identifier: BSD-3-Clause
// The sound of impacts for watchers of a session, who get too few snapshots to synthesise contact sound as a
// run does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// An impact of the part in hand on another part.
struct Blow {
  std::size_t part = 0;
  double impulse_Ns = 0;
  Vec3 p_P = Vec3::Zero(), n_P = Vec3::UnitZ();  ///< place and direction, in the part's frame
  Vec3 p_W = Vec3::Zero();                       ///< place in W
  std::int64_t taken_ns = 0;                     ///< time of the snapshot, as passed to BlowSounds::hear()
};

/// The sound of an impact.
struct BlowSound {
  static constexpr int kRate_hz = 24000;
  std::vector<double> pressure_Pa;
  Vec3 p_W = Vec3::Zero();    ///< place of the impact
  std::int64_t taken_ns = 0;  ///< time of the snapshot that showed the impact
};

/// Finds impacts between snapshots. When contact begins, the impulse follows from the part's loss of speed
/// along the contact normal. A part that was in contact before causes no impact.
class VPS_VIEWER_API BlowSense {
 public:
  /// @param masses_kg  mass of each part
  explicit BlowSense(std::vector<double> masses_kg) : masses_kg_(std::move(masses_kg)) {}
  /// Returns the impact since the snapshot before, if there is one. Call it with the snapshots in order.
  std::optional<Blow> hear(const scenes::Snapshot& shot);

 private:
  std::vector<double> masses_kg_;
  std::optional<scenes::Snapshot> last_;
  Vec3 v_W_ = Vec3::Zero();  ///< velocity of the part in hand over the last interval
};

/// Synthesises the sound of impacts from the struck part's modes, on a thread of its own.
class VPS_VIEWER_API BlowSounds {
 public:
  /// Copies the scene.
  explicit BlowSounds(const scenes::Scene& scene);
  ~BlowSounds();
  BlowSounds(const BlowSounds&) = delete;
  BlowSounds& operator=(const BlowSounds&) = delete;

  /// Looks for an impact in the next snapshot.
  /// @param taken_ns  time of the snapshot, passed on to BlowSound
  void hear(const scenes::Snapshot& shot, std::int64_t taken_ns = 0);
  /// The sounds that became ready since the last call.
  std::vector<BlowSound> take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vps::viewer
