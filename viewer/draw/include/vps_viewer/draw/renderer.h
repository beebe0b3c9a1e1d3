// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a Snapshot by OpenGL 4.5 without a display, through EGL on Mesa's surfaceless platform.
//
// The scene is lit by a key light, a fill light, a rim light and a sky, with ambient occlusion and a soft
// shadow on an invisible floor. Sharp edges are thin dark lines. The part in hand is blue; its target is
// transparent in the same blue. Light is summed in linear colour and converted to sRGB. The same input gives
// the same bits on one machine; other CPUs round a few pixels differently by 1/255, so compare images with a
// tolerance.
#pragma once

#include <memory>
#include <string>

#include "vps_scenes/run/snapshot.h"
#include "vps_viewer/draw/camera.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/draw/render_scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Owns an OpenGL context and a scene's buffers. Use a renderer on the thread that made it; several may exist
/// at once.
class VPS_VIEWER_API Renderer {
 public:
  /// Uploads the meshes; faces that meet at more than 28 degrees get separate normals. Throws
  /// std::runtime_error, which names the packages to install, when EGL or OpenGL 4.5 is missing.
  explicit Renderer(const RenderScene& scene);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws one picture. Half a million triangles at 1280x720 take 0.34 s of processor time with llvmpipe.
  /// Throws std::runtime_error, with a remedy, if OpenGL is out of memory or the graphics card was reset;
  /// afterwards only a new Renderer can draw.
  Image render(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options = {});

  /// Whether the whole last picture was drawn: false for a draft in which only parts and marks moved.
  [[nodiscard]] bool drewWhole() const;

  /// The driver and its settings: "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5, 4 samples".
  [[nodiscard]] std::string description() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace vps::viewer
