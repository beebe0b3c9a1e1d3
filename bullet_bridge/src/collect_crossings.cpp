// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <span>

#include "candidate.h"
#include "vps/edge_crossing.h"

namespace vps {

std::size_t collectCrossings(const SideView& body0, const SideView& body1, double cutoff_m, double depth_m,
                             const VpsBulletSettings& settings, std::vector<Candidate>& out) {
  const EdgeSet &edges0 = body0.shape->edges(), &edges1 = body1.shape->edges();
  thread_local std::vector<EdgeCrossing> crossings;
  crossings.clear();
  findCrossings(edges0, edges1, body0.X_WM.inverse() * body1.X_WM, cutoff_m, depth_m, crossings);
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

}  // namespace vps
