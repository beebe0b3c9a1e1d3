// SPDX-License-Identifier: BSD-3-Clause
#include "proof/places.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "fits/fits.h"
#include "pair/pair_measures.h"
#include "pair/touches.h"
#include "proof/blocked_proof.h"
#include "proof/clash_groups.h"
#include "proof/pose_cover.h"
#include "text/words.h"
#include "vps/box_intersection.h"
#include "vps/mesh_overlap.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

/// Remaining overlap that the search accepts: a few times the precision of deepestOverlap().
constexpr double kClear_m = 3 * kOverlapCertain_m;
static_assert(kClear_m + kOverlapCertain_m < kContactDepth_m);

/// Limit of the work for one group of clashing parts, in the unit of Overlap::work: half a minute of one
/// core.
constexpr std::size_t kMostPlaceWork = 30'000'000;

/// Limit of the work for the proof that one pair overlaps at all its poses, in the unit of PoseCover::work.
constexpr std::size_t kMostCoverWork = 10'000'000;

constexpr std::size_t kMostNamed = 4;  // parts that are named in a message

/// Bodies that are moved, and their motions.
struct Moving {
  std::vector<std::size_t> bodies;
  std::vector<std::size_t> variable;  ///< by body: its index in `bodies`, or GapRow::kHeld
  std::vector<LooseBody> loose;
  Motions x;
};

/// The outcome of moving some bodies.
struct Tried {
  Moving moving;
  bool has_limits = true;  ///< false for a proof, whose forces must be in balance without those of FitLimit
  bool is_free = false;
  double left_m = 0;  ///< deepest remaining overlap beyond the allowed depth
  std::vector<SixNumbers> motion;
  std::vector<Pose> X_WP;
  std::vector<PressedTouch> pressed;  ///< touches of the last step
};

/// The search for places without overlap, and for proofs that no such places exist.
class PlaceSearch {
 public:
  PlaceSearch(const std::vector<PlacedSurface>& parts, const CheckResult& checked)
      : parts_(parts),
        checked_(checked),
        bodies_(looseBodies(parts, checked)),
        body_of_(bodyOfPart(bodies_, parts.size())),
        clashes_(parts, checked, bodies_),
        motion_(bodies_.size(), SixNumbers::Zero()) {
    for (const PlacedSurface& part : parts) X_WP_.push_back(part.X_WP);
  }

  [[nodiscard]] CheckedPlaces search(const Progress& progress) {
    constexpr const char* kDoing = "searching for places without overlap";
    StoppableWork search(progress, kDoing);
    CheckedPlaces out;
    const std::vector<std::vector<std::size_t>> groups = clashes_.groups();
    const auto add = [&out](CheckedGroup group) {
      const bool is_worse = group.verdict == Verdict::Blocked || out.verdict == Verdict::Fits;
      if (group.verdict != out.verdict && out.verdict != Verdict::Blocked && is_worse) {
        out.verdict = group.verdict;
        out.reason = group.reason;
      }
      out.groups.push_back(std::move(group));
    };
    for (std::size_t i = 0; i < groups.size(); ++i) {
      search.report(kDoing, double(i) / double(groups.size()));
      std::vector<std::string> names;
      for (const std::size_t body : groups[i])
        for (const std::size_t part : bodies_[body].parts) names.push_back(parts_[part].name);
      std::ranges::sort(names);
      auto [verdict, reason] = freeGroup(groups[i], out.verdict == Verdict::Blocked);
      add({std::move(names), verdict, std::move(reason)});
    }
    for (const NearPair& pair : clashes_.tied()) pollStop(), add(tiedGroup(pair));
    if (out.verdict == Verdict::Fits && !isFree(movedPairs(), X_WP_)) {
      out.verdict = Verdict::NotShown;
      out.reason = "no places without overlap were found for all parts at once";
    }
    appendMoved(out.moved);
    return out;
  }

 private:
  using Answer = std::pair<Verdict, std::string>;

