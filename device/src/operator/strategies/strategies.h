// SPDX-License-Identifier: BSD-3-Clause
// The strategies of insertion; each has a source of its own.
#pragma once

#include "operator/strategies/strategy.h"

namespace vps::device {

/// Hovers until it has looked long enough, then moves ahead until it touches, slowly near the target. Failed:
/// the part is seen beyond its target and nothing stopped it.
class Approach final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  Held touch_;
};

/// Pushes lightly until the part no longer slides on.
class Touch final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  Progress progress_;
};

/// The part leans with one corner ahead and inside the hole, slides with it against the wall, and is turned
/// upright there. For holes with sharp edges: it finds a hole from farther away than its clearance.
class TiltIn final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  enum class Stage { Lean, Lower, Slide, Upright, Drop };
  void enter(Stage stage, double now_s) noexcept;

  Stage stage_ = Stage::Lean;
  double stage_s_ = 0;
  Vec3 corner_W_ = Vec3::Zero();
  double slide_m_ = 0;
  Held touch_;
};

/// Slides the part over the surface in an Archimedean spiral until it drops.
class SpiralSearch final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  double angle_rad_ = 0, wait_s_ = 0, level_m_ = 0;
  Vec3 center_m_ = Vec3::Zero(), lead_m_ = Vec3::Zero();  ///< of the spiral; of the hand before the part
};

/// Turns about the axis of insertion, to and fro and farther each time, pressed lightly on the surface, until
/// the part drops.
class TurnSearch final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  double settled_s_ = 0, level_m_ = 0;
  double turn_rad_ = 0, reach_rad_ = 0;  ///< of the present sweep
  int side_ = 1, first_side_ = 1;
};

/// Pushes, giving way across and in rotation, with a small wobble against friction, until nothing moves on or
/// nothing resists.
class AlignByTorque final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  Progress progress_;
  Held free_;
};

/// Withdraws: a little within the hole, else to before its mouth; there it looks again.
class BackOff final : public Strategy {
 public:
  explicit BackOff(bool is_whole) : is_whole_(is_whole) {}
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  bool is_whole_;
  double goal_m_ = 0, looked_s_ = 0, longest_s_ = 0;
};

/// Presses the part against its stop, and relaxes. Failed: it yields, or it is seen elsewhere.
class PressHome final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;
  /// It moved on under the press: nothing stops it there.
  [[nodiscard]] bool hasYielded() const noexcept { return has_yielded_; }

 private:
  bool has_yielded_ = false;
};

/// Turns against the thread, pressed lightly on the mouth of the other one, until the part drops: the ends of
/// both threads have passed each other. Failed: it did not drop.
class TurnBack final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  double settled_s_ = 0, from_rad_ = 0, top_m_ = 0;
  int grips_ = 0;
  bool has_dropped_ = false;
  Progress sinking_;
};

/// Turns the part onto the thread, and compares its way along the axis with the pitch. Done: it is seen at
/// its target, or it is tight. Failed: it does not follow the thread, leans, or is stuck.
class ScrewOn final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;
  /// How far it was turned on.
  [[nodiscard]] double turned_rad() const noexcept { return turned_rad_; }

 private:
  [[nodiscard]] bool followsThread(const Feel& feel) noexcept;

  double from_rad_ = 0, turned_rad_ = 0, mark_rad_ = 0, mark_m_ = 0, along_m_ = 0, short_m_ = 0;
  Vec3 lean_rad_ = Vec3::Zero();
  int grips_ = 0;
  bool has_caught_ = false;
  Progress turning_;
};

/// Holds the part where it is seen at its target, as nothing else tells where that is.
class PlaceBySight final : public Strategy {
 public:
  void start(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  double home_m_ = 0;  ///< mean of where it is seen to belong, as along_m
  double held_s_ = 0;  ///< how long that was seen; 0: the part still comes
};

}  // namespace vps::device
