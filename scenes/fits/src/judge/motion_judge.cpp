// SPDX-License-Identifier: BSD-3-Clause
#include "judge/motion_judge.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "judge/pair_path.h"

namespace vps::scenes {

namespace {

/// Budget of work (the credit) at the start. The passage of one body through another takes about fifty
/// measures of some ten units each.
constexpr double kFirstCredit = 50e3;
/// Greatest budget of work that is saved for later searches.
constexpr double kMostCredit = 200e3;
/// A search may spend this share of the budget of work, or the work that its steps added if that is more. The
/// rest of the budget is kept for later searches, in which a body may pass through another one.
constexpr double kShareOfCredit = 0.25;
/// Share of a search's budget of work for proofs that surfaces do not meet, since such proofs may fail.
constexpr double kShareOfProofs = 0.25;

Box unionOf(Box a, const Box& b) {
  a.add(b.min);
  a.add(b.max);
  return a;
}

}  // namespace

struct MotionJudge::Stretch {
  std::size_t path;
  double from, to;      ///< ends of the interval, counted in steps
  double from_m, to_m;  ///< depth at the ends; an upper bound where the depth was not measured
  bool is_from_measured, is_to_measured;
  double bound_m = 0;                           ///< upper bound of the depth within the interval
  bool operator<(const Stretch& other) const {  // order: the greatest bound first, then the earliest interval
    if (bound_m != other.bound_m) return bound_m < other.bound_m;
    return path != other.path ? path > other.path : from > other.from;
  }
};

MotionJudge::MotionJudge(std::vector<MovingBody> bodies, const std::vector<Pose>& X_WP, double time_s)
    : bodies_(std::move(bodies)),
      exact_(bodies_.size()),
      X_WP_(bodies_.size()),
      time_s_{time_s},
      credit_(kFirstCredit) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) X_WP_[i].push_back(X_WP[i]);
}

const ExactBody& MotionJudge::body(std::size_t number) {
  if (!exact_[number]) exact_[number] = bodies_[number].make();
  return *exact_[number];
}

void MotionJudge::addStep(double time_s, const std::vector<Pose>& X_WP, double credit,
                          const std::atomic<bool>* stop) {
  time_s_.push_back(time_s);
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (!bodies_[i].is_fixed) X_WP_[i].push_back(X_WP[i]);
  credit_ = std::min(credit_ + credit, kMostCredit);
  income_ += credit;
  if (time_s_.size() > kSteps) search(stop);
}

void MotionJudge::place(double time_s, const std::vector<Pose>& X_WP) {
  time_s_ = {time_s};
  for (std::size_t i = 0; i < bodies_.size(); ++i) X_WP_[i] = {X_WP[i]};
  depth_m_.clear();
}

BodyMotion MotionJudge::motion(std::size_t body, std::size_t step) const {
  const std::vector<Pose>& X_WP = X_WP_[body];
  return bodies_[body].is_fixed ? BodyMotion(X_WP.front())
                                : BodyMotion(X_WP[step], X_WP[step + 1], bodies_[body].center_P);
}

Pose MotionJudge::poseAt(std::size_t body, double step) const {
  if (bodies_[body].is_fixed) return X_WP_[body].front();
  const auto i = static_cast<std::size_t>(step);
  const double share = step - static_cast<double>(i);
  return share == 0 ? X_WP_[body][i] : motion(body, i).at(share);
}

double MotionJudge::timeAt(double step) const {
  const auto i = static_cast<std::size_t>(step);
  return i + 1 < time_s_.size() ? std::lerp(time_s_[i], time_s_[i + 1], step - static_cast<double>(i))
                                : time_s_[i];
}

double MotionJudge::allowed_m(const Pair& pair) const {
  const auto allowed = allowed_m_.find(pair);
  return allowed == allowed_m_.end() ? 0 : allowed->second;
}

double MotionJudge::enough_m(const Pair& pair) const {
  return std::max({deepest_.depth_m + toleranceOf(deepest_.depth_m), allowed_m(pair), least_m_});
}

double MotionJudge::bound_m() const {
  const double deepest_m = std::max({deepest_of_all_.depth_m, most_allowed_m_, least_m_});
  return std::max(deepest_m + toleranceOf(deepest_m), left_m_);
}

