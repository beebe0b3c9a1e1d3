// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/renderer.h"

#include <algorithm>
#include <exception>

#include "gl/egl_context.h"
#include "marks/overlay.h"
#include "mesh/scene_meshes.h"
#include "render/last_draft.h"
#include "render/passes.h"
#include "vps/stoppable.h"

namespace vps::viewer {
namespace {

using Eigen::Vector3f;

const Vector3f kHandColor(0.028f, 0.21f,
                          0.74f);  // blue, on which the warm depth colours of contacts are clearly visible

}  // namespace

struct Renderer::Impl {
  EglContext context;
  std::unique_ptr<GpuResources> gl;  // made and destroyed while the context is current
  std::vector<const GpuMesh*> part_meshes;
  std::vector<Vector3f> part_colors;
  std::vector<PartExtent> parts;
  Lettering lettering;
  std::string description;
  std::optional<LastDraft> last_draft;  ///< empty: the whole next draft is drawn
  bool drew_whole = false;

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
      static_cast<void>(gl.release());  // the context was lost, and its objects with it
    }
  }

  void upload(const RenderScene& scene) {
    gl = std::make_unique<GpuResources>();
    std::size_t triangles = 0;
    for (const DrawnMesh& part : scene) triangles += part.mesh->triangles.size();
    for (const DrawnMesh& part : scene) {
      pollStop();
      std::unique_ptr<GpuMesh>& mesh = gl->meshes[part.mesh];
      if (!mesh) mesh = std::make_unique<GpuMesh>(part, triangles);
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
                         const bool is_blue = is_in_hand && options.highlight_hand;
                         body.color = is_blue ? kHandColor : part_colors[part];
                         body.shows_faces = !is_blue && body.mesh->has_face_colors;
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

  Image drawInFull(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options);
  /// Draws only the changes since the last draft; all pixels equal those of a draft of the whole picture.
  Image drawDraft(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options);
};

Renderer::Renderer(const RenderScene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
std::string Renderer::description() const {
  return impl_->description;
}

namespace {

/// The options that determine the pixels of a draft; options of the overlay are reset.
DrawOptions withoutOverlay(DrawOptions options) {
  options.title.clear();
  options.caption.clear();
  options.show_legend = options.show_flash = false;
  return options;
}

/// The rectangle that parts and marks can cover. On llvmpipe the pixels outside the rectangle would cost as
/// much time as those inside it.
PixelRect partsOnScreen(const std::vector<DrawnBody>& bodies, const DrawnBody* target, const MarkList& marks,
                        const View& view, const DrawOptions& options) {
  PixelRect rect;
  const auto add = [&](const DrawnBody& body) {
    rect = join(rect, boxOnScreen(body, view, options.width, options.height, lineMargin_px(options.height)));
  };
  for (const DrawnBody& body : bodies) add(body);
  if (target != nullptr) add(*target);
  for (const std::vector<Mark>* list : {&marks.discs, &marks.arrows})
    for (const Mark& mark : *list) rect = join(rect, markOnScreen(mark, view, options.width, options.height));
  return rect;
}

}  // namespace

Image Renderer::render(const scenes::Snapshot& snapshot, const Camera& camera, const DrawOptions& options) {
  Impl& impl = *impl_;
  const EglContext::Current current(impl.context);
  DrawOptions clamped = options;
  clamped.width = pictureLength_px(options.width);
  clamped.height = pictureLength_px(options.height);
  if (impl.gl->resizeFrame(clamped.width, clamped.height, std::clamp(options.supersampling, 1, 4),
                           clamped.is_draft) &&
      clamped.is_draft)
    impl.last_draft.reset();

  glEnable(GL_DEPTH_TEST);
  // Opacities are accumulated as for layers, because the picture is blended over its background at the end.
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glClearStencil(0);
  Image image = clamped.is_draft ? impl.drawDraft(snapshot, camera, clamped)
                                 : impl.drawInFull(snapshot, camera, clamped);
  if (options.show_flash) drawFlash(*impl.gl, totalForce_N(snapshot.contacts) > 0, image);
  gl::requireSound();
  drawOverlay(image, snapshot, options, {kHandColor, kHandColor}, impl.lettering);
  return image;
}

bool Renderer::drewWhole() const {
  return impl_->drew_whole;
}

Image Renderer::Impl::drawInFull(const scenes::Snapshot& snapshot, const Camera& camera,
                                 const DrawOptions& options) {
  drew_whole = true;
  const View view =
      makeView(visibleBounds(parts, snapshot, options.show_waiting, options.show_target), camera, options);
  const std::vector<DrawnBody> bodies = listBodies(snapshot, view, options);
  const std::optional<DrawnBody> target = targetOf(snapshot, view, options);
  const MarkList marks = listMarks(snapshot, view.X_CW, 2 * view.detail_m, options);
  const PixelRect whole = {0, 0, options.width, options.height};
  const Picture picture = {*gl,     view,
                           options, bodies,
                           whole,   partsOnScreen(bodies, target ? &*target : nullptr, marks, view, options)};
  renderKeyShadow(picture);
  if (options.show_ground) renderFloorShadow(picture);
  renderGeometry(picture);
  renderOcclusion(picture);
  renderBehind(picture);
  renderColor(picture, marks, target ? &*target : nullptr);
  Image image(options.width, options.height);
  resolvePicture(picture, image);
  return image;
}

Image Renderer::Impl::drawDraft(const scenes::Snapshot& snapshot, const Camera& camera,
                                const DrawOptions& options) {
  DraftContents next;
  next.box_W = coarseBounds(visibleBounds(parts, snapshot, options.show_waiting, options.show_target),
                            last_draft ? &last_draft->contents.box_W : nullptr);
  next.camera = camera;
  next.options = withoutOverlay(options);
  const View view = makeView(next.box_W, camera, options);
  next.bodies = listBodies(snapshot, view, options);
  next.target = targetOf(snapshot, view, options);
  next.marks = listMarks(snapshot, view.X_CW, 2 * view.detail_m, options);

  std::optional<PixelRect> changed;
  if (last_draft) changed = changedPixels(last_draft->contents, next, view, options.width, options.height);
  drew_whole = !changed;
  Image image = last_draft ? std::move(last_draft->image) : Image(options.width, options.height);
  last_draft.reset();  // no valid draft until this picture is drawn
  std::vector<DrawnBody> shown = next.bodies;
  if (changed)
    std::erase_if(shown, [&](const DrawnBody& body) {
      return intersection(*changed, boxOnScreen(body, view, options.width, options.height,
                                                lineMargin_px(options.height)))
          .isEmpty();
    });
  const PixelRect region = changed.value_or(PixelRect{0, 0, options.width, options.height});
  const DrawnBody* target = next.target ? &*next.target : nullptr;
  const Picture picture = {
      *gl,   view,   options,
      shown, region, intersection(region, partsOnScreen(next.bodies, target, next.marks, view, options))};
  if (!changed) {
    lightEverything(picture);
    renderBehind(picture);
  }
  if (!picture.region.isEmpty()) {
    renderColor(picture, next.marks, target);
    resolvePicture(picture, image);
  }
  last_draft = LastDraft{std::move(next), image};
  return image;
}

}  // namespace vps::viewer
