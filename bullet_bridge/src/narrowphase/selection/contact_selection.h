// SPDX-License-Identifier: BSD-3-Clause
// Selects the contacts of the solver from all near points of a pair: a few rigid contacts
// (rigid_selection.cpp), or every point that presses (penalty_selection.cpp).
#pragma once

#include <vector>

#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

// Functions of both contact methods.

/// Appends the points that are nearer to the other side than the cutoff, of both sides if Settings::sides is
/// Both. A pair's state makes repeated queries cheaper; points beyond the cutoff may then be included, and
/// where many points are near only the most urgent point of each place is.
/// @param motion  with a state: the bodies' motion from their present poses
void findPointCandidates(const PairView& pair, double cutoff_m, Context& context, std::vector<Candidate>& out,
                         PairState* state = nullptr, const RelativeMotion* motion = nullptr);

/// True in a pair's first step, and if a contact of the last selection overlaps by more than depth_m.
bool mayOverlap(const Selection& last, double depth_m);

/// Appends points, as findPointCandidates(), and crossings of edges.
void findCandidates(const PairView& pair, double cutoff_m, Context& context, std::vector<Candidate>& out,
                    PairState* state = nullptr, const RelativeMotion* motion = nullptr);

/// Appends the candidates of the step. A body that moves less than the query range is queried once, at its
/// present pose. A body that is fast only because it turns in place (turnsInPlace()) is queried once too; the
/// check of the solved step finds the contacts that this query lacks. Any other fast body is queried at
/// several places along its path, so that it cannot tunnel; the plane that a point meets first then holds for
/// the whole step.
void findStepCandidates(const PairView& pair, const RelativeMotion& motion, PairState& state,
                        std::vector<Candidate>& out);

/// True if a body is so slow that it cannot leave the query range within the step.
bool isQueriedOnce(const PairView& pair, const RelativeMotion& motion);

/// True if a body could leave the query range, but only by its rotation: its centre stays within the range,
/// and the solved step is checked.
bool turnsInPlace(const PairView& pair, const RelativeMotion& motion);

/// Refines the candidates by the exact surfaces, if Settings::use_surfaces is set.
void refineAll(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
               std::vector<Candidate>& candidates);

/// Refines the candidates of findStepCandidates(), each at the place of the path where it was found. At the
/// present pose of a fast body another surface may be the nearest one, or none may be within reach.
void refineOnWay(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                 std::vector<Candidate>& candidates);

/// Corrects the distances of refined contacts that slide along a face, so that their gaps at the end of the
/// step in free motion are exact.
void measureAtEnd(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                  std::vector<Candidate>& candidates);

void dropUnreachable(const RelativeMotion& motion, std::vector<Candidate>& candidates);

/// Reduces thousands of near points to the few contacts that support the part.
/// @param writer  has last step's contacts; may be null
/// @param selection  receives what a check of the solved step needs, including the candidates that are left
/// out; may be null
void selectContacts(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                    ManifoldWriter* writer, std::vector<Candidate>& candidates,
                    Selection* selection = nullptr);

void storeSelection(const std::vector<Candidate>& contacts, const PairView& pair,
                    const RelativeMotion& motion, Selection& selection);

/// True if the stored selection is still valid for this step.
bool hasNotMoved(const Selection& selection, const PairView& pair, const RelativeMotion& motion);

/// Upper bound of how much the step's motion of any point of the smaller body differs from its motion at the
/// time of the selection [m].
double motionChange_m(const Selection& selection, const PairView& pair, const RelativeMotion& motion);

/// Motion that carries a selection's planes to the present poses. Within kSamePlace_m the carried planes are
/// as good as a query.
CandidateMotion motionSince(const Selection& selection, const PairView& pair);

/// True if bodies meet within the step at a contact with restitution. Bullet's own solver then lets the
/// bodies bounce at once, with the right speed but early by less than a step's travel. bullet::Solver solves
/// for the gap and applies restitution.h.
/// @param gap_m, predicted_m  the gap now, and at the end of the step in free motion
bool meetsWithBounce(double restitution, double gap_m, double predicted_m, double dt_s);

/// Reduces each point's area to the share on faces that face the other body. A point on an edge belongs in
/// part to each adjacent face; a point on a wall beside a touching face has no share.
void keepFacingShares(const PairView& pair, std::vector<Candidate>& points);

/// Distributes the area of all touching points over the chosen contacts. Each point's area goes to the
/// nearest contact; the areas are then corrected so that the contacts have the same total area, centre and
/// second moments as the points. On curved faces that lie flush in each other, a contact may be exchanged for
/// a point nearer to the middle of its area. Polynomials of second degree are then integrated exactly, and
/// the mean distance of a face from an axis, on which the moment of friction depends, to a few per cent.
/// @param all  all candidates, with their areas
/// @param chosen  some of `all`; sorted by key on return
/// @param length_m  size of the smaller body
/// Cost: all times chosen, some 2 ns each, and 5 us.
void shareAreas(const std::vector<Candidate>& all, double length_m, std::vector<Candidate>& chosen);

/// Nearest points of two bodies within `wanted_m`, beyond the range of the fields, measured by the exact
/// surfaces: the nearest place around the nearest shell point of either side, and the points that are farther
/// by no more than a tenth of the spacing. Only the spheres and triangles that can hold such points are
/// visited, so the cost hardly depends on `wanted_m`.
std::vector<Candidate> nearestFarPoints(const PairView& pair, double wanted_m, Context& context);

// The two contact methods. Each method sets state.contacts for the coming step; selectPenalty() also sets
// state.penalty.

void selectRigid(const PairView& pair, PairState& state);
void selectPenalty(const PairView& pair, PairState& state);

}  // namespace vps::bullet
