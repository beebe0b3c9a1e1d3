// SPDX-License-Identifier: BSD-3-Clause
#include "clutch_work.h"

#include <cmath>

#include "hand.h"

namespace vps {

namespace {

/// Where safety keeps the clutch from moving, go on as it is after so many times what it takes. assumed.
constexpr double kPatience = 10;

bool forSteps(double steps, const std::function<bool()>& go_on) {
  for (double i = 0; i < steps; ++i)
    if (!go_on()) return false;
  return true;
}

}  // namespace

// What was asked for shows in the report after a tick only: so at least as long as it takes.
bool ClutchWork::waitForClutch(double ratio, const std::function<bool()>& go_on) const {
  const double steps = std::ceil(side_.settings().clutch_s / physics_s_);
  if (!forSteps(steps, go_on)) return false;
  for (double i = steps; i < kPatience * steps && side_.last().clutch_ratio != ratio; ++i)
    if (!go_on()) return false;
  return true;
}

bool ClutchWork::takeHold(const std::function<bool()>& go_on) const {
  return waitForClutch(1, go_on);
}

bool ClutchWork::comeFree(const std::function<bool()>& go_on) const {
  side_.openClutch();
  return waitForClutch(0, go_on);
}

bool ClutchWork::setDown(const std::function<bool(double)>& go_on) const {
  const double steps = std::ceil(side_.settings().clutch_s / physics_s_);
  for (double left = steps - 1; left >= 0; --left)
    if (!go_on(left / steps)) return false;
  return true;
}

bool ClutchWork::regrasp(const std::function<bool()>& go_on) const {
  if (!comeFree(go_on)) return false;
  side_.recentre();
  if (!forSteps(std::round(kHandReturn_s / physics_s_), go_on)) return false;
  side_.closeClutch();
  if (!takeHold(go_on)) return false;
  side_.goOn();
  return true;
}

}  // namespace vps
