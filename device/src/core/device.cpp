// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/device.h"

#include <algorithm>
#include <array>

namespace vps::device {
namespace {

using Kind = DeviceEventKind;

struct Row {
  Kind kind;
  const char* text;
  const char* remedy;
};

constexpr std::array kRows = {
    Row{Kind::BadEncoder, "an encoder's value is not a number",
        "check the encoder and its cable, then re-arm"},
    Row{Kind::EncoderJump, "an arm's reading jumped", "check the encoder's cable, calibrate, then re-arm"},
    Row{Kind::PulledApart, "the arms' ends are not the handle's length apart",
        "check the handle's joints, calibrate, then re-arm"},
    Row{Kind::LeftArmLost, "the left arm does not answer", "check the arm's power and cable, then re-arm"},
    Row{Kind::RightArmLost, "the right arm does not answer", "check the arm's power and cable, then re-arm"},
    Row{Kind::ClockBackwards, "the device's clock went backwards",
        "re-arm; if the clock goes backwards again, restart the device"},
    Row{Kind::Silent, "the device sends no new readings", "check the device's power and cable, then re-arm"},
    Row{Kind::SharpMotion, "the handle moved faster than a hand does", "hold the handle, then re-arm"},
    Row{Kind::PeerLost, "the program sent no force in time", "check that the haptic loop runs, then re-arm"},
    Row{Kind::BadForce, "the computed force is not a number",
        "report this fault with a recording, then re-arm"},
    Row{Kind::BadPose, "the device's pose is not a number", "check the device, then re-arm"},
    Row{Kind::PoseJump, "the device's pose jumped", "hold the handle, then re-arm"},
    Row{Kind::DeviceLost, "the device does not answer", "check the device's power and cable, then re-arm"},
    Row{Kind::BadGains, "the coupling's gains are out of range",
        "correct [coupling], or remove it to use gains derived from the device"},
    Row{Kind::PhysicsStalled, "the simulation has stopped",
        "wait until the simulation continues, then re-arm"},
    Row{Kind::NotCalibrated, "the encoders are not calibrated",
        "put the handle into its cradle and calibrate"},
    Row{Kind::BadWrench, "the commanded force is not a number and counts as zero",
        "report this warning with a recording"},
    Row{Kind::Saturated, "the commanded force exceeds the motors' limits",
        "push less, or scale the force down"},
    Row{Kind::MotorHot, "a motor is hot: the peak force decreases", "rest, or scale the force down"},
    Row{Kind::NearStop, "an arm is near its end stop", "move back, or shift the workspace"},
    Row{Kind::NearSingular, "the handle is near its greatest rotation", "turn the handle back"},
    Row{Kind::ArmsNear, "the arms are near each other", "turn the handle back towards straight"},
    Row{Kind::TicksMissed, "the haptic loop missed its period",
        "close other programs, or lower the haptic rate"},
    Row{Kind::NoPriority, "the system refuses real-time priority for the haptic loop",
        "allow real-time priority: ulimit -r 90, or rtprio in /etc/security/limits.conf"},
    Row{Kind::NotLocked, "the system refuses to lock the program's memory",
        "allow locked memory: ulimit -l unlimited, or memlock in /etc/security/limits.conf"},
    Row{Kind::Calibrated, "calibrated", ""},
    Row{Kind::Rearmed, "re-armed", ""},
};

Row rowOf(Kind kind) {
  const auto* row = std::find_if(kRows.begin(), kRows.end(), [kind](const Row& r) { return r.kind == kind; });
  return row != kRows.end() ? *row : Row{kind, "unknown", ""};
}

}  // namespace

Severity severityOf(Kind kind) noexcept {
  if (kind <= Kind::NotCalibrated) return Severity::Fault;
  return kind <= Kind::NotLocked ? Severity::Warning : Severity::Notice;
}

const char* toText(Kind kind) noexcept {
  return rowOf(kind).text;
}

const char* remedyOf(Kind kind) noexcept {
  return rowOf(kind).remedy;
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
