// SPDX-License-Identifier: BSD-3-Clause
// The states between nodes in 40 bytes, as most of them are sent over UDP. Now and then a state is sent whole
// (compact_fields.h) in place of a dense one: at the beginning, each kWholeEvery, when something changed that
// dense ones do not have, and where a value is beyond their range. A reader takes dense states once it has
// read a whole one.
//
//   both     1 | kind 2 | version 5 | sender 18 | number 24 | tick or step 8
//   haptic   status 3 | fault 3 | coupled 1 | hand 8 | time 32 | pose 122 | twist 64 | force or torque 29
//   physics  coupled 1 | stored energy known 1, float 32 | time 32 | pose 122 | twist 64 | pace 10
//
// Position: 22 bits each of 1 um, +-2 m. Rotation: 18 bits for each of three components of the quaternion.
// Twist: for velocity and turning one exponent of 5 bits and three mantissas of 9. Force on even numbers,
// torque on odd ones: an exponent of 5 and mantissas of 8. Time: microseconds. The encoder of the simulated
// arm resolves some 20 um and 1 mrad.
//
// The part in hand is at rest in the frame of the grasp, so its pose and twist follow from those of the grasp
// and from where it was there when last sent whole; the twist times the pace, in 1/64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "vps/pose.h"
#include "vps_device/coupling_port.h"

namespace vps::scenes {

struct HapticMessage;
struct PhysicsMessage;

inline constexpr std::size_t kDenseBytes = 40;
/// With the time of sending [ns], which goes over the network as the time stamp that RTPS has anyway.
inline constexpr std::size_t kDenseMessageBytes = kDenseBytes + 8;

/// What a reader must know besides the message before.
struct DenseBase {
  bool is_known = false;  ///< a whole state was read
  Pose X_GP;              ///< the part in the frame of the grasp
};

/// Decides what is sent whole, and writes the others. Never allocates.
class DenseWriter {
 public:
  /// False: send it whole; then nothing is written and `number` is not used.
  /// @param out  emptied, then the message without its time of sending
  bool write(const HapticMessage& m, std::uint64_t sender, std::uint64_t number, std::string& out) noexcept;
  bool write(const PhysicsMessage& m, std::uint64_t sender, std::uint64_t number, std::string& out) noexcept;

 private:
  static constexpr int kWholeEvery = 64;
  static constexpr int kWholeAfterNews = 8;  ///< so many in a row, since some are lost
  static constexpr int kAtLeast = 4;         ///< dense ones between two that slow values ask for

  bool isDue(bool is_news, bool is_wished) noexcept;

  int since_whole_ = kWholeEvery, whole_left_ = kWholeAfterNews;
  std::int32_t tick_ = 0;
  double time_s_ = 0;
  // As last sent whole.
  device::SafetyState safety_;
  double clutch_ratio_ = 1;
  device::HeldPart held_;
  Pose X_GP_;
};

/// What came of the bytes of a dense state.
struct DenseHead {
  std::uint32_t sender = 0;  ///< the lower bits
  std::uint64_t number = 0;  ///< as near to the last one as its lower bits allow
};
inline constexpr std::uint64_t kDenseSenders = std::uint64_t{1} << 18U;

/// Whether bytes claim to be a dense state.
constexpr bool isDense(std::string_view bytes) noexcept {
  return bytes.size() == kDenseMessageBytes && (static_cast<unsigned char>(bytes[0]) & 0x80U) != 0;
}
/// Values of the message that the bytes do not have stay, and tell the upper bits of tick and time. False:
/// the bytes have values that no state has.
bool readDense(std::string_view bytes, const DenseBase& base, HapticMessage& m) noexcept;
bool readDense(std::string_view bytes, const DenseBase& base, PhysicsMessage& m) noexcept;
/// @param last_number  of the dense state before; 0: none
DenseHead denseHead(std::string_view bytes, std::uint64_t last_number) noexcept;
bool isDenseOf(std::string_view bytes, const HapticMessage&) noexcept;
bool isDenseOf(std::string_view bytes, const PhysicsMessage&) noexcept;
bool isThisVersion(std::string_view bytes) noexcept;

/// A whole state that came after a later dense one: its fast values are old, so those of `now` stay.
void keepNewer(HapticMessage& read, const HapticMessage& now) noexcept;
void keepNewer(PhysicsMessage& read, const PhysicsMessage& now) noexcept;
/// A dense state that came after a later whole one.
bool isOlder(const HapticMessage& read, const HapticMessage& now) noexcept;
bool isOlder(const PhysicsMessage& read, const PhysicsMessage& now) noexcept;
/// The base that a whole state gives.
DenseBase baseOf(const HapticMessage& m) noexcept;
DenseBase baseOf(const PhysicsMessage& m) noexcept;

}  // namespace vps::scenes
