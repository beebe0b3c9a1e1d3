// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/query_state.h"
#include "narrowphase/round_contact.h"
#include "native_shapes/native_shape_adapter.h"
#include "native_shapes/primitive.h"
#include "shape/sheet_border.h"

namespace vps::bullet::inline v0 {

namespace {

std::size_t limitOf(const Settings& settings, const PointShell& shell) {
  return settings.candidate_limit > 0 ? static_cast<std::size_t>(settings.candidate_limit) : shell.size();
}

// A penalty point must stay where its area is.
bool refinesOnRounds(const Settings& settings) {
  return settings.use_surfaces && settings.contact_method == ContactMethod::Constraint;
}

// Finds a shell's points near anything with a distance function, by the hierarchy of bounding spheres.
template <typename CanBeNear, typename At>
std::size_t findByDistance(const SideView& side, const Pose& X_WS, double cutoff_m, const Settings& settings,
                           const CanBeNear& canBeNear, const At& at, std::vector<Candidate>& out,
                           std::size_t& points_tested) {
  const PointShell& shell = *side.shape->models().shell;
  const double sign = side.side == 0 ? 1 : -1;
  const std::size_t limit = limitOf(settings, shell);
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < shell.nodes.size();) {
    const ShellNode& node = shell.nodes[i];
    if (!canBeNear(node)) {
      i = node.skip;
      continue;
    }
    ++i;
    if (!node.is_leaf) continue;
    points_tested += node.count;
    for (std::uint32_t id = node.first; id < node.first + node.count; ++id) {
      const SurfaceDistance surface = at(id);
      if (surface.distance_m > cutoff_m) continue;
      if (out.size() >= limit) {
        ++left_out;
        continue;
      }
      Candidate c;
      c.p_W = side.X_WM * shell.points[id];
      c.n_W = sign * (X_WS.R * surface.n);
      c.distance_m = surface.distance_m;
      c.area_m2 = shell.area_m2[id];
      c.id = id;
      c.side = side.side;
      out.push_back(c);
    }
  }
  return left_out;
}

// All points around the place where a ball touches a face move there; the one that moved least is kept.
// Points that neither touch nor move are dropped.
void mergeOnRound(const SideView& side, const SideView& other, const btCollisionShape& primitive,
                  double cutoff_m, std::vector<Candidate>& out, std::size_t first) {
  struct Moved {
    std::size_t index;
    double way_m;
  };
  thread_local std::vector<Moved> moved;
  moved.clear();
  std::size_t kept = first;
  for (std::size_t i = first; i < out.size(); ++i) {
    Candidate c = out[i];
    const bool is_moved = refineOnRound(c, side, other, primitive);
    if (c.distance_m > cutoff_m) continue;
    if (is_moved) {
      constexpr double kSame_m = 1e-6;
      const double way_m = (c.p_W - out[i].p_W).norm();
      const auto same = std::find_if(moved.begin(), moved.end(), [&](const Moved& m) {
        return (out[m.index].p_W - c.p_W).squaredNorm() < kSame_m * kSame_m;
      });
      if (same != moved.end()) {
        if (way_m < same->way_m) {
          out[same->index] = c;
          same->way_m = way_m;
        }
        continue;
      }
      moved.push_back({kept, way_m});
    }
    out[kept++] = c;
  }
  out.resize(kept);
}

// The same motion about the origin of M, in M.
Twist aboutMap(const Twist& V_W, const Pose& X_MW) {
  const Vec3 p_WM = -(X_MW.R.transpose() * X_MW.p);
  return {X_MW.R * V_W.w, X_MW.R * (V_W.v + V_W.w.cross(p_WM))};
}

/// Distances of points of `side` (in its models' frame M) from the surfaces of `other` (in its frame N).
class SurfaceView {
 public:
  SurfaceView(const SideView& side, const SideView& other)
      : side_(side),
        surfaces_(other.shape->models().surfaces),
        known_(surfaces_.size()),
        X_NM_(other.X_WM.inverse() * side.X_WM) {}

  /// Lower bound of the distance of p; max_m if p is farther, or deep behind a sheet.
  [[nodiscard]] double leastDistance(const Vec3& p_M, double max_m) {
    double least_m = max_m;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      const Vec3 p = surfaces_[i].X_MP.inverse() * (X_NM_ * p_M);
      least_m = std::min(least_m, surfaces_[i].sheet ? sheetBound(surfaces_[i], p, max_m)
                                                     : solidDistance(surfaces_[i], p, max_m, known_[i]));
    }
    return least_m;
  }

