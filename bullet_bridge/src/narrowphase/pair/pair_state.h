// SPDX-License-Identifier: BSD-3-Clause
// State that is kept from step to step: of one pair of bodies, and of all pairs of one installation.
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
  // Counters are atomic since btCollisionDispatcherMt processes pairs in parallel.
  std::atomic<std::size_t> pair_updates{0}, points_tested{0}, candidates{0}, contacts{0}, left_out{0},
      overlapping_starts{0};
  std::atomic<double> deepest_start_m{0};
};

/// The contacts selected by a full query, and the bodies' poses at that time.
struct Selection {
  std::vector<Candidate> contacts;
  bool is_valid = false;
  Pose X_01;                              ///< pose of body 1 in body 0
  double reach_m = 0;                     ///< contact margin plus the bodies' own motion in the step
  Pose X_W0;                              ///< pose of body 0
  Twist V;                                ///< RelativeMotion::V
  ShapeKey key[2];                        ///< keys of sides that are not a Shape
  std::vector<Candidate> penalty_points;  ///< with penalty contact: all points that can touch
  std::vector<Candidate> refined;  ///< with rigid contact: all candidates whose exact distance is known
  bool leaves_out = false;         ///< some refined candidates are not contacts
  bool is_of_path = false;         ///< only what a fast body meets first on its predicted path was considered
  double any_way_m = 0;            ///< distance within which points were searched in every direction
  double sampling_m = 0;  ///< greatest size of an area of which only the most urgent points were considered
};

/// Motion in a step for which a check found no missed contact. The result holds for any motion that begins
/// and ends within a share of the rest gap of that motion. Most pairs repeat their motion from one
/// check of a step to the next, and bodies at rest from step to step.
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
  /// @param with_small_gaps  the check also looks at gaps that were small at the start
  /// @param apart_m  greatest allowed displacement of a point from the remembered motion
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
  ShapeKey key_[2];  // keys of sides that are not a Shape
  bool is_known_ = false, has_small_gaps_ = false;
};

struct PairState {
  std::shared_ptr<Context> context;
  std::unique_ptr<ManifoldWriter> writer;
  Selection selection;
  std::vector<Candidate> contacts;  ///< contacts of the coming step
  RelativeMotion motion;
  bool is_prepared = false;
  int turns_in_row = 0;        ///< consecutive steps in which the bodies turned too far against each other
  double fastest_rad_s = 0;    ///< the bodies' greatest relative rotation rate in these steps
  bool was_queried = false;    ///< the pair was queried in an earlier step
  bool is_incomplete = false;  ///< the solved step needed contacts that the selection lacks
  std::unique_ptr<StepCheck> check;   ///< with rigid contact
  std::unique_ptr<ContactLoop> loop;  ///< with rigid contact, in a world whose solver calls no check
  FeatureMotion features;             ///< with rigid contact: features of the models
  std::vector<FeatureContact> missed_features;  ///< with rigid contact: feature contacts that earlier steps
                                                ///< missed and that are still near
  ClearWay clear_way;                           ///< with rigid contact
  std::vector<std::uint64_t> let_go;  ///< keys of the contacts of this step that letGo() was called for
  SpinClearance spin;                 ///< with rigid contact: free space around the models
  CrossingMemory crossings;           ///< with rigid contact: crossings of the models' edges
  PenaltyPair penalty;                ///< with penalty contact
  bool is_registered = false;         ///< `penalty` is registered in the context's PenaltyContacts
  std::optional<QueryState> query_state[2];  ///< for side 0's points in side 1's map, and the reverse
  std::vector<std::uint32_t> always[2];      ///< ids of the points last selected, for the query
  std::optional<bool> are_both_curved;       ///< cached result of areBothCurved()
  std::uint64_t revision[2] = {
      0, 0};  ///< revisions of the shapes to which the ids in writer and selection refer

  /// Notes that a contact is let go: it carries load although no surface faces its point. Returns false if
  /// the contact was let go in this step before, so that the rounds of a step end.
  bool letGo(std::uint64_t key) {
    if (std::find(let_go.begin(), let_go.end(), key) != let_go.end()) return false;
    let_go.push_back(key);
    return true;
  }
};

}  // namespace vps::bullet
