// SPDX-License-Identifier: BSD-3-Clause
// Contacts between query and solver: candidates are found, reduced and refined.
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

/// Gap of a contact that does not act: farther than any step moves.
inline constexpr double kOutOfReach_m = 1;

/// A point that can touch within the step: a point of one side's shell, or a crossing of an edge of body 0
/// with an edge of body 1.
struct Candidate {
  Vec3 p_W = Vec3::Zero();         ///< the shell's point now; at a crossing the point on body 0's edge
  Vec3 n_W = Vec3::Zero();         ///< unit, from body 1 to body 0
  double distance_m = 0;           ///< signed gap now
  double predicted_m = 0;          ///< gap at the end of the step in free motion
  double area_m2 = 0;              ///< surface that the point represents
  Vec3 area_off_W = Vec3::Zero();  ///< its centre from p_W
  Eigen::Matrix3f area_spread = Eigen::Matrix3f::Zero();  ///< mean of d d', d from the centre, in W [m2]
  double impulse_Ns = 0;                                  ///< its normal impulse in the last step
  double rest_m = 0;                                      ///< gap at which sharp features rest
  double met_s = 0;                   ///< time in the step, on the way of a fast body, at which it was found
  double curvature_per_m = 0;         ///< of faces that touch flush: the greatest sum of both curvatures
  double hollow_per_m = 0;            ///< by how much the face bends towards the point that the plane is of
  bool is_flush = false;              ///< curved surfaces of both parts lie flush around it
  bool is_flat = false;               ///< flat faces of both parts do, or one on an edge: measured
  bool bounces = false;               ///< restitution acts on it in this step
  bool was_contact = false;           ///< was given to the solver in the last step
  std::uint32_t id = 0;               ///< of the point in its shell; at a crossing body 0's edge
  std::uint32_t crossed = 0;          ///< at a crossing 1 + body 1's edge; 0: a shell point
  std::uint16_t surface[2] = {0, 0};  ///< of body 0 and 1, that touches: index of ShapeModels::surfaces
  std::uint8_t side = 0;              ///< whose shell the point belongs to: body 0 or 1
  std::uint8_t plane_of = kBetween;   ///< body whose face the plane is: 0 or 1
  static constexpr std::uint8_t kBetween = 2;  ///< the plane lies between edges, or is only the field's

  [[nodiscard]] Vec3 areaCenter_W() const { return p_W + area_off_W; }
  [[nodiscard]] bool isCrossing() const { return crossed != 0; }
  [[nodiscard]] std::uint64_t key() const { return contactKey(side, crossed, id); }
};

/// Motion of body 0 relative to body 1 in the step, and which points it can bring into contact.
struct RelativeMotion {
  Twist V;  ///< velocity of body 0 minus that of body 1, about the world's origin, in W
  double dt_s = 0;
  double contact_margin_m = 0;
  double speed_m_s = 0;      ///< upper bound of the relative speed of the smaller body's points
  double own_speed_m_s = 0;  ///< the same without the pull of couplings
  double pull_share = 1;     ///< the share of that pull which V has
  bool is_checked = false;   ///< isSurelyChecked(): contacts that the first guess lacks are found later

  [[nodiscard]] Vec3 velocityAt(const Vec3& p_W) const { return V.v + V.w.cross(p_W); }
  /// How far points are taken to move in any direction.
  [[nodiscard]] double anyWay_m() const { return 0.5 * own_speed_m_s * dt_s; }
  /// Sets predicted_m; true if the candidate can touch within the step.
  bool canTouch(Candidate& c) const;
};

/// Carries candidates along with small motions since their query: their planes move with body 0.
struct CandidateMotion {
  Pose body0;    ///< motion of body 0 since the query, in W
  Pose against;  ///< motion of body 1 relative to body 0, applied to a point given in W now

  void operator()(Candidate& c) const {
    c.p_W = body0 * c.p_W;
    c.n_W = body0.R * c.n_W;
    c.distance_m -= c.n_W.dot(against * c.p_W - c.p_W);
  }
};

/// One side of a pair: its shell's points are queried in the other's field.
struct SideView {
  const Shape* shape = nullptr;  ///< the side with the shell
  Pose X_WM;                     ///< its models' frame
  std::uint8_t side = 0;
};

struct QueryState {
  /// O(points / 16). The shell must outlive it.
  QueryState(const VoxMap& map, const PointShell& shell) : query(map, shell) {}

  QueryMemory query;
  /// Two representative points of each group of neighbours with similar normals; for constraint contact, as
  /// soon as more points than smallQueryLimit() have been near. O(points) to make: most pairs never need it.
  std::optional<RepresentativePoints> leading;
  /// @param radius_m  of the pair's smaller body
  void lead(const PointShell& shell, std::span<const std::uint8_t> on_edge, double radius_m);
};

/// Up to this number of near points of one side, all of them are examined.
std::size_t smallQueryLimit(const Settings& settings);
/// About this number of candidates is refined by the exact surfaces: enough although some turn out to be out
/// of reach. With half of it a shaft in its bushings had to be solved again in most steps, which cost more.
std::size_t refinedLimit(const Settings& settings);
/// True if representative points serve for so many near points.
bool needsLeading(std::size_t near_points, const PointShell& shell, const Settings& settings);

