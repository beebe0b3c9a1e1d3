// SPDX-License-Identifier: BSD-3-Clause
#include "hand_path.h"

#include <algorithm>

namespace vps::search {

HandPath::HandPath(const Hand& hand, const Pose& X_start) : goals_(hand.goals), X_W_(X_start) {}

CouplingState HandPath::advance(double dt_s) {
  const Pose before = X_W_;
  if (next_ < goals_.size()) {
    const Hand::Goal& goal = goals_[next_];
    const Vec3 way = goal.X_WP.p - X_W_.p, turn = rotationVector(goal.X_WP.R * X_W_.R.transpose());
    const double needed_s = std::max(way.norm() / goal.speed_m_s, turn.norm() / goal.spin_rad_s);
    if (needed_s <= dt_s) {
      X_W_ = goal.X_WP;
      ++next_;
    } else {
      const double share = dt_s / needed_s;
      X_W_ = {rotationFromVector(share * turn) * X_W_.R, X_W_.p + share * way};
    }
  }
  CouplingState state;
  state.X_W = X_W_;
  state.V_W.v = (X_W_.p - before.p) / dt_s;
  state.V_W.w = rotationVector(X_W_.R * before.R.transpose()) / dt_s;
  state.is_coupled = true;
  return state;
}

}  // namespace vps::search
