// SPDX-License-Identifier: BSD-3-Clause
// The headset of a window: it shows the window's scene, and its controllers pick and grab parts.
#include <algorithm>

#include "glfw/session.h"

namespace vps::viewer {
namespace {

/// Handles a trigger press: grabs the part in hand at the place that the controller points at, if a person
/// moves the part; picks any other part.
void pressed(Session& session, std::size_t hand, const Pose& X_WH) {
  const Ray ray = {X_WH.p, -X_WH.R.col(2)};
  const std::optional<PickedPlace> place = pick(session.drawn, session.placed, session.view.draw, ray);
  const scenes::BodySnapshot* body = partInHand(session.shown);
  const bool takes = session.isByMouse() && !session.drag.isGrabbed() && session.view.explode == 0 &&
                     body != nullptr && place && place->part == body->part;
  if (!takes) {
    session.view.picked = place;
    return;
  }
  session.drag.grab(place->p_W, session.shown);
  if (session.drag.isGrabbed()) session.holding_hand = hand;
}

void moved(Session& session, const HeadsetHand& from, const HeadsetHand& to) {
  session.drag.move(to.X_WH.p - from.X_WH.p);
  session.drag.turn(rotationVector(to.X_WH.R * from.X_WH.R.transpose()));
}

}  // namespace

void beginHeadset(Session& session, GlfwWindow& window) {
  if (!session.options.seeks_headset) return;
  std::string why_not;
  session.headset = HeadsetSession::begin(
      session.drawn, session.box_W(), [&window] { window.wake(); }, why_not);
  if (session.headset) return;
  session.say(why_not);
  if (session.options.say) session.options.say(why_not);
}

void useHeadset(Session& session) {
  if (!session.headset) return;
  for (const std::string& words : session.headset->takeMessages()) {
    session.say(words);
    if (session.options.say) session.options.say(words);
  }
  session.headset->show(session.placed, session.view.draw);
  const std::array<HeadsetHand, 2> now = session.headset->hands();
  for (std::size_t i = 0; i < now.size(); ++i) {
    HeadsetHand& last = session.hands[i];
    const bool is_holding = session.holding_hand == i;
    if (is_holding && (!now[i].is_taking || !session.drag.isGrabbed())) {
      if (session.drag.isGrabbed()) session.drag.letGo(session.shown);
      session.holding_hand.reset();
    } else if (is_holding && now[i].is_tracked) {
      if (last.is_tracked) moved(session, last, now[i]);
      // The vibration is proportional to the force, since a controller cannot show the force otherwise.
      constexpr double kMost_N = 10;  // greatest force of the mouse's handle (device/pulled_handle.h)
      session.headset->tremble(i, std::min(1.0, session.shown.F_hand_W.f.norm() / kMost_N));
    } else if (now[i].is_tracked && now[i].is_taking && !last.is_taking) {
      pressed(session, i, now[i].X_WH);
    }
    // A hand that was not tracked for a while moves the part again from the place where it reappears.
    last = now[i];
  }
}

}  // namespace vps::viewer
