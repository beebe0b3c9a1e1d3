// SPDX-License-Identifier: BSD-3-Clause
// Contact candidates, from the query to the solver: how they are found, reduced and refined.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/contact_key.h"
#include "vps/edge_crossing.h"
#include "vps/pose.h"
#include "vps/query.h"
#include "vps/representative_points.h"
#include "vps_bullet/settings.h"
#include "vps_bullet/shape.h"

class btCollisionShape;

namespace vps::bullet {

/// Gap of a contact that does not act, larger than the motion of any step.
inline constexpr double kOutOfReach_m = 1;

/// A point that can touch within the step: a point of one side's shell, or a crossing of an edge of body 0
/// with an edge of body 1.
struct Candidate {
  Vec3 p_W = Vec3::Zero();         ///< the shell's point now; at a crossing the point on body 0's edge
  Vec3 n_W = Vec3::Zero();         ///< unit normal, from body 1 to body 0
  double distance_m = 0;           ///< signed gap now
  double predicted_m = 0;          ///< gap at the end of the step in free motion
  double area_m2 = 0;              ///< surface that the point represents
  Vec3 area_off_W = Vec3::Zero();  ///< centre of the represented surface, relative to p_W
  Eigen::Matrix3f area_spread = Eigen::Matrix3f::Zero();  ///< mean of d d', d from the centre, in W [m2]
  double impulse_Ns = 0;                                  ///< normal impulse of this contact in the last step
  double rest_m = 0;                                      ///< gap at which sharp features rest
  double met_s = 0;            ///< time within the step at which a fast body meets the contact plane
  double curvature_per_m = 0;  ///< for faces that touch flush: greatest sum of both curvatures
  double hollow_per_m = 0;     ///< curvature of a concave face that bends from its plane towards the point
  bool is_flush = false;       ///< curved surfaces of both parts lie flush around the contact
  bool is_flat = false;  ///< flat faces of both parts lie on each other here, or a flat face lies on an edge
  bool bounces = false;  ///< restitution acts on this contact in this step
  bool was_contact = false;   ///< the solver had this contact in the last step
  std::uint32_t id = 0;       ///< index of the point in its shell; for a crossing: index of body 0's edge
  std::uint32_t crossed = 0;  ///< for a crossing: 1 + index of body 1's edge; 0 for a shell point
  std::uint16_t surface[2] = {0,
                              0};  ///< index in ShapeModels::surfaces of the touching surface of body 0 and 1
  std::uint8_t side = 0;           ///< body (0 or 1) whose shell the point belongs to
  std::uint8_t plane_of = kBetween;  ///< body (0 or 1) whose face gives the contact plane
  static constexpr std::uint8_t kBetween =
      2;  ///< the plane lies between two edges, or is known from the distance field only

  [[nodiscard]] Vec3 areaCenter_W() const { return p_W + area_off_W; }
  [[nodiscard]] bool isCrossing() const { return crossed != 0; }
  [[nodiscard]] std::uint64_t key() const { return contactKey(side, crossed, id); }
};

/// Motion of body 0 relative to body 1 in the step, and which points it can bring into contact.
struct RelativeMotion {
  Twist V;        ///< velocity of body 0 minus that of body 1, about the world's origin, in W
  Twist V_start;  ///< as V, but at the start of the step; zero unless the friction model depends on it
  double dt_s = 0;
  double contact_margin_m = 0;
  double speed_m_s = 0;      ///< upper bound of the relative speed of the smaller body's points
  double own_speed_m_s = 0;  ///< bound as speed_m_s, without the pull of couplings
  double pull_share = 1;     ///< share of the couplings' pull that V includes
  bool is_checked = false;   ///< isSurelyChecked(): contacts that the selection lacks are found later

  [[nodiscard]] Vec3 velocityAt(const Vec3& p_W) const { return V.v + V.w.cross(p_W); }
  /// Distance that points are assumed to move in any direction [m].
  [[nodiscard]] double anyWay_m() const { return 0.5 * own_speed_m_s * dt_s; }
  /// Sets predicted_m; true if the candidate can touch within the step.
  bool canTouch(Candidate& c) const;
};

/// Moves candidates along with small motions of the bodies since their query. Contact planes move with body
/// 0.
struct CandidateMotion {
  Pose body0;    ///< motion of body 0 since the query, in W
  Pose against;  ///< motion of body 1 relative to body 0, applied to a point given in W now

  void operator()(Candidate& c) const {
    c.p_W = body0 * c.p_W;
    c.n_W = body0.R * c.n_W;
    c.distance_m -= c.n_W.dot(against * c.p_W - c.p_W);
  }
};

/// One body of a pair, whose shell points are queried in the other body's distance field.
struct SideView {
  const Shape* shape = nullptr;  ///< the shape that has the shell
  Pose X_WM;                     ///< frame of the shape's models
  std::uint8_t side = 0;
};

struct QueryState {
  /// O(points / 16). The shell must outlive this object.
  QueryState(const VoxMap& map, const PointShell& shell) : query(map, shell) {}

