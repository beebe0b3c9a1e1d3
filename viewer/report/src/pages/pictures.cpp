// SPDX-License-Identifier: BSD-3-Clause
#include "pages/pictures.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "files/html.h"
#include "vps/stoppable.h"
#include "vps_scenes/cad/colors.h"
#include "vps_scenes/fits/check_fields.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/draw/renderer.h"

namespace vps::viewer {
namespace {

using html::format;

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
    options.caption = result_.verdict == scenes::Verdict::Fits ? "as assembled" : "at the end of the run";
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
    // The pictures of contact and end share a close-up of the part and its target, cut open along the
    // direction of insertion.
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
          result_.contact[i]
              .has_hand) {  // the arrow of the force starts at the hand, so the hand must be in the picture
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
  const StoppableWork work(options.progress, "pictures");
  try {
    return PictureSet(scene, result, dir, options).draw();
  } catch (const std::runtime_error& error) {
    none.failure_reason = error.what();  // a missing picture must not end a run
    return none;
  }
}

namespace {

using html::format;

constexpr std::array<std::array<double, 3>, 4> kRamp = {
    {{0.86, 0.10, 0.08}, {0.98, 0.80, 0.10}, {0.20, 0.65, 0.25}, {0.15, 0.35, 0.85}}};
constexpr std::array<double, 3> kOverlap = {0.85, 0.0, 0.75}, kFar = {0.80, 0.81, 0.82};
constexpr double kDecades = 3;

std::array<float, 3> toLinear(const std::array<double, 3>& srgb) {
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(scenes::linearFromSrgb(srgb[k]));
  return out;
}

std::string legend(double near_m) {
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 44\" width=\"640\" "
      "font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n";
  const auto box = [&](double x, double width, const std::array<double, 3>& c) {
    out += "<rect x=\"" + format(x, "%.1f") + "\" y=\"2\" width=\"" + format(width, "%.1f") +
           "\" height=\"18\" fill=\"rgb(" + format(255 * c[0], "%.0f") + "," + format(255 * c[1], "%.0f") +
           "," + format(255 * c[2], "%.0f") + ")\"/>\n";
  };
  const auto words = [&](double x, const std::string& text) {
    out += "<text x=\"" + format(x, "%.0f") + "\" y=\"36\" text-anchor=\"middle\">" + text + "</text>\n";
  };
  box(2, 70, kOverlap);
  words(37, "overlap");
  constexpr int kSteps = 140;
  for (int i = 0; i < kSteps; ++i)
    box(90 + 3 * i, 3.2, clearanceColor(near_m * std::pow(10, kDecades * ((i + 0.5) / kSteps - 1)), near_m));
  for (int i = 0; i <= 3; ++i)
    words(90 + 140.0 * i, (i == 0 ? "≤ " : "") + lengthText(near_m * std::pow(10, i - kDecades)));
  box(560, 70, kFar);
  words(595, "farther");
  return out + "</svg>\n";
}

std::string picture(Renderer& renderer, std::size_t part, const Box& box_W, const Vec3& to_viewer) {
  scenes::Snapshot snapshot;
  snapshot.bodies.push_back({part, Pose(), scenes::BodyRole::Mounted});
  DrawOptions options;
  options.width = 560;
  options.height = 420;
  options.show_ground = options.show_legend = options.highlight_hand = false;
  const Image image = renderer.render(snapshot, frameScene(box_W, to_viewer, 0.5, 4.0 / 3), options);
  return "<img alt=\"\" style=\"width:49%;display:inline-block\" src=\"" + pngInText(pngBytes(image)) + "\">";
}

/// The first pair of the table in which the part is: its deepest overlap, a contact, or its least clearance.
/// The numbers are those of the table, which are exact, where the map measures at its vertices only.
std::string nearestWords(const scenes::CheckResult& result, const std::string& part) {
  const auto pair = std::ranges::find_if(
      result.pairs, [&](const scenes::CheckedPair& one) { return one.a == part || one.b == part; });
  if (pair == result.pairs.end()) return "";
  const std::string other = "<b>" + escapeHtml(pair->a == part ? pair->b : pair->a) + "</b>";
  const auto withError = [&](double length_m) {
    return lengthOnPage(length_m) + " ± " + lengthOnPage(pair->error_m);
  };
  if (pair->is_uncertain) return "It is not known whether the part overlaps " + other + ".";
  const double depth_m = pair->interference_depth_m;
  if (isOverlapping(*pair)) return "The part overlaps " + other + " by " + withError(depth_m) + ".";
  const std::string measured =
      depth_m > 0 ? "overlap " + withError(depth_m) : "clearance " + withError(pair->clearance_m);
  return pair->state == scenes::PairState::Contact
             ? "The part touches " + other + ", to within the error: " + measured + "."
             : "The part's least " + measured + ", to " + other + ".";
}

std::string pictures(const scenes::CheckResult& result, const Progress& progress) {
  RenderScene scene;
  std::vector<std::vector<std::array<float, 3>>> colors;
  colors.reserve(result.maps.size());
  for (const scenes::ClearanceMap& map : result.maps) {
    auto& of_map = colors.emplace_back();
    for (const double distance_m : map.distance_m)
      of_map.push_back(toLinear(clearanceColor(distance_m, result.near_m)));
    scene.push_back({&map.mesh_W, {1, 1, 1}, false, Pose(), &of_map});
  }
  Renderer renderer(scene);
  std::string out;
  for (std::size_t i = 0; i < result.maps.size(); ++i) {
    const scenes::ClearanceMap& map = result.maps[i];
    if (progress)
      progress("drawing clearances", static_cast<double>(i) / static_cast<double>(result.maps.size()));
    const Box box_W = bounds(map.mesh_W);
    out += "<figure class=\"section\">" + picture(renderer, i, box_W, Vec3(0.75, -1.25, 0.85)) +
           picture(renderer, i, box_W, Vec3(-0.75, 1.25, -0.85)) + "<figcaption><b>" + escapeHtml(map.part) +
           "</b>, from the front, right and above, and from the opposite side. " +
           nearestWords(result, map.part) + "</figcaption></figure>\n";
  }
  return out;
}

}  // namespace

std::array<double, 3> clearanceColor(double distance_m, double near_m) {
  // At a point on a common face the sign of the distance is rounding error.
  if (distance_m < -1e-5 * near_m) return kOverlap;
  if (distance_m >= near_m) return kFar;
  const double share = std::clamp(1 + std::log10(std::max(distance_m, 1e-300) / near_m) / kDecades, 0.0, 1.0);
  const double at = share * (kRamp.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kRamp.size() - 2);
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = kRamp[i][k] + (at - static_cast<double>(i)) * (kRamp[i + 1][k] - kRamp[i][k]);
  return out;
}

std::string clearancePictures(const scenes::CheckResult& result, const Progress& progress) {
  if (result.maps.empty()) return "";
  std::string out =
      "<h2>Clearance on the surfaces</h2>\n<p>The distance of each point of a part's surface from the "
      "nearest other part. The other part is not drawn. An overlap that counts as contact in the table of "
      "pairs "
      "has the colour of contact. On coarse curved faces the colours show the facets of the meshes.</p>\n" +
      legend(result.near_m);
  const StoppableWork work(progress, "drawing clearances");
  try {
    return out + pictures(result, progress);
  } catch (const std::runtime_error& error) {  // this machine has no EGL or OpenGL
    return out + "<p class=\"note\">These pictures are missing: " + escapeHtml(error.what()) + "</p>\n";
  }
}

}  // namespace vps::viewer
