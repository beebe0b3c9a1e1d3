// SPDX-License-Identifier: BSD-3-Clause
#include "gl/egl_context.h"

#include <epoxy/egl.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace vps::viewer {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(
      "no picture can be made: " + what +
      "; Mesa draws without a GPU or display (Debian: apt install libegl1 libgl1-mesa-dri)");
}

EGLDisplay openDisplay() {
  // Without the library, every other function of epoxy ends the program.
  if (!epoxy_has_egl()) fail("libEGL.so.1 is not installed");

  // The default display requires an X server or Wayland; the surfaceless platform requires neither.
  EGLDisplay display = EGL_NO_DISPLAY;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
    display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
      fail("EGL offers neither the surfaceless platform nor a display");
  }
  return display;
}

}  // namespace

EglContext::EglContext() : display_(openDisplay()) {
  if (!eglBindAPI(EGL_OPENGL_API)) fail("EGL offers no desktop OpenGL");
  const EGLint config_wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                  EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display_, config_wanted, &config, 1, &count) || count == 0)
    config = nullptr;  // EGL_KHR_no_config_context suffices, since framebuffer objects are drawn into
  // A robust context reports a reset of the graphics card; with other contexts a reset may end the program.
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                           4,
                           EGL_CONTEXT_MINOR_VERSION,
                           5,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR,
                           EGL_LOSE_CONTEXT_ON_RESET_KHR,
                           EGL_NONE};
  // The attributes without the last two, for drivers without robust contexts.
  std::array<EGLint, 7> plain = {};
  std::copy_n(wanted, plain.size() - 1, plain.begin());
  plain.back() = EGL_NONE;
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, wanted);
  if (context_ == EGL_NO_CONTEXT) context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, plain.data());
  if (context_ == EGL_NO_CONTEXT) fail("the driver has no OpenGL 4.5 core profile");
}

// The display stays open, because other code of the process may use it.
EglContext::~EglContext() {
  eglDestroyContext(display_, context_);
}

EglContext::Current::Current(const EglContext& context)
    : display_(context.display_),
      previous_display_(eglGetCurrentDisplay()),
      previous_draw_(eglGetCurrentSurface(EGL_DRAW)),
      previous_read_(eglGetCurrentSurface(EGL_READ)),
      previous_context_(eglGetCurrentContext()) {
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_))
    fail("the OpenGL context cannot be made current (is it in use on another thread?)");
}

EglContext::Current::~Current() {
  if (previous_context_ != EGL_NO_CONTEXT)
    eglMakeCurrent(previous_display_, previous_draw_, previous_read_, previous_context_);
  else
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace vps::viewer
