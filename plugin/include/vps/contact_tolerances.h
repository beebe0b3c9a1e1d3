// SPDX-License-Identifier: BSD-3-Clause
// Tolerances of contact: of the queries of this library, and of the narrow phase and the solver for Bullet.
//
// What counts: each number that decides whether two lengths, directions or places are one, whether bodies
// touch, when an iteration has converged, and how much work a step may take at most. What doesn't, and stays
// where it is used: flags, tags, sentinels and indices; sizes of tables, tiles and cells, lane counts and
// stacks; bounds that follow from a number format; values that must agree with Bullet's; a material's values;
// what a public class promises (FeatureMotion::kRest_m, RepresentativePoints::kSame_m); and what only trades
// time for time, as the width of a tube, the shape of a tree, or when sweeps give way to Newton's method.
//
// Angles of faces and edges are those of PointShellSettings::edge_angle_rad's default. "Test" names one that
// was seen to fail with the value doubled or halved, or as it says: a family of vps_families, or a test of
// the bridge, the queries or the scenes; Replay is Replay.TheCommittedRecordingRunsAgainBitForBit, which pins
// the bits of one recorded scene and no bound. "No test pins it": the families B_mass_ratio_turns, B_corners,
// B_fast_corners, B_heights and I_flush, that recording, and the tests of crossings, edges and cones passed
// with it doubled, or the angle doubled and halved; others were not tried.
#pragma once

#include <cstddef>

