// SPDX-License-Identifier: BSD-3-Clause
// What is stored from step to step: for a pair of bodies, and for all pairs of one installation.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/pair/manifold_writer.h"
#include "narrowphase/pair/pair_view.h"
#include "native_shapes/native_shape.h"
#include "solver/penalty/penalty_pair.h"
#include "solver/rigid/contact_loop.h"
#include "solver/rigid/step_check.h"
#include "vps/edge_crossing.h"
#include "vps/feature_motion.h"
#include "vps/spin_clearance.h"
#include "vps_bullet/settings.h"

namespace vps::bullet {

class NativeShapeCache;
class PenaltyContacts;
class StepChecks;
struct TurnReports;

struct Context {
  Settings settings;
  std::shared_ptr<NativeShapeCache> native_shapes;
  std::shared_ptr<PenaltyContacts> penalty_contacts;
  std::shared_ptr<StepChecks> step_checks;
  std::shared_ptr<TurnReports> turn_reports;
  // Atomic: btCollisionDispatcherMt processes pairs in parallel.
  std::atomic<std::size_t> pair_updates{0}, points_tested{0}, candidates{0}, contacts{0}, left_out{0},
      overlapping_starts{0};
  std::atomic<double> deepest_start_m{0};
};

/// The contacts selected by a full query, and where the bodies were.
struct Selection {
  std::vector<Candidate> contacts;
  bool is_valid = false;
  Pose X_01;                              ///< body 1 in body 0
  double reach_m = 0;                     ///< margin and the bodies' own motion in the step
  Pose X_W0;                              ///< of body 0
  Twist V;                                ///< RelativeMotion::V
  ShapeKey key[2];                        ///< of sides that are no Shape
  std::vector<Candidate> penalty_points;  ///< with penalty contact: all that can touch
  std::vector<Candidate> refined;         ///< with rigid contact: all whose exact distance is known
  bool leaves_out = false;                ///< not all of these are contacts
  bool is_of_path = false;  ///< only what a fast body met first on its predicted path was considered
  double any_way_m = 0;     ///< otherwise: points that could move so far in any direction were
  double sampling_m = 0;  ///< greatest size of an area from which only the most urgent points were considered
};

/// The way of a step on which a check found nothing that was missed. What it found holds for any way that
/// begins and ends within a share of the rest gap of this one: most pairs move alike in the rounds of a step,
/// and what rests, from step to step.
class ClearWay {
 public:
  void forget() { is_known_ = false; }
  void remember(const PairView& start, const Pose& X_01_end, bool with_small_gaps) {
    X_01_start_ = start.X_01();
    X_01_end_ = X_01_end;
    for (const int i : {0, 1}) key_[i] = start.key(i);
    is_known_ = true;
    has_small_gaps_ = with_small_gaps;
  }
  /// @param with_small_gaps  gaps that were small at the start are looked at, too
  /// @param apart_m          how far a point may be from where it was on this way
  [[nodiscard]] bool covers(const PairView& start, const Pose& X_01_end, bool with_small_gaps,
                            double apart_m) const {
    const auto isNear = [&](const Pose& X_01, const Pose& had) {
      return start.movedBy_m(X_01 * had.inverse()) <= apart_m;
    };
    return is_known_ && (has_small_gaps_ || !with_small_gaps) && start.key(0) == key_[0] &&
           start.key(1) == key_[1] && isNear(start.X_01(), X_01_start_) && isNear(X_01_end, X_01_end_);
  }

 private:
  Pose X_01_start_, X_01_end_;
  ShapeKey key_[2];  // of sides that are no Shape
  bool is_known_ = false, has_small_gaps_ = false;
};

struct PairState {
  std::shared_ptr<Context> context;
  std::unique_ptr<ManifoldWriter> writer;
  Selection selection;
  std::vector<Candidate> contacts;  ///< of the coming step
  RelativeMotion motion;
  bool is_prepared = false;
  int turns_in_row = 0;               ///< steps in which the bodies turned too far against each other
  double fastest_rad_s = 0;           ///< their greatest rotation in these
  bool was_queried = false;           ///< in an earlier step
  bool is_incomplete = false;         ///< the solved step needed more contacts than the selection has
  std::unique_ptr<StepCheck> check;   ///< with rigid contact
  std::unique_ptr<ContactLoop> loop;  ///< with rigid contact, in a world whose solver asks no check
  FeatureMotion features;             ///< with rigid contact: of the models
  std::vector<FeatureContact> missed_features;  ///< with rigid contact: what earlier steps lacked, still near
  ClearWay clear_way;                           ///< with rigid contact
  std::vector<std::uint64_t> let_go;            ///< keys of contacts, in this step: see letGo()
  SpinClearance spin;                           ///< with rigid contact: of the models
  CrossingMemory crossings;                     ///< with rigid contact: of the models' edges
  PenaltyPair penalty;                          ///< with penalty contact
  bool is_registered = false;                   ///< penalty is in the context's PenaltyContacts
  std::optional<QueryState> query_state[2];     ///< of side 0's points in side 1's map, and the reverse
  std::vector<std::uint32_t> always[2];         ///< ids of the points last selected, for the query
  std::optional<bool> are_both_curved;          ///< both shapes have facets that stand for curved surfaces
  std::uint64_t revision[2] = {0, 0};  ///< of the shapes that the ids in writer and selection belong to

  /// Lets go of a contact that carries load though nothing faces its point any more. False: it was let go in
  /// this step already, and found again without its row. So the rounds of a step end.
  bool letGo(std::uint64_t key) {
    if (std::find(let_go.begin(), let_go.end(), key) != let_go.end()) return false;
    let_go.push_back(key);
    return true;
  }
};

}  // namespace vps::bullet
