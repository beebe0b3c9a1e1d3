// SPDX-License-Identifier: BSD-3-Clause
// The contents of a picture: meshes, sections, and the options of drawing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// One mesh that can be drawn; BodySnapshot::part is an index into the list of these meshes.
struct DrawnMesh {
  const Mesh* mesh = nullptr;  ///< must live as long as the constructor of Renderer runs
  std::array<float, 3> color = {0.7f, 0.72f, 0.75f};  ///< linear RGB
  bool is_fixed = false;                              ///< drawn at X_WP even if the snapshot does not list it
  Pose X_WP = {};
  /// Linear RGB by vertex, multiplied with `color`; null: white. Must live as long as the mesh.
  const std::vector<std::array<float, 3>>* vertex_colors = nullptr;
  /// Colours of the faces, used in place of `color` while the part is not in hand; null or empty: no face has
  /// a colour of its own. Must live as long as the mesh.
  const scenes::FaceColors* face_colors = nullptr;
};
using RenderScene = std::vector<DrawnMesh>;

/// The parts of a scene, in order. Parts without a colour of their own get one from a muted palette, so that
/// neighbours can be distinguished.
VPS_VIEWER_API RenderScene drawnMeshes(const scenes::Scene& scene);

/// A section: the half space that n_W points into is cut away.
struct CutPlane {
  Vec3 p_W = Vec3::Zero();
  Vec3 n_W = Vec3::UnitY();
  /// False as in technical drawings: the inserted part (shaft, pin, screw) stays whole
  bool cuts_hand = false;

  bool operator==(const CutPlane&) const = default;
};

/// Approximate greatest number of triangles in a draft. Measured with llvmpipe, 491,520 triangles and a draft
/// of a third of 1280 x 720: 33 ms of processor time with 40,000, 60 ms with 100,000.
inline constexpr std::size_t kDraftTriangles = 40000;

struct DrawOptions {
  int width = 1280, height = 960;  ///< see pictureLength_px()
  bool show_waiting = false;       ///< parts whose step has not begun
  bool show_target = true;
  bool show_contacts = true;
  bool show_force = true;
  bool show_edges = true;
  bool show_ground = true;
  bool show_hidden_marks = true;  ///< hidden contacts and forces are faintly visible through the parts
  bool is_dark = false;           ///< the background
  bool highlight_hand = true;     ///< the part in hand is blue instead of its own colour
  bool show_legend = true;
  /// Draws a square in the lower left corner, white during contact and black otherwise, for a light sensor
  /// that measures the latency of pictures.
  bool show_flash = false;
  std::optional<CutPlane> cut;
  std::string title;                    ///< first line, top left; UTF-8
  std::string caption;                  ///< smaller lines under the title, separated by '\n'
  double contact_full_scale_m = 20e-6;  ///< contact depth at the red end of the colour scale
  double force_full_scale_N = 15;       ///< force whose arrow has a sixth of the picture's size
  /// Samples per pixel in each direction, in addition to multisampling: 1 fast, 2 for print.
  int supersampling = 2;
  /// For a moving view: no shadows, ambient occlusion or outlines, and coarser meshes in scenes of more than
  /// kDraftTriangles. If only parts and marks moved since the last draft, only the rectangle around them is
  /// drawn again, with the same bits.
  bool is_draft = false;

  bool operator==(const DrawOptions&) const = default;
};

/// Greatest width and height of a picture. pictureLength_px() clamps a size to the range from 1 to this
/// value.
inline constexpr int kGreatestPicture_px = 8192;
[[nodiscard]] constexpr int pictureLength_px(int wanted) {
  return std::clamp(wanted, 1, kGreatestPicture_px);
}

/// Edge of the square of DrawOptions::show_flash [px].
[[nodiscard]] constexpr int flashSize_px(int height) {
  return std::max(4, height / 18);
}

/// The box in W around everything that the snapshot shows. With show_waiting the box includes waiting parts.
VPS_VIEWER_API Box snapshotBounds(const RenderScene& scene, const scenes::Snapshot& snapshot,
                                  bool show_waiting = false);

/// The section through p_W that shows a motion along d_W to a viewer in the given direction: it contains d_W
/// and faces the viewer. If d_W is along an axis of W, the plane is spanned by two axes, as in technical
/// drawings.
VPS_VIEWER_API CutPlane sectionAlong(const Vec3& p_W, const Vec3& d_W, const Vec3& to_viewer_W);

}  // namespace vps::viewer
