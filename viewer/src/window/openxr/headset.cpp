// SPDX-License-Identifier: BSD-3-Clause
// Asks the loader of OpenXR. The only file that includes it.
#include "vps_viewer/headset.h"

#include <openxr/openxr.h>

#include <cstdio>
#include <cstdlib>

namespace vps::viewer::inline v0 {
namespace {

constexpr const char* kBrowser = "a headset shows the scene by its browser: vps watch SCENE --web 8080";

/// An instance of OpenXR; null: there is none.
class Instance {
 public:
  Instance() {
    setenv("XR_LOADER_DEBUG", "none", 0);  // what it prints by itself; we say it in words
    XrInstanceCreateInfo wanted{};
    wanted.type = XR_TYPE_INSTANCE_CREATE_INFO;
    wanted.applicationInfo.apiVersion = XR_CURRENT_API_VERSION;
    std::snprintf(static_cast<char*>(wanted.applicationInfo.applicationName), XR_MAX_APPLICATION_NAME_SIZE,
                  "vps");
    result_ = xrCreateInstance(&wanted, &instance_);
  }
  ~Instance() {
    if (instance_ != XR_NULL_HANDLE) xrDestroyInstance(instance_);
  }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  [[nodiscard]] XrResult result() const { return result_; }
  [[nodiscard]] std::string runtime() const {
    XrInstanceProperties found{};
    found.type = XR_TYPE_INSTANCE_PROPERTIES;
    return XR_SUCCEEDED(xrGetInstanceProperties(instance_, &found)) ? static_cast<char*>(found.runtimeName)
                                                                    : "a runtime";
  }
  [[nodiscard]] bool hasHeadset() const {
    XrSystemGetInfo wanted{};
    wanted.type = XR_TYPE_SYSTEM_GET_INFO;
    wanted.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    XrSystemId system = XR_NULL_SYSTEM_ID;
    return XR_SUCCEEDED(xrGetSystem(instance_, &wanted, &system));
  }

 private:
  XrInstance instance_ = XR_NULL_HANDLE;
  XrResult result_ = XR_ERROR_RUNTIME_UNAVAILABLE;
};

}  // namespace

std::string headsetWords() {
  const Instance instance;
  if (XR_FAILED(instance.result()))
    return std::string(instance.result() == XR_ERROR_RUNTIME_UNAVAILABLE
                           ? "no OpenXR runtime is installed or chosen, so there is no headset here; "
                           : "the OpenXR runtime does not start; see that its service runs; ") +
           kBrowser;
  if (!instance.hasHeadset())
    return instance.runtime() + " (OpenXR) has no headset; connect it; or " + kBrowser;
  return instance.runtime() + " (OpenXR) has a headset, into which this window does not draw; " + kBrowser;
}

}  // namespace vps::viewer::inline v0
