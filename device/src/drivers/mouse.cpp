// SPDX-License-Identifier: BSD-3-Clause
// The mouse as a kind of device: a handle that the window of `vps view` pulls.
#include <chrono>
#include <utility>

#include "vps/errors.h"
#include "vps_device/device_kinds.h"

namespace vps::device {
namespace {

class Mouse final : public Device {
 public:
  Mouse(std::shared_ptr<HandleWish> wish, const PulledHandleSettings& settings)
      : wish_(std::move(wish)), handle_(settings) {}

  DeviceSample read() noexcept override { return handle_.step(wish_->read(), F_Ho_D_, seconds()); }
  void write(const Wrench& F_Ho_D) noexcept override { F_Ho_D_ = F_Ho_D; }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return handle_.limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return "mouse"; }

 private:
  [[nodiscard]] double seconds() const noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }

  std::shared_ptr<HandleWish> wish_;
  PulledHandle handle_;
  Wrench F_Ho_D_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

std::unique_ptr<Device> openFor(const DeviceOptions& options) {
  if (options.wish == nullptr)
    throw LoadError("", "", "the mouse moves a part only in a window: vps view SCENE --hand mouse");
  PulledHandleSettings settings;
  settings.rate_hz = options.rate_hz;
  return openMouse(options.wish, settings);
}

}  // namespace

std::unique_ptr<Device> openMouse(std::shared_ptr<HandleWish> wish, const PulledHandleSettings& settings) {
  return std::make_unique<Mouse>(std::move(wish), settings);
}

DeviceKind mouseKind() {
  return {"mouse",
          "the mouse in the window of vps view: a spring from the cursor to the part",
          "use the mouse in a window: vps view SCENE --hand mouse",
          openFor,
          nullptr,
          [] { return std::string(); }};
}

}  // namespace vps::device