  /// Distance and normal in N of the nearest surface; kNever_m beyond cutoff_m.
  [[nodiscard]] SurfaceDistance at(const Vec3& p_M, const Vec3& inward_M, double cutoff_m) const {
    SurfaceDistance nearest{kNever_m, Vec3::Zero()};
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      const SurfaceDistance d = surfaces_[i].sheet ? atSheet(surfaces_[i], p_M, inward_M, cutoff_m)
                                                   : atSolid(surfaces_[i], p_M, cutoff_m, known_[i]);
      if (d.distance_m < nearest.distance_m) nearest = d;
    }
    return nearest;
  }

 private:
  static constexpr double kNever_m = 1e30;

  /// The last distance from a solid that was computed for a node of the shell: of p, at q.
  struct Known {
    Vec3 p = Vec3::Zero(), q = Vec3::Zero();
    double distance_m = 0;
    bool is_set = false;
  };

  // How far the nearest surface can be from p, since q is a point of it; where p must lie outside, no farther
  // than matters. Inside a solid every depth counts, so the sign is needed at any distance. A search
  // without a limit would be long where much of the surface is about equally far. 0: p is outside and beyond
  // max_m. With a winding number the sign may change off the surface, at holes.
  static double searchLimit_m(const Surface& surface, const Vec3& p, double max_m, const Known& known) {
    constexpr double kRounding = 1 + 1e-9, kLeast_m = 1e-12;
    if (!known.is_set) return 1e300;
    const double way_m = (p - known.p).norm();
    const double limit_m = (p - known.q).norm() * kRounding + kLeast_m;
    if (surface.distance->isByWinding() || known.distance_m <= way_m * kRounding + kLeast_m) return limit_m;
    if (known.distance_m - way_m * kRounding - kLeast_m > max_m) return 0;
    return std::min(limit_m, std::max(max_m, 0.0) * kRounding + kLeast_m);
  }

  // max_m if p is farther.
  static double solidDistance(const Surface& surface, const Vec3& p, double max_m, Known& known) {
    const double limit_m = searchLimit_m(surface, p, max_m, known);
    if (limit_m == 0) return max_m;
    const Solid::Closest closest = surface.distance->closest(p, limit_m);
    if (!closest.found) return max_m;
    const double sign = closest.normal.dot(p - closest.q) < 0 ? -1 : 1;
    known = {p, closest.q, sign * closest.distance_m, true};
    return known.distance_m;
  }

  // Greatest depth behind a sheet at which a point counts: as far as its part's field can measure.
  [[nodiscard]] double depthBehindSheets_m() const {
    const VoxMap* map = side_.shape->models().map.get();
    return map ? 2 * map->band_m() : 0.5 * side_.shape->models().shell->spacing_m;
  }

  [[nodiscard]] double sheetBound(const Surface& surface, const Vec3& p, double max_m) const {
    const double reach_m = max_m + depthBehindSheets_m();
    const MeshDistance::Closest closest = surface.distance->closest(p, reach_m);
    return closest.found ? closest.distance_m - depthBehindSheets_m() : max_m;
  }

  static SurfaceDistance make(const MeshDistance::Closest& closest, const Vec3& p, const Vec3& normal,
                              const Surface& surface) {
    const double sign = normal.dot(p - closest.q) < 0 ? -1 : 1;
    constexpr double kTouching_m = 1e-9;  // too short to be a direction
    const Vec3 n =
        closest.distance_m > kTouching_m ? Vec3(sign / closest.distance_m * (p - closest.q)) : normal;
    return {sign * closest.distance_m, surface.X_MP.R * n};
  }

  [[nodiscard]] SurfaceDistance atSolid(const Surface& surface, const Vec3& p_M, double cutoff_m,
                                        const Known& known) const {
    const SurfaceDistance never{kNever_m, Vec3::Zero()};
    const Vec3 p = surface.X_MP.inverse() * (X_NM_ * p_M);
    const double limit_m = searchLimit_m(surface, p, cutoff_m, known);
    if (limit_m == 0) return never;
    const Solid::Closest closest = surface.distance->closest(p, limit_m);
    return closest.found ? make(closest, p, closest.normal, surface) : never;
  }

  [[nodiscard]] SurfaceDistance atSheet(const Surface& surface, const Vec3& p_M, const Vec3& inward_M,
                                        double cutoff_m) const {
    const SurfaceDistance never{kNever_m, Vec3::Zero()};
    const Pose X_PM = surface.X_MP.inverse() * X_NM_;
    const Vec3 p = X_PM * p_M, inward = X_PM.R * inward_M;
    const MeshDistance::Closest closest =
        surface.distance->closest(p, std::max(cutoff_m, depthBehindSheets_m()));
    if (!closest.found) return never;
    const SheetFoot foot = surface.sheet->seenFrom(p, inward, closest);
    const Vec3 normal = foot.normal;
    // Where the point looks nearly along the sheet, its side depends on rounding; such points do not touch.
    constexpr double kEdgeOn = 0.05;
    if (inward.dot(normal) < kEdgeOn) return never;
    const SurfaceDistance d = make(closest, p, normal, surface);
    return d.distance_m < 0 && !hasEnteredBy(-d.distance_m, X_PM.inverse() * closest.q) ? never : d;
  }

  // A face that looks at a sheet from a wall's thickness above has not passed through it from below: the
  // sheet is then nearer to the wall's other face. The part's own field tells, with an error of half a voxel
  // at its edges.
  [[nodiscard]] bool hasEnteredBy(double depth_m, const Vec3& q_M) const {
    const VoxMap* map = side_.shape->models().map.get();
    return !map || 0.5 * map->voxel_m() - map->distance(q_M) >= 0.5 * depth_m;
  }

  const SideView& side_;
  const std::vector<Surface>& surfaces_;
  std::vector<Known> known_;  // by surface
  Pose X_NM_;
};

}  // namespace

