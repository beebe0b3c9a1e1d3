// SPDX-License-Identifier: BSD-3-Clause
// The game controller through SDL2. The only file that includes SDL.
#include <SDL.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "drivers/polled_device.h"
#include "vps_device/device_kinds.h"
#include "vps_device/rate_control.h"

namespace vps::device {

namespace {

constexpr auto kPause = std::chrono::milliseconds(4);  // controllers report every 4 to 8 ms

double axis(SDL_GameController* controller, SDL_GameControllerAxis which) {
  return std::max(-1.0, SDL_GameControllerGetAxis(controller, which) / 32767.0);
}

double button(SDL_GameController* controller, SDL_GameControllerButton which) {
  return SDL_GameControllerGetButton(controller, which) != 0 ? 1 : 0;
}

/// SDL's sticks are positive to the right and towards the person. D: x towards the person, y right, z up.
/// Pulling the right stick tilts the handle's top towards the person, about +y; pushing it right turns the
/// handle clockwise, seen from above; the right shoulder button tilts the handle to the right.
Deflection deflectionOf(SDL_GameController* c) {
  Deflection d;
  d.push = Vec3(axis(c, SDL_CONTROLLER_AXIS_LEFTY), axis(c, SDL_CONTROLLER_AXIS_LEFTX),
                axis(c, SDL_CONTROLLER_AXIS_TRIGGERRIGHT) - axis(c, SDL_CONTROLLER_AXIS_TRIGGERLEFT));
  d.turn =
      Vec3(button(c, SDL_CONTROLLER_BUTTON_LEFTSHOULDER) - button(c, SDL_CONTROLLER_BUTTON_RIGHTSHOULDER),
           axis(c, SDL_CONTROLLER_AXIS_RIGHTY), -axis(c, SDL_CONTROLLER_AXIS_RIGHTX));
  d.is_recentring = button(c, SDL_CONTROLLER_BUTTON_START) > 0;
  return d;
}

class GameController final : public HandSource {
 public:
  GameController() {
    // The program keeps Ctrl-C, and the controller is read whichever window has the focus.
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    const bool is_first = SDL_WasInit(SDL_INIT_GAMECONTROLLER) == 0;
    has_library_ = SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) == 0;
    if (!has_library_ || !is_first) return;
    // No other code reads the events, so they must not accumulate.
    SDL_JoystickEventState(SDL_IGNORE);
    SDL_GameControllerEventState(SDL_IGNORE);
  }
  ~GameController() override {
    close();
    if (has_library_) SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
    SDL_TLSCleanup();  // frees SDL's data of this thread, which SDL did not create
  }

  void poll(HandInput& input) override {
    std::this_thread::sleep_for(kPause);
    if (!has_library_) return;
    SDL_GameControllerUpdate();
    if (controller_ != nullptr && SDL_GameControllerGetAttached(controller_) == SDL_FALSE) close();
    if (controller_ == nullptr) open();
    input = {};
    if (controller_ == nullptr) return;
    input.is_connected = true;
    input.deflection = deflectionOf(controller_);
  }

 private:
  void open() {
    for (int i = 0; i < SDL_NumJoysticks() && controller_ == nullptr; ++i)
      if (SDL_IsGameController(i) == SDL_TRUE) controller_ = SDL_GameControllerOpen(i);
  }
  void close() {
    if (controller_ != nullptr) SDL_GameControllerClose(controller_);
    controller_ = nullptr;
  }

  bool has_library_ = false;
  SDL_GameController* controller_ = nullptr;
};

}  // namespace

std::unique_ptr<Device> openGameController(const RateSettings& settings) {
  return std::make_unique<PolledDevice<GameController>>(settings, "game_controller");
}

DeviceKind gameControllerKind() {
  return {"game_controller",
          "game controller through SDL2, moved by a person; gives no force",
          "plug in a controller that SDL2 supports",
          [](const DeviceOptions& options) { return openGameController(rateSettings(options)); },
          nullptr,
          [] {
            if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0) return std::string(SDL_GetError());
            bool is_found = false;
            for (int i = 0; i < SDL_NumJoysticks(); ++i)
              is_found = is_found || SDL_IsGameController(i) == SDL_TRUE;
            SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
            return std::string(is_found ? "" : "no game controller was found");
          }};
}

}  // namespace vps::device
