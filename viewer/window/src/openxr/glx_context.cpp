// SPDX-License-Identifier: BSD-3-Clause
#include "openxr/glx_context.h"

#include <stdexcept>

namespace vps::viewer {
namespace {

[[noreturn]] void fail(Display* display, const std::string& what) {
  if (display != nullptr) XCloseDisplay(display);
  throw std::runtime_error("a headset needs " + what);
}

/// Xlib's own handler of errors ends the process.
class QuietErrors {
 public:
  explicit QuietErrors(Display* display) : display_(display) {}
  ~QuietErrors() {
    XSync(display_, 0);
    XSetErrorHandler(before_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  Display* display_;
  XErrorHandler before_ = XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
};

}  // namespace

GlxContext::GlxContext() : display_(XOpenDisplay(nullptr)) {
  // A connection of its own, so that no other thread uses it.
  if (display_ == nullptr) fail(nullptr, "an X display (DISPLAY; under Wayland that of XWayland)");
  const int screen = DefaultScreen(display_);
  if (epoxy_glx_version(display_, screen) < 13 ||
      !epoxy_has_glx_extension(display_, screen, "GLX_ARB_create_context_profile"))
    fail(display_, "GLX 1.3 with OpenGL 3.3 on its X display (Debian: libgl1-mesa-dri)");
  const int wanted[] = {GLX_DRAWABLE_TYPE,
                        GLX_PBUFFER_BIT | GLX_WINDOW_BIT,
                        GLX_RENDER_TYPE,
                        GLX_RGBA_BIT,
                        GLX_RED_SIZE,
                        8,
                        GLX_GREEN_SIZE,
                        8,
                        GLX_BLUE_SIZE,
                        8,
                        0};
  int count = 0;
  GLXFBConfig* configs = glXChooseFBConfig(display_, screen, wanted, &count);
  if (configs == nullptr || count == 0) fail(display_, "a GLX visual of 8 bits a colour");
  config_ = configs[0];
  XFree(configs);
  if (XVisualInfo* visual = glXGetVisualFromFBConfig(display_, config_); visual != nullptr) {
    visual_ = static_cast<unsigned>(visual->visualid);
    XFree(visual);
  }
  const int version[] = {
      GLX_CONTEXT_MAJOR_VERSION_ARB,    3, GLX_CONTEXT_MINOR_VERSION_ARB, 3, GLX_CONTEXT_PROFILE_MASK_ARB,
      GLX_CONTEXT_CORE_PROFILE_BIT_ARB, 0};
  const int size[] = {GLX_PBUFFER_WIDTH, 1, GLX_PBUFFER_HEIGHT, 1, 0};
  {
    const QuietErrors quiet(display_);
    context_ = glXCreateContextAttribsARB(display_, config_, nullptr, 1, version);
    surface_ = glXCreatePbuffer(display_, config_, size);
  }
  if (context_ == nullptr) fail(display_, "OpenGL 3.3 on its X display (Debian: libgl1-mesa-dri)");
}

GlxContext::~GlxContext() {
  release();
  glXDestroyPbuffer(display_, surface_);
  glXDestroyContext(display_, context_);
  XCloseDisplay(display_);
}

void GlxContext::makeCurrent() const {
  if (!glXMakeContextCurrent(display_, surface_, surface_, context_))
    throw std::runtime_error("the headset's OpenGL context cannot be used");
}

void GlxContext::release() const {
  glXMakeContextCurrent(display_, 0, 0, nullptr);
}

XrGraphicsBindingOpenGLXlibKHR GlxContext::binding() const {
  auto made = xrStruct<XrGraphicsBindingOpenGLXlibKHR>(XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
  made.xDisplay = display_;
  made.visualid = visual_;
  made.glxFBConfig = config_;
  made.glxDrawable = surface_;
  made.glxContext = context_;
  return made;
}

}  // namespace vps::viewer
