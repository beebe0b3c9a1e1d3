// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL objects of one renderer: shaders, render targets, meshes, marks. The context must be current
// wherever one is made, used or destroyed.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "gl/frame_targets.h"
#include "gl/scene_buffers.h"
#include "gl/shaders.h"
#include "marks/marks.h"

namespace vps::viewer {

/// The blur of the floor's shadow [texels of its texture].
struct FloorBlur {
  static constexpr double kTexels =
      ShadowTargets::kFloorSize / (2 * ShadowTargets::kFloorRadii);  // texels per radius of the scene
  static constexpr double kNarrow = 0.035 * kTexels, kWide = 0.16 * kTexels;  // standard deviations
  static constexpr int kRadius_texel = static_cast<int>(kTexels + 1);
  static constexpr int kReach_texel = static_cast<int>(2.5 * kWide + 1);
  /// GLSL constants for kFloorBlurFragment.
  static std::string constants();
};

struct ShaderPrograms {
  gl::Program mesh{"mesh", glsl::kMeshVertex, std::string(glsl::kStudio) + glsl::kMeshFragment};
  gl::Program ghost{"ghost", glsl::kMeshVertex, glsl::kGhostFragment};
  gl::Program depth{"depth", glsl::kMeshVertex, glsl::kEmptyFragment};
  gl::Program geometry{"geometry", glsl::kMeshVertex, glsl::kGeometryFragment};
  gl::Program cap{"cap", glsl::kCapVertex, std::string(glsl::kStudio) + glsl::kCapFragment};
  gl::Program cap_geometry{"cap geometry", glsl::kCapVertex, glsl::kGeometryFragment};
  gl::Program occlusion{"occlusion", glsl::kFullScreenVertex, glsl::kOcclusionFragment};
  gl::Program occlusion_blur{"occlusion blur", glsl::kFullScreenVertex, glsl::kOcclusionBlurFragment};
  gl::Program floor{"floor", glsl::kMeshVertex, glsl::kFloorFragment};
  gl::Program floor_blur{"floor blur", glsl::kFullScreenVertex,
                         FloorBlur::constants() + glsl::kFloorBlurFragment};
  gl::Program floor_shadow{"floor shadow", glsl::kCapVertex, glsl::kFloorShadowFragment};
  gl::Program background{"background", glsl::kFullScreenVertex, glsl::kBackgroundFragment};
  gl::Program line{"line", glsl::kLineVertex, glsl::kFlatFragment};
  gl::Program mark{"mark", glsl::kMarkVertex, glsl::kMarkFragment};
};

struct GpuResources {
  ShaderPrograms programs;
  ShadowTargets shadows;
  FrameTargets* frame = nullptr;                           ///< targets of the current picture
  std::map<const Mesh*, std::unique_ptr<GpuMesh>> meshes;  ///< equal parts share a GpuMesh
  MarkShape arrow = MarkShape::arrow(), disc = MarkShape::disc();
  gl::Buffer quad_corners;
  gl::VertexArray quad = gl::makeVertexArray(), empty = gl::makeVertexArray();

  GpuResources();
  /// Makes `frame` have the given size. Drafts have targets of their own, which keep the last draft.
  /// @return whether the targets are new and hold no picture yet
  bool resizeFrame(int width, int height, int factor, bool is_draft);
  /// The program of kFinalFragment for `frame`.
  /// @param has_parts  false: the picture shows the background only
  [[nodiscard]] const gl::Program& finalProgram(bool has_parts) const {
    return has_parts ? final_.at(frame->factor) : final_background_;
  }
  /// Runs a program that uses kFullScreenVertex on every pixel.
  void drawFullScreen(const gl::Program& program) const;
  /// Runs a program that uses kCapVertex: one square in a plane.
  void drawSquare(const gl::Program& program) const;

 private:
  std::unique_ptr<FrameTargets> full_, draft_;
  std::map<int, gl::Program> final_;  ///< by FrameTargets::factor
  gl::Program final_background_;
};

}  // namespace vps::viewer
