// SPDX-License-Identifier: BSD-3-Clause
// The hand controllers of a headset: poses, triggers and vibration.
#pragma once

#include <array>

#include "openxr/xr_instance.h"

namespace vps::viewer {

/// State of a controller; it points along the -z of its frame H, whose pose is in the room's frame R.
struct Controller {
  bool is_tracked = false, is_taking = false;
  Pose X_RH;
};

class Controllers {
 public:
  /// Call it before the session's first frame. Throws std::runtime_error.
  Controllers(XrInstance instance, XrSession session);
  ~Controllers();
  Controllers(const Controllers&) = delete;
  Controllers& operator=(const Controllers&) = delete;

  /// State of both controllers at a time of the runtime's clock.
  [[nodiscard]] std::array<Controller, 2> at(XrSpace room, XrTime time) const;
  void tremble(std::size_t hand, double share) const;

 private:
  void suggest(const char* profile, const char* trigger) const;
  [[nodiscard]] XrPath path(const char* text) const;

  XrInstance instance_;
  XrSession session_;
  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction aim_ = XR_NULL_HANDLE, take_ = XR_NULL_HANDLE, tremble_ = XR_NULL_HANDLE;
  std::array<XrPath, 2> hands_{};
  std::array<XrSpace, 2> spaces_{};
};

}  // namespace vps::viewer