  /// Two clashing parts that no motion of the search separates.
  [[nodiscard]] CheckedGroup tiedGroup(const NearPair& pair) const {
    CheckedGroup out;
    out.parts = {parts_[pair.a].name, parts_[pair.b].name};
    out.verdict = Verdict::Blocked;
    std::ranges::sort(out.parts);
    out.reason = provenAlone(pair);
    if (!out.reason.empty()) return out;
    const bool is_fixed =
        mayMove_m(parts_[pair.a]) + mayMove_m(parts_[pair.b]) == 0 && std::isfinite(pair.error_m);
    if (!is_fixed) out.verdict = Verdict::NotShown;
    out.reason = quoted(parts_[pair.a].name) + " and " + quoted(parts_[pair.b].name) + " overlap and are " +
                 (is_fixed ? "both fixed" : "tied to each other by fixed parts or press fits");
    return out;
  }

  /// @param is_quick  asks only for the proofs that need no search
  [[nodiscard]] Answer freeGroup(const std::vector<std::size_t>& group, bool is_quick) {
    std::vector<const NearPair*> clashes;
    for (const NearPair& pair : clashes_.pairs())
      if (clashes_.isOf(group, pair)) clashes.push_back(&pair);
    for (const NearPair* pair : clashes)
      if (std::string why = provenAlone(*pair); !why.empty()) return {Verdict::Blocked, std::move(why)};
    if (is_quick) return {Verdict::NotShown, "places were not searched for, since other parts are blocked"};
    for (const NearPair* pair : clashes)
      if (std::string why = hiddenByFacets(*pair); !why.empty()) return {Verdict::NotShown, std::move(why)};
    Tried last;
    std::size_t most_moved = 0;
    work_ = 0;
    for (const std::vector<std::size_t>& moved : clashes_.tries(group)) {
      if (work_ >= kMostPlaceWork) break;
      Tried tried = move(moved);
      if (tried.is_free) {
        motion_ = std::move(tried.motion);
        X_WP_ = std::move(tried.X_WP);
        return {Verdict::Fits, ""};
      }
      if (std::string why = proven(tried.pressed); !why.empty()) return {Verdict::Blocked, std::move(why)};
      std::size_t parts_moved = 0;
      for (const std::size_t body : moved) parts_moved += bodies_[body].parts.size();
      most_moved = std::max(most_moved, parts_moved);
      last = std::move(tried);
    }
    for (const NearPair* pair : clashes)
      if (std::string why = provenByCover(*pair); !why.empty()) return {Verdict::Blocked, std::move(why)};
    return {Verdict::NotShown, notShownWords(group, most_moved, last)};
  }

  /// The reason why no places were found.
  /// @param most_moved greatest number of parts that a try moved
  [[nodiscard]] std::string notShownWords(const std::vector<std::size_t>& group, std::size_t most_moved,
                                          const Tried& last) const {
    std::vector<std::string> names;
    double allowed_m = 0;
    for (const std::size_t body : group) {
      if (bodies_[body].is_fixed) continue;
      allowed_m = std::max(allowed_m, bodies_[body].allowed_m);
      for (const std::size_t part : bodies_[body].parts) names.push_back(parts_[part].name);
    }
    const bool has_fits =
        std::ranges::any_of(group, [&](std::size_t body) { return !bodies_[body].limits.empty(); });
    std::string why = "no places without overlap were found for " + listed(names, kMostNamed) + " within " +
                      lengthInWords(allowed_m) + " of where " + (names.size() == 1 ? "it is" : "they are") +
                      " drawn" + (has_fits ? " and within the play of the fits" : "") +
                      ", and nothing proves that there are none";
    if (most_moved == 0) return why + "; too many parts overlap each other to be moved at once";
    why +=
        "; up to " + std::to_string(most_moved) + (most_moved == 1 ? " part was moved" : " parts were moved");
    // An overlap that the search accepts can still be a clash by the check's measure, which is greater.
    why += last.left_m <= kClear_m ? ", and no direction out was found"
                                   : ", with an overlap of " + lengthInWords(last.left_m) + " left";
    return why + (work_ < kMostPlaceWork ? "" : " when the search reached its limit");
  }

