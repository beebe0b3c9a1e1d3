// SPDX-License-Identifier: BSD-3-Clause
// The deepest overlap of bodies along their motion, including the poses between the ends of the steps.
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

/// A body whose motion is judged.
struct MovingBody {
  Box box_P;
  Vec3 center_P = Vec3::Zero();  ///< centre of mass, about which the body turns within a step
  bool is_fixed = false;
  /// Makes the body's exact model; called when the body first comes near another one.
  std::function<std::shared_ptr<const ExactBody>()> make;
};

/// The deepest overlap of any pair, and its place and time.
struct DeepestOverlap {
  std::size_t a = 0, b = 0;  ///< numbers of the bodies
  double depth_m = 0;        ///< 0: none
  Vec3 p_W = Vec3::Zero();
  double time_s = 0;
};

/// Searches for the greatest depth f of any pair along all steps. The depth (a gap counts as a negative
/// depth) is 1-Lipschitz in the pair's relative travel C: between two moments it is at most (f0 + f1 + C1 -
/// C0) / 2. The search measures the time interval with the greatest such bound at the moment where the bound
/// is attained, and divides the interval there, until no bound exceeds the greatest depth found by more than
/// toleranceOf() (Piyavskii 1972). A pair that has moved by less than its gap is therefore never measured, a
/// pair at rest is measured once, and a passage is found at any speed. Two kinds of intervals are not
/// divided. The first kind are intervals in which the bodies' convex hulls stay apart, or overlap by less
/// than the tolerance, along a direction that is fixed in one of the bodies; sliding and rolling on a convex
/// body therefore cost little. The second kind are intervals in which no two triangles of the bodies meet, if
/// the bodies are apart at one end of the interval. A ball that flies along a bore, inside the bore's hull,
/// is a case of the second kind: the ball's facets only have to pass the facets near the ball.
///
/// The cost is bounded by counts: each step adds work to a budget (the credit), and intervals that are left
/// when the budget is spent enter bound_m(). The same input gives the same bits.
class MotionJudge {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;  ///< numbers of two bodies in ascending order

  /// @param X_WP pose of each body at the start
  MotionJudge(std::vector<MovingBody> bodies, const std::vector<Pose>& X_WP, double time_s);

  /// Tolerance of the search: while the budget of work lasts, no depth is missed that exceeds the greatest
  /// depth found, depth_m, by more than this tolerance.
  static double toleranceOf(double depth_m) { return 1e-6 + depth_m / 50; }

  /// Adds a step that ends at these poses. After every kSteps steps, these steps are searched together.
  /// @param credit  work that may be spent, in the unit of Overlap::work
  void addStep(double time_s, const std::vector<Pose>& X_WP, double credit,
               const std::atomic<bool>* stop = nullptr);
  /// Puts the bodies at these poses without judging the motion to these poses.
  void place(double time_s, const std::vector<Pose>& X_WP);
  /// Searches the steps that were added since the last search.
  void search(const std::atomic<bool>* stop = nullptr);
  /// Sets the depth of a pair at the end of the last step that was searched, if the caller measured the
  /// depth. The search continues from this depth.
  void setDepth(const Pair& pair, double depth_m, const Vec3& p_W);

  /// Sets the least depth that matters: smaller depths are not searched for.
  void setLeast(double depth_m) { least_m_ = depth_m; }
  /// Allows overlaps of this pair up to depth_m: such overlaps do not count in deepest(). The caller ends the
  /// permission with forbid().
  void allow(const Pair& pair, double depth_m);
  void forbid(const Pair& pair) { allowed_m_.erase(pair); }

  /// The exact model of a body; it is made on first use.
  [[nodiscard]] const ExactBody& body(std::size_t number);

  /// The deepest overlap that is not allowed.
  [[nodiscard]] const DeepestOverlap& deepest() const { return deepest_; }
  [[nodiscard]] const DeepestOverlap& deepestOfAll() const { return deepest_of_all_; }
  /// Upper bound of the depth along all steps that were searched.
  [[nodiscard]] double bound_m() const;
  /// False if the budget of work did not suffice; bound_m() is then the bound of an interval that was not
  /// divided further.
  [[nodiscard]] bool isSearched() const { return left_m_ == 0 || left_m_ < bound_m(); }
  [[nodiscard]] std::size_t measured() const { return measured_; }  ///< number of pair measures so far

 private:
  static constexpr std::size_t kSteps = 64;
  struct Stretch;  // an interval of time of one pair

  [[nodiscard]] BodyMotion motion(std::size_t body, std::size_t step) const;
  [[nodiscard]] Pose poseAt(std::size_t body, double step) const;
  [[nodiscard]] double timeAt(double step) const;
  [[nodiscard]] std::vector<Pair> nearPairs() const;
  [[nodiscard]] PairPath pathOf(const Pair& pair);
  [[nodiscard]] double allowed_m(const Pair& pair) const;
  [[nodiscard]] double mostDepth_m(const Pair& pair) const;
  [[nodiscard]] double boxDepth_m(const Pair& pair, double step) const;
  [[nodiscard]] double enough_m(const Pair& pair) const;
  /// Measures the depth of the pair; if the bodies are apart, minus a lower bound of the gap.
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
  std::vector<std::shared_ptr<const ExactBody>> exact_;  ///< by body; null until the body's model is needed
  std::vector<std::vector<Pose>> X_WP_;  ///< by body, at the ends of the steps; one pose for a fixed body
  std::vector<double> time_s_;
  std::map<Pair, double> depth_m_;  ///< pairs that are near: upper bound of the depth at the last moment
  /// Direction that separated the hulls last, in the frame of PairPath::a.
  std::map<Pair, Vec3> direction_A_;
  std::map<Pair, double> allowed_m_;
  DeepestOverlap deepest_, deepest_of_all_;
  double least_m_ = 0, most_allowed_m_ = 0;
  double left_m_ = 0;  ///< greatest bound of an interval that was left undivided
  /// Work that may be spent: in total, for steps not yet searched, and in the current search.
  double credit_, income_ = 0, may_spend_ = 0;
  double may_prove_ = 0;  ///< share of may_spend_ for areSurfacesApart()
  std::size_t measured_ = 0;
};

}  // namespace vps::scenes
