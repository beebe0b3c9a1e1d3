// SPDX-License-Identifier: BSD-3-Clause
// How functions report errors and progress: LoadError while loading, Status in the haptic loop, VPS_ASSERT
// for internal errors.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "vps/export.h"

/// Checks an internal condition: on in Debug and sanitized builds, absent in Release.
#ifdef VPS_ASSERT_ON
#define VPS_ASSERT(condition)                                                                            \
  do {                                                                                                   \
    if (!(condition)) {                                                                                  \
      std::fprintf(stderr, "%s:%d: internal error: %s does not hold\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                                      \
    }                                                                                                    \
  } while (false)
#else
#define VPS_ASSERT(condition) static_cast<void>(0)
#endif

namespace vps {

/// Thrown while loading or saving files and while building models; never in the haptic loop. what() is one
/// line for a person: "gear.stl: part 'hub': vertex 17 is not a number; export it again".
class VPS_API LoadError : public std::runtime_error {
 public:
  LoadError(const std::string& file, const std::string& part, const std::string& found_and_remedy)
      : std::runtime_error((file.empty() ? std::string() : file + ": ") +
                           (part.empty() ? std::string() : "part '" + part + "': ") + found_and_remedy) {}
};

/// The status that functions of the haptic loop return instead of throwing.
enum class Status {
  Ok,
  BadPose,     ///< a pose or velocity is not finite; the answer is zero
  Truncated,   ///< a buffer is full; the answer is valid but incomplete, and a counter says by how much
  BeyondBand,  ///< everything is farther away than the narrow band; distances are bounds
  Fault,       ///< the device or peer failed; the wrench is zero until the device is re-armed
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

/// Called from time to time with the name of the current work and the share done, 0 to 1. The function may be
/// empty. Never called from the haptic loop. It may throw to end the work, is called on one thread at a time,
/// but not always on the thread that asked for the work, and may repeat a report (see stoppable.h).
using Progress = std::function<void(std::string_view doing, double share)>;

}  // namespace vps