  /// The proof, in words, that the pair overlaps for all positions of its parts within kSightTolerance_m of
  /// the drawn positions; empty if nothing is proven.
  [[nodiscard]] std::string provenAlone(const NearPair& pair) const {
    const std::string& a = parts_[pair.a].name;
    const std::string& b = parts_[pair.b].name;
    const double apart_m = mayMove_m(parts_[pair.a]) + mayMove_m(parts_[pair.b]);
    // An overlap that only a fit shows may belong to round faces that are not in each other.
    if (pair.drawn_depth_m > apart_m + pair.error_m + kContactDepth_m && hiddenByFacets(pair).empty())
      return quoted(a) + " and " + quoted(b) + " overlap by " + lengthInWords(pair.drawn_depth_m) +
             ", more than the " + lengthInWords(apart_m) + " by which their drawn places may be off together";
    for (const CheckedFit& fit : checked_.fits) {
      const bool is_of_pair = (fit.shaft == a && fit.bore == b) || (fit.shaft == b && fit.bore == a);
      if (is_of_pair && isProvenByFit(parts_, fit))
        return quoted(fit.shaft) + " is " + lengthInWords(-fit.diametral_clearance_m) +
               " larger than its bore in " + quoted(fit.bore) + ", wherever it is in the bore";
    }
    return {};
  }

  /// The reason, in words, why a clash that only a fit shows cannot be cleared: meshes that do not show the
  /// overlap cannot show its absence either. Empty if the meshes show the overlap.
  [[nodiscard]] std::string hiddenByFacets(const NearPair& pair) const {
    // This depth is a lower bound that is found quickly; the exact depth takes a second.
    const PlacedSurface &a = parts_[pair.a], &b = parts_[pair.b];
    const Overlap found = deepestOverlap(a.surface->overlap(), a.X_WP, b.surface->overlap(), b.X_WP);
    if (found.depth_m > pair.error_m + kContactDepth_m) return {};
    const std::optional<CheckedPair> drawn = checkPair(parts_[pair.a], parts_[pair.b], checked_.near_m);
    if (drawn && drawn->state == PairState::Clash && !drawn->is_uncertain) return {};
    return "the overlap of " + quoted(parts_[pair.a].name) + " and " + quoted(parts_[pair.b].name) +
           " is less than the distance of their meshes from the true faces, so the meshes cannot show that a "
           "motion clears the overlap";
  }

  /// The proof, in words, that no motion within kSightTolerance_m clears the touches of a try; empty if
  /// nothing is proven. All bodies of the touches are moved from their drawn places, so that the forces on
  /// each body are in balance. Nothing is proven for parts that are pressed into each other, since they may
  /// be drawn at a wrong place in each other.
  [[nodiscard]] std::string proven(const std::vector<PressedTouch>& touches) const {
    std::vector<std::size_t> bodies;
    for (const PressedTouch& pressed : touches)
      for (const std::size_t part : {pressed.touch.of, pressed.touch.above})
        if (mayMove_m(parts_[part]) > 0) {
          if (bodies_[body_of_[part]].parts.size() > 1) return {};
          bodies.push_back(body_of_[part]);
        }
    std::ranges::sort(bodies);
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    if (bodies.size() > kMostBodies + 1) return {};
    // A large cost e keeps the motions, and so the remainders, small. A small cost keeps the forces in
    // balance.
    for (const double e : {1.0, 0.1, 0.01, 0.001}) {
      Tried tried = startOf(bodies);
      tried.has_limits = false;
      tried.pressed = touches;
      if (const double least_m = provenAfter(tried, e); least_m > 0) return provenWords(tried, least_m);
    }
    return {};
  }

