// SPDX-License-Identifier: BSD-3-Clause
// Finds faults in the steps of a scene. Measured depths at poses decide whether a part is deeper than
// allowed, so that the check does not depend on the planner. A motion search along the path only adds poses,
// so that a thin wall between two regular poses is also found, up to the search limits of follow().
#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/check_placed.h"
#include "pair/pair_measures.h"
#include "surface/placed_surface.h"
#include "vps/stoppable.h"
#include "ways/pair_motions.h"
#include "ways/way.h"

#include "vps_scenes/planning/plan.h"

namespace vps::scenes {

const char* toText(WayFaultKind kind) {
  switch (kind) {
    case WayFaultKind::Through:
      return "through";
    case WayFaultKind::Order:
      return "order";
    case WayFaultKind::Support:
      return "support";
    case WayFaultKind::Clearance:
      return "clearance";
  }
  return "";
}

namespace {

constexpr int kPosesOfLeg = 24;
constexpr double kTouch_m = 10e-6;  // limit of StepResult::penetration_limit_m for a step without a clearance
constexpr double kFall_m = 1e-3;  // a part that sinks by less than kFall_m counts as carried, as in planning

/// A piece of a path with one motion that starts at a pose.
struct WayPiece {
  Pose X_WP;
  Motion motion_W;
  double most = 0;
};

class WayCheck {
 public:
  WayCheck(const Scene& scene, const std::vector<PlacedSurface>& placed, std::size_t step,
           std::vector<std::size_t> held)
      : step_(scene.steps[step]), part_(placed[step_.part]), center_P_(part_.surface->solid().mass().com) {
    std::vector<const PlacedSurface*> standing;
    for (const std::size_t i : held) {
      standing.push_back(&placed[i]);
      allowed_m_.push_back(kTouch_m + depthAt(placed[i], step_.X_WP_target).depth_m);
    }
    held_ = std::make_shared<const StandingParts>(std::move(standing));
  }

  /// The fault with the greatest depth beyond the allowed depth on the path; its part is empty if the path is
  /// free.
  [[nodiscard]] WayFault deepest() const {
    WayFault worst;
    for (const Pose& X_WP : poses_W()) consider(X_WP, worst);
    for (const WayPiece& piece : pieces_W()) follow(piece, worst);
    for (const PlacedSurface* held : held_->parts)
      if (held->name == worst.against) worst.error_m = meshError_m(part_, *held);
    return worst;
  }

  /// Whether the part falls from its target.
  [[nodiscard]] bool falls(const Vec3& down_W) const {
    const PlacedSurface placed = placedAt(step_.X_WP_target);
    SearchWork work{kMostWork};
    return !MotionSearch(placed, held_, allowed_m_, CrossingDepth::UpToMost)
                .reach({down_W, Vec3::Zero(), false}, kFall_m, &work)
                .is_stopped;
  }

 private:
  /// The depths at the target and on the path may each be off by kOverlapCertain_m. A smaller difference of
  /// the two proves no fault.
  static constexpr double kMeasured_m = 2 * kOverlapCertain_m;
  static constexpr std::uint64_t kMostWork = 2'000'000;  // takes a few seconds for each leg

  [[nodiscard]] Overlap depthAt(const PlacedSurface& held, const Pose& X_WP) const {
    return deepestOverlap(part_.surface->overlap(), X_WP, held.surface->overlap(), held.X_WP);
  }

  [[nodiscard]] PlacedSurface placedAt(const Pose& X_WP) const {
    return displaced(part_, X_WP * part_.X_WP.inverse());
  }

  void consider(const Pose& X_WP, WayFault& worst) const {
    const Box box_W = moved(part_.surface->box(), X_WP);
    for (std::size_t i = 0; i < held_->parts.size(); ++i) {
      const PlacedSurface& held = *held_->parts[i];
      if (!overlap(box_W, held.box_W)) continue;
      const Overlap here = depthAt(held, X_WP);
      const double beyond_m = here.depth_m - allowed_m_[i];
      if (beyond_m <= kMeasured_m || beyond_m <= worst.depth_m - worst.allowed_m) continue;
      worst = {WayFaultKind::Through, part_.name, held.name, here.depth_m, allowed_m_[i], here.p_W};
    }
  }

