// SPDX-License-Identifier: BSD-3-Clause
#include "pages/pictures.h"

#include <algorithm>
#include <exception>

#include "files/html.h"
#include "vps_viewer/draw/renderer.h"

namespace vps::viewer {
namespace {

using html::format;

const Vec3 kToViewer(0.75, -1.25, 0.85);  // from the front, the right and above, as assembly drawings are

class PictureSet {
 public:
  PictureSet(const scenes::Scene& scene, const scenes::AssembleResult& result, std::string dir,
             const ReportOptions& options)
      : scene_(scene),
        result_(result),
        dir_(std::move(dir)),
        options_(options),
        drawn_(drawnMeshes(scene)),
        renderer_(drawn_) {}

  ReportPictures draw() {
    const std::size_t step_count = result_.steps.size();
    total_ = 2 + 3 * step_count;
    ReportPictures pictures;
    DrawOptions options = baseOptions();
    options.show_target = options.show_contacts = options.show_force = options.show_legend = false;
    options.title = result_.scene.empty() ? scene_.name : result_.scene;
    options.caption = result_.verdict == scenes::Verdict::Fits ? "as assembled" : "as the run left it";
    const Camera camera = frame(snapshotBounds(drawn_, result_.finished));
    pictures.overview = save("overview.png", result_.finished, camera, options);
    options.caption += ", cut through the middle";
    options.cut = sectionAlong(snapshotBounds(drawn_, result_.finished).center(), Vec3::UnitZ(), kToViewer);
    pictures.section = save("section.png", result_.finished, camera, options);
    for (std::size_t i = 0; i < step_count; ++i) pictures.steps.push_back(drawStep(i));
    return pictures;
  }

 private:
  [[nodiscard]] DrawOptions baseOptions() const {
    DrawOptions options;
    options.width = options_.width;
    options.height = options_.height;
    options.force_full_scale_N = std::max(1.0, scene_.hand.force_limit_N);
    return options;
  }

  [[nodiscard]] Camera frame(const Box& box_W) const {
    return frameScene(box_W, kToViewer, 0.5, static_cast<double>(options_.width) / options_.height);
  }

  StepPictures drawStep(std::size_t i) {
    StepPictures pictures;
    const scenes::SceneStep* step = i < scene_.steps.size() ? &scene_.steps[i] : nullptr;
    const std::string prefix = "step_" + std::to_string(i + 1) + "_";
    const std::string title = "Step " + std::to_string(i + 1) + " of " +
                              std::to_string(result_.steps.size()) + ": " + result_.steps[i].part;
    DrawOptions options = baseOptions();
    options.title = title;
    if (result_.steps[i].penetration_limit_m > 0)
      options.contact_full_scale_m = result_.steps[i].penetration_limit_m;
    if (i < result_.start.size()) {
      options.caption = "start; the target is transparent";
      pictures.start = save(prefix + "start.png", result_.start[i],
                            frame(snapshotBounds(drawn_, result_.start[i])), options);
    }
    // Contact and end share a close-up of the part and its target, cut open along the direction of insertion.
    Camera camera = frame(snapshotBounds(drawn_, result_.finished));
    if (step != nullptr) {
      const Box place_W = bounds(transformed(scene_.parts[step->part].part.mesh, placeOf(*step)));
      Box close_W = place_W;
      if (i < result_.contact.size())
        for (const scenes::BodySnapshot& body : result_.contact[i].bodies)
          if (body.part == step->part && body.X_WP.isFinite()) {
            const Box part_W = bounds(transformed(scene_.parts[step->part].part.mesh, body.X_WP));
            close_W.add(part_W.min);
            close_W.add(part_W.max);
          }
      if (i < result_.contact.size() &&
          result_.contact[i].has_hand) {  // the arrow of the force starts at the hand
        const Vec3& p_hand_W = result_.contact[i].X_W_Proxy.p;
        if ((p_hand_W - close_W.center()).norm() < close_W.size().norm()) close_W.add(p_hand_W);
      }
      const Vec3 room_W = Vec3::Constant(0.2 * close_W.size().norm());
      camera = frame({close_W.min - room_W, close_W.max + room_W});
      const Pose& X_before = step->way_points.empty() ? step->X_WP_start : step->way_points.back();
      const Pose& X_first = step->way_points.empty() ? step->X_WP_target : step->way_points.front();
      options.cut = sectionAlong(
          place_W.center(),
          step->takes_off ? Vec3(step->X_WP_start.p - X_first.p) : Vec3(step->X_WP_target.p - X_before.p),
          kToViewer);
    }
    if (i < result_.contact.size()) {
      const scenes::Snapshot& s = result_.contact[i];
      double depth_m = 0;
      for (const scenes::ContactMark& c : s.contacts) depth_m = std::max(depth_m, c.depth_m);
      options.caption = "contact at " + format(s.time_s, "%.3f s") + ", depth " +
                        format(1e6 * depth_m, "%.2f µm") + ", force " + format(s.F_hand_W.f.norm(), "%.1f N");
      pictures.contact = save(prefix + "contact.png", s, camera, options);
    }
    if (i < result_.end.size()) {
      options.caption = result_.steps[i].reason.empty()
                            ? (result_.steps[i].is_taken_off ? "end: taken off" : "end: in place")
                            : "end: " + result_.steps[i].reason;
      pictures.end = save(prefix + "end.png", result_.end[i], camera, options);
    }
    return pictures;
  }

  std::string save(const std::string& name, const scenes::Snapshot& snapshot, const Camera& camera,
                   const DrawOptions& options) {
    if (options_.progress)
      options_.progress("pictures", static_cast<double>(done_) / static_cast<double>(total_));
    ++done_;
    savePng(renderer_.render(snapshot, camera, options), dir_ + "/pictures/" + name);
    return "pictures/" + name;
  }

  const scenes::Scene& scene_;
  const scenes::AssembleResult& result_;
  std::string dir_;
  const ReportOptions& options_;
  RenderScene drawn_;
  Renderer renderer_;
  std::size_t done_ = 0, total_ = 1;
};

}  // namespace

ReportPictures drawPictures(const scenes::Scene& scene, const scenes::AssembleResult& result,
                            const std::string& dir, const ReportOptions& options) {
  ReportPictures none;
  none.steps.resize(result.steps.size());
  if (!options.has_pictures) return none;
  try {
    return PictureSet(scene, result, dir, options).draw();
  } catch (const std::exception& error) {
    none.failure_reason = error.what();  // a missing picture must not end a run
    return none;
  }
}

}  // namespace vps::viewer
