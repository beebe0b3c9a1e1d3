// SPDX-License-Identifier: BSD-3-Clause
// Tolerances of contact: of the queries of this library, and of the narrow phase and the solver for Bullet.
//
// This file holds each number that decides whether two lengths, directions or places are equal, whether
// bodies touch, when an iteration has converged, and how much work a step may do at most. Numbers of other
// kinds stay where they are used: flags, tags, sentinels and indices; sizes of tables, tiles and cells, lane
// counts and stacks; bounds that follow from a number format; values that must agree with Bullet's; material
// values; promises of a public class (FeatureMotion::kRest_m, RepresentativePoints::kSame_m); and numbers
// that affect only run time, such as the width of a tube, the shape of a tree, or when sweeps give way to
// Newton's method.
//
// A name that ends in "Share" is a fraction; its comment starts with the quantity that it is a fraction of.
// Angles of faces and edges follow PointShellSettings::edge_angle_rad's default.
//
// "Test" names a test that was seen to fail with the value doubled or halved, or changed as stated: a family
// of vps_families, or a test of the bridge, the queries or the scenes. Replay is the test
// Replay.TheCommittedRecordingRunsAgainBitForBit, which pins the bits of one recorded scene and no bound.
// "No test pins it" means: the families B_mass_ratio_turns, B_corners, B_fast_corners, B_heights and I_flush,
// the test Replay, and the tests of crossings, edges and cones passed with the value doubled (an angle:
// doubled and halved); other tests were not tried.
#pragma once

#include <cstddef>