  /// Searches along a piece until the part is stopped, measures the depth at eight poses up to 1.3 mm beyond
  /// that pose, and continues from the last of these poses. The search ends early once a fault is found, and
  /// incomplete at the limit of work or of stops; the rest of the leg is then checked only at its 24 regular
  /// poses.
  void follow(WayPiece piece, WayFault& worst) const {
    constexpr int kStopsWithFault = 16, kBeyond = 8;
    constexpr int kMostStops = 1024;  // 1.3 m of a path on which the part is stopped everywhere
    SearchWork work{kMostWork};
    for (int stop = 0; piece.most > 0; ++stop) {
      if (stop >= (worst.part.empty() ? kMostStops : kStopsWithFault) || work.isSpent()) return;
      const PlacedSurface placed = placedAt(piece.X_WP);
      const Reach reach = MotionSearch(placed, held_, allowed_m_, CrossingDepth::UpToMost)
                              .reach(piece.motion_W, piece.most, &work);
      if (!reach.is_stopped) return;
      const double speed = piece.motion_W.is_turn ? speedOf(piece) : 1;
      double s = reach.s;
      for (int k = 0; k < kBeyond; ++k) {
        s = std::min(piece.most, reach.s + (1 << k) * kTouch_m / speed);
        consider(piece.motion_W.at(s) * piece.X_WP, worst);
      }
      // From the new pose on, a straight motion and a turn about a fixed axis stay the same motion; only the
      // centre advances.
      piece.X_WP = piece.motion_W.at(s) * piece.X_WP;
      if (piece.motion_W.is_turn)
        piece.motion_W.center += piece.motion_W.forward_m * s * piece.motion_W.direction;
      piece.most -= s;
    }
  }

  /// Upper bound of the speed of the box's corners.
  [[nodiscard]] double speedOf(const WayPiece& piece) const {
    const Vec3 middle_W = piece.X_WP * part_.surface->box().center();
    return piece.motion_W.velocity(middle_W).norm() + 0.5 * part_.surface->box().size().norm();
  }

  [[nodiscard]] std::vector<Pose> stops_W() const {
    std::vector<Pose> stops{step_.X_WP_start};
    stops.insert(stops.end(), step_.way_points.begin(), step_.way_points.end());
    stops.push_back(step_.X_WP_target);
    return stops;
  }

  [[nodiscard]] std::vector<Pose> poses_W() const {
    const std::vector<Pose> stops = stops_W();
    std::vector<Pose> poses;
    for (std::size_t leg = 0; leg + 1 < stops.size(); ++leg) {
      const bool is_turned = step_.motion == StepMotion::Screw && leg + 2 == stops.size();
      if (is_turned) poses.push_back(stops[leg]);  // the pose at which the hand begins to turn the screw
      for (int i = 0; i < kPosesOfLeg; ++i) {
        const double share = static_cast<double>(i) / kPosesOfLeg;
        poses.push_back(is_turned ? screwed(1 - share, stops[leg])
                                  : between(stops[leg], stops[leg + 1], share));
      }
    }
    return poses;
  }

  [[nodiscard]] std::vector<WayPiece> pieces_W() const {
    const std::vector<Pose> stops = stops_W();
    std::vector<WayPiece> pieces;
    for (std::size_t leg = 0; leg + 1 < stops.size(); ++leg) {
      if (step_.motion == StepMotion::Screw && leg + 2 == stops.size()) {
        const Vec3 center_W = step_.X_WP_target * center_P_, out_W = stops[leg] * center_P_ - center_W;
        if (out_W.norm() > kStill && step_.pitch_m != 0)
          pieces.push_back({step_.X_WP_target, threadMotion(out_W), turnOf(out_W)});
        continue;
      }
      const int count = piecesOf(stops[leg], stops[leg + 1]);
      for (int i = 0; i < count; ++i)
        addPiece(between(stops[leg], stops[leg + 1], static_cast<double>(i) / count),
                 between(stops[leg], stops[leg + 1], static_cast<double>(i + 1) / count), pieces);
    }
    return pieces;
  }

