// SPDX-License-Identifier: BSD-3-Clause
// The deepest overlap of bodies along their motion, between the poses at the ends of the steps too.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "judge/body_motion.h"
#include "judge/exact_body.h"

namespace vps::scenes {

struct PairPath;

/// A body as MotionJudge knows it.
struct MovingBody {
  Box box_P;
  Vec3 center_P = Vec3::Zero();  ///< centre of mass, about which it turns within a step
  bool is_fixed = false;
  /// Called when the body first comes near another one.
  std::function<std::shared_ptr<const ExactBody>()> make;
};

struct DeepestOverlap {
  std::size_t a = 0, b = 0;  ///< numbers of the bodies
  double depth_m = 0;        ///< 0: none
  Vec3 p_W = Vec3::Zero();
  double time_s = 0;
};

/// Looks for the greatest depth f of any pair along all steps. The depth, and the gap as a negative depth, is
/// 1-Lipschitz in the pair's relative travel C: between two moments it is at most (f0 + f1 + C1 - C0) / 2.
/// The stretch of time with the greatest such bound is measured where the bound is attained, and divided
/// there, until no bound exceeds the greatest depth found by more than toleranceOf() (Piyavskii 1972). A pair
/// that has not moved by its gap is so never measured, one at rest once, and a passage is found however fast
/// it is. Stretches in which the bodies' convex hulls stay apart, or overlap by less than the tolerance,
/// along a direction that is fixed in one of them are not divided either: so sliding and rolling on a convex
/// body costs little. Nor are those in which no two triangles of them meet on the way, if the bodies are
/// apart at one of its ends: so a ball that flies along a bore, which lies within the bore's hull, is known
/// to be apart by the distance of the facets that it passes, and not by its whole travel.
///
/// The cost is bounded by counts: each step gives a credit, and stretches that are left when it is used up
/// count in bound_m(). Same input, same bits.
class MotionJudge {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;  ///< the lower number first

  /// @param X_WP  poses at the start, by body
  MotionJudge(std::vector<MovingBody> bodies, const std::vector<Pose>& X_WP, double time_s);

  /// How much more than the greatest depth found may be missed where there is credit.
  static double toleranceOf(double depth_m) { return 1e-6 + depth_m / 50; }

  /// Adds a step that ends at these poses; every kSteps steps are searched at once.
  /// @param credit  work that may be spent, in the unit of Overlap::work
  void addStep(double time_s, const std::vector<Pose>& X_WP, double credit,
               const std::atomic<bool>* stop = nullptr);
  /// The bodies are put at these poses, without a motion.
  void place(double time_s, const std::vector<Pose>& X_WP);
  /// Searches the steps that were added since the last search.
  void search(const std::atomic<bool>* stop = nullptr);
  /// The depth of a pair at the end of the last step that was searched, measured elsewhere: the search goes
  /// on from there.
  void setDepth(const Pair& pair, double depth_m, const Vec3& p_W);

  /// Depths up to this are not searched for.
  void setLeast(double depth_m) { least_m_ = depth_m; }
  /// Depths of this pair up to depth_m do not count, until it has been apart; see deepest().
  void allow(const Pair& pair, double depth_m);
  void forbid(const Pair& pair) { allowed_m_.erase(pair); }

  /// Null as long as the body was not near another.
  [[nodiscard]] const ExactBody& body(std::size_t number);

  [[nodiscard]] const DeepestOverlap& deepest() const { return deepest_; }  ///< of what counts
  [[nodiscard]] const DeepestOverlap& deepestOfAll() const { return deepest_of_all_; }
  /// No depth is more than this, along all steps that were searched.
  [[nodiscard]] double bound_m() const;
  /// False if credit was missing: then bound_m() is that of a stretch of time which was left.
  [[nodiscard]] bool isSearched() const { return left_m_ == 0 || left_m_ < bound_m(); }
  [[nodiscard]] std::size_t measured() const { return measured_; }  ///< measures of pairs

 private:
  static constexpr std::size_t kSteps = 64;
  struct Stretch;  // of time

  [[nodiscard]] BodyMotion motion(std::size_t body, std::size_t step) const;
  [[nodiscard]] Pose poseAt(std::size_t body, double step) const;
  [[nodiscard]] double timeAt(double step) const;
  [[nodiscard]] std::vector<Pair> nearPairs() const;
  [[nodiscard]] PairPath pathOf(const Pair& pair);
  [[nodiscard]] double allowed_m(const Pair& pair) const;
  [[nodiscard]] double mostDepth_m(const Pair& pair) const;
  [[nodiscard]] double boxDepth_m(const Pair& pair, double step) const;
  [[nodiscard]] double enough_m(const Pair& pair) const;
  /// The depth, or less a lower bound of the gap.
  double measure(PairPath& path, double step, double near_m);
  [[nodiscard]] bool areHullsApart(PairPath& path, double from, double to, double enough_m);
  [[nodiscard]] bool areSurfacesApart(PairPath& path, double from, double to);
  [[nodiscard]] bool areApartAlong(PairPath& path, const Vec3& n_A, double from, double to, double enough_m);
  void spend(double work) {
    credit_ -= work;
    may_spend_ -= work;
  }
  [[nodiscard]] double nextMoment(const PairPath& path, const Stretch& now) const;
  void record(const Pair& pair, double depth_m, const Vec3& p_W, double time_s);
  void searchPaths(std::vector<PairPath>& paths, const std::atomic<bool>* stop);

  std::vector<MovingBody> bodies_;
  std::vector<std::shared_ptr<const ExactBody>> exact_;  ///< by body; null: not needed so far
  std::vector<std::vector<Pose>> X_WP_;                  ///< by body, at the ends of the steps; fixed: one
  std::vector<double> time_s_;
  std::map<Pair, double> depth_m_;    ///< upper bounds at the last moment, of pairs that are near
  std::map<Pair, Vec3> direction_A_;  ///< along which the hulls were apart last, in the first of its path
  std::map<Pair, double> allowed_m_;
  DeepestOverlap deepest_, deepest_of_all_;
  double least_m_ = 0, most_allowed_m_ = 0;
  double left_m_ = 0;                           ///< greatest bound of a stretch that was not divided further
  double credit_, income_ = 0, may_spend_ = 0;  ///< in all; of the steps to be searched; for this search
  double may_prove_ = 0;  ///< the share of may_spend_ for proofs that surfaces do not meet
  std::size_t measured_ = 0;
};

}  // namespace vps::scenes
