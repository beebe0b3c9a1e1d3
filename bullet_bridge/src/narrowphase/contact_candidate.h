// SPDX-License-Identifier: BSD-3-Clause
// Contacts on their way from the query to the solver: collected, reduced, corrected.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/pose.h"
#include "vps/query.h"
#include "vps_bullet/install.h"
#include "vps_bullet/shape.h"

class btCollisionShape;

namespace vps::bullet {

struct QueryState;

/// A point that can touch within the step: of a side's shell, or where an edge of body 0 crosses one of
/// body 1.
struct Candidate {
  Vec3 p_W = Vec3::Zero();    ///< the shell's point now; of a crossing that on body 0's edge
  Vec3 n_W = Vec3::Zero();    ///< unit, from body 1 to body 0
  double distance_m = 0;      ///< signed gap now
  double predicted_m = 0;     ///< the gap at the end of the step if nothing held the bodies
  double area_m2 = 0;         ///< surface the point stands for
  double impulse_Ns = 0;      ///< normal impulse it had last step
  bool was_contact = false;   ///< was given to the solver last step
  std::uint32_t id = 0;       ///< of the point in its shell; of a crossing body 0's edge
  std::uint32_t crossed = 0;  ///< of a crossing 1 + body 1's edge; 0: a shell's point
  std::uint16_t owner = 0;    ///< part of the other side's map
  std::uint8_t side = 0;      ///< whose shell the point is of: body 0 or 1

  [[nodiscard]] bool isCrossing() const { return crossed != 0; }
  [[nodiscard]] std::uint64_t key() const {
    return (std::uint64_t(side) << 63) | (std::uint64_t(crossed) << 32) | id;
  }
};

/// How body 0 moves against body 1 in the step, and what that means for which points matter.
struct RelativeMotion {
  Twist V;  ///< velocity of body 0 less that of body 1, about the world's origin, in W
  double dt_s = 0;
  double contact_margin_m = 0;
  double speed_m_s = 0;      ///< no point of the smaller body moves faster against the other
  double own_speed_m_s = 0;  ///< the same without the couplings' pull

  [[nodiscard]] Vec3 velocityAt(const Vec3& p_W) const { return V.v + V.w.cross(p_W); }
  /// Sets predicted_m; true if the candidate can touch within the step.
  bool canTouch(Candidate& c) const;
};

/// What small motions since a query make of its candidates: their planes go with body 0.
struct Carry {
  Pose body0;    ///< place of body 0 then -> now, in W
  Pose against;  ///< of body 1 against body 0, as it would move a point of W now

  void operator()(Candidate& c) const {
    c.p_W = body0 * c.p_W;
    c.n_W = body0.R * c.n_W;
    c.distance_m -= c.n_W.dot(against * c.p_W - c.p_W);
  }
};

/// One side of a pair: its shell's points against the other's field.
struct SideView {
  const Shape* shape = nullptr;  ///< the side with the shell
  Pose X_WM;                     ///< its models' frame
  std::uint8_t side = 0;
};

/// What a step asks of that side's points.
struct SideQuery {
  QueryState* memory = nullptr;  ///< null: all near points, and nothing remembered
  Twist step_W;                  ///< how the side's body moves against the other, about W's origin [rad, m]
  std::span<const std::uint32_t> always;  ///< ids, ascending: of last step's contacts
};

/// Points of `side` near the other Shape's map (of `other`, at its X_WM). With a memory and far more of
/// them than the solver is given, those that lead: what thinOut() would leave, not the same to the point.
/// @param cutoff_m   distance to look at, below the map's band
/// Appends to out. Returns how many did not fit into settings.candidate_limit.
std::size_t collectFromMap(const SideView& side, const SideView& other, double cutoff_m,
                           const Settings& settings, const SideQuery& ask, std::vector<Candidate>& out,
                           std::size_t& points_tested);

/// The same against one of Bullet's primitives at X_WS.
std::size_t collectFromPrimitive(const SideView& side, const btCollisionShape& primitive, const Pose& X_WS,
                                 double cutoff_m, const Settings& settings, std::vector<Candidate>& out,
                                 std::size_t& points_tested);

/// The same against the exact surfaces of a Shape without a map. A point that has gone through a sheet
/// counts if its part's field says that the sheet is nearer to the point's own face than to any other.
std::size_t collectFromSurfaces(const SideView& side, const SideView& other, double cutoff_m,
                                const Settings& settings, std::vector<Candidate>& out,
                                std::size_t& points_tested);

/// Where edges of two VpsShapes cross, nearer than the cutoff or overlapping by no more than the depth; their
/// distance and normal are exact. Appends to out. Returns how many did not fit into settings.candidate_limit,
/// after all that are there.
std::size_t collectCrossings(const SideView& body0, const SideView& body1, double cutoff_m, double depth_m,
                             const Settings& settings, std::vector<Candidate>& out);

/// Keeps the most urgent candidate of each cell of position and direction: depth, extent and every direction
/// of contact survive, and what has survived once is preferred, so that the set does not flicker.
/// @param cell_m  edge of a cell, a fraction of the smaller body's size
void thinOut(std::vector<Candidate>& candidates, double cell_m);

/// Replaces distance and normal of the candidates of `side` by the exact ones: of the other Shape's
/// surfaces (if it has any) or of the primitive `theirs`. What meets flush on curved faces, or a primitive's
/// round side, moves to where they are nearest. The field still decides where no surface is near.
/// @param is_answered  the other side's points are looked at too: a contact that one of them has is left to
/// it
void correct(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
             const btCollisionShape& theirs, const RelativeMotion& motion, bool is_answered);

/// Exact distance and normal of the points of `side` that are on edges, where the other side has a map and
/// surfaces: seen from where both bodies would be at the end of the step if they kept their velocities,
/// unless that is an overlap that is not there now. `distance_m` is what the plane found there means now.
/// @param way  of body 0 and body 1 in the step, in W
void correctEdges(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
                  const btCollisionShape& theirs, const Pose (&way)[2], const RelativeMotion& motion);

/// What correct() does without exact surfaces: a point on a face keeps its own tangent plane clear, so near
/// an edge of the other side, whose field's normals lean there, it does not push sideways. Drops the points
/// of `side` that the other's surface does not face. Cost: some products for each.
void takeOwnNormals(std::vector<Candidate>& candidates, const SideView& side);

/// Chooses at most `limit`: those that carried load, then the deepest, then the farthest from all chosen so
/// far, in position (in units of length_m) and direction. Ends in ascending key order, so that equal sets are
/// equal to the bit.
void chooseSpread(std::vector<Candidate>& candidates, std::size_t limit, double length_m,
                  double contact_margin_m);

}  // namespace vps::bullet
