// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/renderer.h"

#include <algorithm>
#include <exception>

#include "draw/egl_context.h"
#include "draw/overlay.h"
#include "draw/passes.h"
#include "draw/visible_parts.h"

namespace vps::viewer::inline v0 {
namespace {

using Eigen::Vector3f;

const Vector3f kHandColor(0.028f, 0.21f, 0.74f);  // blue: the warm depth colours of contacts stand out on it

}  // namespace

struct Renderer::Impl {
  EglContext context;
  std::unique_ptr<GpuResources> gl;  // made and destroyed while the context is current
  std::vector<const GpuMesh*> part_meshes;
  std::vector<Vector3f> part_colors;
  std::vector<PartExtent> parts;
  Lettering lettering;
  std::string description;

  explicit Impl(const RenderScene& scene) : parts(partExtents(scene)) {
    const EglContext::Current current(context);
    try {
      upload(scene);
      gl::requireSound();
    } catch (...) {
      gl.reset();  // while the context is current
      throw;
    }
  }
  ~Impl() {
    try {
      const EglContext::Current current(context);
      gl.reset();
    } catch (const std::exception&) {
      static_cast<void>(gl.release());  // a lost context; its objects went with it
    }
  }

  void upload(const RenderScene& scene) {
    gl = std::make_unique<GpuResources>();
    std::size_t triangles = 0;
    for (const DrawnMesh& part : scene) triangles += part.mesh->triangles.size();
    for (const DrawnMesh& part : scene) {
      std::unique_ptr<GpuMesh>& mesh = gl->meshes[part.mesh];
      if (!mesh) mesh = std::make_unique<GpuMesh>(*part.mesh, part.vertex_colors, triangles);
      part_meshes.push_back(mesh.get());
      part_colors.emplace_back(Eigen::Map<const Vector3f>(part.color.data()));
    }
    description = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", OpenGL " +
                  reinterpret_cast<const char*>(glGetString(GL_VERSION));
  }

  DrawnBody bodyAt(std::size_t part, const Pose& X_WP, const View& view) const {
    DrawnBody body;
    body.mesh = part_meshes[part];
    body.part = part;
    body.X_CP = view.X_CW * X_WP * Pose::translation(body.mesh->shading.center);
    return body;
  }

  std::vector<DrawnBody> listBodies(const scenes::Snapshot& snapshot, const View& view,
                                    const DrawOptions& options) const {
    std::vector<DrawnBody> bodies;
    forEachVisiblePart(parts, snapshot, options.show_waiting,
                       [&](std::size_t part, const Pose& X_WP, scenes::BodyRole role) {
                         const bool is_in_hand = role == scenes::BodyRole::InHand;
                         DrawnBody body = bodyAt(part, X_WP, view);
                         body.color = is_in_hand && options.highlight_hand ? kHandColor : part_colors[part];
                         body.detail = options.is_draft ? Detail::Draft : Detail::Full;
                         body.is_cut = options.cut && (!is_in_hand || options.cut->cuts_hand);
                         bodies.push_back(body);
                       });
    return bodies;
  }

  std::optional<DrawnBody> targetOf(const scenes::Snapshot& snapshot, const View& view,
                                    const DrawOptions& options) const {
    if (!options.show_target || !snapshot.has_target || snapshot.target_part >= parts.size() ||
        !snapshot.X_WP_target.isFinite())
      return std::nullopt;
    DrawnBody target = bodyAt(snapshot.target_part, snapshot.X_WP_target, view);
    target.color = kHandColor;
    target.detail = options.is_draft ? Detail::Draft : Detail::Full;
    target.is_cut = options.cut && options.cut->cuts_hand;
    return target;
  }
};

Renderer::Renderer(const RenderScene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
std::string Renderer::description() const {
  return impl_->description;
}

Image Renderer::render(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options) {
  Impl& impl = *impl_;
  const EglContext::Current current(impl.context);
  DrawOptions clamped = options;
  clamped.width = pictureLength_px(options.width);
  clamped.height = pictureLength_px(options.height);
  impl.gl->resizeFrame(clamped.width, clamped.height, std::clamp(options.supersampling, 1, 4));

  glEnable(GL_DEPTH_TEST);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glClearStencil(0);
  const View view = makeView(visibleBounds(impl.parts, snapshot, clamped.show_waiting, clamped.show_target),
                             camera, clamped);
  const std::vector<DrawnBody> bodies = impl.listBodies(snapshot, view, clamped);
  const std::optional<DrawnBody> target = impl.targetOf(snapshot, view, clamped);
  const Picture picture = {*impl.gl, view, clamped, bodies};
  if (clamped.is_draft) {
    lightEverything(picture);
  } else {
    renderKeyShadow(picture);
    if (clamped.show_ground) renderFloorShadow(picture);
    renderGeometry(picture);
    renderOcclusion(picture);
  }
  renderColor(picture, snapshot, target ? &*target : nullptr);
  Image image = resolvePicture(
      *impl.gl, options.show_flash ? std::optional(totalForce_N(snapshot.contacts) > 0) : std::nullopt);
  gl::requireSound();
  drawOverlay(image, snapshot, options, {kHandColor, kHandColor}, impl.lettering);
  return image;
}

}  // namespace vps::viewer::inline v0
