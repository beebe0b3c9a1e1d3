// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/clutching.h"

#include "haptics/hand.h"

namespace vps::scenes {

namespace {

/// Where safety keeps the clutch from moving, go on as it is after so many times what it takes. assumed.
constexpr double kPatience = 10;

/// What rounding leaves of a step when all are done.
constexpr double kRounding = 1e-6;

}  // namespace

bool ClutchWork::goOnFor(double seconds, const std::function<bool()>& go_on) const {
  for (double left_s = seconds, step_s = step_s_(); left_s > kRounding * step_s; step_s = step_s_()) {
    if (!go_on()) return false;
    left_s -= step_s;
  }
  return true;
}

// What was asked for shows in the report after a tick only: so at least as long as it takes.
bool ClutchWork::waitForClutch(double ratio, const std::function<bool()>& go_on) const {
  const double clutch_s = driver_.settings().clutch_s;
  if (!goOnFor(clutch_s, go_on)) return false;
  for (double waited_s = clutch_s; waited_s < kPatience * clutch_s && driver_.last().clutch_ratio != ratio;
       waited_s += step_s_())
    if (!go_on()) return false;
  return true;
}

bool ClutchWork::takeHold(const std::function<bool()>& go_on) const {
  return waitForClutch(1, go_on);
}

bool ClutchWork::comeFree(const std::function<bool()>& go_on) const {
  driver_.openClutch();
  return waitForClutch(0, go_on);
}

bool ClutchWork::setDown(const std::function<bool(double)>& go_on) const {
  double left_s = driver_.settings().clutch_s;
  const auto fade = [&] {
    const double step_s = step_s_();
    left_s = left_s > (1 + kRounding) * step_s ? left_s - step_s : 0;
    return go_on(left_s / driver_.settings().clutch_s);
  };
  while (left_s > 0)
    if (!fade()) return false;
  return true;
}

bool ClutchWork::index_point(const std::function<bool()>& go_on) const {
  if (!comeFree(go_on)) return false;
  driver_.recentre();
  if (!goOnFor(kHandReturn_s, go_on)) return false;
  driver_.closeClutch();
  if (!takeHold(go_on)) return false;
  driver_.goOn();
  return true;
}

}  // namespace vps::scenes
