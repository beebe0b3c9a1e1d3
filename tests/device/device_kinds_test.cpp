// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/device_kinds.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include "vps/errors.h"

namespace vps::device {
namespace {

TEST(DeviceKinds, NamesAreUniqueAndEachIsFoundByItsName) {
  std::set<std::string_view> names;
  for (const DeviceKind& kind : deviceKinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(findDeviceKind(kind.name), &kind);
    EXPECT_FALSE(kind.description.empty()) << kind.name;
    EXPECT_NE(deviceKindNames().find(kind.name), std::string::npos) << kind.name;
  }
  // Scene files name the kinds of devices by these words.
  for (const char* known : {"dual_arm", "ideal_dual_arm", "space_mouse", "game_controller", "mouse"})
    EXPECT_NE(findDeviceKind(known), nullptr) << known;
  EXPECT_EQ(findDeviceKind("spoon"), nullptr);
}

TEST(DeviceKinds, EachIsInTheTableOfTheDocumentation) {
  std::ifstream in(std::string(VPS_SOURCE_DIR) + "/device/DRIVERS.md");
  const std::string page(std::istreambuf_iterator<char>(in), {});
  for (const DeviceKind& kind : deviceKinds())
    EXPECT_NE(page.find("| `" + std::string(kind.name) + "` |"), std::string::npos) << kind.name;
}

TEST(DeviceKinds, AKindIsEitherSimulatedOrOpenedAndThenNamesARemedy) {
  for (const DeviceKind& kind : deviceKinds()) {
    EXPECT_NE(kind.simulate == nullptr, kind.open == nullptr) << kind.name;
    EXPECT_NE(kind.isSimulated(), !kind.remedy.empty()) << kind.name;
    EXPECT_TRUE(!kind.isSimulated() || kind.missing().empty()) << kind.name;
  }
}

TEST(DeviceKinds, ASimulatedKindStartsWhereTheOptionsSay) {
  DeviceOptions options;
  options.X_DH_start = Pose::translation(Vec3(0.02, -0.03, 0.01));
  for (const DeviceKind& kind : deviceKinds()) {
    if (!kind.isSimulated()) continue;
    const std::unique_ptr<SimulatedDevice> device = kind.simulate(options);
    EXPECT_LT((device->truePose().p - options.X_DH_start.p).norm(), 1e-12) << kind.name;
    EXPECT_EQ(device->read().status, Status::Ok) << kind.name;
    EXPECT_EQ(device->limits().rate_hz, options.rate_hz) << kind.name;
  }
}

TEST(DeviceKinds, TheIdealDualArmLacksResolutionAndDelay) {
  const DeviceLimits real = findDeviceKind("dual_arm")->simulate({})->limits();
  const DeviceLimits ideal = findDeviceKind("ideal_dual_arm")->simulate({})->limits();
  EXPECT_GT(real.resolution_m, 0);
  EXPECT_EQ(ideal.resolution_m, 0);
  EXPECT_GT(real.delay_s, 0);
  EXPECT_EQ(ideal.delay_s, 0);
  EXPECT_EQ(ideal.peak_force_N, real.peak_force_N);
}

TEST(DeviceKinds, AParameterFileThatIsNotThereIsRefused) {
  DeviceOptions options;
  options.parameter_file = "no_such_file.toml";
  EXPECT_THROW(findDeviceKind("dual_arm")->simulate(options), LoadError);
}

}  // namespace
}  // namespace vps::device
