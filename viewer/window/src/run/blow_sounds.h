// SPDX-License-Identifier: BSD-3-Clause
// The sound of impacts, for those who watch a session: they get too few snapshots to synthesise it as a run
// does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// The part in hand meets something.
struct Blow {
  std::size_t part = 0;
  double impulse_Ns = 0;
  Vec3 p_P = Vec3::Zero(), n_P = Vec3::UnitZ();  ///< of the part: place and direction
  Vec3 p_W = Vec3::Zero();                       ///< the place
  std::int64_t taken_ns = 0;                     ///< as BlowSounds::hear() was told
};

/// What a blow sounds like.
struct BlowSound {
  static constexpr int kRate_hz = 24000;
  std::vector<double> pressure_Pa;
  Vec3 p_W = Vec3::Zero();    ///< where it comes from
  std::int64_t taken_ns = 0;  ///< of the snapshot that showed it
};

/// Finds blows between snapshots: where contact begins, the part gives up the speed at which it came along
/// the contact's normal. A part that was in contact already strikes nothing.
class VPS_VIEWER_API BlowSense {
 public:
  /// @param masses_kg  by part
  explicit BlowSense(std::vector<double> masses_kg) : masses_kg_(std::move(masses_kg)) {}
  /// Give the snapshots in order.
  std::optional<Blow> hear(const scenes::Snapshot& shot);

 private:
  std::vector<double> masses_kg_;
  std::optional<scenes::Snapshot> last_;
  Vec3 v_W_ = Vec3::Zero();  ///< of the part in hand, over the last interval
};

/// Lets the struck part ring, by its modes, on a thread of its own.
class VPS_VIEWER_API BlowSounds {
 public:
  /// Copies the scene.
  explicit BlowSounds(const scenes::Scene& scene);
  ~BlowSounds();
  BlowSounds(const BlowSounds&) = delete;
  BlowSounds& operator=(const BlowSounds&) = delete;

  /// @param taken_ns  when it was taken, for BlowSound
  void hear(const scenes::Snapshot& shot, std::int64_t taken_ns = 0);
  /// What is ready, each once.
  std::vector<BlowSound> take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vps::viewer
