// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/device.h"

namespace vps::device {
namespace {

using Kind = DeviceEventKind;

struct Words {
  const char* text;
  const char* remedy;
};

Words wordsOf(Kind kind) {
  switch (kind) {
    case Kind::BadEncoder:
      return {"an encoder's value is not a number", "check the encoder and its cable, then re-arm"};
    case Kind::EncoderJump:
      return {"an arm's reading jumped", "check the encoder's cable, calibrate, then re-arm"};
    case Kind::PulledApart:
      return {"the arms' ends are not the handle's length apart",
              "check the handle's joints, calibrate, then re-arm"};
    case Kind::LeftArmLost:
      return {"the left arm does not answer", "check its power and cable, then re-arm"};
    case Kind::RightArmLost:
      return {"the right arm does not answer", "check its power and cable, then re-arm"};
    case Kind::ClockBackwards:
      return {"the device's clock went backwards", "re-arm; if it comes again, restart the device"};
    case Kind::Silent:
      return {"the device sends nothing new", "check its power and cable, then re-arm"};
    case Kind::SharpMotion:
      return {"the handle moved faster than a hand does", "hold the handle, then re-arm"};
    case Kind::PeerLost:
      return {"no force was asked for in time", "see that the rendering runs, then re-arm"};
    case Kind::BadForce:
      return {"the force worked out is not a number", "report it with a recording, then re-arm"};
    case Kind::BadPose:
      return {"the device's pose is not a number", "check the device, then re-arm"};
    case Kind::PoseJump:
      return {"the device's pose jumped", "hold the handle, then re-arm"};
    case Kind::DeviceLost:
      return {"the device does not answer", "check its power and cable, then re-arm"};
    case Kind::BadGains:
      return {"the coupling's gains are out of range", "correct [coupling], or leave it to the device's own"};
    case Kind::PhysicsStalled:
      return {"the simulation stands still", "wait until it goes on, then re-arm"};
    case Kind::NotCalibrated:
      return {"the encoders do not know where they are", "put the handle into its cradle and calibrate"};
    case Kind::BadWrench:
      return {"a force that is not a number was asked for, and not given", "report it with a recording"};
    case Kind::Saturated:
      return {"more force was asked for than the motors give", "push less, or scale the force down"};
    case Kind::MotorHot:
      return {"a motor is hot: the peak force fades", "rest, or scale the force down"};
    case Kind::NearStop:
      return {"an arm is near its end", "move back, or shift the workspace"};
    case Kind::NearSingular:
      return {"the handle is turned almost as far as it goes", "turn it back"};
    case Kind::ArmsNear:
      return {"the arms come near each other", "turn the handle back towards straight"};
    case Kind::TicksMissed:
      return {"the haptic loop came too late", "close other programs, or lower the haptic rate"};
    case Kind::NoPriority:
      return {"the system refuses the haptic loop its priority",
              "allow it: ulimit -r 90, or rtprio in /etc/security/limits.conf"};
    case Kind::NotLocked:
      return {"the system refuses to keep the program in memory",
              "allow it: ulimit -l unlimited, or memlock in /etc/security/limits.conf"};
    case Kind::Calibrated:
      return {"calibrated", ""};
    case Kind::Rearmed:
      return {"re-armed", ""};
  }
  return {"unknown", ""};
}

}  // namespace

Severity severityOf(Kind kind) noexcept {
  if (kind <= Kind::NotCalibrated) return Severity::Fault;
  return kind <= Kind::NotLocked ? Severity::Warning : Severity::Notice;
}

const char* toText(Kind kind) noexcept {
  return wordsOf(kind).text;
}

const char* remedyOf(Kind kind) noexcept {
  return wordsOf(kind).remedy;
}

Beep beepOf(Kind kind) noexcept {
  switch (severityOf(kind)) {
    case Severity::Notice:
      return {};
    case Severity::Warning:
      return {880, 1};
    case Severity::Fault:
      return {1760, 3};
  }
  return {};
}

bool DeviceEventQueue::push(const DeviceEvent& event) noexcept {
  const std::size_t pushed = pushed_.load(std::memory_order_relaxed);
  if (pushed - popped_.load(std::memory_order_acquire) == kCapacity) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  events_[pushed % kCapacity] = event;
  pushed_.store(pushed + 1, std::memory_order_release);
  return true;
}

bool DeviceEventQueue::pop(DeviceEvent& event) noexcept {
  const std::size_t popped = popped_.load(std::memory_order_relaxed);
  if (popped == pushed_.load(std::memory_order_acquire)) return false;
  event = events_[popped % kCapacity];
  popped_.store(popped + 1, std::memory_order_release);
  return true;
}

}  // namespace vps::device
