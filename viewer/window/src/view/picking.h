// SPDX-License-Identifier: BSD-3-Clause
// Pixels of the picture, the ray through a pixel, and the part under the cursor.
#pragma once

#include <array>
#include <optional>

#include "vps_viewer/draw/camera.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// Size of the picture in pixels.
struct PictureSize {
  int width = 1280, height = 720;
  bool operator==(const PictureSize&) const = default;
};

/// A place in the picture in pixels: x right, y down.
using PixelPlace = std::array<double, 2>;

/// A ray from the eye; its direction is a unit vector.
struct Ray {
  Vec3 p_W = Vec3::Zero();
  Vec3 d_W = -Vec3::UnitZ();
};
/// The ray from the eye through a place of the picture.
[[nodiscard]] VPS_VIEWER_API Ray rayThrough(const Camera& camera, const PixelPlace& at, PictureSize size);

struct PickedPlace {
  std::size_t part = 0;  ///< index into the RenderScene
  Vec3 p_W = Vec3::Zero();
  double distance_m = 0;  ///< distance from the eye
};

/// The first visible surface on the ray: of a part that the options show, or the section's cut face. Material
/// that the section cuts away is skipped. O(triangles of the parts whose boxes the ray meets).
[[nodiscard]] VPS_VIEWER_API std::optional<PickedPlace> pick(const RenderScene& scene,
                                                             const scenes::Snapshot& snapshot,
                                                             const DrawOptions& options, const Ray& ray);

}  // namespace vps::viewer
