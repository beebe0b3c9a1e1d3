// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/clutching.h"

#include "haptics/hand.h"

namespace vps::scenes {

namespace {

/// If the safety chain keeps the clutch from moving, the run continues after this multiple of clutch_s. The
/// value is assumed.
constexpr double kWaitLimit = 10;

/// Share of a physics step that rounding errors may leave over.
constexpr double kRounding = 1e-6;

}  // namespace

bool ClutchWork::advanceFor(double seconds, const std::function<bool()>& advance) const {
  for (double left_s = seconds, step_s = step_s_(); left_s > kRounding * step_s; step_s = step_s_()) {
    if (!advance()) return false;
    left_s -= step_s;
  }
  return true;
}

// The driver's report (driver_.last()) shows the clutch ratio one tick late and may still have the ratio of
// an earlier motion of the clutch. The wait therefore lasts at least clutch_s, the duration of one motion.
bool ClutchWork::waitForClutch(double ratio, const std::function<bool()>& advance) const {
  const double clutch_s = driver_.settings().clutch_s;
  if (!advanceFor(clutch_s, advance)) return false;
  for (double waited_s = clutch_s; waited_s < kWaitLimit * clutch_s && driver_.last().clutch_ratio != ratio;
       waited_s += step_s_())
    if (!advance()) return false;
  return true;
}

bool ClutchWork::takeHold(const std::function<bool()>& advance) const {
  return waitForClutch(1, advance);
}

bool ClutchWork::comeFree(const std::function<bool()>& advance) const {
  driver_.openClutch();
  return waitForClutch(0, advance);
}

bool ClutchWork::setDown(const std::function<bool(double)>& advance) const {
  double left_s = driver_.settings().clutch_s;
  const auto fade = [&] {
    const double step_s = step_s_();
    left_s = left_s > (1 + kRounding) * step_s ? left_s - step_s : 0;
    return advance(left_s / driver_.settings().clutch_s);
  };
  while (left_s > 0)
    if (!fade()) return false;
  return true;
}

bool ClutchWork::index(const std::function<bool()>& advance) const {
  if (!comeFree(advance)) return false;
  driver_.recentre();
  if (!advanceFor(kHandReturn_s, advance)) return false;
  driver_.closeClutch();
  if (!takeHold(advance)) return false;
  driver_.goOn();
  return true;
}

}  // namespace vps::scenes
