// SPDX-License-Identifier: BSD-3-Clause
#include "pages/sections.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "files/html.h"

namespace vps::viewer {

namespace {

using html::format;

constexpr double kPathRate_hz = 25;                                         // rate at which the path is drawn
constexpr double kViewWidth_px = 440, kViewHeight_px = 330, kPxPerM = 190;  // size and scale of a side view
constexpr double kGround_px = 315,
                 kShoulders_px = 120;  // vertical positions of the floor and the shoulders in a side view

std::string inWholeDegrees(double rad) {
  return format(rad * 180 / std::numbers::pi, "%.0f");
}

std::string personTable(const scenes::Ergonomics& measured) {
  std::vector<std::vector<html::Cell>> rows;
  for (const scenes::StepErgonomics& s : measured.steps)
    rows.push_back({{escapeHtml(s.part), ""},
                    {s.body + ", " + toText(s.posture), ""},
                    {s.hand, ""},
                    {format(100 * s.greatest_reach, "%.0f"), s.greatest_reach > 1 ? "n bad" : "n"},
                    {format(100 * s.out_of_reach_share, "%.0f"), s.out_of_reach_share > 0 ? "n bad" : "n"},
                    {inWholeDegrees(s.raised_rad), "n"},
                    {inWholeDegrees(s.elbow_least_rad) + " to " + inWholeDegrees(s.elbow_most_rad), "n"},
                    {format(s.rula_mean, "%.1f"), "n"},
                    {std::to_string(s.rula_worst), "n"}});
  return html::table(
      {"part", "person", "hand", "greatest reach [% of the arm]", "time out of reach [%]",
       "upper arm raised by up to [degrees]", "elbow flexed [degrees]", "RULA, mean (2 to 6)", "RULA, worst"},
      rows);
}

/// Draws a view along -x: y to the right, z up, the floor at the bottom.
class SideView {
 public:
  SideView(const scenes::Ergonomics& measured, scenes::Posture posture)
      : p_WB_(measured.p_WB),
        posture_(posture),
        bench_m_(posture == scenes::Posture::Seated ? scenes::kSeatedBench_m : scenes::kStandingBench_m) {}

  std::string draw(const std::vector<Vec3>& path_W) const {
    std::string shapes =
        line(-1, 0, 2, 0, "#888", 1) + line(scenes::kToShoulder_m / 2, bench_m_, 2, bench_m_, "#8a6d3b", 3);
    for (const scenes::Body& body : scenes::assumedBodies()) shapes += person(body, path_W);
    std::string points;
    for (const Vec3& p : path_W)
      points.append(format(x(p.y() - p_WB_.y()), "%.1f,")).append(format(y(heightOf(p)), "%.1f "));
    shapes.append("<polyline fill=\"none\" stroke=\"#b00020\" stroke-width=\"1.5\" points=\"")
        .append(points)
        .append("\"/>\n");
    return "<figure><svg viewBox=\"0 0 " + format(kViewWidth_px, "%.0f ") + format(kViewHeight_px, "%.0f") +
           "\">\n" + shapes + "</svg><figcaption>" +
           (posture_ == scenes::Posture::Seated ? "Seated" : "Standing") +
           ", from the side: path of the part in hand (red), the arms of a small woman and a large man at "
           "its "
           "farthest place, and the reach of their arms.</figcaption></figure>\n";
  }

 private:
  [[nodiscard]] static double x(double ahead_m) { return kShoulders_px + kPxPerM * ahead_m; }
  [[nodiscard]] static double y(double height_m) { return kGround_px - kPxPerM * height_m; }
  [[nodiscard]] double heightOf(const Vec3& p_W) const { return p_W.z() - p_WB_.z() + bench_m_; }

  static std::string line(double a_m, double b_m, double c_m, double d_m, const char* color, double width) {
    return "<line x1=\"" + format(x(a_m), "%.1f") + "\" y1=\"" + format(y(b_m), "%.1f") + "\" x2=\"" +
           format(x(c_m), "%.1f") + "\" y2=\"" + format(y(d_m), "%.1f") + "\" stroke=\"" + color +
           "\" stroke-width=\"" + format(width, "%.1f") + "\"/>\n";
  }

