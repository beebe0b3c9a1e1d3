// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid/contact_loop.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

/// The bodies whose motion is shortened.
class Held {
 public:
  explicit Held(std::size_t count) : is_held_(count, 0) {}
  void add(int body) {
    if (body >= 0) is_held_[static_cast<std::size_t>(body)] = 1;
  }
  /// Adds all bodies that are connected to the held bodies by joints or loaded contacts.
  void spread(std::span<const RigidContact> contacts, const JointRows& joints) {
    bool has_grown = true;
    while (has_grown) {
      has_grown = false;
      for (const RigidContact& c : contacts)
        if (c.p_n > 0) has_grown |= join(c.normal.side[0].body, c.normal.side[1].body);
      for (const JointRow& row : joints.rows) has_grown |= join(row.body[0], row.body[1]);
    }
  }
  [[nodiscard]] bool has(std::size_t body) const { return is_held_[body] != 0; }

 private:
  bool join(int a, int b) {
    if (a < 0 || b < 0 || has(static_cast<std::size_t>(a)) == has(static_cast<std::size_t>(b))) return false;
    add(a);
    add(b);
    return true;
  }
  std::vector<std::uint8_t> is_held_;
};

}  // namespace

bool endEarly(Island& island, std::span<const RigidContact> contacts, const JointRows& joints,
              std::span<StepCheck* const> checks, std::span<const Vec6> push, double dt_s) {
  bool is_short = false;
  for (int k = 0; k < kMostRounds; ++k) {
    double share = 1;
    Held held(island.bodies.size());
    for (StepCheck* check : checks) {
      const int body[2] = {island.indexOf(check->object(0)), island.indexOf(check->object(1))};
      const auto stands = [&](int i) {
        return i < 0 || island.bodies[static_cast<std::size_t>(i)].way_share < 1 - kShortShare;
      };
      if (stands(body[0]) && stands(body[1])) continue;
      const Pose X_WB_end[2] = {island.endPose(check->object(0), push, dt_s),
                                island.endPose(check->object(1), push, dt_s)};
      const double own = std::min(check->freeShare(X_WB_end), check->freeShareOfPoints(X_WB_end));
      if (!(own < 1)) continue;
      share = std::min(share, kShortShare * own);
      for (const int i : body) held.add(i);
    }
    if (share >= 1) break;
    is_short = true;
    held.spread(contacts, joints);
    for (std::size_t i = 0; i < island.bodies.size(); ++i)
      if (held.has(i)) island.bodies[i].way_share *= share;
  }
  return is_short;
}

}  // namespace vps::bullet
