// SPDX-License-Identifier: BSD-3-Clause
// Encodes snapshots as bytes for one browser: only the changes since the snapshot that it was sent last.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "run/blow_sounds.h"
#include "web/watched_run.h"

namespace vps::viewer {

/// Layout, little-endian; lengths are in metres from `center_W`, rotations are quaternions x y z w:
///
///     u8 kShotKind   u32 number   f64 time_s   f64 taken_ms   i16 step   u8 flags
///     u16 count    { u16 part, u8 role, f32 pose[7] }   bodies that changed; role 255: no longer there
///     if flags & 1:  u16 part, f32 pose[7]              target
///     if flags & 2:  f32 pose[7], f32 force_N[3], f32 torque_Nm[3]     handle, and what the hand feels
///     u16 count    { f32 p[3], i8 n[3], f32 depth_um, f32 force_N }    contacts, at most kMostContacts
///
/// Flag 4: the message has all bodies, so the browser forgets the other bodies.
class SnapshotCoder {
 public:
  explicit SnapshotCoder(const Vec3& center_W) : center_W_(center_W) {}

  /// Encodes the next snapshot. O(bodies + contacts).
  std::string encode(const WatchedShot& shot);
  /// Number of the last snapshot, counted from 1.
  [[nodiscard]] std::uint32_t number() const { return number_; }

 private:
  void putBodies(const std::vector<scenes::BodySnapshot>& bodies, std::string& out);
  [[nodiscard]] std::string poseBytes(const Pose& X_W) const;

  Vec3 center_W_;
  std::uint32_t number_ = 0;
  std::map<std::uint16_t, std::string> sent_;  ///< role and pose that were sent last, by part
};

inline constexpr std::size_t kMostContacts = 256;

/// First byte of the binary messages to a browser.
inline constexpr std::uint8_t kShotKind = 1, kBlowKind = 2;

/// The message of an impact's sound: u8 kBlowKind, f64 taken_ms, u32 rate_hz, f32 pressure of the value 32767
/// [Pa], i16 samples.
std::string blowBytes(const BlowSound& sound);

}  // namespace vps::viewer
