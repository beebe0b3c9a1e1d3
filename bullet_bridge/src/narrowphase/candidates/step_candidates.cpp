// SPDX-License-Identifier: BSD-3-Clause
// Finds the candidates of a step. A fast body is queried, and its candidates are refined, at several places
// along its path.
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

// Edges that come to overlap in a step are found by the check of its solution, which cannot measure edges
// that overlap already. Crossings are therefore candidates only where edges may overlap by more than an
// impact may leave (as in PairCheck), and with solvers whose check does not know joints and other bodies.
using Find = void (*)(const PairView&, double cutoff_m, Context&, std::vector<Candidate>&, PairState*,
                      const RelativeMotion*);
Find findingFor(const PairView& pair, const PairState& state) {
  const double left_m = 0.5 * state.context->settings.contact_margin_m;
  const bool finds_later = isCheckedBySolver(pair, state) && !mayOverlap(state.selection, left_m);
  return finds_later ? findPointCandidates : findCandidates;
}

// Marks a candidate whose plane the body meets later in the step, but which is refined at the present poses.
constexpr double kAtStart_s = -1;

// True if a contact plane that is met along the path can be referred to the present poses. Where bodies turn,
// the path of a point bends from its tangent, and the plane turns.
bool isStraight(const PairView& pair, const RelativeMotion& motion) {
  const double turn_rad = motion.V.w.norm() * motion.dt_s, travel_m = motion.speed_m_s * motion.dt_s;
  return turn_rad * (0.5 * turn_rad * pair.radius_m() + travel_m) <= motion.contact_margin_m;
}

/// The pair at a time within the step, in free motion.
struct Later {
  const PairView& now;
  const RelativeMotion& motion;
  double t_s;
  PairView pair;

  Later(const PairView& at_start, const RelativeMotion& in_step, double time_s)
      : now(at_start), motion(in_step), t_s(time_s), pair(at_start) {
    if (t_s > 0) advance(pair, now, motion.dt_s, t_s);
  }
  /// Refers a plane found at the later time to the bodies' present poses.
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
  // canTouch() and crossingRange() use the same range.
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
    // Keeps the planes that points meet first, referred to the bodies' present poses. A point that is behind
    // a plane at the start of this part of the path has met another plane before.
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
      // The point cannot meet a plane that it is behind already; such a plane would push it.
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