  /// Draws the arm in the plane of the picture. An arm that reaches sideways therefore looks more bent than
  /// it is.
  [[nodiscard]] std::string person(const scenes::Body& body, const std::vector<Vec3>& path_W) const {
    const double shoulder_m = body.shoulderHeight_m(posture_);
    const double arm_m = body.upperArm_m() + body.forearm_m();
    const double hip_m = posture_ == scenes::Posture::Seated ? scenes::Body::kSeat_m : 0.530 * body.stature_m;
    std::string out = line(0, hip_m, 0, shoulder_m, "#3b6ea5", 2);
    if (posture_ == scenes::Posture::Standing) out += line(0, 0, 0, hip_m, "#3b6ea5", 2);
    out += "<circle cx=\"" + format(x(0), "%.1f") + "\" cy=\"" + format(y(shoulder_m), "%.1f") + "\" r=\"" +
           format(kPxPerM * arm_m, "%.1f") +
           "\" fill=\"none\" stroke=\"#3b6ea5\" stroke-dasharray=\"4 4\"/>\n";
    Vec3 farthest = Vec3::Zero();
    for (const Vec3& p : path_W) {
      const Vec3 from(0, p.y() - p_WB_.y(), heightOf(p) - shoulder_m);
      if (from.norm() > farthest.norm()) farthest = from;
    }
    const scenes::ArmPose arm = armTo(body, farthest);
    const double elbow_y_m = body.upperArm_m() * std::sin(arm.raised_rad),
                 elbow_z_m = shoulder_m - body.upperArm_m() * std::cos(arm.raised_rad);
    const double fore_rad = arm.raised_rad + arm.elbow_rad;
    return out + line(0, shoulder_m, elbow_y_m, elbow_z_m, "#3b6ea5", 3) +
           line(elbow_y_m, elbow_z_m, elbow_y_m + body.forearm_m() * std::sin(fore_rad),
                elbow_z_m - body.forearm_m() * std::cos(fore_rad), "#3b6ea5", 3);
  }

  Vec3 p_WB_;
  scenes::Posture posture_;
  double bench_m_;
};

std::string answer(const scenes::Ergonomics& measured) {
  const auto far = std::ranges::max_element(measured.steps, {}, &scenes::StepErgonomics::out_of_reach_share);
  if (far->out_of_reach_share <= 0)
    return "<p>Every part stays within reach of both persons, seated and standing.</p>\n";
  return "<p class=\"note\">'" + escapeHtml(far->part) + "' is out of reach of the " + far->body + ", " +
         toText(far->posture) + ", for " + format(100 * far->out_of_reach_share, "%.0f") +
         " % of its time in hand.</p>\n";
}

}  // namespace

std::string ergonomicsSection(const scenes::Scene& scene, const scenes::AssembleResult& result) {
  const scenes::Ergonomics measured = measureErgonomics(scene, result.trace);
  if (measured.steps.empty()) return {};
  std::vector<Vec3> path_W;
  for (const scenes::TraceRow& row : thinned(result.trace, kPathRate_hz))
    if (row.phase != static_cast<int>(scenes::TracePhase::Rest)) path_W.push_back(row.X_WP.p);
  std::string out = "<h2>Ergonomics</h2>\n" + answer(measured) + "<div class=\"pictures two\">\n";
  for (const scenes::Posture posture : {scenes::Posture::Seated, scenes::Posture::Standing})
    out += SideView(measured, posture).draw(path_W);
  return out + "</div>\n" + personTable(measured) +
         "<p class=\"quiet\"><i>Assumed</i>: statures of 1.535 m (5th percentile of women) and 1.855 m (95th "
         "of "
         "men), 18 to 65 years (DIN 33402-2:2005); lengths of the body as shares of the stature (Drillis and "
         "Contini 1966); a bench of 0.74 m to sit and of 1.05 m to stand at (EN 527-1:2011), on which the "
         "lowest part stands; the shoulders 0.20 m in front of the nearest part or place of the path, on the "
         "side of the least y. The hand is at the centre of mass of the part, the elbow hangs below the line "
         "from "
         "shoulder to hand. RULA scores of upper arm and lower arm after McAtamney and Corlett (1993), "
         "without "
         "wrist, neck, trunk and load.</p>\n";
}

}  // namespace vps::viewer
