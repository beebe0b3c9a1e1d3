// SPDX-License-Identifier: BSD-3-Clause
// The status that functions of the haptic loop return instead of throwing.
#pragma once

namespace vps {

enum class Status {
  Ok,
  BadPose,     ///< a pose or velocity is not finite; the answer is zero
  Truncated,   ///< a buffer is full; the answer is valid but incomplete, and a counter says by how much
  BeyondBand,  ///< everything is farther away than the narrow band; distances are bounds
  Fault,       ///< the device or peer failed; zero wrench until re-armed
  Singular,    ///< a mechanism is in a singular position, where no answer exists; the answer is zero
};

inline const char* toText(Status status) {
  switch (status) {
    case Status::Ok:
      return "ok";
    case Status::BadPose:
      return "bad pose";
    case Status::Truncated:
      return "truncated";
    case Status::BeyondBand:
      return "beyond band";
    case Status::Fault:
      return "fault";
    case Status::Singular:
      return "singular";
  }
  return "unknown";
}

}  // namespace vps
