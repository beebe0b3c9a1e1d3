// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/candidates/same_places.h"
#include "narrowphase/refinement/curved_contact.h"
#include "narrowphase/refinement/surface_view.h"
#include "native_shapes/native_shape.h"
#include "native_shapes/native_shape_adapter.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// Greatest cell of merged groups, as a share of the smaller body's radius. Assumed.
constexpr double kMostCellShare = 0.5;

std::size_t limitOf(const Settings& settings, const PointShell& shell) {
  return settings.candidate_limit > 0 ? static_cast<std::size_t>(settings.candidate_limit) : shell.size();
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
      c.surface[c.side] = side.shape->surfaceAt(id);
      c.surface[1 - c.side] = surface.surface;
      out.push_back(c);
    }
  }
  return left_out;
}

// Where a ball touches a face, all points of the face around the contact move to it; only the point that
// moved least is kept. Points that neither touch nor move are dropped.
void mergeOnRound(const SideView& side, const SideView& other, const btCollisionShape& primitive,
                  double cutoff_m, std::vector<Candidate>& out, std::size_t first) {
  struct Moved {
    std::size_t index;
    double way_m;
  };
  thread_local std::vector<Moved> moved;
  thread_local SamePlaces places;
  moved.clear();
  places.clear(out.size() - first);
  std::size_t kept = first;
  for (std::size_t i = first; i < out.size(); ++i) {
    Candidate c = out[i];
    const bool is_moved = refineOnRound(c, side, other, primitive);
    if (c.distance_m > cutoff_m) continue;
    if (is_moved) {
      const double way_m = (c.p_W - out[i].p_W).norm();
      const std::uint32_t same = places.find(c.p_W, [&](std::uint32_t m) {
        return (out[moved[m].index].p_W - c.p_W).squaredNorm() < kSamePlace_m * kSamePlace_m;
      });
      if (same != SamePlaces::kNone) {
        if (way_m < moved[same].way_m) {
          out[moved[same].index] = c;
          moved[same].way_m = way_m;
          places.add(c.p_W, same);
        }
        continue;
      }
      places.add(c.p_W, static_cast<std::uint32_t>(moved.size()));
      moved.push_back({kept, way_m});
    }
    out[kept++] = c;
  }
  out.resize(kept);
}

// Converts a twist about W's origin, in W, to one about M's origin, in M.
Twist aboutMap(const Twist& V_W, const Pose& X_MW) {
  const Vec3 p_WM = -(X_MW.R.transpose() * X_MW.p);
  return {X_MW.R * V_W.w, X_MW.R * (V_W.v + V_W.w.cross(p_WM))};
}

}  // namespace

bool RelativeMotion::canTouch(Candidate& c) const {
  const double approach_m = -c.n_W.dot(velocityAt(c.p_W)) * dt_s;
  c.predicted_m = c.distance_m - approach_m;
  // Contact changes the free motion: a part that lands on one edge swings its other edge faster than it fell.
  // Half of the greatest speed is therefore assumed in every direction, which covers a rod struck at one end.
  // The pull of couplings is not included: it is large on a part that is pressed against its seat, and
  // contact balances it.
  return c.distance_m <= contact_margin_m + std::max(approach_m, anyWay_m());
}

Candidate candidateOf(const Contact& contact, const SideView& side, const SideView& other) {
  const double sign = side.side == 0 ? 1 : -1;  // the field's normal points out of `other`
  Candidate c;
  c.p_W = other.X_WM * contact.p_M;
  c.n_W = sign * (other.X_WM.R * contact.n_M);
  c.distance_m = contact.distance_m;
  c.area_m2 = contact.area_m2;
  c.id = contact.id;
  c.side = side.side;
  c.surface[c.side] = side.shape->surfaceAt(c.id);
  c.surface[1 - c.side] = contact.owner;
  return c;
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
  const RepresentativePoints::Request leaders{options,
                                              aboutMap(query.step_W, X_MW),
                                              query.always,
                                              smallQueryLimit(settings),
                                              refinedLimit(settings),
                                              kMostCellShare * query.radius_m};
  if (!query.state || !query.state->leading) {
    points_tested += queryContacts(*theirs.map, shell, X_MP, options, near, memory).points_tested;
    if (query.state && needsLeading(near.contacts.size(), shell, settings))
      query.state->lead(shell, side.shape->edgePoints(), query.radius_m);
  }
  if (query.state && query.state->leading)
    points_tested += query.state->leading->find(*theirs.map, X_MP, leaders, near, memory).points_tested;
  // The number of candidates is limited to limitOf(), not to the buffer's capacity, which depends on other
  // pairs.
  const std::size_t count = std::min(near.contacts.size(), limitOf(settings, shell));
  for (const Contact& contact : std::span(near.contacts).first(count))
    out.push_back(candidateOf(contact, side, other));
  if (query.state && query.state->leading) {
    const auto surfaces = query.state->leading->surfaces();
    for (std::size_t i = 0; i < std::min(count, surfaces.size()); ++i) {
      Candidate& c = out[out.size() - count + i];
      c.area_m2 = surfaces[i].area_m2;
      c.area_off_W = side.X_WM * surfaces[i].center - c.p_W;
      c.area_spread = (side.X_WM.R * surfaces[i].spread * side.X_WM.R.transpose()).cast<float>();
    }
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
  const double reach_m = isExact(settings) ? roundReach_m(exact, shell.spacing_m) : 0;
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

namespace {

// A surface tile has four by four points, so that more tiles than contacts are near when smallQueryLimit() is
// exceeded.
constexpr std::size_t kTilePoints = 16;
constexpr double kTileSpacings = 6;  // diagonal of a tile and a margin, in spacings
// Tiles of a dense shell are larger: three of reduceByCell()'s cells. The tile size does not depend on the
// number of points, since contact must not change when the shell is cropped.
constexpr double kTileShare = 0.18;  // share of the smaller body's radius

}  // namespace

void QueryState::lead(const PointShell& shell, std::span<const std::uint8_t> on_edge, double radius_m) {
  leading.emplace(shell, std::max(kTileSpacings * shell.spacing_m, kTileShare * radius_m), on_edge);
}

// Penalty contact needs every point; rigid contact needs a few.
bool needsLeading(std::size_t near_points, const PointShell& shell, const Settings& settings) {
  return settings.contact_method == ContactMethod::Constraint && near_points > smallQueryLimit(settings) &&
         shell.spacing_m > 0;
}

std::size_t refinedLimit(const Settings& settings) {
  return 4 * static_cast<std::size_t>(settings.contact_limit);
}

std::size_t smallQueryLimit(const Settings& settings) {
  return kTilePoints * static_cast<std::size_t>(settings.contact_limit);
}

}  // namespace vps::bullet
