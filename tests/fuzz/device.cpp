// SPDX-License-Identifier: BSD-3-Clause
// Interprets bytes as faults of a dual arm's hardware, physics and operator, tick by tick. The force must
// stay within its limit, be zero after a fault, and return after rearm().
#include "fuzz.h"
#include "support/device/hostile_arm.h"
#include "vps/errors.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The first byte selects a parameter file or a sequence for the controller.
  if (size > 0 && data[0] == '[') {
    try {
      const vps::device::DualArmFile file =
          vps::device::parseDualArm({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
      vps::fuzz::require(vps::device::isReachable(file.parameters,
                                                  vps::Pose::translation(0.5 * file.parameters.workspace_m)),
                         "a file that is accepted makes a device that reaches its workspace");
    } catch (const vps::LoadError&) {
    }
    return 0;
  }
  vps_test::runHostile(data, std::min<std::size_t>(size, 400), vps::fuzz::require);
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  // Seeds: no fault; each fault in turn; gains that are not numbers; a parameter file.
  std::string calm = {1, char(128)}, all = {2, char(140)}, bad_gains = {0, 100};
  for (int i = 0; i < 40; ++i) calm.append({31, 0});
  for (char code = 0; code < 23; ++code) {
    for (int i = 0; i < 4; ++i) all.append({31, 0});
    all.append({code, 50, 16, 0});
  }
  for (int i = 0; i < 10; ++i) bad_gains.append({31, 0, 16, 0});
  return {calm, all, bad_gains,
          "[handle]\nmass_kg = {value = 0.3, assumed = \"why\"}\n[timing]\ndelay_ticks = 2\n"};
}
