// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/path_segments.h"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps_scenes/scene/scene_parts.h"

namespace vps::scenes {

namespace {

/// Margin of the device's workspace on each side of a segment, for aim errors and the search for a hole.
/// The values are assumed.
constexpr double kMargin_m = 20e-3, kMargin_rad = 0.1;
/// Poses whose rotations differ by half a turn, within this margin, could be joined in either direction.
constexpr double kHalfTurnMargin_rad = 1e-3;
/// A smaller share of a leg does not become a segment of its own.
constexpr double kLeastShare = 1e-6;
constexpr int kBisections = 40;

Vec3 turnBetween(const Mat3& R_from, const Mat3& R_to) {
  return rotationVector(R_to * R_from.transpose());
}

/// The share of the line from a to b that fits into a box of size size_m together with `box`, which contains
/// a.
double reachOf(const Box& box, const Vec3& size_m, const Vec3& a, const Vec3& b) {
  double share = 1;
  for (int i = 0; i < 3; ++i) {
    const double d_m = b[i] - a[i];
    if (d_m > 0) share = std::min(share, (box.min[i] + size_m[i] - a[i]) / d_m);
    if (d_m < 0) share = std::min(share, (box.max[i] - size_m[i] - a[i]) / d_m);
  }
  return std::clamp(share, 0.0, 1.0);
}

/// Rotations of a segment. The middle is halfway between the two rotations that are farthest apart. All
/// rotations lie within radius_rad() of the middle, and so do rotations between two of them, since a ball of
/// less than a quarter turn is convex.
class Turns {
 public:
  void add(const Mat3& R) {
    all_.push_back(R);
    for (const Mat3& other : all_)
      if (const double apart_rad = turnBetween(other, R).norm(); apart_rad > apart_rad_) {
        apart_rad_ = apart_rad;
        middle_ = interpolate(Pose(other, Vec3(Vec3::Zero())), Pose(R, Vec3(Vec3::Zero())), 0.5).R;
      }
  }
  [[nodiscard]] double radius_rad() const {
    double radius_rad = 0;
    if (apart_rad_ > kRounding_rad)
      for (const Mat3& R : all_) radius_rad = std::max(radius_rad, turnBetween(middle_, R).norm());
    return radius_rad;
  }
  /// The handle's rotation when the grasp frame has rotation R, if the handle's rotation is the identity at
  /// the middle.
  [[nodiscard]] Mat3 handleAt(const Mat3& R) const {
    return apart_rad_ > kRounding_rad ? Mat3(R * middle_.transpose()) : Mat3(Mat3::Identity());
  }

