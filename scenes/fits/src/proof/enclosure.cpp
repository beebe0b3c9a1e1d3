// SPDX-License-Identifier: BSD-3-Clause
#include "proof/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "pair/pair_measures.h"
#include "vps/mesh_overlap.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

namespace {

constexpr double kMostSpan_rad = 0.5;

/// The faces of a growing box of motions.
class GrowingBox {
 public:
  GrowingBox(const PartSurface& part, const Pose& X_WP, std::span<const Obstacle> obstacles, const Vec3& at_W,
             bool is_round, std::size_t most_work)
      : part_(part),
        X_WP_(X_WP),
        obstacles_(obstacles),
        at_W_(at_W),
        axes_(is_round ? 5 : 6),
        most_work_(most_work) {
    double size_m = part.box().size().norm(), error_m = 0;
    for (const Obstacle& obstacle : obstacles) {
      error_m = std::max(error_m, obstacle.error_m);
      size_m = std::max(size_m, obstacle.surface->box().size().norm());
    }
    // Small enough for a tight fit, and still larger than the overlap that does not count.
    constexpr double kStart = 1e-3;
    const double start_m = std::max(kStart * part.box().size().norm(), 4 * error_m);
    arm_m_ = 0.5 * part.box().size().norm();
    for (int k = 0; k < axes_; ++k) {
      out_.high[k] = k < 3 ? start_m : std::min(start_m / arm_m_, 0.5 * kMostSpan_rad);
      out_.low[k] = -out_.high[k];
    }
    most_m_ = part.box().size().norm() + size_m;
  }

  Enclosure prove() {
    // At first a little work for each face finds most of the free poses.
    for (const std::size_t each : {most_work_ / 200, most_work_}) {
      bool is_grown = true;
      while (is_grown) {
        is_grown = false;
        bool is_whole = true;
        for (int face = 0; face < 2 * axes_; ++face) {
          const std::size_t left = most_work_ - std::min(out_.work, most_work_);
          if (left == 0) return out_;
          const PoseCover cover = coverPoses(part_, X_WP_, obstacles_, setOf(face), std::min(left, each));
          out_.work += cover.work;
          if (cover.is_proven) continue;
          is_whole = false;
          if (!cover.free) {
            if (each == most_work_) return out_;
            continue;
          }
          is_grown = true;
          if (!grow(face)) return out_;
        }
        if (is_whole) {
          out_.is_proven = true;
          return out_;
        }
      }
    }
    return out_;
  }

 private:
  [[nodiscard]] PoseSet setOf(int face) const {
    const int axis = face / 2;
    PoseSet set;
    set.at_W = at_W_;
    set.center = 0.5 * (out_.low + out_.high);
    set.half = 0.5 * (out_.high - out_.low);
    set.center[axis] = face % 2 == 0 ? out_.low[axis] : out_.high[axis];
    set.half[axis] = 0;
    return set;
  }

  bool grow(int face) {
    constexpr double kGrowth = 1.6;
    const int axis = face / 2;
    double& edge = face % 2 == 0 ? out_.low[axis] : out_.high[axis];
    edge *= kGrowth;
    return std::abs(edge) <= (axis < 3 ? most_m_ : kMostSpan_rad);
  }

