// SPDX-License-Identifier: BSD-3-Clause
// An OpenGL context on the X display that no window shows: runtimes of OpenXR take pictures from such.
#pragma once

#include "openxr/xr_calls.h"

namespace vps::viewer {

class GlxContext {
 public:
  /// Throws std::runtime_error, which says what is missing: an X display, or GLX with OpenGL 3.3.
  GlxContext();
  ~GlxContext();
  GlxContext(const GlxContext&) = delete;
  GlxContext& operator=(const GlxContext&) = delete;

  /// On this thread. While a Renderer draws on it, no context of GLX may be current.
  void makeCurrent() const;
  void release() const;
  [[nodiscard]] XrGraphicsBindingOpenGLXlibKHR binding() const;

 private:
  Display* display_ = nullptr;
  GLXFBConfig config_ = nullptr;
  GLXContext context_ = nullptr;
  GLXPbuffer surface_ = 0;
  unsigned visual_ = 0;
};

}  // namespace vps::viewer
