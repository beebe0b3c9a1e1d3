// SPDX-License-Identifier: BSD-3-Clause
// The passes that make up a picture, in the order in which the renderer runs them.
//
// Each pass expects depth test on and blending, clipping and stencil off, and leaves them so.
#pragma once

#include <optional>
#include <vector>

#include "draw/gpu_resources.h"
#include "draw/view.h"

namespace vps::viewer::inline v0 {

/// What the passes of one picture read.
struct Picture {
  const GpuResources& gl;
  const View& view;
  const DrawOptions& options;
  const std::vector<DrawnBody>& bodies;
};

// shadow_pass.cpp
/// The depth map of the key light.
void renderKeyShadow(const Picture& picture);
/// How close the nearest part above each place of the floor is, blurred.
void renderFloorShadow(const Picture& picture);
/// Lays the floor's shadow under the picture.
void drawFloorShadow(const Picture& picture);

// occlusion_pass.cpp
/// Normal and depth of every pixel, for renderOcclusion().
void renderGeometry(const Picture& picture);
/// How much light of the sky and of the key light reaches every pixel.
void renderOcclusion(const Picture& picture);
/// Instead of renderOcclusion(): all light reaches every pixel.
void lightEverything(const Picture& picture);

// color_pass.cpp
/// The colour image: background, parts, cut faces, edges, marks, target.
/// @param target the part at its target pose; null: none
void renderColor(const Picture& picture, const scenes::Snapshot& snapshot, const DrawnBody* target);
/// Averages the samples, converts to sRGB and reads the picture back.
/// @param flash  DrawOptions::show_flash: whether something touches; none: no square
Image resolvePicture(const GpuResources& gl, std::optional<bool> flash);

// What several passes use.
// mesh_drawing.cpp
/// @param is_shaded whether the program takes a colour
/// @param is_shadow large scenes have fewer triangles (Detail::Shadow)
void drawMeshes(const gl::Program& program, const std::vector<DrawnBody>& bodies, const View& view,
                const Eigen::Matrix4f& projection, bool is_shaded, bool is_shadow = false);
// section_caps.cpp
/// The cut faces of all parts that the section passes through.
void drawCaps(const gl::Program& program, const Picture& picture);
// edge_lines.cpp
/// Sharp edges, outlines and the lines of the section.
void drawEdges(const Picture& picture);
void drawLines(const GpuLines& lines, const DrawnBody& body, const Picture& picture, float width_px,
               const Eigen::Vector4f& color);

}  // namespace vps::viewer::inline v0