void MotionJudge::allow(const Pair& pair, double depth_m) {
  allowed_m_[pair] = depth_m;
  most_allowed_m_ = std::max(most_allowed_m_, depth_m);
}

/// Upper bound of the depth of a pair: no point is deeper in a body than half the least side of the body's
/// box.
double MotionJudge::mostDepth_m(const Pair& pair) const {
  const auto half_m = [&](std::size_t i) { return 0.5 * bodies_[i].box_P.size().minCoeff(); };
  return std::max(half_m(pair.first), half_m(pair.second));
}

/// Upper bound of the depth at one moment, from the boxes alone.
double MotionJudge::boxDepth_m(const Pair& pair, double step) const {
  const auto box_W = [&](std::size_t i) { return moved(bodies_[i].box_P, poseAt(i, step)); };
  const double apart_m = std::sqrt(distance2(box_W(pair.first), box_W(pair.second)));
  return apart_m > 0 ? -apart_m : mostDepth_m(pair);
}

/// Pairs whose boxes may meet during the steps.
std::vector<MotionJudge::Pair> MotionJudge::nearPairs() const {
  std::vector<Box> swept_W(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (const Pose& X_WP : X_WP_[i]) swept_W[i] = unionOf(swept_W[i], moved(bodies_[i].box_P, X_WP));
    double bend_m = 0;  // greatest distance of a point from its chord within a step
    const double radius_m =
        0.5 * bodies_[i].box_P.size().norm() + (bodies_[i].box_P.center() - bodies_[i].center_P).norm();
    for (std::size_t step = 0; step + 1 < X_WP_[i].size(); ++step)
      bend_m = std::max(bend_m, radius_m * motion(i, step).turn_W().squaredNorm() / 8);
    swept_W[i] = grown(swept_W[i], bend_m + 1e-9);
  }
  std::vector<Pair> near;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (!(bodies_[a].is_fixed && bodies_[b].is_fixed) && overlap(swept_W[a], swept_W[b]))
        near.emplace_back(a, b);
  return near;
}

PairPath MotionJudge::pathOf(const Pair& pair) {
  const auto size2 = [&](std::size_t i) { return bodies_[i].box_P.size().squaredNorm(); };
  const bool is_second_first = !bodies_[pair.first].is_fixed &&
                               (bodies_[pair.second].is_fixed || size2(pair.second) > size2(pair.first));
  PairPath path{pair, pair.first, pair.second, {0}, {}, 0, 0, 0};
  if (is_second_first) std::swap(path.a, path.b);
  for (std::size_t step = 0; step + 1 < time_s_.size(); ++step) {
    const RelativeMotion moved = relativeMotion(motion(path.a, step), bodies_[path.a].box_P,
                                                motion(path.b, step), bodies_[path.b].box_P);
    path.travel_m.push_back(path.travel_m.back() + moved.travel_m);
    path.sagitta_m.push_back(moved.sagitta_m);
  }
  return path;
}

void MotionJudge::record(const Pair& pair, double depth_m, const Vec3& p_W, double time_s) {
  if (depth_m > deepest_of_all_.depth_m) deepest_of_all_ = {pair.first, pair.second, depth_m, p_W, time_s};
  if (depth_m > deepest_.depth_m && depth_m > allowed_m(pair))
    deepest_ = {pair.first, pair.second, depth_m, p_W, time_s};
}

double MotionJudge::measure(PairPath& path, double step, double near_m) {
  const PairMeasure found =
      measurePair(body(path.a), poseAt(path.a, step), body(path.b), poseAt(path.b, step), near_m);
  ++measured_;
  spend(static_cast<double>(found.work));
  record(path.pair, found.depth_m, found.p_W, timeAt(step));
  if (!found.n_W.isZero(0)) direction_A_[path.pair] = poseAt(path.a, step).R.transpose() * found.n_W;
  path.end_depth_m = std::min(path.end_depth_m, found.depth_m + path.travel_m.back() - path.travelAt(step));
  return found.depth_m;
}

