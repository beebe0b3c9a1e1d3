// SPDX-License-Identifier: BSD-3-Clause
// The render targets of a picture.
#pragma once

#include "draw/gl_objects.h"

namespace vps::viewer::inline v0 {

struct FrameTargets {
  int width, height;  ///< of the finished picture
  int factor;         ///< supersampling: the colour image is factor times as wide and high
  int samples;        ///< multisampling on top of it

  // Normal and depth of the visible surface, for ambient occlusion, at the size of the finished picture.
  gl::Texture geometry;
  gl::Renderbuffer geometry_depth;
  gl::Framebuffer geometry_target;
  gl::Texture occlusion_raw, occlusion;
  gl::Framebuffer occlusion_raw_target, occlusion_target;
  // Linear colour: multisampled with stencil, then resolved, then converted to sRGB.
  gl::Renderbuffer color, depth;
  gl::Framebuffer color_target;
  gl::Texture resolved;
  gl::Framebuffer resolved_target;
  gl::Renderbuffer shown;
  gl::Framebuffer shown_target;

  FrameTargets(int width, int height, int factor);
};

/// The render targets whose size does not depend on the picture's.
struct ShadowTargets {
  static constexpr int kKeySize = 2048, kFloorSize = 256;
  gl::Texture key;  ///< depth map of the key light, with comparison on lookup
  gl::Framebuffer key_target;
  gl::Texture floor_a, floor_b;
  gl::Renderbuffer floor_depth;
  gl::Framebuffer floor_a_target, floor_b_target;
  ShadowTargets();
};

}  // namespace vps::viewer::inline v0
