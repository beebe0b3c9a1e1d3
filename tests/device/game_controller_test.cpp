// SPDX-License-Identifier: BSD-3-Clause
// The game controller, simulated by SDL's virtual joystick.
#if __has_include(<SDL2/SDL.h>)
#include <SDL2/SDL.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "support/device/fake_device.h"
#include "support/no_alloc.h"
#include "vps/errors.h"
#include "vps_device/rate_control.h"

namespace vps::device {
namespace {

using test::isThere;
using test::within10s;

/// A controller that is plugged in during its lifetime.
class VirtualController {
 public:
  VirtualController()
      : index_(SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
                                         SDL_CONTROLLER_BUTTON_MAX, 0)),
        joystick_(SDL_JoystickOpen(index_)) {
    EXPECT_NE(joystick_, nullptr) << SDL_GetError();
  }
  ~VirtualController() {
    SDL_JoystickClose(joystick_);
    SDL_JoystickDetachVirtual(index_);
  }
  VirtualController(const VirtualController&) = delete;
  VirtualController& operator=(const VirtualController&) = delete;

  void push(SDL_GameControllerAxis axis, Sint16 value) { SDL_JoystickSetVirtualAxis(joystick_, axis, value); }
  void press(SDL_GameControllerButton button, bool is_down) {
    SDL_JoystickSetVirtualButton(joystick_, button, is_down ? 1 : 0);
  }

 private:
  int index_;
  SDL_Joystick* joystick_;
};

class GameController : public testing::Test {
 protected:
  void SetUp() override {
    if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0) GTEST_SKIP() << SDL_GetError();
    try {
      device_ = openGameController();
    } catch (const LoadError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  void TearDown() override {
    device_.reset();
    SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
  }
  std::unique_ptr<Device> device_;
};

TEST_F(GameController, UnpluggedItIsLostAndPluggedInItIsFound) {
  EXPECT_EQ(device_->read().status, Status::Fault);
  {
    VirtualController controller;
    EXPECT_TRUE(within10s(*device_, isThere));
  }
  EXPECT_TRUE(within10s(*device_, [](const DeviceSample& s) { return s.status == Status::Fault; }));
  VirtualController another;
  EXPECT_TRUE(within10s(*device_, isThere));
}

TEST_F(GameController, EachStickAndButtonMovesItsOwnAxis) {
  VirtualController controller;
  ASSERT_TRUE(within10s(*device_, isThere));
  const auto expectMoves = [&](const Vec3& v, const Vec3& w, const char* what) {
    EXPECT_TRUE(within10s(*device_, [&](const DeviceSample& s) {
      return (s.V_DH.v - 0.08 * v).norm() < 1e-9 && (s.V_DH.w - 0.8 * w).norm() < 1e-9;
    })) << what;
  };
  const struct {
    SDL_GameControllerAxis axis;
    Vec3 v, w;
    const char* what;
  } cases[] = {
      {SDL_CONTROLLER_AXIS_LEFTX, Vec3::UnitY(), Vec3::Zero(), "left stick right"},
      {SDL_CONTROLLER_AXIS_LEFTY, Vec3::UnitX(), Vec3::Zero(), "left stick pulled"},
      {SDL_CONTROLLER_AXIS_TRIGGERRIGHT, Vec3::UnitZ(), Vec3::Zero(), "right trigger"},
      {SDL_CONTROLLER_AXIS_TRIGGERLEFT, -Vec3::UnitZ(), Vec3::Zero(), "left trigger"},
      {SDL_CONTROLLER_AXIS_RIGHTX, Vec3::Zero(), -Vec3::UnitZ(), "right stick right"},
      {SDL_CONTROLLER_AXIS_RIGHTY, Vec3::Zero(), Vec3::UnitY(), "right stick pulled"},
  };
  for (const SDL_GameControllerAxis trigger :
       {SDL_CONTROLLER_AXIS_TRIGGERLEFT, SDL_CONTROLLER_AXIS_TRIGGERRIGHT})
    controller.push(trigger, -32768);  // a virtual trigger is an axis, released at its lower end
  for (const auto& c : cases) {
    const bool is_trigger =
        c.axis == SDL_CONTROLLER_AXIS_TRIGGERLEFT || c.axis == SDL_CONTROLLER_AXIS_TRIGGERRIGHT;
    controller.push(c.axis, 32767);
    expectMoves(c.v, c.w, c.what);
    controller.push(c.axis, is_trigger ? -32768 : 0);
  }
  controller.push(SDL_CONTROLLER_AXIS_LEFTX, -32768);
  expectMoves(-Vec3::UnitY(), Vec3::Zero(), "left stick left, one count beyond full");
  controller.push(SDL_CONTROLLER_AXIS_LEFTX, 3000);  // less than a tenth: a worn stick at rest
  expectMoves(Vec3::Zero(), Vec3::Zero(), "at rest");
  controller.press(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, true);
  expectMoves(Vec3::Zero(), -Vec3::UnitX(), "right shoulder");
  controller.press(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, false);
  controller.press(SDL_CONTROLLER_BUTTON_START, true);
  EXPECT_TRUE(within10s(*device_, [](const DeviceSample& s) {
    return s.X_DH.p.norm() < 1e-12 && rotationVector(s.X_DH.R).norm() < 1e-9;
  })) << "start re-centres";
}

TEST_F(GameController, ReadingNeverAllocates) {
  VirtualController controller;
  ASSERT_TRUE(within10s(*device_, isThere));
  controller.push(SDL_CONTROLLER_AXIS_LEFTX, 32767);
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 10'000; ++i) device_->read();
}

}  // namespace
}  // namespace vps::device
#endif
