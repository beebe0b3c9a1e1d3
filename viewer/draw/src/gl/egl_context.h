// SPDX-License-Identifier: BSD-3-Clause
// An OpenGL 4.5 core context without a window or display.
#pragma once

#include <string>

namespace vps::viewer {

class EglContext {
 public:
  /// Throws std::runtime_error, which names the packages to install, when no context can be made. The context
  /// is not current afterwards.
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes the context current on this thread. The destructor restores the context that was current before,
  /// so that a program with windows can use a renderer.
  class Current {
   public:
    explicit Current(const EglContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    void* display_;
    void *previous_display_, *previous_draw_, *previous_read_, *previous_context_;
  };

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace vps::viewer
