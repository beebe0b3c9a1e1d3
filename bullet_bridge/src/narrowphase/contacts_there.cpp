// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/contacts_there.h"

#include <cmath>

#include "narrowphase/contact_selection.h"

namespace vps::bullet {

bool isInside(const Vec3& p_W, const SideView& other, double near_m, double tolerated_m) {
  if (!other.shape || other.shape->models().surfaces.empty()) return true;
  for (const Surface& surface : other.shape->models().surfaces) {
    if (surface.sheet) return true;
    const Vec3 p = (other.X_WM * surface.X_MP).inverse() * p_W;
    if (surface.distance->signedDistance(p, near_m) < -tolerated_m) return true;
  }
  return false;
}

bool refineAt(const PairView& pair, double max_m, const Settings& settings, Candidate& c) {
  thread_local std::vector<Candidate> one;
  one.assign(1, c);
  one[0].distance_m = -max_m;
  refineAll(pair, RelativeMotion(), settings, one);
  c = one[0];
  return std::abs(c.distance_m) < max_m;
}

bool areBothCurved(const PairView& pair, PairState& state) {
  const auto hasCurves = [](const Shape* shape) {
    if (!shape) return true;
    const FeatureSet& features = shape->features();
    for (std::uint32_t i = 0; i < features.facets().size(); ++i)
      if (features.isCurved(i)) return true;
    return false;
  };
  if (!state.are_both_curved) state.are_both_curved = hasCurves(pair.shape[0]) && hasCurves(pair.shape[1]);
  return *state.are_both_curved;
}

void findThere(const PairView& there, const PairState& state, bool only_loaded, std::vector<Candidate>& now,
               std::vector<Candidate>& ends) {
  const Settings& settings = state.context->settings;
  now.clear();
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const Candidate& c = state.contacts[k];
    if (c.isCrossing() || !there.shape[c.side]) continue;
    if (only_loaded) {
      const btManifoldPoint* point = state.writer->find(c.key(), k);
      if (!point || !(point->m_appliedImpulse > 0)) continue;
    }
    now.push_back(c);
  }
  ends = now;
  for (Candidate& end : ends) {
    end.p_W = there.side(end.side).X_WM * there.shape[end.side]->models().shell->points[end.id];
    end.n_W.setZero();  // stays so if the point is then out of reach
  }
  RelativeMotion still;
  still.contact_margin_m = settings.contact_margin_m;
  refineAll(there, still, settings, ends);
}

}  // namespace vps::bullet