  /// The proof, in words, that a pair overlaps at all relative poses that its parts may have within
  /// kSightTolerance_m of the drawn places; empty if nothing is proven. Nothing is proven for parts that are
  /// pressed into others, since they may be drawn at a wrong place in them.
  [[nodiscard]] std::string provenByCover(const NearPair& pair) const {
    const PlacedSurface *a = &parts_[pair.a], *b = &parts_[pair.b];
    PoseSet set;
    double turn_rad = 0;
    for (const std::size_t part : {pair.a, pair.b}) {
      const MovableBody& body = bodies_[body_of_[part]];
      if (body.is_fixed) continue;
      if (body.parts.size() > 1) return {};
      set.most_m += kSightTolerance_m;
      turn_rad += body.mostTurn(kSightTolerance_m);
    }
    if (!(set.most_m > 0) || !std::isfinite(pair.error_m)) return {};
    // Between points of both boxes, no two move farther apart than the corners of both boxes together.
    set.box_W = intersection(a->box_W, b->box_W);
    if (set.box_W.isEmpty()) return {};
    set.at_W = set.box_W.center();
    set.half << Vec3::Constant(set.most_m), Vec3::Constant(turn_rad);
    if (b->surface->mesh().triangles.size() < a->surface->mesh().triangles.size()) std::swap(a, b);
    const Obstacle obstacle{b->surface.get(), b->X_WP,
                            std::max(pair.error_m + kContactDepth_m, pair.allowed_m)};
    if (!coverPoses(*a->surface, a->X_WP, std::span(&obstacle, 1), set, kMostCoverWork).is_proven) return {};
    return "wherever " + quoted(parts_[pair.a].name) + " and " + quoted(parts_[pair.b].name) +
           " are within " + lengthInWords(kSightTolerance_m) +
           " of where they are drawn, they overlap by more than the error of their " + "meshes";
  }

  /// The result of provenOverlap_m() after the least motion of the touches for the cost e.
  double provenAfter(Tried& tried, double e) const {
    constexpr int kRounds = 4;
    // Greatest excess of a touch's bound over its gap, as a share of the deepest overlap. Touches with a
    // greater excess weaken the proof and are left out.
    constexpr double kMostBend = 0.6;
    solve(tried, e);
    const auto moved_m = [&] {
      std::vector<double> out(bodies_.size());
      for (std::size_t i = 0; i < bodies_.size(); ++i) out[i] = bodies_[i].mostMoved_m(tried.motion[i]);
      return out;
    };
    double deepest_m = 0;
    for (const PressedTouch& pressed : tried.pressed) deepest_m = std::max(deepest_m, pressed.weight);
    const std::vector<double> greatest_m =
        greatestGaps_m(parts_, tried.X_WP, tried.pressed, bodies_, moved_m());
    std::vector<PressedTouch> kept;
    for (std::size_t i = 0; i < greatest_m.size(); ++i) {
      const Touch& touch = tried.pressed[i].touch;
      const double gap_m = touch.gap_m(tried.X_WP[touch.of], tried.X_WP[touch.above]);
      if (greatest_m[i] - gap_m < kMostBend * deepest_m) kept.push_back(tried.pressed[i]);
    }
    tried.pressed = std::move(kept);
    for (int round = 0; round < kRounds; ++round) {
      for (PressedTouch& pressed : tried.pressed) {
        Touch& touch = pressed.touch;
        touch.renew(*parts_[touch.above].surface, tried.X_WP[touch.above].inverse() * tried.X_WP[touch.of]);
      }
      solve(tried, e);
    }
    return provenOverlap_m(parts_, tried.X_WP, tried.pressed, bodies_, moved_m());
  }

  [[nodiscard]] std::string provenWords(const Tried& tried, double least_m) const {
    std::vector<std::string> names;
    for (const PressedTouch& pressed : tried.pressed) {
      if (!(pressed.weight > 0)) continue;
      for (const std::size_t part : {pressed.touch.of, pressed.touch.above})
        if (std::ranges::find(names, parts_[part].name) == names.end()) names.push_back(parts_[part].name);
    }
    std::ranges::sort(names);
    return "wherever " + listed(names, kMostNamed) + " are within " + lengthInWords(kSightTolerance_m) +
           " of where they are drawn, some of them overlap by at least " +
           lengthInWords(least_m + kContactDepth_m) + " more than the error of their meshes";
  }

