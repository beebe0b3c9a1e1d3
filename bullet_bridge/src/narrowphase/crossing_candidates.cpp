// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <span>

#include "narrowphase/contact_candidate.h"
#include "vps/edge_crossing.h"

namespace vps::bullet::inline v0 {

namespace {

// A merged body is the union of its parts: an edge that another part covers is not an edge of the body.
// @param out_M  direction out of the body at the edge's point p_M
bool isCovered(const Shape& shape, std::uint16_t owner, const Vec3& p_M, const Vec3& out_M) {
  constexpr double kOff_m = 10e-6;  // assumed: more than the seam between parts mounted on each other
  const std::vector<Surface>& surfaces = shape.models().surfaces;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (i == owner || surfaces[i].sheet) continue;
    const Vec3 p = surfaces[i].X_MP.inverse() * (p_M + kOff_m * out_M);
    if (surfaces[i].distance->signedDistance(p, kOff_m) < 0.5 * kOff_m) return true;
  }
  return false;
}

bool isCovered(const EdgeCrossing& at, const SideView& body0, const SideView& body1, const Pose& X_10) {
  const auto ownerOf = [&](const SideView& body, int k) {
    return body.shape->edges().segments()[at.edge[k]].owner;
  };
  return isCovered(*body0.shape, ownerOf(body0, 0), at.p[0], -at.n) ||
         isCovered(*body1.shape, ownerOf(body1, 1), X_10 * at.p[1], X_10.R * at.n);
}

}  // namespace

std::size_t findCrossingCandidates(const SideView& body0, const SideView& body1, double cutoff_m,
                                   double depth_m, const Settings& settings, std::vector<Candidate>& out) {
  const EdgeSet &edges0 = body0.shape->edges(), &edges1 = body1.shape->edges();
  thread_local std::vector<EdgeCrossing> crossings;
  crossings.clear();
  const Pose X_01 = body0.X_WM.inverse() * body1.X_WM;
  findCrossings(edges0, edges1, X_01, cutoff_m, depth_m, crossings);
  std::erase_if(crossings, [&, X_10 = X_01.inverse()](const EdgeCrossing& at) {
    return isCovered(at, body0, body1, X_10);
  });
  std::size_t room = crossings.size();
  if (const auto limit = static_cast<std::size_t>(settings.candidate_limit); limit > 0)
    room = std::min(room, limit - std::min(limit, out.size()));
  for (const EdgeCrossing& at : std::span(crossings).first(room)) {
    Candidate c;
    c.p_W = body0.X_WM * at.p[0];
    c.n_W = body0.X_WM.R * at.n;
    c.distance_m = at.gap_m;
    c.id = at.edge[0];
    c.crossed = at.edge[1] + 1;
    c.owner = edges1.segments()[at.edge[1]].owner;
    out.push_back(c);
  }
  return crossings.size() - room;
}

}  // namespace vps::bullet::inline v0