bool RelativeMotion::canTouch(Candidate& c) const {
  const double approach_m = -c.n_W.dot(velocityAt(c.p_W)) * dt_s;
  c.predicted_m = c.distance_m - approach_m;
  // Contact changes the free motion: a part that lands on one edge swings its other edge faster than it fell.
  // So a share of the greatest speed counts in every direction. Half: assumed; it covers a rod struck at one
  // end. The pull of couplings is not included: on a part that is pressed against its seat it is large, and
  // contact balances it.
  return c.distance_m <= contact_margin_m + std::max(approach_m, anyWay_m());
}

std::size_t findMapCandidates(const SideView& side, const SideView& other, double cutoff_m,
                              const Settings& settings, const SideQuery& query, std::vector<Candidate>& out,
                              std::size_t& points_tested) {
  const ShapeModels& theirs = other.shape->models();
  const PointShell& shell = *side.shape->models().shell;
  // One buffer for each thread, as large as the largest shell so far, instead of megabytes for each pair.
  thread_local ContactSet near(0);
  near.contacts.reserve(shell.size());
  QueryOptions options;
  options.cutoff_m = cutoff_m;
  options.gradient = settings.gradient;
  const Pose X_MW = other.X_WM.inverse(), X_MP = X_MW * side.X_WM;
  QueryMemory* memory = query.state ? &query.state->query : nullptr;
  const RepresentativePoints::Request leaders{options, aboutMap(query.step_W, X_MW), query.always,
                                              smallQueryLimit(settings)};
  if (!query.state || !query.state->leading) {
    points_tested += queryContacts(*theirs.map, shell, X_MP, options, near, memory).points_tested;
    if (query.state && needsLeading(near.contacts.size(), shell, settings))
      query.state->lead(shell, settings);
  }
  if (query.state && query.state->leading)
    points_tested += query.state->leading->find(*theirs.map, X_MP, leaders, near, memory).points_tested;
  const double sign = side.side == 0 ? 1 : -1;  // the field's normal points out of `other`
  // The buffer's capacity depends on other pairs; the limit must not.
  const std::size_t count = std::min(near.contacts.size(), limitOf(settings, shell));
  for (const Contact& contact : std::span(near.contacts).first(count)) {
    Candidate c;
    c.p_W = other.X_WM * contact.p_M;
    c.n_W = sign * (other.X_WM.R * contact.n_M);
    c.distance_m = contact.distance_m;
    c.area_m2 = contact.area_m2;
    c.id = contact.id;
    c.owner = contact.owner;
    c.side = side.side;
    out.push_back(c);
  }
  return near.contacts.size() - count;
}

std::size_t findPrimitiveCandidates(const SideView& side, const btCollisionShape& primitive, const Pose& X_WS,
                                    double cutoff_m, const Settings& settings, std::vector<Candidate>& out,
                                    std::size_t& points_tested) {
  const btCollisionShape& exact = unwrapped(primitive);
  const SideView other{nullptr, X_WS, static_cast<std::uint8_t>(1 - side.side)};
  const Pose X_SM = X_WS.inverse() * side.X_WM;
  const PointShell& shell = *side.shape->models().shell;
  const double reach_m = refinesOnRounds(settings) ? roundReach_m(exact, shell.spacing_m) : 0;
  const auto at = [&](std::uint32_t id) { return primitiveDistance(exact, X_SM * shell.points[id]); };
  const auto canBeNear = [&](const ShellNode& node) {
    return primitiveDistance(exact, X_SM * node.center).distance_m - node.radius_m <= cutoff_m + reach_m;
  };
  const std::size_t first = out.size();
  const std::size_t left_out =
      findByDistance(side, X_WS, cutoff_m + reach_m, settings, canBeNear, at, out, points_tested);
  if (reach_m > 0) mergeOnRound(side, other, exact, cutoff_m, out, first);
  return left_out;
}

std::size_t findSurfaceCandidates(const SideView& side, const SideView& other, double cutoff_m,
                                  const Settings& settings, std::vector<Candidate>& out,
                                  std::size_t& points_tested) {
  if (other.shape->models().surfaces.empty()) return 0;
  SurfaceView view(side, other);
  const PointShell& shell = *side.shape->models().shell;
  const auto at = [&](std::uint32_t id) { return view.at(shell.points[id], shell.inward[id], cutoff_m); };
  const auto canBeNear = [&](const ShellNode& node) {
    return view.leastDistance(node.center, node.radius_m + cutoff_m) - node.radius_m <= cutoff_m;
  };
  return findByDistance(side, other.X_WM, cutoff_m, settings, canBeNear, at, out, points_tested);
}

}  // namespace vps::bullet::inline v0
