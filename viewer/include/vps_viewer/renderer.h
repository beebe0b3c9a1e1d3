// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a Snapshot by OpenGL 4.5, without a display: EGL on Mesa's surfaceless platform.
//
// The look: studio light (key, fill, rim and sky), ambient occlusion, a soft shadow on an invisible floor,
// thin dark lines on sharp edges. The part in hand is blue, its target a ghost of the same blue. Light is
// added up in linear colour and shown in sRGB. The same input gives the same bits on one machine; different
// CPUs round a few pixels differently by 1/255, so compare images with a tolerance.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/scene.h"
#include "vps_scenes/snapshot.h"
#include "vps_viewer/camera.h"
#include "vps_viewer/export.h"
#include "vps_viewer/image.h"

namespace vps::viewer {

/// One thing that can be drawn; BodySnapshot::part counts these.
struct DrawnMesh {
  const Mesh* mesh = nullptr;  ///< must live as long as the constructor of Renderer runs
  std::array<float, 3> color = {0.7f, 0.72f, 0.75f};  ///< linear RGB
  bool is_fixed = false;                              ///< drawn where X_WP says, whatever the snapshot lists
  Pose X_WP = {};
};
using RenderScene = std::vector<DrawnMesh>;

/// What there is to draw of a scene: its parts, in order. Parts that bring no colour of their own get one
/// each from a muted palette, so that neighbours can be told apart.
VPS_VIEWER_API RenderScene drawnMeshes(const scenes::Scene& scene);

/// A section: what lies beyond the plane, on the side n_W points to, is cut away.
struct CutPlane {
  Vec3 p_W = Vec3::Zero();
  Vec3 n_W = Vec3::UnitY();
  bool cuts_hand = false;  ///< drawing practice: the inserted part (shaft, pin, screw) stays whole
};

struct DrawOptions {
  int width = 1280, height = 960;
  bool show_waiting = false;  ///< parts not yet in the procedure
  bool show_target = true;
  bool show_contacts = true;
  bool show_force = true;
  bool show_edges = true;
  bool show_ground = true;
  bool show_hidden_marks = true;  ///< contacts and force shine faintly through the material
  bool highlight_hand = true;     ///< the part in hand in the accent colour instead of its own
  bool show_legend = true;
  std::optional<CutPlane> cut;
  std::string title;                    ///< first line, top left; UTF-8
  std::string caption;                  ///< smaller lines under it; '\n' starts a new one
  double contact_full_scale_m = 20e-6;  ///< depth at the red end of the colour scale
  double force_full_scale_N = 15;       ///< force whose arrow is a sixth of the picture's size
  int supersampling = 2;                ///< 1 quick, 2 for print: each pixel is 2x2, on top of multisampling
};

/// Bounds of all that the snapshot shows, in W. With show_waiting, of waiting parts too.
VPS_VIEWER_API Box snapshotBounds(const RenderScene& scene, const scenes::Snapshot& snapshot,
                                  bool show_waiting = false);

/// The section through p_W that shows a motion along d_W to a viewer in the given direction: it contains d_W,
/// faces the viewer, and lies along two of W's axes where d_W does along one, as sections are drawn.
VPS_VIEWER_API CutPlane sectionAlong(const Vec3& p_W, const Vec3& d_W, const Vec3& to_viewer_W);

/// Holds an OpenGL context and a scene's buffers. Use it on the thread that made it; several may live side by
/// side.
class VPS_VIEWER_API Renderer {
 public:
  /// Uploads the meshes: smooth normals are split where faces meet at more than 28 degrees. Throws
  /// std::runtime_error in words a user can act on when EGL or OpenGL 4.5 is missing.
  explicit Renderer(const RenderScene& scene);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// One picture. Half a million triangles take about a second on two cores of llvmpipe at 1280x960.
  Image render(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options = {});

  /// "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5, 4 samples".
  [[nodiscard]] std::string description() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace vps::viewer