  /// Number of screw motions that approximate the leg so that the part's centre stays within 2 um of its
  /// straight line.
  [[nodiscard]] int piecesOf(const Pose& from, const Pose& to) const {
    constexpr double kOff_m = 2e-6;
    constexpr int kMost = 64;
    const double turn_rad = rotationVector(to.R * from.R.transpose()).norm();
    const double way_m = (to * center_P_ - from * center_P_).norm();
    if (turn_rad < kStill || way_m < kOff_m) return 1;
    // An arc of radius r and angle t over a chord c = r t rises by r t^2 / 8 = c t / 8; with n pieces, c and
    // t become c / n and t / n.
    return std::clamp(static_cast<int>(std::ceil(std::sqrt(way_m * turn_rad / (8 * kOff_m)))), 1, kMost);
  }

  /// The screw motion from one pose to another (Chasles).
  void addPiece(const Pose& from, const Pose& to, std::vector<WayPiece>& pieces) const {
    const Vec3 turn = rotationVector(to.R * from.R.transpose());
    const Vec3 a = from * center_P_, way = to * center_P_ - a;
    const double turn_rad = turn.norm();
    if (turn_rad < kStill) {
      if (way.norm() > kStill) pieces.push_back({from, {way.normalized(), Vec3::Zero(), false}, way.norm()});
      return;
    }
    const Vec3 n = turn / turn_rad, across = way - n.dot(way) * n;
    const Vec3 center = a + 0.5 * across + 0.5 / std::tan(0.5 * turn_rad) * n.cross(across);
    pieces.push_back({from, {n, center, true, n.dot(way) / turn_rad}, turn_rad});
  }

  /// Pose of the leg at a share of its length; the part's centre moves on a straight line, as the hand moves
  /// it.
  [[nodiscard]] Pose between(const Pose& from, const Pose& to, double share) const {
    const Pose X_PG = Pose::translation(center_P_);
    return interpolate(from * X_PG, to * X_PG, share) * X_PG.inverse();
  }

  [[nodiscard]] Motion threadMotion(const Vec3& out_W) const {
    const double forward_m = step_.pitch_m / (2 * std::numbers::pi);
    return {out_W.normalized(), step_.X_WP_target * center_P_, true, forward_m};
  }
  [[nodiscard]] double turnOf(const Vec3& out_W) const {
    return 2 * std::numbers::pi * out_W.norm() / step_.pitch_m;
  }

  /// Pose on the thread at a share of the way from the target out to `from`.
  [[nodiscard]] Pose screwed(double share, const Pose& from) const {
    const Vec3 out_W = share * (from * center_P_ - step_.X_WP_target * center_P_);
    if (out_W.norm() < kStill || step_.pitch_m == 0) return step_.X_WP_target;
    return threadMotion(out_W).at(turnOf(out_W)) * step_.X_WP_target;
  }