namespace vps {

// --- Rounding: below these, nothing is known ---------------------------------------------------------------

/// A length: the direction between points that are nearer is not known, and a distance that is measured twice
/// differs by less. The solver leaves less than this [m].
/// Test: I_flush.
inline constexpr double kRounding_m = 1e-9;
/// Of a length, of a momentum, or of the fastest approach of an impact.
/// Test: DistanceQuery.IsTheLeastBetweenConvexBodies, at forty times.
inline constexpr double kRoundingShare = 1e-9;
/// A velocity of a row that is held, or that an impact leaves; above rounding, so that what is held already
/// keeps its bits [m/s], and [rad/s] for a joint's angle.
/// Assumed; no test pins it.
inline constexpr double kRoundingSpeed_m_s = 1e-9;
/// Of a sum of many terms: of the inverse mass of a row that depends on others, and of an impact's energy.
/// Assumed; no test pins it.
inline constexpr double kSumRounding = 1e-12;
/// A sum or difference of unit vectors that is shorter has no direction; a sine below it is zero.
/// Assumed; no test pins it.
inline constexpr double kNoDirection = 1e-6;
/// Sine: facets that turn by less lie in one plane. Above the rounding of files in single precision.
/// Assumed; no test pins it.
inline constexpr double kSinFlat = 1e-4;

// --- Angles ------------------------------------------------------------------------------------------------

/// 20 degrees, as PointShellSettings::edge_angle_rad: faces that turn by more meet at a sharp edge, those
/// that turn by less are one face; faces whose normals are opposite to within this lie flush.
/// Test: Replay.
inline constexpr double kCosSameFace = 0.94;
/// 8 degrees, a polygon of 45 corners: facets and segments that turn by less stand for something curved, if
/// they turn at all. Assumed. A coarser one is met as it is: chain links of 10 corners gained energy along
/// the normals of curves, since their gap is that of the segments.
/// Test: FeatureSet.SidesThatTurnByLessThanEightDegreesAreACurve.
inline constexpr double kCosCurved = 0.9903;
/// 0.8 degrees: planes that turn by less are one contact's. Less than between the facets of a round
/// face of 400.
/// Assumed; no test pins it.
inline constexpr double kCosSamePlane = 0.9999;
/// 45 degrees: the direction along which something lies rather than across it.
/// Assumed; no test pins it.
inline constexpr double kCosAlike = 0.7;
/// Edges that are nearer to parallel have no plane of their own. Far above rounding, far below the
/// turns of curved edges.
/// Assumed; no test pins it.
inline constexpr double kSinParallel = 1e-3;
/// 5 degrees: a direction that leaves an edge or a face by less runs along it, and a plane that leans into a
/// face by less still lies on it; so an edge that passes from one edge of a fine polygon to the next stays in
/// contact meanwhile. A crossing of lines at a smaller angle is mostly rounding.
/// Assumed; no test pins it.
inline constexpr double kSinLean = 0.087;
/// 11 degrees from a plane, 78 from its normal: a face does not touch what it faces at a more grazing angle,
/// as a table's top and the side of a box that stands on it. A corner's mean normal faces each of its faces.
/// Test: Replay.
inline constexpr double kSinGrazing = 0.2;
/// 16 degrees, twice the angle of kCosCurved: how far a corner's own surface may fall towards the facet that
/// it touches, so that a corner between two facets of curved surfaces is kept.
/// Test: TouchCone.HoldsEveryDirectionThatAllRaysAllow.
inline constexpr double kSinTouch = 0.28;
/// Tangent of 10 degrees, half of the angle of kCosSameFace: at a joint of a curved edge, a crossing falls
/// between two segments, and beyond the end of each by up to this share of the gap.
/// Assumed; no test pins it.
inline constexpr double kTanPastEnd = 0.18;

// --- Lengths of contact ------------------------------------------------------------------------------------

/// Places are one if they are nearer. A twentieth of the default contact margin: far above the noise of a
/// part at rest, 1 nm, and below any depth that matters. Contacts keep their planes for a motion by less, and
/// a candidate that was a contact is preferred to one that is nearer by less [m].
/// Test: I_flush.
inline constexpr double kSamePlace_m = 1e-6;
/// Gaps are one if they differ by less: it is not worth a query, and a contact's role does not change [m].
/// Test: Replay.
inline constexpr double kSameGap_m = 1e-7;
/// More than the seam between parts that are mounted on each other. [m].
/// Assumed; no test pins it.
inline constexpr double kSeam_m = 10e-6;
/// Of the contact margin: overlaps below it are left to the solver's push. 1 um of 20 um, far above what the
/// solver leaves.
/// Test: Replay.
inline constexpr double kToleratedShare = 0.05;
/// Of the overlap that is tolerated: by this an older overlap may grow in a step, since it is rounded.
/// Assumed; no test pins it.
inline constexpr double kGrowthShare = 0.1;
/// Of the contact margin: a step whose rounds did not end goes on as far as points are no deeper. With their
/// growth 10 um of 20, what an impact may leave; with less, steps would end early for what the push removes.
/// Assumed; no test pins it.
inline constexpr double kUnsolvedShare = 0.5 / (1 + kGrowthShare);
/// Of the contact margin: a contact that carries load ends the step no farther apart. Half of the gap at
/// which edges rest; with a tenth, some polygons roll better and others worse, and a nut's step takes longer.
/// Assumed; no test pins it.
inline constexpr double kApartShare = 0.0025;
/// Of the contact margin: a vertex that is higher than the middle of its facet by less is no feature. With
/// 20 um: facets of 1 mm on a ball of 14 mm have vertices 14 um high, which are; those of 0.2 mm on a ball of
/// 5 mm 1 um high. The families C_balls and G_impact need it.
/// Test: C_balls.
inline constexpr double kFacetCornerShare = 0.25;
/// Of the query range, and of the cutoff: greatest overlap of edges that counts as a crossing. At
/// greater depth shell points lie inside and act instead.
/// Assumed; no test pins it.
inline constexpr double kEdgeDepthShare = 0.25;
/// Of the rest gap: features that start nearer are held by a contact, even if they do not come nearer.
/// Test: I_flush.
inline constexpr double kHeldShare = 0.2;
/// Error of the field's distance in voxels, at edges and elsewhere. Measured: 0.40 of an edge's point beside
/// an edge.
/// Test: Replay.
inline constexpr double kEdgeError_voxels = 0.45;
/// Test: I_flush.
inline constexpr double kFaceError_voxels = 0.05;
/// Of the shell's spacing: points that are farther than the nearest by no more are reported too, as those of
/// a face that lies opposite a face.
/// Assumed; no test pins it.
inline constexpr double kBeyondShare = 0.1;
/// Of the shell's spacing: a curved face's point is found to within this; normals then differ by less than a
/// thousandth.
/// Test: Replay.
inline constexpr double kNearestShare = 5e-3;

// --- Motion within a step ----------------------------------------------------------------------------------

/// A step that ends early goes this share of the way to the place. A body with less than the rest of its way
/// stands; what is still too deep is moved by the other body.
/// Assumed; no test pins it.
inline constexpr double kShortShare = 0.9;
/// Bodies that start inside each other separate no faster [m/s].
/// Assumed; no test pins it.
inline constexpr double kSeparation_m_s = 0.05;
/// A slower contact point has no direction of slip. Far above a resting part's jitter [m/s].
/// Test: Replay.
inline constexpr double kSliding_m_s = 1e-4;

// --- Convergence of the solver -----------------------------------------------------------------------------

/// Of the greatest limit of friction, and of a coupling's law: a smaller change does not matter.
/// Assumed; no test pins it.
inline constexpr double kSettledShare = 1e-6;
/// Of the island's fastest speed: the solver's error. A micrometre on a path of a decimetre.
/// Test: I_flush.
inline constexpr double kSpeedErrorShare = 1e-5;
/// What the terms of a sum gain on each other. Of the residual, how accurate a contact's law is (the whole
/// one turned a nut by 2 %, since it has one sign from step to step); of a slope, when a line search ends;
/// how much less a round's error must be than the last one's for the contacts not to become stiffer, and by
/// how much softer they are after a round that did not end [Bertsekas 1982, ch. 2].
/// Test: B_mass_ratio_turns.
inline constexpr double kAccuracyShare = 0.1;
/// Error that the first round is solved for [m/s].
/// Test: Replay.
inline constexpr double kFirstError_m_s = 1e-2;
/// Of the compliance of a free body: a contact's, at first and at least. A stiff contact leaves little error
/// in a round, but Newton's method needs many steps from a distant start; for a compliant one it is the
/// reverse.
/// Test: B_mass_ratio_turns.
inline constexpr double kFirstCompliance = 0.1;
/// Test: Replay and B_mass_ratio_turns, at ten times.
inline constexpr double kLeastCompliance = 1e-7;
/// From one round to the next: of the compliance, and of the error of the last one, to which it is solved.
/// With a tenth, a third of the problems of a pile end in a round that does not end; with 0.8 there are too
/// many rounds.
/// Test: ContactNewton.SettlesTheFrictionOfAHeapInFewSteps.
inline constexpr double kRoundShare = 0.5;
/// Of a face's load: contacts that share it evenly but for less are left as they are, so that what rests
/// needs no new solution in each step. Test: EvenPressure.LeavesWhatIsEvenAndWhatIsHeldInOneWay, and piles at
/// rest.
inline constexpr double kEvenShare = 0.05;
/// Of a face's load: what an even pressure may leave to the solver. Contacts of a thread, whose normals all
/// lean alike, carry some moments only by great impulses against each other. Test:
/// EvenPressure.KeepsForceAndMomentOfAnyLoadAndNothingPulls, M_torque.
inline constexpr double kUnspreadShare = 1e-4;
/// Stiffness of a joint, and mass of a body in directions in which it is held, relative to that of a free
/// body: joints are springs that miss their target by a millionth. They have no multipliers, since rows of
/// joints often contradict each other.
/// Assumed; no test pins it.
inline constexpr double kRigidRatio = 1e6;
/// A push that separates overlapping bodies is softer by this share.
/// Test: I_flush.
inline constexpr double kPushSoftness = 0.1;
/// Of the fastest approach: a slower one is no impact of its own, but is stopped. Contacts of flush faces
/// that rest on each other would otherwise be reflected or not by the sign of their rounding, and the bodies
/// would turn. It costs at most the square of this in energy.
/// Assumed; no test pins it.
inline constexpr double kSlowApproachShare = 1e-2;

// --- Budgets -----------------------------------------------------------------------------------------------

/// Rounds of a correction by a check, or halvings; most need two or three.
/// Test: B_mass_ratio_turns.
inline constexpr int kMostRounds = 8;
/// Times that a contact's place, or its row, is taken anew; most need one or two.
/// Test: Replay.
inline constexpr int kMostRetakes = 5;
/// Iterations that converge in a few where they converge at all, and Newton steps that are always allowed:
/// where the latter are cut short, each step is solved again for the contacts that it misses.
/// Test: Replay.
inline constexpr int kMostIterations = 60;
/// Sweeps over the friction of an impact, which converge slowly where flush faces have dozens of contacts.
/// Assumed; no test pins it.
inline constexpr int kMostImpactSweeps = 400;
/// Places that are looked at along one path or one search direction.
/// Test: Replay.
inline constexpr int kMostPlaces = 20;
/// Contacts of a kind that are added for a pair in one check. A body is held by six; the next check adds
/// more.
/// Test: Replay.
inline constexpr std::size_t kMostAdded = 8;
/// Stretches of the path of one step, each as long as a query sees: 0.5 m at a voxel of 0.25 mm.
/// Assumed; no test pins it.
inline constexpr double kMostStretches = 1000;
/// Products of rows in one impact, about 0.1 s. A body between two others of R times its mass takes
/// pi sqrt(R / 2) impacts, of some 300 products each between flush faces.
/// Assumed; no test pins it.
inline constexpr std::size_t kMostImpactWork = 10'000'000;

}  // namespace vps
