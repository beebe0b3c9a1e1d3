// SPDX-License-Identifier: BSD-3-Clause
// OpenXR with OpenGL on X11: its headers, checked results, and the connection to the runtime.
#pragma once

// epoxy comes first: it includes the X11 header that the OpenXR header needs.
#include <epoxy/gl.h>
#include <epoxy/glx.h>
#define XR_USE_PLATFORM_XLIB
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
// Other headers use the names of these macros of Xlib.
#undef None
#undef Bool
#undef Status
#undef Success

#include <stdexcept>
#include <string>

#include "vps/pose.h"

namespace vps::viewer {

/// The connection to the OpenXR runtime.
class XrConnection {
 public:
  XrConnection();
  ~XrConnection();
  XrConnection(const XrConnection&) = delete;
  XrConnection& operator=(const XrConnection&) = delete;

  /// Why there is no headset for pictures of OpenGL, with a remedy; empty: there is one.
  [[nodiscard]] std::string whyNot() const;
  /// Name of the runtime, for example "Monado(XRT) by Collabora et al".
  [[nodiscard]] std::string runtime() const;
  [[nodiscard]] XrInstance instance() const { return instance_; }
  [[nodiscard]] XrSystemId system() const { return system_; }

 private:
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  XrResult result_ = XR_ERROR_RUNTIME_UNAVAILABLE;
};

/// A struct of OpenXR with its type set and all other members zero.
template <class T>
[[nodiscard]] T xrStruct(XrStructureType type) {
  T made{};
  made.type = type;
  return made;
}

/// Throws std::runtime_error if a call failed: "the headset's runtime refuses xrBeginFrame (-25)".
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
