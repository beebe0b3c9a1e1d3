// SPDX-License-Identifier: BSD-3-Clause
// Scenes of a peer's test suite (Rigid IPC, Ferguson et al. 2021), run by `simulate` with the overlap of all
// bodies judged at every step, and with a check of the expected motion of each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vps::peers {

struct PeerResult {
  std::string scene;
  double seconds = 0;
  double deepest_m = 0, limit_m = 0;
  std::string deepest_pair;
  std::size_t overlapping_starts = 0;
  /// Greatest rise of kinetic and potential energy above an earlier value. The limit allows for two effects:
  /// contact may remove the allowed overlap, which lifts all weight by this distance; and Bullet's
  /// semi-implicit steps lift a body that rises at v by v dt / 2 too much.
  double energy_rise_J = 0, energy_limit_J = 0;
  std::string expected, found;  ///< the expected event, and what happened
  bool happens = false;
  double step_p99_us = 0, wall_s = 0;
  [[nodiscard]] bool isGood() const {
    return happens && deepest_m <= limit_m && energy_rise_J <= energy_limit_J;
  }
};

/// Names of the scenes; each is a folder with a scene.toml.
std::vector<std::string> peerScenes();

/// @param folder  the folder of the scenes
/// @param seconds  simulated time; 0: as long as the check needs
/// Throws LoadError as loadScene() and simulate().
PeerResult runPeer(const std::filesystem::path& folder, const std::string& scene, double seconds = 0);

}  // namespace vps::peers
