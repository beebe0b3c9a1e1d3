// SPDX-License-Identifier: BSD-3-Clause
// From all points of a pair that are near the other side to those that the solver is given: a few rigid
// contacts (rigid_selection.cpp), or every point that presses (penalty_selection.cpp).
#pragma once

#include <vector>

#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

// Both contact methods use these.

/// Adds the points nearer to the other side than the cutoff, both ways if the settings say so. With a pair's
/// state, which makes repeated queries cheaper, possibly more points than that, and of many near points only
/// the most urgent of each place.
/// @param motion  with a state: that of the bodies from where they are
void findPointCandidates(const PairView& pair, double cutoff_m, Context& context, std::vector<Candidate>& out,
                         PairState* state = nullptr, const RelativeMotion* motion = nullptr);

/// True in a pair's first step, and where contacts of the last selection overlap by more than depth_m.
bool mayOverlap(const Selection& last, double depth_m);

/// Adds points, as findPointCandidates(), and crossings of edges.
void findCandidates(const PairView& pair, double cutoff_m, Context& context, std::vector<Candidate>& out,
                    PairState* state = nullptr, const RelativeMotion* motion = nullptr);

/// Adds the candidates of the step. A body that moves less than the query range is queried once, where it is.
/// So is one that is fast only because it turns: what it needs beside the points that come to the surface on
/// their way from there, the check of the solved step finds. Another fast one is queried at several places
/// along its path, so that it cannot tunnel; the plane that it meets first then holds for the whole step.
void findStepCandidates(const PairView& pair, const RelativeMotion& motion, PairState& state,
                        std::vector<Candidate>& out);

/// True if a body is so slow that it cannot leave the query range within the step.
bool isQueriedOnce(const PairView& pair, const RelativeMotion& motion);

/// True if it could, but only by its turn, its centre stays within the query range, and the solved step is
/// checked.
bool turnsInPlace(const PairView& pair, const RelativeMotion& motion);

/// Refines the candidates by the exact surfaces, if the settings say so.
void refineAll(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
               std::vector<Candidate>& candidates);

/// The same for those of findStepCandidates(), each where it was found: from where a fast body is now,
/// another surface may be the nearest, or none within reach.
void refineOnWay(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                 std::vector<Candidate>& candidates);

/// Replaces the distances of refined contacts that slide along a face by those that give the right gap at the
/// end of the step in free motion.
void measureAtEnd(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                  std::vector<Candidate>& candidates);

void dropUnreachable(const RelativeMotion& motion, std::vector<Candidate>& candidates);

/// Reduces thousands of near points to the few contacts that support the part.
/// @param writer  knows last step's contacts; may be null
/// @param selection  gets what a check of the solved step needs, of the candidates left out as well; may be
/// null
void selectContacts(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                    ManifoldWriter* writer, std::vector<Candidate>& candidates,
                    Selection* selection = nullptr);

void storeSelection(const std::vector<Candidate>& contacts, const PairView& pair,
                    const RelativeMotion& motion, Selection& selection);

/// True if the stored selection is still valid for this step.
bool hasNotMoved(const Selection& selection, const PairView& pair, const RelativeMotion& motion);

/// How much farther than at the time of the selection any point of the smaller body may go in the step [m].
double motionChange_m(const Selection& selection, const PairView& pair, const RelativeMotion& motion);

/// Carries a selection's planes to where the bodies are now. Within kSamePlace_m that is as good as a query.
CandidateMotion motionSince(const Selection& selection, const PairView& pair);

/// True if bodies meet within the step at a contact with restitution. Bullet's own solver then lets them
/// bounce at once: early by less than a step's travel, with the right speed. bullet::Solver solves for the
/// gap, and has restitution.h.
/// @param gap_m, predicted_m  now, and at the end of the step in free motion
bool meetsWithBounce(double restitution, double gap_m, double predicted_m, double dt_s);

/// Leaves the points their shares of the faces that the other body faces: a point on an edge belongs in part
/// to each of its faces, and one on a wall beside a face that touches to none that touches.
void keepFacingShares(const PairView& pair, std::vector<Candidate>& points);

/// Gives the contacts that were chosen the area of all points that touch: each point's to the contact nearest
/// to it, then so corrected that the contacts have the same area, centre and second moments as the points.
/// Of curved faces that lie flush in each other, a contact may be exchanged for a point nearer to the middle
/// of its part. Polynomials of second degree are then integrated exactly, and the mean distance of a face
/// from an axis, on which the moment of friction depends, to a few per cent.
/// @param all       points with their areas
/// @param chosen    some of them; in ascending key order afterwards
/// @param length_m  size of the smaller body
/// Cost: all times chosen, some 2 ns each, and 5 us.
void shareAreas(const std::vector<Candidate>& all, double length_m, std::vector<Candidate>& chosen);

/// The nearest points of two bodies that are within `wanted_m`, measured by the exact surfaces: the nearest
/// place around the nearest shell point of either side, and the points that are farther by no more than a
/// tenth of the spacing. Only the spheres and triangles that can hold them are visited, so the cost hardly
/// depends on `wanted_m`.
std::vector<Candidate> nearestFarPoints(const PairView& pair, double wanted_m, Context& context);

// The two contact methods: set state.contacts for the coming step; with penalty, state.penalty as well.

void selectRigid(const PairView& pair, PairState& state);
void selectPenalty(const PairView& pair, PairState& state);

}  // namespace vps::bullet
