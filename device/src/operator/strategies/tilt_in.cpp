// SPDX-License-Identifier: BSD-3-Clause
#include "operator/strategies/strategy.h"

namespace vps::device {
namespace {

constexpr double kLean_s = 0.4, kUpright_s = 0.6, kDrop_s = 0.3;
constexpr double kTiltInTouch_s = 0.02;
constexpr double kShift_m = 0.35e-3;  // shift of the corner into the hole: 3.5 times the default see_error_m
constexpr double kSlide_m = 1e-3;  // length of the slide, more than the distance of the corner from its wall
constexpr double kSlide_m_s = 2.5e-3;
constexpr double kCaught_N = 0.9;      // side force of a caught corner, more than the friction of the push
constexpr double kPreload_m = 0.3e-3;  // keeps the corner at its walls while the part is turned upright
constexpr double kTiltInDropped_m = 0.3e-3;  // depth of a drop, more than the radius of a rounded edge

/// Tilts the part with one corner ahead, puts that corner into the hole, slides it against the wall and turns
/// the part upright there. For holes with sharp edges: the search finds a hole that is farther away than the
/// clearance.
class TiltIn final : public Strategy {
 public:
  [[nodiscard]] bool isSearch() const noexcept override { return true; }
  [[nodiscard]] bool suits(const Situation& situation) const noexcept override {
    return !situation.corner_W.isZero();
  }

  Outcome step(const Feel& feel, double dt_s) noexcept override {
    const OperatorHabits& habits = situation_.habits;
    const double t_s = feel.time_s - stage_s_;
    const Vec3 lean_rad = habits.tilt_rad * corner_W_.cross(situation_.axis_W);  // the corner goes ahead
    switch (stage_) {
      case Stage::Lean:
        move_.turn_rad = minimumJerk(t_s / kLean_s) * lean_rad;
        move_.across_m = minimumJerk(t_s / kLean_s) * slide_m_ * corner_W_;
        if (t_s > 1.5 * kLean_s) enter(Stage::Lower, feel.time_s);
        break;
      case Stage::Lower:
        pressLightly();
        if (touch_.step(feel.resist_N > 0.7 * habits.touch_N, dt_s) > kTiltInTouch_s)
          enter(Stage::Slide, feel.time_s);
        else if (t_s > kLower_s)
          return Outcome::Failed;
        break;
      case Stage::Slide:
        slide_m_ += dt_s * kSlide_m_s;
        move_.across_m = slide_m_ * corner_W_;
        if (-feel.side_N.dot(corner_W_) > kCaught_N) {
          move_.across_m = (slide_m_ + kPreload_m) * corner_W_;
          enter(Stage::Upright, feel.time_s);
        } else if (slide_m_ > kSlide_m) {
          return Outcome::Failed;
        }
        break;
      case Stage::Upright:
        move_.turn_rad = (1 - minimumJerk(t_s / kUpright_s)) * lean_rad;
        move_.push_N = 2 * habits.search_N;
        if (t_s > 1.2 * kUpright_s) enter(Stage::Drop, feel.time_s);
        break;
      case Stage::Drop:
        move_.gives_way = true;
        if (t_s > kDrop_s)
          return feel.along_m > situation_.mouth_m + kTiltInDropped_m ? Outcome::Done : Outcome::Failed;
        break;
    }
    return Outcome::GoingOn;
  }

 private:
  enum class Stage { Lean, Lower, Slide, Upright, Drop };

  void begin(const Feel& feel) noexcept override {
    corner_W_ = situation_.attempt % 2 == 0 ? situation_.corner_W : Vec3(-situation_.corner_W);
    slide_m_ = -kShift_m;
    touch_ = {};
    enter(Stage::Lean, feel.time_s);
  }
  void enter(Stage stage, double now_s) noexcept {
    stage_ = stage;
    stage_s_ = now_s;
  }

  Stage stage_ = Stage::Lean;
  double stage_s_ = 0, slide_m_ = 0;
  Vec3 corner_W_ = Vec3::Zero();
  Held touch_;
};

}  // namespace

std::unique_ptr<Strategy> makeTiltIn() {
  return std::make_unique<TiltIn>();
}

}  // namespace vps::device
