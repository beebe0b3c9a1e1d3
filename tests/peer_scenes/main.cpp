// SPDX-License-Identifier: BSD-3-Clause
// vps_peer_scenes FOLDER [SCENE...]: the table of the peer's scenes. Exits 1 if one is not as it should be.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "peer_scenes.h"

int main(int argc, char** argv) {
  using namespace vps::peers;
  if (argc < 2) {
    std::printf("usage: vps_peer_scenes FOLDER [SCENE...]\nscenes:");
    for (const std::string& scene : peerScenes()) std::printf(" %s", scene.c_str());
    std::printf("\n");
    return 2;
  }
  std::vector<std::string> scenes(argv + 2, argv + argc);
  if (scenes.empty()) scenes = peerScenes();
  bool is_good = true;
  std::printf(
      "| scene | simulated [s] | deepest [um] | pair | energy gained / limit [J] | has to | does | p99 of a "
      "step [us] | good |\n|---|---|---|---|---|---|---|---|---|\n");
  try {
    for (const std::string& scene : scenes) {
      const PeerResult r = runPeer(argv[1], scene);
      std::printf("| %s | %.1f | %.2f | %s | %.2g / %.2g | %s | %s: %s | %.0f | %s |\n", r.scene.c_str(),
                  r.seconds, 1e6 * r.deepest_m, r.deepest_pair.c_str(), r.energy_rise_J, r.energy_limit_J,
                  r.expected.c_str(), r.happens ? "yes" : "no", r.found.c_str(), r.step_p99_us,
                  r.isGood() ? "yes" : "**no**");
      std::fflush(stdout);
      is_good = is_good && r.isGood();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return is_good ? 0 : 1;
}
