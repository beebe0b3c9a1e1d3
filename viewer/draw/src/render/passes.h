// SPDX-License-Identifier: BSD-3-Clause
// The passes that make up a picture, in the order in which the renderer runs them.
//
// Each pass expects depth test on and blending, clipping and stencil off, and leaves them so.
#pragma once

#include <optional>
#include <vector>

#include "marks/marks.h"
#include "render/gpu_resources.h"
#include "render/view.h"
#include "vps_viewer/draw/image.h"

namespace vps::viewer {

/// The input of all passes of one picture.
struct Picture {
  const GpuResources& gl;
  const View& view;
  const DrawOptions& options;
  const std::vector<DrawnBody>& bodies;
  PixelRect region;  ///< the part of the finished picture that is drawn
  PixelRect parts;   ///< the part of `region` that parts or marks can cover; the background fills the rest
};

// shadow_pass.cpp
/// The depth map of the key light.
void renderKeyShadow(const Picture& picture);
/// A blurred map of the height of the nearest part above each place of the floor.
void renderFloorShadow(const Picture& picture);
/// Lays the floor's shadow on the background.
void drawFloorShadow(const Picture& picture);

// occlusion_pass.cpp
/// Normal and depth of every pixel, for renderOcclusion().
void renderGeometry(const Picture& picture);
/// The share of the light of the sky and of the key light that reaches each pixel.
void renderOcclusion(const Picture& picture);
/// Replaces renderOcclusion() in drafts: all light reaches every pixel.
void lightEverything(const Picture& picture);

// color_pass.cpp
/// The background and the floor's shadow, over which everything else is blended.
void renderBehind(const Picture& picture);
/// The colour image: parts, cut faces, edges, marks, target.
/// @param target the part at its target pose; null: none
void renderColor(const Picture& picture, const MarkList& marks, const DrawnBody* target);
/// Averages the samples, converts to sRGB and reads the region into `image`, which has the picture's size.
void resolvePicture(const Picture& picture, Image& image);
/// Draws the square of DrawOptions::show_flash and reads it back.
void drawFlash(const GpuResources& gl, bool is_lit, Image& image);

// Functions that several passes use.
// mesh_drawing.cpp
/// @param is_shaded whether the program takes a colour
/// @param detail    null: as many triangles as the view can show
void drawMeshes(const gl::Program& program, const std::vector<DrawnBody>& bodies, const View& view,
                const Eigen::Matrix4f& projection, bool is_shaded,
                std::optional<Detail> detail = std::nullopt);
// section_caps.cpp
/// The cut faces of all parts that the section passes through.
void drawCaps(const gl::Program& program, const Picture& picture);
// edge_lines.cpp
/// Sharp edges, outlines and the lines of the section.
void drawEdges(const Picture& picture);
void drawLines(const GpuLines& lines, const DrawnBody& body, const Picture& picture, float width_px,
               const Eigen::Vector4f& color);

}  // namespace vps::viewer
