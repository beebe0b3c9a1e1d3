// SPDX-License-Identifier: BSD-3-Clause
// The candidates of a step. A fast body is queried at several places on its way, and its candidates are
// refined there.
#include <algorithm>
#include <cmath>

#include "narrowphase/check/pair_check.h"
#include "narrowphase/selection/contact_selection.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// In penalty contact the points of faces press along their own normals.
void useOwnNormalsForPenalty(const PairView& pair, const Settings& settings,
                             std::vector<Candidate>& candidates) {
  for (int i = 0; i < 2; ++i)
    if (settings.contact_method == ContactMethod::Penalty && pair.hasShell(i))
      useOwnNormals(candidates, pair.side(i));
}

// Edges that come to overlap in a step are found in its solution; edges that overlap already have no distance
// there. So crossings are candidates only where edges may overlap, by more than an impact may leave (as in
// PairCheck), and with solvers that do not know joints and other bodies when they look for what a step lacks.
using Find = void (*)(const PairView&, double cutoff_m, Context&, std::vector<Candidate>&, PairState*,
                      const RelativeMotion*);
Find findingFor(const PairView& pair, const PairState& state) {
  const double left_m = 0.5 * state.context->settings.contact_margin_m;
  const bool finds_later = isCheckedBySolver(pair, state) && !mayOverlap(state.selection, left_m);
  return finds_later ? findPointCandidates : findCandidates;
}

constexpr double kAtStart_s =
    -1;  // of a candidate that is refined where the bodies are now, although met later

// True if a plane that is met on the way says where it is from now. Where bodies turn, the way of a point
// bends from its tangent, and the plane turns.
bool isStraight(const PairView& pair, const RelativeMotion& motion) {
  const double turn_rad = motion.V.w.norm() * motion.dt_s, travel_m = motion.speed_m_s * motion.dt_s;
  return turn_rad * (0.5 * turn_rad * pair.radius_m() + travel_m) <= motion.contact_margin_m;
}

/// A pair where its bodies are at a time of the step in free motion.
struct Later {
  const PairView& now;
  const RelativeMotion& motion;
  double t_s;
  PairView pair;

  Later(const PairView& at_start, const RelativeMotion& in_step, double time_s)
      : now(at_start), motion(in_step), t_s(time_s), pair(at_start) {
    if (t_s > 0) advance(pair, now, motion.dt_s, t_s);
  }
  /// The same plane, relative to where the bodies are now.
  void moveBack(Candidate& c) const {
    if (!(t_s > 0)) return;
    c.distance_m -= c.n_W.dot(motion.velocityAt(c.p_W) * t_s);
    c.p_W = now.X_WS[c.side] * (pair.X_WS[c.side].inverse() * c.p_W);
  }
  void moveHere(Candidate& c) const {
    if (!(t_s > 0)) return;
    c.p_W = pair.X_WS[c.side] * (now.X_WS[c.side].inverse() * c.p_W);
    c.distance_m += c.n_W.dot(motion.velocityAt(c.p_W) * t_s);
  }
};

}  // namespace

void findStepCandidates(const PairView& pair, const RelativeMotion& motion, PairState& state,
                        std::vector<Candidate>& out) {
  Context& context = *state.context;
  const Find find = findingFor(pair, state);
  const double range_m = queryRange_m(pair);
  const double travel_m = motion.speed_m_s * motion.dt_s;
  // Bullet's broadphase widens boxes of moving bodies by 50 mm (gDbvtMargin), so most pairs are far apart.
  // This is as far as canTouch() and crossingRange() look.
  const double way_m = std::max(travel_m, motion.anyWay_m());
  if (pair.leastDistance_m() > motion.contact_margin_m + way_m) return;
  if (isQueriedOnce(pair, motion) || turnsInPlace(pair, motion)) {
    const double seen_m = isExact(context.settings) ? fieldError_m(pair) : 0;
    find(pair, std::min(motion.contact_margin_m + travel_m + seen_m, range_m), context, out, &state, &motion);
    useOwnNormalsForPenalty(pair, context.settings, out);
    return;
  }
  const double stride_m = std::max(0.5 * (range_m - motion.contact_margin_m), 0.25 * range_m);
  const int strides = static_cast<int>(std::ceil(std::min(travel_m / stride_m, kMostStretches)));
  thread_local std::vector<Candidate> met;
  thread_local std::vector<std::uint64_t> met_before;
  met_before.clear();
  for (int k = 0; k < strides; ++k) {
    const Later later(pair, motion, motion.dt_s * k / strides);
    met.clear();
    find(later.pair, std::min(motion.contact_margin_m + travel_m / strides, range_m), context, met, nullptr,
         nullptr);
    useOwnNormalsForPenalty(later.pair, context.settings, met);
    // Keep what a point meets first, as planes relative to where the bodies are now. A point that is behind a
    // plane when the stride begins has met another before.
    std::erase_if(met, [&](Candidate& c) {
      const double approach_m = -c.n_W.dot(motion.velocityAt(c.p_W)) * motion.dt_s / strides;
      if (c.distance_m - approach_m > motion.contact_margin_m) return true;
      if (k > 0 && (c.distance_m < -motion.contact_margin_m ||
                    std::binary_search(met_before.begin(), met_before.end(), c.key())))
        return true;
      c.met_s = later.t_s;
      later.moveBack(c);
      return false;
    });
    for (const Candidate& c : met) met_before.push_back(c.key());
    std::sort(met_before.begin(), met_before.end());
    out.insert(out.end(), met.begin(), met.end());
  }
}

void refineOnWay(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                 std::vector<Candidate>& candidates) {
  if (isQueriedOnce(pair, motion) || turnsInPlace(pair, motion) || !isStraight(pair, motion))
    return refineAll(pair, motion, settings, candidates);
  thread_local std::vector<double> times_s;
  times_s.clear();
  for (const Candidate& c : candidates) times_s.push_back(c.met_s);
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  thread_local std::vector<Candidate> here;
  for (const double t_s : times_s) {
    const Later later(pair, motion, t_s);
    RelativeMotion rest = motion;
    rest.dt_s -= t_s;
    here.clear();
    for (const Candidate& c : candidates)
      if (c.met_s == t_s) later.moveHere(here.emplace_back(c));
    refineAll(later.pair, rest, settings, here);
    std::size_t next = 0;
    for (Candidate& c : candidates) {
      if (c.met_s != t_s) continue;
      Candidate& found = here[next++];
      later.moveBack(found);
      // A plane that the point is behind already is not the one that it will meet, and would push.
      if (t_s > 0 && found.distance_m < 0)
        c.met_s = kAtStart_s;
      else
        c = found;
    }
  }
  here.clear();
  for (const Candidate& c : candidates)
    if (c.met_s == kAtStart_s) here.push_back(c);
  refineAll(pair, motion, settings, here);
  std::size_t next = 0;
  for (Candidate& c : candidates)
    if (c.met_s == kAtStart_s) c = here[next++];
}

}  // namespace vps::bullet