  static constexpr double kStill = 1e-12;
  const SceneStep& step_;
  const PlacedSurface& part_;
  Vec3 center_P_;
  std::shared_ptr<const StandingParts> held_;
  std::vector<double> allowed_m_;
};

/// The parts that are in place before a step.
std::vector<std::size_t> inPlaceBefore(const Scene& scene, std::size_t step) {
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (scene.parts[i].is_fixed) held.push_back(i);
  for (std::size_t i = 0; i < step; ++i) held.push_back(scene.steps[i].part);
  return held;
}

/// Whether the blocking part would pass if this step came before its own.
bool wouldPassLater(const Scene& scene, const std::vector<PlacedSurface>& placed, std::size_t step,
                    const std::string& against) {
  for (std::size_t i = 0; i < step; ++i)
    if (placed[scene.steps[i].part].name == against)
      return WayCheck(scene, placed, i, {scene.steps[step].part}).deepest().against.empty();
  return false;
}

WayFault faultOf(const Scene& scene, const std::vector<PlacedSurface>& placed, std::size_t step) {
  const WayCheck check(scene, placed, step, inPlaceBefore(scene, step));
  WayFault fault = check.deepest();
  if (!fault.against.empty()) {
    if (wouldPassLater(scene, placed, step, fault.against)) fault.kind = WayFaultKind::Order;
    return fault;
  }
  const bool is_let_go = !scene.steps[step].is_held && !scene.steps[step].takes_off;
  if (is_let_go && scene.gravity_W.norm() > 0 && check.falls(scene.gravity_W.normalized())) {
    fault.kind = WayFaultKind::Support;
    fault.part = placed[scene.steps[step].part].name;
  }
  return fault;
}

/// Converts the paths of a scene to a planned assembly.
PlannedAssembly asPlanned(const Scene& scene) {
  PlannedAssembly out{scene.name, {}, {}, {}, {}, {}};
  for (const ScenePart& part : scene.parts)
    if (part.is_fixed) out.fixed.push_back(part.part.name);
  for (const SceneStep& step : scene.steps) {
    PlannedStep planned;
    planned.name = scene.parts[step.part].part.name;
    planned.parts = {planned.name};
    const Pose X_PW = step.X_WP_target.inverse();
    planned.before_W.push_back(step.X_WP_start * X_PW);
    for (const Pose& point : step.way_points) planned.before_W.push_back(point * X_PW);
    const bool is_screw = step.motion == StepMotion::Screw;
    planned.kind = is_screw ? WayKind::Screw : WayKind::Straight;
    planned.lead_m = is_screw ? step.pitch_m : 0;
    const Vec3 last_W = -planned.before_W.back().p;
    if (!last_W.isZero(0)) planned.insertion_W = last_W.normalized();
    out.steps.push_back(std::move(planned));
  }
  return out;
}

void addLostClearances(const Scene& scene, const std::vector<PlacedSurface>& placed,
                       const std::map<std::string, double>& planned_m, const Progress& progress,
                       std::vector<WayFault>& of_step) {
  constexpr double kSame_m = 2e-6,
                   kSameShare = 2e-3;  // each clearance is measured to within half of these values
  CheckSettings settings;
  settings.has_play = false;
  const CheckResult checked = checkPlaced(scene.name, placed, settings, progress);
  PlannedAssembly assembly = asPlanned(scene);
  measureWays({placed, checked, Vec3::UnitZ()}, assembly, progress);
  for (std::size_t i = 0; i < of_step.size(); ++i) {
    const PlannedStep& step = assembly.steps[i];
    const auto planned = planned_m.find(step.name);
    if (!of_step[i].part.empty() || planned == planned_m.end() || !step.clearance_m) continue;
    if (*step.clearance_m >= (1 - kSameShare) * planned->second - kSame_m) continue;
    of_step[i] = {.kind = WayFaultKind::Clearance,
                  .part = step.name,
                  .against = step.nearest,
                  .clearance_m = *step.clearance_m,
                  .planned_m = planned->second};
  }
}

}  // namespace

std::vector<WayFault> checkWays(const Scene& scene, const Progress& progress,
                                const std::map<std::string, double>& planned_clearance_m) {
  const StoppableWork stoppable(progress, "checking the paths");
  const std::vector<DrawnPart> drawn = drawnParts(scene);
  const std::vector<PlacedSurface> placed = placedSurfaces(drawn, progress);
  std::vector<WayFault> of_step(scene.steps.size());
  forEachOnCores(scene.steps.size(), progress, "checking the paths",
                 [&](std::size_t i) { of_step[i] = faultOf(scene, placed, i); });
  if (!planned_clearance_m.empty()) addLostClearances(scene, placed, planned_clearance_m, progress, of_step);
  std::erase_if(of_step, [](const WayFault& fault) { return fault.part.empty(); });
  return of_step;
}

}  // namespace vps::scenes