  QueryMemory query;
  /// Two representative points of each group of neighbours with similar normals. Built in O(points) for
  /// constraint contact, the first time that more points than smallQueryLimit() are near; most pairs never
  /// need these points.
  std::optional<RepresentativePoints> leading;
  /// @param radius_m  radius of the pair's smaller body
  void lead(const PointShell& shell, std::span<const std::uint8_t> on_edge, double radius_m);
};

/// Up to this number of near points of one side, every near point is examined.
std::size_t smallQueryLimit(const Settings& settings);
/// Approximate number of candidates that are refined by the exact surfaces, including candidates that turn
/// out to be out of reach. With half as many refined candidates, most steps of a shaft in its bushings had to
/// be solved again, which cost more.
std::size_t refinedLimit(const Settings& settings);
/// True if representative points are to be used for this number of near points.
bool needsLeading(std::size_t near_points, const PointShell& shell, const Settings& settings);

/// Input of a query of one side's points in a step.
struct SideQuery {
  QueryState* state = nullptr;  ///< null: report all near points and store nothing
  Twist step_W;                 ///< motion of this body relative to the other body, about W's origin [rad, m]
  std::span<const std::uint32_t> always;  ///< ids of the last step's contacts, ascending
  double radius_m = 0;                    ///< radius of the smaller body
};

/// Converts a contact that a point of `side` has in the map of `other`.
Candidate candidateOf(const Contact& contact, const SideView& side, const SideView& other);

/// True for constraint contact on exact surfaces. Penalty points represent areas, so they are not moved; a
/// crossing represents no area.
inline bool isExact(const Settings& settings) {
  return settings.use_surfaces && settings.contact_method == ContactMethod::Constraint;
}

// Finding: each function appends to `out`.

/// Points of `side` near the other Shape's map (of `other`, at its X_WM). With a query state, and if far more
/// points are near than the solver takes, reports one representative point per surface tile: nearly the set
/// that reduceByCell() would keep.
/// @param cutoff_m  greatest distance, below the map's band
/// @return number of points left out by settings.candidate_limit
std::size_t findMapCandidates(const SideView& side, const SideView& other, double cutoff_m,
                              const Settings& settings, const SideQuery& query, std::vector<Candidate>& out,
                              std::size_t& points_tested);

/// As findMapCandidates(), near one of Bullet's primitives at X_WS.
std::size_t findPrimitiveCandidates(const SideView& side, const btCollisionShape& primitive, const Pose& X_WS,
                                    double cutoff_m, const Settings& settings, std::vector<Candidate>& out,
                                    std::size_t& points_tested);

/// As findMapCandidates(), near the exact surfaces of a Shape without a map. A point behind a sheet counts
/// only if the sheet is nearer to the point's own face than to any other face of its part, by the part's
/// field.
std::size_t findSurfaceCandidates(const SideView& side, const SideView& other, double cutoff_m,
                                  const Settings& settings, std::vector<Candidate>& out,
                                  std::size_t& points_tested);

/// Finds where edges of two Shapes cross within a range. Distance and normal are exact.
/// @param memory  memory of the two Shapes' crossings, or null
/// @return number of crossings left out by settings.candidate_limit, which limits all candidates in `out`
std::size_t findCrossingCandidates(const SideView& body0, const SideView& body1, const CrossingRange& range,
                                   const Settings& settings, CrossingMemory* memory,
                                   std::vector<Candidate>& out);

// Reducing.

/// Adds the surface area that candidate `from` represents to the area of candidate `to`.
void addArea(const Candidate& from, Candidate& to);

/// Keeps the most urgent candidates of each cell of position and direction, now and at the end of the step:
/// depth, extent and every direction of contact are preserved. Last step's contacts are kept, so that the set
/// does not flicker. While more than `limit` candidates are left, the cell size is doubled, up to most_m.
/// @param cell_m  initial edge length of a cell, a fraction of the smaller body's size
/// @param X_GW  pose of W in the grid's frame G, which is fixed to one of the bodies, so that a scene that is
/// moved as a whole keeps its contacts
/// @return final edge length of a cell; 0 if there were no more than `limit` candidates
double reduceByCell(std::vector<Candidate>& candidates, std::size_t limit, double cell_m, double most_m,
                    const Pose& X_GW = Pose());

/// Keeps at most `limit` candidates: those that carried load, then the deepest, then repeatedly the candidate
/// farthest from all selected ones, in position (in units of length_m) and direction. The result is in
/// ascending key order, so that equal sets have equal bits.
void reduceBySpread(std::vector<Candidate>& candidates, std::size_t limit, double length_m,
                    double contact_margin_m, const Mat3& R_GW = Mat3::Identity());

// Refining.

/// Replaces distance and normal of the candidates of `side` by exact values, measured from the other Shape's
/// surfaces (if it has any) or from the primitive `theirs`. Candidates on curved faces that touch flush, and
/// on a primitive's round side, move to the place of least distance. Where no surface is in reach, the
/// field's values remain.
/// @param motion  motion in the step; of zero duration in a query, where distances are between points, not to
///   planes
/// @param is_two_sided  the other body's points are queried too, and keep the contacts that they find
void refine(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
            const btCollisionShape& theirs, const RelativeMotion& motion, bool is_two_sided);

/// Sets exact distance and normal of the points of `side` that lie on edges, where the other side has a map
/// and surfaces. Distance and normal are measured at the poses that both bodies would have at the end of the
/// step at constant velocity, unless the bodies overlap there and do not overlap now. `distance_m` is the
/// present distance to the plane found at these end poses.
/// @param way  displacement of body 0 and body 1 in the step, in W
void refineEdges(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
                 const btCollisionShape& theirs, const Pose (&way)[2], const RelativeMotion& motion);

/// Replaces refine() without exact surfaces: a point on a face takes the normal of its own tangent plane.
/// Near an edge of the other side the field's normals lean, and would push sideways. Drops the points of
/// `side` that do not face the other's surface. Cost: a few products per point.
void useOwnNormals(std::vector<Candidate>& candidates, const SideView& side);

}  // namespace vps::bullet
