// SPDX-License-Identifier: BSD-3-Clause
// The connection to the runtime of OpenXR, and whether it has a headset.
#pragma once

#include <string>

#include "openxr/xr_calls.h"

namespace vps::viewer {

class XrConnection {
 public:
  XrConnection();
  ~XrConnection();
  XrConnection(const XrConnection&) = delete;
  XrConnection& operator=(const XrConnection&) = delete;

  /// Why there is no headset that OpenGL can draw into, with what helps; empty: there is one.
  [[nodiscard]] std::string whyNot() const;
  /// Its name: "Monado(XRT) by Collabora et al".
  [[nodiscard]] std::string runtime() const;
  [[nodiscard]] XrInstance instance() const { return instance_; }
  [[nodiscard]] XrSystemId system() const { return system_; }

 private:
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  XrResult result_ = XR_ERROR_RUNTIME_UNAVAILABLE;
};

}  // namespace vps::viewer
