// SPDX-License-Identifier: BSD-3-Clause
// The render targets of a picture.
#pragma once

#include "gl/gl_objects.h"

namespace vps::viewer {

struct FrameTargets {
  int width, height;  ///< size of the finished picture [px]
  int factor;         ///< supersampling: the colour image is factor times as wide and high
  int samples;        ///< samples of multisampling, in addition to supersampling

  // Normal and depth of the visible surface, for ambient occlusion, at the size of the finished picture. A
  // draft has no ambient occlusion, so geometry and occlusion of a draft have one pixel.
  gl::Texture geometry;
  gl::Renderbuffer geometry_depth;
  gl::Framebuffer geometry_target;
  gl::Texture occlusion_raw, occlusion;
  gl::Framebuffer occlusion_raw_target, occlusion_target;
  // Background and the shadow on the floor, in linear colour. Background and shadow are smooth, so one sample
  // a pixel is enough.
  gl::Texture behind;
  gl::Framebuffer behind_target;
  // Linear colour and opacity of parts, edges and marks, multisampled, with stencil. The colours are later
  // blended over `behind` and converted to sRGB.
  gl::Texture color;
  gl::Renderbuffer depth;
  gl::Framebuffer color_target;
  gl::Renderbuffer shown;
  gl::Framebuffer shown_target;

  FrameTargets(int width, int height, int factor, bool is_draft);
};

/// The render targets whose size does not depend on the size of the picture.
struct ShadowTargets {
  static constexpr int kKeySize = 2048, kFloorSize = 256;
  static constexpr double kFloorRadii = 3;  ///< half the width of the floor's texture, in radii of the scene
  gl::Texture key;                          ///< depth map of the key light, with comparison on lookup
  gl::Framebuffer key_target;
  gl::Texture floor_a, floor_b;
  gl::Renderbuffer floor_depth;
  gl::Framebuffer floor_a_target, floor_b_target;
  ShadowTargets();
};

}  // namespace vps::viewer
