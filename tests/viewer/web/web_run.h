// SPDX-License-Identifier: BSD-3-Clause
// A run for the web page whose parts a test moves.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "viewer/small_run.h"
#include "web/watched_run.h"

namespace vps::viewer::test {

class FakeRun final : public WatchedRun {
 public:
  /// @param allows_hand  a browser may take the peg
  explicit FakeRun(bool allows_hand = false) : scene_(smallScene()) {
    if (allows_hand) drag_.emplace(1.0);
  }

  void poll() override { ++polls; }
  [[nodiscard]] const scenes::Scene* scene() const override { return &scene_; }
  [[nodiscard]] int number() const override { return run_number; }
  [[nodiscard]] std::string doing() const override { return doing_now; }
  std::optional<WatchedShot> takeShot() override { return std::exchange(next, std::nullopt); }
  std::vector<WatchedNews> takeNews() override { return std::exchange(news, {}); }
  [[nodiscard]] HandDrag* drag() override { return drag_ ? &*drag_ : nullptr; }
  void point(int person, const std::optional<Vec3>& p_W) override { pointed.push_back({person, p_W}); }
  std::vector<scenes::SessionPointer> takePointers() override { return std::exchange(elsewhere, {}); }

  [[nodiscard]] std::optional<Playback> playback() const override { return playing; }
  void play(bool on) override { playing->is_playing = on; }
  void seek(double to_s) override { sought_s = to_s; }

  /// Shows a snapshot with the peg in hand at height z_m, optionally with a contact below the peg.
  void show(double z_m, bool has_contact = false) {
    scenes::Snapshot shot;
    shot.time_s = time_s += 1.0 / 60;
    shot.step = 0;
    shot.bodies = {{1, Pose::translation(Vec3(0, 0, z_m)), scenes::BodyRole::InHand}};
    shot.has_target = true;
    shot.target_part = 1;
    shot.has_hand = true;
    shot.X_W_Proxy = shot.bodies[0].X_WP;
    shot.F_hand_W.f = Vec3(0, 0, 3);
    if (has_contact) shot.contacts = {{Vec3(0.01, 0, z_m), Vec3::UnitZ(), 2e-6, 1.5, Vec3::Zero()}};
    next = WatchedShot{shot, 1'000'000};
  }

  int polls = 0, run_number = 1;
  double time_s = 0;
  std::string doing_now;
  std::optional<WatchedShot> next;
  std::vector<WatchedNews> news;
  std::optional<Playback> playing;  ///< state of playback; empty: no recording
  double sought_s = 0;
  std::vector<scenes::SessionPointer> pointed,
      elsewhere;  ///< pointers of browsers, and of watchers elsewhere

 private:
  scenes::Scene scene_;
  std::optional<HandDrag> drag_;
};

}  // namespace vps::viewer::test