 private:
  std::vector<Mat3> all_;
  static constexpr double kRounding_rad = 1e-9;  // rotations closer than kRounding_rad are equal
  double apart_rad_ = kRounding_rad;
  Mat3 middle_ = Mat3::Identity();
};

/// The share of the rotation from one pose to the next that fits together with `turns`.
double turnReachOf(const Turns& turns, double limit_rad, const Pose& X_from, const Pose& X_to) {
  const auto fits = [&](double share) {
    Turns more = turns;
    more.add(interpolate(X_from, X_to, share).R);
    return more.radius_rad() <= limit_rad;
  };
  if (limit_rad <= 0 || fits(1)) return 1;
  double least = 0, most = 1;
  for (int i = 0; i < kBisections; ++i) {
    const double share = 0.5 * (least + most);
    (fits(share) ? least : most) = share;
  }
  return least;
}

/// Positions and rotations of one segment.
struct Covered {
  Box box;
  Turns turns;
  void add(const Pose& X) {
    box.add(X.p);
    turns.add(X.R);
  }
};

/// The path of the grasp frame G, which the handle follows. The handle's path is shorter by the device's
/// scale.
struct GraspPath {
  std::vector<Pose> X_WG;
  std::vector<bool> is_index_point;
};

/// Splits the path from the target backwards, each segment as long as possible.
GraspPath inSegments(const std::vector<Pose>& X_WG, const Workspace& workspace_W) {
  GraspPath path{{X_WG.back()}, {false}};  // in reverse order until this function ends
  Covered covered;
  covered.add(X_WG.back());
  for (std::size_t i = X_WG.size() - 1; i-- > 0;) {
    const Pose X_goal = X_WG[i];
    for (;;) {
      const Pose X_at = path.X_WG.back();
      const double share = std::min(reachOf(covered.box, workspace_W.size_m, X_at.p, X_goal.p),
                                    turnReachOf(covered.turns, workspace_W.turn_rad, X_at, X_goal));
      if (share >= 1) break;
      if (share > kLeastShare) {
        path.X_WG.push_back(interpolate(X_at, X_goal, share));
        path.is_index_point.push_back(true);
      } else {
        path.is_index_point.back() = true;  // the workspace ends at a way point
      }
      covered = Covered{};
      covered.add(path.X_WG.back());
    }
    path.X_WG.push_back(X_goal);
    path.is_index_point.push_back(false);
    covered.add(X_goal);
  }
  std::reverse(path.X_WG.begin(), path.X_WG.end());
  std::reverse(path.is_index_point.begin(), path.is_index_point.end());
  return path;
}

[[noreturn]] void refuse(const Scene& scene, const SceneStep& step, const std::string& words) {
  throw LoadError(scene.file, scene.parts[step.part].part.name, words);
}

constexpr const char* kIndexingRemedy =
    "let the hand re-grasp the part along the path ([device] indexing = true)";

[[noreturn]] void refuseLength(const Scene& scene, const SceneStep& step, const Vec3& needed_m,
                               const Vec3& workspace_m) {
  char words[240];
  std::snprintf(words, sizeof words,
                "its path is longer than the device's workspace of %.0f x %.0f x %.0f mm; start nearer, set "
                "[device] scale above %f, or %s",
                1e3 * workspace_m.x(), 1e3 * workspace_m.y(), 1e3 * workspace_m.z(),
                scene.device.scale * (needed_m.array() / workspace_m.array()).maxCoeff(), kIndexingRemedy);
  refuse(scene, step, words);
}

constexpr double inDegrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

[[noreturn]] void refuseTurn(const Scene& scene, const SceneStep& step, double needed_rad, double limit_rad) {
  char words[240];
  std::snprintf(
      words, sizeof words,
      "its path turns the part by %.0f degrees to each side, but the device's handle turns by %.0f; turn the "
      "part less, or %s",
      inDegrees(needed_rad), inDegrees(limit_rad), kIndexingRemedy);
  refuse(scene, step, words);
}

/// Refuses two poses half a turn apart, since the direction of the turn is not defined.
void requireDirections(const Scene& scene, const SceneStep& step, const std::vector<Pose>& X_WG) {
  for (std::size_t i = 1; i < X_WG.size(); ++i)
    if (turnBetween(X_WG[i - 1].R, X_WG[i].R).norm() > std::numbers::pi - kHalfTurnMargin_rad)
      refuse(
          scene, step,
          "its path has two poses half a turn apart, so that the hand cannot know which way to turn; add a "
          "way point between them");
}

/// Adds the handle's pose at the start of each segment.
PathSegments withHandle(const GraspPath& path, const Pose& X_GP, double scale) {
  PathSegments segments;
  Covered segment;
  Pose X_from = path.X_WG.front();
  const auto endSegment = [&](const Pose& X_next) {
    segments.X_DH_start.emplace_back(segment.turns.handleAt(X_from.R),
                                     Vec3((X_from.p - segment.box.center()) / scale));
    X_from = X_next;
    segment = Covered{};
    segment.add(X_next);
  };
  for (std::size_t i = 0; i < path.X_WG.size(); ++i) {
    const Pose& X = path.X_WG[i];
    segment.add(X);
    if (i > 0 && i + 1 < path.X_WG.size()) segments.way_points.push_back(X * X_GP);
    if (!path.is_index_point[i]) continue;
    segments.index_points.push_back(segments.way_points.size() - 1);
    endSegment(X);
  }
  endSegment(X_from);
  return segments;
}

/// splitPath() for a device whose axes are parallel to the world's.
PathSegments splitAlongAxes(const Scene& scene, const SceneStep& step, const Workspace& workspace) {
  const double scale = scene.device.scale;
  const Pose X_PG = Pose::translation(partMass(scene.parts[step.part]).com);
  std::vector<Pose> X_WG = {step.X_WP_start * X_PG};
  for (const Pose& X_WP : step.way_points) X_WG.push_back(X_WP * X_PG);
  X_WG.push_back(step.X_WP_target * X_PG);
  requireDirections(scene, step, X_WG);

  Covered all;
  for (const Pose& X : X_WG) all.add(X);
  const Vec3 needed_m = all.box.size() / scale;
  const bool is_too_long = (needed_m.array() > workspace.size_m.array()).any();
  const double most_rad = turnRange_rad(workspace.turn_rad), needed_rad = all.turns.radius_rad();
  const bool turns_too_far = workspace.turn_rad > 0 && needed_rad > most_rad;
  if (is_too_long || turns_too_far) {
    if (!scene.device.has_indexing && is_too_long) refuseLength(scene, step, needed_m, workspace.size_m);
    if (!scene.device.has_indexing) refuseTurn(scene, step, needed_rad, most_rad);
    const Vec3 margin_m = (workspace.size_m / 10).cwiseMin(kMargin_m);
    const Workspace inner_W{scale * (workspace.size_m - 2 * margin_m), workspace.turn_rad > 0 ? most_rad : 0};
    return withHandle(inSegments(X_WG, inner_W), X_PG.inverse(), scale);
  }
  PathSegments one = withHandle({X_WG, std::vector<bool>(X_WG.size(), false)}, X_PG.inverse(), scale);
  one.way_points = step.way_points;  // way points with unchanged bits
  return one;
}

}  // namespace

double turnRange_rad(double handle_rad) {
  return handle_rad - std::min(kMargin_rad, handle_rad / 5);
}

PathSegments splitPath(const Scene& scene, const SceneStep& step, const Workspace& workspace) {
  if (!scene.device.placement) return splitAlongAxes(scene, step, workspace);
  // The path is split in the device's axes, in which the workspace is a box.
  const Pose X_DW(Mat3(scene.device.placement->R.transpose()), Vec3(Vec3::Zero()));
  SceneStep turned = step;
  for (Pose* X : {&turned.X_WP_start, &turned.X_WP_target}) *X = X_DW * *X;
  for (Pose& X : turned.way_points) X = X_DW * X;
  PathSegments segments = splitAlongAxes(scene, turned, workspace);
  for (Pose& X : segments.way_points) X = X_DW.inverse() * X;
  return segments;
}

PathSegments withoutPassed(const PathSegments& segments, std::size_t passed) {
  PathSegments ahead;
  const auto isIndexPoint = [&](std::size_t i) {
    return std::find(segments.index_points.begin(), segments.index_points.end(), i) !=
           segments.index_points.end();
  };
  std::size_t segment = 0;
  for (std::size_t i = 0; i < segments.way_points.size(); ++i) {
    const bool is_index_point = isIndexPoint(i);
    if (passed > 0) {
      if (is_index_point)
        ++segment;
      else
        --passed;
      continue;
    }
    if (is_index_point) ahead.index_points.push_back(ahead.way_points.size());
    ahead.way_points.push_back(segments.way_points[i]);
  }
  ahead.X_DH_start.assign(segments.X_DH_start.begin() + static_cast<std::ptrdiff_t>(segment),
                          segments.X_DH_start.end());
  return ahead;
}

}  // namespace vps::scenes