/// The moment to measure next: an end of the interval that was not measured, else the moment at which the
/// bound is attained. If the interval contains the end of a step, that moment is rounded to such an end,
/// where the pose is not interpolated.
double MotionJudge::nextMoment(const PairPath& path, const Stretch& now) const {
  if (!now.is_to_measured) return now.to;
  if (!now.is_from_measured) return now.from;
  const double from_m = path.travelAt(now.from), to_m = path.travelAt(now.to);
  const double at = path.stepAt(0.5 * (from_m + to_m + now.to_m - now.from_m));
  const double first_end = std::floor(now.from) + 1, last_end = std::ceil(now.to) - 1;
  if (first_end <= last_end) return std::clamp(std::round(at), first_end, last_end);
  return std::clamp(at, std::lerp(now.from, now.to, 0.1), std::lerp(now.from, now.to, 0.9));
}

void MotionJudge::searchPaths(std::vector<PairPath>& paths, const std::atomic<bool>* stop) {
  std::priority_queue<Stretch> waiting;
  const auto add = [&](Stretch stretch) {
    const PairPath& path = paths[stretch.path];
    const double travel_m = path.travelAt(stretch.to) - path.travelAt(stretch.from);
    // The depth at an end that was not measured is at most the depth at the other end plus the travel between
    // the two ends.
    stretch.bound_m = std::min({0.5 * (stretch.from_m + stretch.to_m + travel_m), stretch.from_m + travel_m,
                                stretch.to_m + travel_m, mostDepth_m(path.pair)});
    if (stretch.bound_m > enough_m(path.pair)) waiting.push(stretch);
  };
  const double end = static_cast<double>(time_s_.size() - 1);
  for (std::size_t p = 0; p < paths.size(); ++p)
    add({p, 0, end, depth_m_.at(paths[p].pair), paths[p].end_depth_m, false, false});
  while (!waiting.empty()) {
    const Stretch now = waiting.top();
    waiting.pop();
    PairPath& path = paths[now.path];
    const double enough = enough_m(path.pair);
    if (now.bound_m <= enough || areHullsApart(path, now.from, now.to, enough)) continue;
    // A depth of at most 0 at one end means that the bodies are apart there.
    if (std::min(now.from_m, now.to_m) <= 0 && areSurfacesApart(path, now.from, now.to)) continue;
    if (may_spend_ <= 0 || (stop != nullptr && stop->load())) {
      left_m_ = std::max(left_m_, now.bound_m);
      continue;
    }
    const double at = nextMoment(path, now);
    const double depth_m = measure(path, at, path.travelAt(now.to) - path.travelAt(now.from) + enough);
    Stretch before = now, after = now;
    before.to = after.from = at;
    before.to_m = after.from_m = depth_m;
    before.is_to_measured = after.is_from_measured = true;
    if (at > now.from) add(before);
    if (at < now.to) add(after);
  }
}

void MotionJudge::search(const std::atomic<bool>* stop) {
  if (time_s_.size() < 2) return;
  std::vector<PairPath> paths;
  for (const Pair& pair : nearPairs()) {
    paths.push_back(pathOf(pair));
    const double from_m = depth_m_.try_emplace(pair, boxDepth_m(pair, 0)).first->second;
    paths.back().end_depth_m = std::min(from_m + paths.back().travel_m.back(),
                                        boxDepth_m(pair, static_cast<double>(time_s_.size() - 1)));
  }
  may_spend_ = std::min(credit_, std::max(income_, kShareOfCredit * credit_));
  may_prove_ = kShareOfProofs * may_spend_;
  searchPaths(paths, stop);
  income_ = 0;
  depth_m_.clear();
  for (const PairPath& path : paths) depth_m_[path.pair] = path.end_depth_m;
  time_s_ = {time_s_.back()};
  for (std::vector<Pose>& X_WP : X_WP_) X_WP = {X_WP.back()};
}

void MotionJudge::setDepth(const Pair& pair, double depth_m, const Vec3& p_W) {
  record(pair, depth_m, p_W, time_s_.back());
  double& known_m = depth_m_.try_emplace(pair, depth_m).first->second;
  known_m = depth_m > 0 ? depth_m : std::min(known_m, 0.0);
}

}  // namespace vps::scenes