  const PartSurface& part_;
  Pose X_WP_;
  std::span<const Obstacle> obstacles_;
  Vec3 at_W_;
  int axes_;
  std::size_t most_work_;
  double arm_m_ = 0, most_m_ = 0;
  Enclosure out_;
};

/// An axis in the part's frame about which a part is round, and how far it is from being round.
struct RoundAxis {
  Vec3 axis = Vec3::UnitZ(), p = Vec3::Zero();
  double off_m = 0;
};

/// Measures how far a part is from being round about the axis of its largest round face, by the shadow of its
/// facets on a half-plane with the coordinates r (distance from the axis) and z (along the axis). A ring (r,
/// z) outside all shadows meets no facet, so the whole ring is inside the part or outside. All that a turn
/// can change thus lies in the shadows. A facet across whose corners the axis is seen under the angle a, and
/// whose corners' (r, z) lie within `across` of a line, has its shadow within across + r (1 - cos(a / 2)) of
/// this line, since r is a convex function of the facet's points and at least the mean of the corners' r
/// times cos(a / 2). Walls along the axis have wide shadows.
std::optional<RoundAxis> roundAxisOf(const PartSurface& part, double most_off_m) {
  const RoundFace* largest = nullptr;
  const auto area = [](const RoundFace& face) { return face.radius_m * (face.to_m - face.from_m); };
  for (const RoundFace& face : part.round())
    if (largest == nullptr || area(face) > area(*largest)) largest = &face;
  if (largest == nullptr) return {};
  RoundAxis out{largest->axis, largest->p, 0};
  constexpr double kOnAxis_m = 1e-9, kAlong = 1e-12;
  for (std::uint32_t i = 0; i < part.mesh().triangles.size(); ++i) {
    std::array<Eigen::Vector2d, 3> shadow;
    std::array<Vec3, 3> out_of_axis;
    double most_r_m = 0, least_cos = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 r = part.triangle(i)[k] - out.p;
      out_of_axis[k] = r - out.axis.dot(r) * out.axis;
      shadow[k] = {out_of_axis[k].norm(), out.axis.dot(r)};
      most_r_m = std::max(most_r_m, shadow[k].x());
    }
    double across_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
      const Eigen::Vector2d edge = shadow[next] - shadow[k], side = shadow[last] - shadow[k];
      const double length_m = edge.norm();
      const double off_m =
          length_m > 0 ? std::abs(edge.x() * side.y() - edge.y() * side.x()) / length_m : side.norm();
      across_m = std::min(across_m, off_m);
      if (shadow[k].x() > kOnAxis_m && shadow[next].x() > kOnAxis_m)
        least_cos =
            std::min(least_cos, out_of_axis[k].dot(out_of_axis[next]) / (shadow[k].x() * shadow[next].x()));
    }
    // The shadow of a facet across the axis is a piece of one line z. Corners on all sides of the axis are
    // seen under 120 degrees at least, so that dip_m is half of r and the part is not round.
    const bool is_across = std::abs(part.normal(i).dot(out.axis)) > 1 - kAlong;
    const double dip_m =
        is_across ? 0 : most_r_m * (1 - std::sqrt(0.5 * (1 + std::clamp(least_cos, -1.0, 1.0))));
    out.off_m = std::max(out.off_m, 2 * (across_m + dip_m));
    if (out.off_m > most_off_m) return {};
  }
  return out;
}

}  // namespace

Enclosure enclosureOf(const PartSurface& part, const Pose& X_WP, std::span<const Obstacle> obstacles,
                      const Vec3& at_W, const Vec3& round_axis_W, std::size_t most_work) {
  const bool is_round = round_axis_W.norm() > 0;
  if (!is_round) return GrowingBox(part, X_WP, obstacles, at_W, false, most_work).prove();
  // A frame with its third axis along the axis of the round part, whose last number stays zero.
  const Vec3 x = round_axis_W.unitOrthogonal();
  Mat3 R_WF;
  R_WF << x, round_axis_W.cross(x), round_axis_W;
  const Pose X_FW(Mat3(R_WF.transpose()), Vec3::Zero());
  std::vector<Obstacle> turned(obstacles.begin(), obstacles.end());
  for (Obstacle& obstacle : turned) obstacle.X_WP = X_FW * obstacle.X_WP;
  return GrowingBox(part, X_FW * X_WP, turned, X_FW * at_W, true, most_work).prove();
}

Enclosure enclosureOfPair(const PlacedSurface& a, const PlacedSurface& b, std::size_t most_work) {
  const PlacedSurface *part = &a, *other = &b;
  double error_m = meshError_m(a, b) + kContactDepth_m;
  if (a.drawn->allow_overlap || b.drawn->allow_overlap) return {};
  error_m += std::max(a.drawn->press_fit_m, b.drawn->press_fit_m);
  const double drawn_m = deepestOverlap(a.surface->overlap(), a.X_WP, b.surface->overlap(), b.X_WP).depth_m;
  if (drawn_m > error_m || !a.surface->isClosed() || !b.surface->isClosed()) return {};
  if (b.surface->box().size().norm() < a.surface->box().size().norm()) std::swap(part, other);
  std::optional<RoundAxis> round = roundAxisOf(*part->surface, error_m);
  if (!round) {
    round = roundAxisOf(*other->surface, error_m);
    if (round) std::swap(part, other);
  }
  if (round) error_m += round->off_m;
  // The rotation is about the middle of the part, or about the nearest point of the axis.
  Vec3 at_P = part->surface->box().center(), axis_W = Vec3::Zero();
  if (round) {
    at_P = round->p + round->axis.dot(at_P - round->p) * round->axis;
    axis_W = part->X_WP.R * round->axis;
  }
  const Obstacle obstacle{other->surface.get(), other->X_WP, error_m};
  return enclosureOf(*part->surface, part->X_WP, std::span(&obstacle, 1), part->X_WP * at_P, axis_W,
                     most_work);
}

}  // namespace vps::scenes