namespace vps {

// --- Rounding: smaller differences are rounding errors -----------------------------------------------------

/// Rounding error of a length: points that are nearer to each other define no direction, and two measurements
/// of one distance differ by less. The solver's remaining error is smaller than this [m]. Test: I_flush.
inline constexpr double kRounding_m = 1e-9;
/// Rounding error as a fraction of a length, of a momentum, or of the fastest approach velocity of an impact.
/// Test: DistanceQuery.IsTheLeastBetweenConvexBodies fails at forty times the value.
inline constexpr double kRoundingShare = 1e-9;
/// Velocity error below which a row of the solver counts as held, or as stopped by an impact. The value is
/// larger than rounding errors, so that a row that is held already keeps its bits [m/s]; for a joint's angle
/// [rad/s]. Assumed; no test pins it.
inline constexpr double kRoundingSpeed_m_s = 1e-9;
/// Fraction of a sum of many terms (the inverse mass of a row that depends on others, the energy of an
/// impact) that is rounding error. Assumed; no test pins it.
inline constexpr double kSumRounding = 1e-12;
/// A sum or difference of unit vectors shorter than this has no direction; a smaller sine counts as zero.
/// Assumed; no test pins it.
inline constexpr double kNoDirection = 1e-6;
/// Sine of the angle between facets below which they lie in one plane. The value is above the rounding error
/// of files in single precision. Assumed; no test pins it.
inline constexpr double kSinFlat = 1e-4;

// --- Angles ------------------------------------------------------------------------------------------------

/// 20 degrees, as PointShellSettings::edge_angle_rad: two faces at a larger angle meet at a sharp edge, at a
/// smaller angle they are one face. Faces whose normals are opposite to within this angle lie flush.
/// Test: Replay.
inline constexpr double kCosSameFace = 0.94;
/// 8 degrees, the angle of a polygon of 45 corners: neighbouring facets or segments at a smaller angle, but
/// not in one plane, approximate a curved surface or edge. Assumed. A coarser polygon counts as a polygon:
/// with normals of the curve, chain links of 10 corners gained energy, since their gap is measured between
/// the segments. Test: FeatureSet.SidesThatTurnByLessThanEightDegreesAreACurve.
inline constexpr double kCosCurved = 0.9903;
/// 0.8 degrees: planes at a smaller angle belong to one contact. The angle is smaller than that between
/// neighbouring facets of a cylinder of 400 facets. Assumed; no test pins it.
inline constexpr double kCosSamePlane = 0.9999;
/// 45 degrees: two directions at a smaller angle count as alike; a direction at a larger angle to a plane's
/// normal lies more along the plane than across it. Assumed; no test pins it.
inline constexpr double kCosAlike = 0.7;
/// Sine of the angle between two edges below which they count as parallel and define no common plane. The
/// value is far above rounding errors and far below the angles between segments of curved edges. Assumed; no
/// test pins it.
inline constexpr double kSinParallel = 1e-3;
/// Sine of 5 degrees: a direction that leaves an edge or a face at a smaller angle runs along it, and a plane
/// that leans into a face by less still lies on the face. Therefore an edge that slides from one edge of a
/// fine polygon to the next stays in contact. Where two lines cross at a smaller angle, the place of the
/// crossing is mostly rounding error. Assumed; no test pins it.
inline constexpr double kSinLean = 0.087;
/// Sine of 11 degrees: a face at a more grazing angle to a direction does not face it, as the side of a box
/// does not face the table's top that the box stands on. The mean normal of a corner faces all of its faces.
/// Test: Replay.
inline constexpr double kSinGrazing = 0.2;
/// Sine of 16 degrees, twice the angle of kCosCurved: the greatest slope at which a corner's own surface may
/// approach the facet that it touches, so that a corner between two facets of curved surfaces is kept.
/// Test: TouchCone.HoldsEveryDirectionThatAllRaysAllow.
inline constexpr double kSinTouch = 0.28;
/// Tangent of 10 degrees, half of the angle of kCosSameFace. At a joint of a curved edge a crossing may lie
/// between two segments, beyond the end of each by up to this fraction of the gap.
/// Assumed; no test pins it.
inline constexpr double kTanPastEnd = 0.18;

// --- Lengths of contact ------------------------------------------------------------------------------------

/// Two places nearer to each other than this are the same. The value is a twentieth of the default contact
/// margin, far above the noise of a part at rest (1 nm) and below any depth that matters. A contact keeps its
/// plane while it moves by less than this, and a candidate that was a contact before is preferred to a
/// candidate that is nearer by less than this [m]. Test: I_flush.
inline constexpr double kSamePlace_m = 1e-6;
/// Gaps that differ by less than this are the same: the difference is worth no query and changes no contact's
/// role [m]. Test: Replay.
inline constexpr double kSameGap_m = 1e-7;
/// Distance outside an edge of one part of a merged body at which the other parts are sought [m]. If the
/// place is inside another part, or nearer to it than half of this distance, the edge is covered and is no
/// edge of the body. Seams between mounted parts are narrower than this. Assumed; no test pins it.
inline constexpr double kSeam_m = 10e-6;
/// Overlaps below this share of the contact margin are left to the solver's push: 1 um of 20 um, far above
/// the solver's remaining error. Test: Replay.
inline constexpr double kToleratedShare = 0.05;
/// Share of the tolerated overlap by which an overlap that existed at the start of a step may grow in the
/// step, because of rounding. Assumed; no test pins it.
inline constexpr double kGrowthShare = 0.1;
/// A step that still has overlaps after the last round of checks continues as long as no point is deeper than
/// this share of the contact margin. With the growth of one step the limit is 10 um at a margin of 20 um, the
/// depth that an impact may leave; with a smaller value steps would end early because of overlaps that the
/// push removes. Assumed; no test pins it.
inline constexpr double kUnsolvedShare = 0.5 / (1 + kGrowthShare);
/// At the end of a step a contact that carries load has at most this share of the contact margin as its gap.
/// The value is half of the gap at which edges rest; with a tenth of that gap, some polygons roll better and
/// others worse, and a nut's step takes longer. Assumed; no test pins it.
inline constexpr double kApartShare = 0.0025;
/// A vertex that stands out from the middle of its facet by less than this share of the contact margin is no
/// feature. At a margin of 20 um, facets of 1 mm on a ball of 14 mm have vertices 14 um high, which are
/// features; facets of 0.2 mm on a ball of 5 mm have vertices 1 um high, which are not. The test families
/// C_balls and G_impact need this limit. Test: C_balls.
inline constexpr double kFacetCornerShare = 0.25;
/// Share of the query range: greatest overlap of two edges that counts as a crossing, if the range's share
/// exceeds the query's cutoff distance. At greater depth shell points lie inside the other part and carry the
/// contact. Crossings deeper than the cutoff are sought only in a pair's first step, or if a contact of the
/// last step overlaps by more than this share of the cutoff. Assumed; no test pins it.
inline constexpr double kEdgeDepthShare = 0.25;
/// Share of the rest gap (FeatureMotion::kRest_m). Features that start a step with a smaller gap get a
/// contact even if they do not approach. After kMostRetakes rounds of a check, features whose gap at the
/// step's end is larger than this share of the smaller of rest gap and starting gap are accepted. Test:
/// I_flush.
inline constexpr double kHeldShare = 0.2;
/// Error of the field's distance at sharp edges, in voxels. Measured: 0.40 at a point of an edge that lies
/// next to another edge. Test: Replay.
inline constexpr double kEdgeError_voxels = 0.45;
/// Error of the field's distance away from edges, in voxels.
/// Test: I_flush.
inline constexpr double kFaceError_voxels = 0.05;
/// Points that are farther than the nearest point by at most this share of the shell's spacing are reported
/// too, such as the points of a face that lies opposite to a face. Assumed; no test pins it.
inline constexpr double kBeyondShare = 0.1;
/// Accuracy to which the nearest point of a curved face is found, as a share of the shell's spacing; normals
/// then differ by less than a thousandth. Test: Replay.
inline constexpr double kNearestShare = 5e-3;

// --- Motion within a step ----------------------------------------------------------------------------------

/// A step that ends early covers this share of the path to the place of contact. A body that has less than
/// the remaining share of its path left stands still; an overlap that remains is removed by moving the other
/// body. Assumed; no test pins it.
inline constexpr double kShortShare = 0.9;
/// Greatest velocity at which bodies that start inside each other are separated [m/s].
/// Assumed; no test pins it.
inline constexpr double kSeparation_m_s = 0.05;
/// Slip below this speed has no direction [m/s]. The value is far above the jitter of a part at rest.
/// Test: Replay.
inline constexpr double kSliding_m_s = 1e-4;

// --- Convergence of the solver -----------------------------------------------------------------------------

/// A change below this share of the greatest friction limit, or of a coupling's force, counts as converged. A
/// friction impulse within this share of its limit counts as being at the limit. Also the regularisation of
/// small least-squares problems, as a share of the matrix's trace. Assumed; no test pins it.
inline constexpr double kSettledShare = 1e-6;
/// Allowed error of the solver, as a share of the fastest speed in the island: a micrometre on a path of a
/// decimetre. Test: I_flush.
inline constexpr double kSpeedErrorShare = 1e-5;
/// A tenth, used in several tests of progress:
/// - A contact's law is solved to this share of the allowed error. (When a law was solved only to the whole
///   error, a nut turned by 2 %, since the error has the same sign from step to step.)
/// - A line search ends where the derivative has fallen to this share of its value at the start.
/// - A round (outer iteration) must reduce the error of the contacts' laws to this share of the last round's
///   error; otherwise the contacts' compliance is reduced by kRoundShare. After a round that did not
///   converge, the compliance is divided by this share [Bertsekas 1982, ch. 2].
/// - If rounding stops Newton's method, the solution is accepted if the allowed error is more than this share
///   of the remaining error.
/// Test: B_mass_ratio_turns.
inline constexpr double kAccuracyShare = 0.1;
/// Upper limit of the error to which a round (outer iteration) is solved, before the factor kRoundShare: the
/// first round is solved to 5 mm/s [m/s]. Test: Replay.
inline constexpr double kFirstError_m_s = 1e-2;
/// A contact's compliance in the first round (outer iteration), as a share of a free body's compliance. A
/// stiff contact leaves little error in a round, but Newton's method then needs many steps from a distant
/// start; a compliant contact leaves more error and needs fewer steps. Test: B_mass_ratio_turns.
inline constexpr double kFirstCompliance = 0.1;
/// A contact's least compliance, as a share of a free body's compliance. Test: Replay and B_mass_ratio_turns
/// fail at ten times the value.
inline constexpr double kLeastCompliance = 1e-7;
/// Factor by which the contacts' compliance is reduced after a round (outer iteration), and ratio of the
/// error to which a round is solved to the error of the contacts' laws after the round before. With a factor
/// of 0.1, a third of the problems of a pile have a round that does not converge; with 0.8 there are too many
/// rounds. Test: ContactNewton.SettlesTheFrictionOfAHeapInFewSteps.
inline constexpr double kRoundShare = 0.5;
/// Contacts whose loads are equal to within this share of the face's load are left unchanged, so that a body
/// at rest needs no new solution in each step. Test: EvenPressure.LeavesWhatIsEvenAndWhatIsHeldInOneWay, and
/// piles at rest.
inline constexpr double kEvenShare = 0.05;
/// Share of a face's load that evening out the pressure may leave to the solver. Contacts of a thread, whose
/// normals are all inclined in the same way, carry some moments only by great impulses against each other.
/// Test: EvenPressure.KeepsForceAndMomentOfAnyLoadAndNothingPulls, M_torque.
inline constexpr double kUnspreadShare = 1e-4;
/// Stiffness of a joint relative to a free body, and relative mass of a body in the directions in which it is
/// held. A joint is therefore a spring that misses its target by a millionth. Joints have no multipliers,
/// because rows of joints often contradict each other. Assumed; no test pins it.
inline constexpr double kRigidRatio = 1e6;
/// Compliance of the push that separates overlapping bodies, as a share of the inverse mass of the contact's
/// row. Overlaps may contradict each other, and a rigid push would have no solution. Test: I_flush.
inline constexpr double kPushSoftness = 0.1;
/// An approach slower than this share of the fastest approach is stopped without an impact of its own.
/// Contacts of flush faces that rest on each other would otherwise be reflected or not depending on the sign
/// of their rounding error, and the bodies would turn. The rule changes the energy by at most the square of
/// this share. Assumed; no test pins it.
inline constexpr double kSlowApproachShare = 1e-2;

// --- Budgets -----------------------------------------------------------------------------------------------

/// Greatest number of rounds in which a check corrects a step, or of halvings of the step; most steps need
/// two or three. Also the limit of other short iterations: trial steps of Newton's method, and rounds that
/// even out the pressure. Test: B_mass_ratio_turns.
inline constexpr int kMostRounds = 8;
/// Greatest number of times that a contact's place, or its row, is computed again; most contacts need one or
/// two. Test: Replay.
inline constexpr int kMostRetakes = 5;
/// Limit of iterations that converge after a few iterations if they converge at all. Also the number of
/// Newton steps that a solution of an island may always take: with fewer, each step of the simulation is
/// solved again for the contacts that its solution misses. Test: Replay.
inline constexpr int kMostIterations = 60;
/// Greatest number of sweeps over the friction of an impact. The sweeps converge slowly where flush faces
/// have dozens of contacts. Assumed; no test pins it.
inline constexpr int kMostImpactSweeps = 400;
/// Greatest number of places that are tested along one path or one search direction. Test: Replay.
inline constexpr int kMostPlaces = 20;
/// Greatest number of contacts of one kind that one check adds to a pair. Six contacts hold a body; the next
/// check adds more contacts. Test: Replay.
inline constexpr std::size_t kMostAdded = 8;
/// Greatest number of segments into which the path of one step is divided. With the narrow phase's segments
/// of about the query range, the path may be 0.5 m long at a voxel of 0.25 mm. The check of sharp features
/// allows ten times this number of segments. Assumed; no test pins it.
inline constexpr double kMostStretches = 1000;
/// Products of rows in one impact, about 0.1 s of work. A body between two others of R times its mass takes
/// pi sqrt(R / 2) impacts; between flush faces each impact takes about 300 products. Assumed; no test pins
/// it.
inline constexpr std::size_t kMostImpactWork = 10'000'000;

}  // namespace vps
