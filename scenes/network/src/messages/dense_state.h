// SPDX-License-Identifier: BSD-3-Clause
// The dense form of states between nodes: 40 bytes, used for most states over UDP. A whole state
// (compact_fields.h) replaces a dense one at the beginning, after every kWholeEvery dense ones, after a
// change of a value that dense states lack, and if a value is out of the dense range. A reader accepts dense
// states once it has read a whole one.
//
//   both     1 | kind 2 | version 5 | sender 18 | number 24 | tick or step 8
//   haptic   status 3 | fault 3 | coupled 1 | hand 8 | time 32 | pose 122 | twist 64 | force or torque 29
//   physics  coupled 1 | stored energy known 1, float 32 | time 32 | pose 122 | twist 64 | pace 10
//
// Position: 22 bits per coordinate, in steps of 1 um, +-2 m. Rotation: 18 bits for each of three components
// of the quaternion. Twist: linear and angular velocity each have one exponent of 5 bits and three mantissas
// of 9 bits. Even-numbered states carry the force, odd-numbered ones the torque: an exponent of 5 bits and
// mantissas of 8 bits. Time: microseconds. For comparison, the encoders of the simulated arm resolve about 20
// um and 1 mrad.
//
// The part in hand is at rest in the frame of the grasp. Its pose and twist therefore follow from those of
// the grasp and from its pose in that frame in the last whole state; the twist is multiplied by the pace, in
// 1/64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "vps/pose.h"
#include "vps_device/coupling_port.h"

namespace vps::scenes {

struct HapticMessage;
struct PhysicsMessage;

inline constexpr std::size_t kDenseBytes = 40;
/// A dense state followed by its sending time [ns]; over the network, the sending time is the RTPS timestamp.
inline constexpr std::size_t kDenseMessageBytes = kDenseBytes + 8;

/// What a reader must know besides the previous message to read a dense state.
struct DenseBase {
  bool is_known = false;  ///< a whole state was read
  Pose X_GP;              ///< pose of the part in the frame of the grasp
};

/// Decides which states are sent whole, and writes the other states in the dense form. Never allocates.
class DenseWriter {
 public:
  /// Returns false if the state has to be sent whole; then nothing is written and `number` is not used.
  /// @param out  cleared, then filled with the message without its sending time
  bool write(const HapticMessage& m, std::uint64_t sender, std::uint64_t number, std::string& out) noexcept;
  bool write(const PhysicsMessage& m, std::uint64_t sender, std::uint64_t number, std::string& out) noexcept;

 private:
  static constexpr int kWholeEvery = 64;
  static constexpr int kWholeAfterNews = 8;  ///< whole states in a row after a change, since some may be lost
  static constexpr int kAtLeast =
      4;  ///< least number of dense states before a whole state that only slowly changing values need

  bool isDue(bool is_news, bool is_wished) noexcept;

  int since_whole_ = kWholeEvery, whole_left_ = kWholeAfterNews;
  std::int32_t tick_ = 0;
  double time_s_ = 0;
  // Values of the last whole state.
  device::SafetyState safety_;
  double clutch_ratio_ = 1;
  device::HeldPart held_;
  Pose X_GP_;
};

/// Sender and number of a dense state.
struct DenseHead {
  std::uint32_t sender = 0;  ///< lower bits of the sender
  std::uint64_t number = 0;  ///< the number with these lower bits that is nearest to the last one
};
inline constexpr std::uint64_t kDenseSenders = std::uint64_t{1} << 18U;

/// Whether the bytes claim to be a dense state.
constexpr bool isDense(std::string_view bytes) noexcept {
  return bytes.size() == kDenseMessageBytes && (static_cast<unsigned char>(bytes[0]) & 0x80U) != 0;
}
/// Reads a dense state. Values that a dense state lacks keep the values of `m`, which also supply the upper
/// bits of tick and time. Returns false if the bytes contain values that no state has.
bool readDense(std::string_view bytes, const DenseBase& base, HapticMessage& m) noexcept;
bool readDense(std::string_view bytes, const DenseBase& base, PhysicsMessage& m) noexcept;
/// @param last_number  number of the previous dense state; 0: none
DenseHead denseHead(std::string_view bytes, std::uint64_t last_number) noexcept;
bool isDenseOf(std::string_view bytes, const HapticMessage&) noexcept;
bool isDenseOf(std::string_view bytes, const PhysicsMessage&) noexcept;
bool isThisVersion(std::string_view bytes) noexcept;

/// For a whole state that arrived after a later dense one: keeps the fast values of `now`, which are newer.
void keepNewer(HapticMessage& read, const HapticMessage& now) noexcept;
void keepNewer(PhysicsMessage& read, const PhysicsMessage& now) noexcept;
/// Whether a dense state arrived after a later whole one.
bool isOlder(const HapticMessage& read, const HapticMessage& now) noexcept;
bool isOlder(const PhysicsMessage& read, const PhysicsMessage& now) noexcept;
/// The base that a whole state provides for later dense states.
DenseBase baseOf(const HapticMessage& m) noexcept;
DenseBase baseOf(const PhysicsMessage& m) noexcept;

/// Packs the three smaller components of the quaternion, 20 bits each, and the index of the largest one: 62
/// bits in total. Accurate to 5e-6 rad with 20 bits; each bit fewer doubles the error.
/// @param bits  bits per component, at most 20
std::uint64_t packedRotation(const Mat3& R, unsigned bits = 20);
/// Unpacks a rotation; empty if no rotation has this packed value.
std::optional<Mat3> unpackedRotation(std::uint64_t packed, unsigned bits = 20);

}  // namespace vps::scenes
