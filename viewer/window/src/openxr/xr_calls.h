// SPDX-License-Identifier: BSD-3-Clause
// What the files of this folder share of OpenXR: its header with OpenGL on X11, and results that are checked.
#pragma once

// epoxy first: the header of X11 that OpenXR's wants comes with it.
#include <epoxy/gl.h>
#include <epoxy/glx.h>
#define XR_USE_PLATFORM_XLIB
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
// Xlib's macros, which other headers use as names.
#undef None
#undef Bool
#undef Status
#undef Success

#include <stdexcept>
#include <string>

#include "vps/pose.h"

namespace vps::viewer {

/// A struct of OpenXR with its type set and all else zero.
template <class T>
[[nodiscard]] T xrStruct(XrStructureType type) {
  T made{};
  made.type = type;
  return made;
}

/// Throws std::runtime_error: "the headset's runtime refuses xrBeginFrame (-25)".
inline void check(XrResult result, const char* call) {
  if (XR_SUCCEEDED(result)) return;
  throw std::runtime_error(std::string("the headset's runtime refuses ") + call + " (" +
                           std::to_string(static_cast<int>(result)) + ")");
}

[[nodiscard]] inline Pose poseOf(const XrPosef& X) {
  const auto& [x, y, z, w] = X.orientation;
  return {Quat(w, x, y, z).normalized(), Vec3(X.position.x, X.position.y, X.position.z)};
}

[[nodiscard]] inline XrPosef identityPose() {
  XrPosef X{};
  X.orientation.w = 1;
  return X;
}

}  // namespace vps::viewer