  /// The start of a try: the bodies that it moves, before the first step.
  [[nodiscard]] Tried startOf(const std::vector<std::size_t>& moved_bodies) const {
    Tried tried;
    tried.motion = motion_;
    tried.X_WP = X_WP_;
    Moving& moving = tried.moving;
    moving.bodies = moved_bodies;
    moving.variable.assign(bodies_.size(), GapRow::kHeld);
    moving.x.resize(6 * Eigen::Index(moved_bodies.size()));
    for (const std::size_t body : moved_bodies) {
      moving.x.segment<6>(6 * Eigen::Index(moving.loose.size())) = motion_[body];
      moving.variable[body] = moving.loose.size();
      moving.loose.push_back(bodies_[body].loose);
    }
    return tried;
  }

  /// Moves the bodies so that the gaps at the overlapping points (Touch) open as far as possible.
  void solve(Tried& tried, double e) const {
    Moving& moving = tried.moving;
    std::vector<GapRow> rows;
    for (const PressedTouch& pressed : tried.pressed) {
      const Touch& touch = pressed.touch;
      const Pose &X_WO = tried.X_WP[touch.of], &X_WA = tried.X_WP[touch.above];
      rows.push_back({moving.variable[body_of_[touch.of]], moving.variable[body_of_[touch.above]],
                      X_WO * touch.p_O, X_WA.R * touch.n_A, touch.gap_m(X_WO, X_WA) + pressed.allowed_m});
    }
    if (tried.has_limits)
      for (std::size_t i = 0; i < moving.bodies.size(); ++i)
        bodies_[moving.bodies[i]].appendLimits(i, tried.motion[moving.bodies[i]], rows);
    std::vector<double> closed_m;
    moving.x = leastMotion(rows, moving.loose, moving.x, e, closed_m);
    for (std::size_t k = 0; k < tried.pressed.size(); ++k) tried.pressed[k].weight = closed_m[k];
    for (std::size_t i = 0; i < moving.bodies.size(); ++i) {
      const std::size_t body = moving.bodies[i];
      tried.motion[body] = moving.x.segment<6>(6 * Eigen::Index(i));
      for (const std::size_t part : bodies_[body].parts)
        tried.X_WP[part] = movedPose(parts_[part].X_WP, bodies_[body].loose, tried.motion[body]);
    }
  }

  [[nodiscard]] bool isWithinTolerances(const Tried& tried) const {
    return std::ranges::all_of(tried.moving.bodies,
                               [&](std::size_t body) { return bodies_[body].allows(tried.motion[body]); });
  }

  /// Moves the bodies until no pair that contains one of them overlaps, or until no progress is made.
  [[nodiscard]] Tried move(const std::vector<std::size_t>& moved_bodies) {
    constexpr int kMostRounds = 40, kMostStalled = 8;
    constexpr double kGain = 0.9;
    Tried tried = startOf(moved_bodies);
    const auto isMoved = [&](std::size_t part) {
      return tried.moving.variable[body_of_[part]] != GapRow::kHeld;
    };
    std::vector<NearPair> pairs;
    for (const NearPair& pair : clashes_.pairs())
      if (isMoved(pair.a) || isMoved(pair.b)) pairs.push_back(pair);
    double best_m = std::numeric_limits<double>::infinity();
    int stalled = 0;
    for (int round = 0; round < kMostRounds && stalled < kMostStalled && work_ < kMostPlaceWork; ++round) {
      tried.left_m = addTouches(pairs, tried);
      if (tried.left_m <= kClear_m) {
        tried.is_free = isWithinTolerances(tried) && isFree(pairs, tried.X_WP);
        break;
      }
      stalled = tried.left_m < kGain * best_m ? 0 : stalled + 1;
      best_m = std::min(best_m, tried.left_m);
      solve(tried, kSearchMotionCost);
    }
    return tried;
  }

