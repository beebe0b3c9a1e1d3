// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <span>

#include "candidate.h"
#include "primitive.h"

namespace vps {

namespace {

std::size_t limitOf(const VpsBulletSettings& settings, const PointShell& shell) {
  return settings.candidate_limit > 0 ? static_cast<std::size_t>(settings.candidate_limit) : shell.size();
}

}  // namespace

bool RelativeMotion::canTouch(Candidate& c) const {
  const double approach_m = -c.n_W.dot(velocityAt(c.p_W)) * dt_s;
  c.predicted_m = c.distance_m - approach_m;
  // Contact turns the free motion: a part that lands on one edge swings its other edge faster than it fell.
  // So a share of the greatest speed counts in every direction. Half: assumed, it covers a rod struck at one
  // end. The couplings' pull is left out of it: on a part that is pressed home it is large, and contact holds
  // it.
  return c.distance_m <= slack_m + std::max(approach_m, 0.5 * own_speed_m_s * dt_s);
}

std::size_t collectFromMap(const SideView& side, const SideView& other, double cutoff_m,
                           const VpsBulletSettings& settings, std::vector<Candidate>& out,
                           std::size_t& points_tested, QueryMemory* memory) {
  const VpsModels& theirs = other.shape->models();
  const PointShell& shell = *side.shape->models().shell;
  // One buffer a thread, so that pairs do not each hold megabytes; as large as the largest shell so far.
  thread_local ContactSet near(0);
  near.contacts.reserve(shell.size());
  QueryOptions options;
  options.cutoff_m = cutoff_m;
  options.gradient = settings.gradient;
  const Pose X_MP = other.X_WM.inverse() * side.X_WM;
  const QueryResult result = queryContacts(*theirs.map, shell, X_MP, options, near, memory);
  points_tested += result.points_tested;
  const double sign = side.side == 0 ? 1 : -1;  // the field's normal points out of `other`
  // The buffer's capacity depends on what other pairs needed; the limit must not.
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

std::size_t collectFromPrimitive(const SideView& side, const btCollisionShape& primitive, const Pose& X_WS,
                                 double cutoff_m, const VpsBulletSettings& settings,
                                 std::vector<Candidate>& out, std::size_t& points_tested) {
  const PointShell& shell = *side.shape->models().shell;
  const Pose X_SM = X_WS.inverse() * side.X_WM;
  const double sign = side.side == 0 ? 1 : -1;
  std::size_t left_out = 0;
  const std::size_t limit = limitOf(settings, shell);
  for (std::size_t i = 0; i < shell.nodes.size();) {
    const ShellNode& node = shell.nodes[i];
    if (primitiveDistance(primitive, X_SM * node.center).distance_m - node.radius_m > cutoff_m) {
      i = node.skip;
      continue;
    }
    ++i;
    if (!node.is_leaf) continue;
    points_tested += node.count;
    for (std::uint32_t id = node.first; id < node.first + node.count; ++id) {
      const SurfaceDistance at = primitiveDistance(primitive, X_SM * shell.points[id]);
      if (at.distance_m > cutoff_m) continue;
      if (out.size() >= limit) {
        ++left_out;
        continue;
      }
      Candidate c;
      c.p_W = side.X_WM * shell.points[id];
      c.n_W = sign * (X_WS.R * at.n);
      c.distance_m = at.distance_m;
      c.area_m2 = shell.area_m2[id];
      c.id = id;
      c.side = side.side;
      out.push_back(c);
    }
  }
  return left_out;
}

void lookUp(const SideView& side, const SideView& other, const btCollisionShape& theirs,
            const VpsBulletSettings& settings, Candidate& c) {
  const double sign = side.side == 0 ? 1 : -1;
  c.p_W = side.X_WM * side.shape->models().shell->points[c.id];
  const Vec3 p_M = other.X_WM.inverse() * c.p_W;
  SurfaceDistance at;
  if (other.shape) {
    const VoxMap& map = *other.shape->models().map;
    at = {map.distance(p_M), map.normal(p_M, settings.gradient)};
  } else {
    at = primitiveDistance(theirs, p_M);
  }
  c.distance_m = at.distance_m;
  c.n_W = sign * (other.X_WM.R * at.n);
  // Deeper than the band the field knows no way out; the point's own inward normal is what queryContacts
  // gives.
  if (at.n.isZero(0)) c.n_W = sign * (side.X_WM.R * side.shape->models().shell->inward[c.id]);
}

}  // namespace vps
