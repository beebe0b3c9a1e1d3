// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/refinement/curved_contact.h"
#include "vps/contact_tolerances.h"
#include "vps/edge_crossing.h"

namespace vps::bullet {

namespace {

// A merged body is the union of its parts: an edge that another part covers is not an edge of the body.
// @param out_M  direction out of the body at the edge's point p_M
bool isCovered(const Shape& shape, std::uint16_t owner, const Vec3& p_M, const Vec3& out_M) {
  const std::vector<Surface>& surfaces = shape.models().surfaces;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (i == owner || surfaces[i].sheet) continue;
    const Vec3 p = surfaces[i].X_MP.inverse() * (p_M + kSeam_m * out_M);
    if (surfaces[i].distance->signedDistance(p, kSeam_m) < 0.5 * kSeam_m) return true;
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

bool isCurved(const EdgeSegment& s) {
  return s.is_curved[0] || s.is_curved[1];
}

// Direction of a curved edge at the joint of two segments: tangent of the parabola through the joint and the
// far ends of both segments. At the end of the edge the result is the direction of the segment.
Vec3 directionAt(const EdgeSet& edges, const EdgeSegment& s, int end) {
  const Vec3 way = s.to - s.from;
  if (!s.is_curved[end]) return way;
  const Vec3& joint = end == 0 ? s.from : s.to;
  Vec3 direction = way;
  double most_cos = 0;
  edges.tree().forEachNear(joint, kRounding_m, [&](std::uint32_t i) {
    const EdgeSegment& other = edges.segments()[i];
    if (&other == &s) return;
    // The other segment, turned so that it runs in the direction of segment s.
    const bool is_reversed = ((end == 0 ? other.from : other.to) - joint).norm() <= kRounding_m;
    const Vec3 goes_on = is_reversed ? Vec3(other.from - other.to) : Vec3(other.to - other.from);
    const double cos = way.dot(goes_on) / (way.norm() * goes_on.norm());
    if (!(cos > most_cos)) return;
    most_cos = cos;
    direction = way / way.squaredNorm() + goes_on / goes_on.squaredNorm();
  });
  return direction;
}

// Direction, at a point of a segment, of the curved edge that the segments approximate.
Vec3 smoothDirection(const EdgeSet& edges, std::uint32_t i, const Vec3& p) {
  const EdgeSegment& s = edges.segments()[i];
  const Vec3 way = s.to - s.from;
  if (!isCurved(s)) return way;
  const double share = std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (1 - share) * directionAt(edges, s, 0).normalized() + share * directionAt(edges, s, 1).normalized();
}

// Where curved edges cross, the normal of the segments leans by up to half the angle between segments, so a
// screw's crest would seem to approach the rim of its nut's thread at each joint. The normal of the curved
// edges does not lean.
Vec3 smoothNormal(const EdgeCrossing& at, const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01) {
  const Vec3 n = smoothDirection(edges0, at.edge[0], at.p[0])
                     .cross(X_01.R * smoothDirection(edges1, at.edge[1], X_01.inverse() * at.p[1]))
                     .normalized();
  const double cos = n.dot(at.n);
  return std::abs(cos) > kCosSameFace ? Vec3(cos < 0 ? -n : n) : at.n;
}

// True if curved faces beside both edges lie flush, as those of a thread and its nut.
bool isFlush(const EdgeSegment& s0, const EdgeSegment& s1, const Mat3& R_01) {
  if (!isCurved(s0) || !isCurved(s1)) return false;
  for (const int i : {0, 1})
    for (const int j : {0, 1})
      if (s0.normal(i).dot(R_01 * s1.normal(j)) < -kCosSameFace) return true;
  return false;
}

}  // namespace

std::size_t findCrossingCandidates(const SideView& body0, const SideView& body1, const CrossingRange& range,
                                   const Settings& settings, CrossingMemory* memory,
                                   std::vector<Candidate>& out) {
  const EdgeSet &edges0 = body0.shape->edges(), &edges1 = body1.shape->edges();
  thread_local std::vector<EdgeCrossing> crossings;
  crossings.clear();
  const Pose X_01 = body0.X_WM.inverse() * body1.X_WM;
  findCrossings(edges0, edges1, X_01, range, crossings, memory);
  std::erase_if(crossings, [&, X_10 = X_01.inverse()](const EdgeCrossing& at) {
    return isCovered(at, body0, body1, X_10);
  });
  std::size_t room = crossings.size();
  if (const auto limit = static_cast<std::size_t>(settings.candidate_limit); limit > 0)
    room = std::min(room, limit - std::min(limit, out.size()));
  for (const EdgeCrossing& at : std::span(crossings).first(room)) {
    Candidate c;
    c.p_W = body0.X_WM * at.p[0];
    c.n_W = body0.X_WM.R * smoothNormal(at, edges0, edges1, X_01);
    c.distance_m = at.gap_m;
    c.id = at.edge[0];
    c.crossed = at.edge[1] + 1;
    c.is_flush = isFlush(edges0.segments()[at.edge[0]], edges1.segments()[at.edge[1]], X_01.R);
    c.surface[0] = edges0.segments()[at.edge[0]].owner;
    c.surface[1] = edges1.segments()[at.edge[1]].owner;
    out.push_back(c);
  }
  return crossings.size() - room;
}

}  // namespace vps::bullet
