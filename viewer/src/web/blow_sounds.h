// SPDX-License-Identifier: BSD-3-Clause
// The sound of impacts, for browsers, which get too few snapshots to synthesise it as a window does.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/scene.h"
#include "vps_scenes/snapshot.h"

namespace vps::viewer::inline v0 {

/// The part in hand meets something.
struct Blow {
  std::size_t part = 0;
  double impulse_Ns = 0;
  Vec3 p_P = Vec3::Zero(), n_P = Vec3::UnitZ();  ///< of the part: place and direction
};

/// Finds blows between snapshots: where contact begins, the part gives up the speed at which it came along
/// the contact's normal. A part that was in contact already strikes nothing.
class BlowSense {
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
class BlowSounds {
 public:
  /// Copies the scene.
  explicit BlowSounds(const scenes::Scene& scene);
  ~BlowSounds();
  BlowSounds(const BlowSounds&) = delete;
  BlowSounds& operator=(const BlowSounds&) = delete;

  void hear(const scenes::Snapshot& shot);
  /// What is ready, each once: u8 kBlowKind, u32 rate_hz, f32 pressure in Pa of the number 32767, i16
  /// samples.
  std::vector<std::string> take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// First byte of the messages to a browser.
inline constexpr std::uint8_t kShotKind = 1, kBlowKind = 2;

}  // namespace vps::viewer::inline v0
