// SPDX-License-Identifier: BSD-3-Clause
// The peer's scenes as tests, except the arch, of which a simulated second takes minutes. vps_peer_scenes
// runs the arch too.
#include "peer_scenes.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace vps::peers {
namespace {

std::filesystem::path sceneFolder() {
  const char* given = std::getenv("VPS_PEER_SCENES_DIR");
  return given != nullptr ? std::filesystem::path(given)
                          : std::filesystem::path(VPS_SOURCE_DIR).parent_path() / "shared" / "peer_scenes";
}

class PeerScenes : public testing::TestWithParam<const char*> {};

TEST_P(PeerScenes, IsWithinItsBounds) {
  const std::filesystem::path folder = sceneFolder();
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << folder.string() << " does not exist; set VPS_PEER_SCENES_DIR";
  const PeerResult result = runPeer(folder, GetParam());
  EXPECT_LE(result.deepest_m, result.limit_m) << result.deepest_pair;
  EXPECT_LE(result.energy_rise_J, result.energy_limit_J);
  EXPECT_TRUE(result.happens) << result.expected << ": " << result.found;
}

INSTANTIATE_TEST_SUITE_P(Each, PeerScenes, testing::Values("tet-corner", "vertex-face", "bolt", "10-links"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace vps::peers