/// Input of a query of one side's points in a step.
struct SideQuery {
  QueryState* state = nullptr;  ///< null: all near points, and nothing is stored
  Twist step_W;  ///< motion of the side's body relative to the other, about W's origin [rad, m]
  std::span<const std::uint32_t> always;  ///< ids, ascending: last step's contacts
  double radius_m = 0;                    ///< of the smaller body
};

/// A point of `side` as it was read in the map of `other`.
Candidate candidateOf(const Contact& contact, const SideView& side, const SideView& other);

/// True for constraint contact on exact surfaces. Penalty points represent areas, so they stay where these
/// are, and a crossing has none.
inline bool isExact(const Settings& settings) {
  return settings.use_surfaces && settings.contact_method == ContactMethod::Constraint;
}

// Finding: each function appends to `out`.

/// Points of `side` near the other Shape's map (of `other`, at its X_WM). With a query state, and far more
/// points than the solver is given, one representative point per surface tile: nearly what reduceByCell()
/// would keep.
/// @param cutoff_m  greatest distance, below the map's band
/// @return how many exceeded settings.candidate_limit
std::size_t findMapCandidates(const SideView& side, const SideView& other, double cutoff_m,
                              const Settings& settings, const SideQuery& query, std::vector<Candidate>& out,
                              std::size_t& points_tested);

/// The same for one of Bullet's primitives at X_WS.
std::size_t findPrimitiveCandidates(const SideView& side, const btCollisionShape& primitive, const Pose& X_WS,
                                    double cutoff_m, const Settings& settings, std::vector<Candidate>& out,
                                    std::size_t& points_tested);

/// The same for the exact surfaces of a Shape without a map. A point behind a sheet counts if its part's
/// field says that the sheet is nearer to the point's own face than to any other.
std::size_t findSurfaceCandidates(const SideView& side, const SideView& other, double cutoff_m,
                                  const Settings& settings, std::vector<Candidate>& out,
                                  std::size_t& points_tested);

/// Crossings of the edges of two Shapes in a range, at their models' frames; distance and normal are exact.
/// @param memory  of the two Shapes, or null
/// @return how many exceeded settings.candidate_limit, which counts all candidates in `out`
std::size_t findCrossingCandidates(const SideView& body0, const SideView& body1, const CrossingRange& range,
                                   const Settings& settings, CrossingMemory* memory,
                                   std::vector<Candidate>& out);

// Reducing.

/// Adds the surface that one point represents to that of another.
void addArea(const Candidate& from, Candidate& to);

/// Keeps the most urgent candidates of each cell of position and direction, now and at the end of the step:
/// depth, extent and every direction of contact are preserved. Last step's contacts are kept, so that the set
/// does not flicker. Where more than `limit` are left, cells are doubled, as long as they are smaller than
/// most_m.
/// @param cell_m  edge of the first cells, a fraction of the smaller body's size
/// @param X_GW    the grid is fixed in a frame G of one of the bodies, so that a scene that is moved as a
///                whole keeps its contacts
/// @return edge of the last cells; 0 if there were no more than `limit`
double reduceByCell(std::vector<Candidate>& candidates, std::size_t limit, double cell_m, double most_m,
                    const Pose& X_GW = Pose());

/// Keeps at most `limit`: those that carried load, then the deepest, then repeatedly the one farthest from
/// all selected, in position (in units of length_m) and direction. The result is in ascending key order, so
/// that equal sets have equal bits.
void reduceBySpread(std::vector<Candidate>& candidates, std::size_t limit, double length_m,
                    double contact_margin_m, const Mat3& R_GW = Mat3::Identity());

// Refining.

/// Replaces distance and normal of the candidates of `side` by the exact ones: of the other Shape's surfaces
/// (if it has any) or of the primitive `theirs`. Candidates on curved faces that touch flush, and on a
/// primitive's round side, move to the nearest place. Where none is in reach, the field's values remain.
/// @param motion  of no duration in a query: distances are then those between points, not of planes
/// @param is_two_sided  the other side's points are queried too: a contact found by one of them is left to it
void refine(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
            const btCollisionShape& theirs, const RelativeMotion& motion, bool is_two_sided);

/// Exact distance and normal of the points of `side` on edges, where the other side has a map and surfaces.
/// They are measured where both bodies would be at the end of the step at constant velocity, unless that is
/// an overlap that does not exist now. `distance_m` is the distance now to the plane found there.
/// @param way  displacement of body 0 and body 1 in the step, in W
void refineEdges(std::vector<Candidate>& candidates, const SideView& side, const SideView& other,
                 const btCollisionShape& theirs, const Pose (&way)[2], const RelativeMotion& motion);

/// What refine() does, without exact surfaces: a point on a face takes the normal of its own tangent plane,
/// so that near an edge of the other side, where the field's normals lean, it does not push sideways. Drops
/// the points of `side` that do not face the other's surface. Cost: a few products each.
void useOwnNormals(std::vector<Candidate>& candidates, const SideView& side);

}  // namespace vps::bullet
