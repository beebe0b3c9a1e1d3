// SPDX-License-Identifier: BSD-3-Clause
#include "openxr/xr_instance.h"

#include <cstdio>
#include <cstdlib>

namespace vps::viewer {

XrConnection::XrConnection() {
  setenv("XR_LOADER_DEBUG", "none", 0);  // whyNot() reports errors, so the loader need not print them
  static constexpr const char* kOpenGl[] = {XR_KHR_OPENGL_ENABLE_EXTENSION_NAME};
  auto wanted = xrStruct<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  // Old runtimes refuse versions above 1.0, which are not needed.
  wanted.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  wanted.enabledExtensionCount = 1;
  wanted.enabledExtensionNames = kOpenGl;
  std::snprintf(static_cast<char*>(wanted.applicationInfo.applicationName), XR_MAX_APPLICATION_NAME_SIZE,
                "vps");
  result_ = xrCreateInstance(&wanted, &instance_);
  if (XR_FAILED(result_)) {
    instance_ = XR_NULL_HANDLE;
    return;
  }
  auto head = xrStruct<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  head.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  if (XR_FAILED(xrGetSystem(instance_, &head, &system_))) system_ = XR_NULL_SYSTEM_ID;
}

XrConnection::~XrConnection() {
  if (instance_ != XR_NULL_HANDLE) xrDestroyInstance(instance_);
}

std::string XrConnection::runtime() const {
  auto found = xrStruct<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
  if (instance_ == XR_NULL_HANDLE || XR_FAILED(xrGetInstanceProperties(instance_, &found)))
    return "the runtime";
  return static_cast<char*>(found.runtimeName);
}

std::string XrConnection::whyNot() const {
  const std::string browser = "; a headset also shows the scene by its browser: vps watch SCENE --web 8080";
  if (result_ == XR_ERROR_RUNTIME_UNAVAILABLE)
    return "no OpenXR runtime is installed or chosen, so there is no headset here" + browser;
  if (result_ == XR_ERROR_EXTENSION_NOT_PRESENT)
    return "the OpenXR runtime does not support OpenGL (XR_KHR_opengl_enable)" + browser;
  if (XR_FAILED(result_)) return "the OpenXR runtime does not start; check that its service runs" + browser;
  if (system_ == XR_NULL_SYSTEM_ID) return runtime() + " (OpenXR) finds no headset; connect it" + browser;
  return "";
}

}  // namespace vps::viewer