  /// Adds the touches of all pairs that overlap by more than allowed; returns the greatest excess.
  double addTouches(const std::vector<NearPair>& pairs, Tried& tried) {
    constexpr double kSame_m = 0.05e-6;  // smaller overlaps need no touch
    std::vector<PairTouches> found(pairs.size());
    onAllCores(pairs.size(), [&](std::size_t i) {
      found[i] = touchesOf(parts_, tried.X_WP, pairs[i].a, pairs[i].b, pairs[i].allowed_m + kSame_m);
    });
    double most_m = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      most_m = std::max(most_m, found[i].depth_m - pairs[i].allowed_m);
      work_ += found[i].work;
      for (const Touch& touch : found[i].touches) {
        const auto known = std::ranges::find_if(tried.pressed, [&](const PressedTouch& other) {
          return touch.vertex != Touch::kNoVertex && other.touch.vertex == touch.vertex &&
                 other.touch.of == touch.of && other.touch.above == touch.above;
        });
        if (known != tried.pressed.end())
          known->touch = touch;
        else
          tried.pressed.push_back({touch, pairs[i].allowed_m, pairs[i].error_m + kContactDepth_m});
      }
    }
    return most_m;
  }

  /// Whether no pair clashes at these poses, by the same measure as the check.
  [[nodiscard]] bool isFree(const std::vector<NearPair>& pairs, const std::vector<Pose>& X_WP) const {
    std::vector<PlacedSurface> at = parts_;
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i].X_WP = X_WP[i];
      at[i].box_W = Box();
    }
    std::vector<std::uint8_t> is_clash(pairs.size());
    for (const NearPair& pair : pairs)
      for (const std::size_t part : {pair.a, pair.b})
        if (at[part].box_W.isEmpty())
          for (const Vec3& p : at[part].surface->mesh().vertices) at[part].box_W.add(X_WP[part] * p);
    onAllCores(pairs.size(), [&](std::size_t i) {
      const std::optional<CheckedPair> pair = checkPair(at[pairs[i].a], at[pairs[i].b], checked_.near_m);
      // A pair that is uncertain at its drawn place makes the whole check uncertain, but not its new place.
      const bool is_new_doubt = pair && pair->is_uncertain && !pairs[i].is_uncertain;
      // A thread, seal or insert may overlap as drawn. Its clearance is not known, so no deeper overlap is
      // free.
      const bool is_as_drawn =
          pair && pairs[i].is_known && pair->interference_depth_m <= pairs[i].allowed_m + kContactDepth_m;
      const bool is_overlap = pair && pair->state == PairState::Clash && !is_as_drawn;
      is_clash[i] = is_overlap || is_new_doubt ? 1 : 0;
    });
    return std::ranges::count(is_clash, 1) == 0;
  }

  /// The pairs that contain a moved part.
  [[nodiscard]] std::vector<NearPair> movedPairs() const {
    std::vector<NearPair> out;
    for (const NearPair& pair : clashes_.pairs())
      if (!motion_[body_of_[pair.a]].isZero() || !motion_[body_of_[pair.b]].isZero()) out.push_back(pair);
    return out;
  }

  void appendMoved(std::vector<MovedPart>& out) const {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (motion_[i].isZero()) continue;
      for (const std::size_t part : bodies_[i].parts) {
        const Vec3 at_W = parts_[part].box_W.center();
        const Pose X = movedPose(Pose(), bodies_[i].loose, motion_[i]);
        out.push_back({parts_[part].name, X * at_W - at_W, motion_[i].tail<3>() / bodies_[i].loose.arm_m,
                       bodies_[i].mostMoved_m(motion_[i], parts_[part].box_W), bodies_[i].allowed_m,
                       X_WP_[part]});
      }
    }
  }

  const std::vector<PlacedSurface>& parts_;
  const CheckResult& checked_;
  std::vector<MovableBody> bodies_;
  std::vector<std::size_t> body_of_;
  ClashGroups clashes_;
  std::vector<SixNumbers> motion_;  // by body: motions of the groups that are free so far
  std::vector<Pose> X_WP_;          // by part: poses after the motions in motion_
  std::size_t work_ = 0;            // work done for the current group
};

}  // namespace

CheckedPlaces freePlaces(const std::vector<PlacedSurface>& parts, const CheckResult& checked,
                         const Progress& progress) {
  if (checked.clashes() == 0) return {};
  return PlaceSearch(parts, checked).search(progress);
}

}  // namespace vps::scenes
