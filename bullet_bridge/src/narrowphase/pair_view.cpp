// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair_view.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include "vps/contact_tolerances.h"

namespace vps::bullet {

RelativeMotion relativeMotion(const PairView& pair, double dt_s, double contact_margin_m, bool is_held) {
  RelativeMotion motion;
  motion.dt_s = dt_s;
  motion.contact_margin_m = contact_margin_m;
  if (!(dt_s > 0)) return motion;
  const auto relative = [&](bool with_couplings) {
    const Twist V0 = predictedVelocity(*pair.wrapper[0]->getCollisionObject(), dt_s, with_couplings);
    const Twist V1 = predictedVelocity(*pair.wrapper[1]->getCollisionObject(), dt_s, with_couplings);
    return Twist{V0.w - V1.w, V0.v - V1.v};
  };
  const auto greatestSpeed = [&](const Twist& V) {
    return (V.v + V.w.cross(pair.center_W())).norm() + V.w.norm() * pair.radius_m();
  };
  motion.V = relative(true);
  motion.speed_m_s = greatestSpeed(motion.V);
  const Twist own = relative(false);
  motion.own_speed_m_s = greatestSpeed(own);
  const double range_m_s = (queryRange_m(pair) - contact_margin_m) / dt_s;
  if (!is_held || motion.speed_m_s <= range_m_s || motion.own_speed_m_s >= range_m_s) return motion;
  // Contact holds the pull, so a body is not looked for along all the way that it would go without.
  const Twist pull{motion.V.w - own.w, motion.V.v - own.v};
  const double left_m_s = range_m_s - motion.own_speed_m_s;
  motion.pull_share = left_m_s / std::max(greatestSpeed(pull), left_m_s);
  motion.V = {own.w + motion.pull_share * pull.w, own.v + motion.pull_share * pull.v};
  motion.speed_m_s = greatestSpeed(motion.V);
  return motion;
}

double queryRange_m(const PairView& pair) {
  double range_m = 1e30;
  for (const Shape* shape : pair.shape)
    if (shape && shape->models().map) range_m = std::min(range_m, 0.95 * shape->models().map->band_m());
  return range_m;
}

double fieldError_m(const PairView& pair, const Candidate& c) {
  if (c.isCrossing()) return 0;
  return (pair.shape[c.side]->isEdgePoint(c.id) ? kEdgeError_voxels : kFaceError_voxels) *
         pair.voxel_m(1 - c.side);
}

double fieldError_m(const PairView& pair) {
  return kEdgeError_voxels * std::max(pair.voxel_m(0), pair.voxel_m(1));
}

bool queriesPoints(const PairView& pair, int i, Sides sides) {
  if (!pair.hasShell(i)) return false;
  if (sides == Sides::Both || !pair.isTwoSided()) return true;
  const bool is_first = pair.shape[0]->bounds().size().norm() <= pair.shape[1]->bounds().size().norm();
  return i == (is_first ? 0 : 1);
}

int sideCount(const PairView& pair, Sides sides) {
  return sides == Sides::Both && pair.isTwoSided() ? 2 : 1;
}

void advance(PairView& pair, const PairView& start, double dt_s, double t_s) {
  for (int i = 0; i < 2; ++i) {
    const btCollisionObject& object = *pair.wrapper[i]->getCollisionObject();
    pair.X_WS[i] = displacement(object, predictedVelocity(object, dt_s), t_s) * start.X_WS[i];
  }
}

void coast(const PairView& pair, double dt_s, Pose (&way)[2]) {
  for (int i = 0; i < 2; ++i) {
    const btCollisionObject& object = *pair.wrapper[i]->getCollisionObject();
    way[i] = displacement(object, predictedVelocity(object, 0, false), dt_s);
  }
}

}  // namespace vps::bullet
