// SPDX-License-Identifier: BSD-3-Clause
// vps_peer_scenes FOLDER [SCENE...]: the table of the peer's scenes. The exit status is 1 if a scene fails
// its check.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "peer_scenes.h"
#include "support/table_rows.h"

namespace {

void writeRows(const vps::peers::PeerResult& r, vps::test::TableRows& file) {
  char bound[64], value[64];
  std::snprintf(bound, sizeof bound, "<= %.3g um", 1e6 * r.limit_m);
  std::snprintf(value, sizeof value, "%.2f um", 1e6 * r.deepest_m);
  const auto verdict = [](bool is_met) { return is_met ? vps::test::kMet : vps::test::kFailed; };
  file.add("peer_scenes " + r.scene + ": deepest", bound, value, verdict(r.deepest_m <= r.limit_m));
  std::snprintf(bound, sizeof bound, "<= %.2g J", r.energy_limit_J);
  std::snprintf(value, sizeof value, "%.2g J", r.energy_rise_J);
  file.add("peer_scenes " + r.scene + ": energy", bound, value, verdict(r.energy_rise_J <= r.energy_limit_J));
  file.add("peer_scenes " + r.scene + ": happens", r.expected, r.found, verdict(r.happens));
  std::snprintf(value, sizeof value, "%.0f us", r.step_p99_us);
  file.add("peer_scenes " + r.scene + ": p99 of a step", "", value, vps::test::kReported);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace vps::peers;
  vps::test::TableRows file;
  std::vector<std::string> words;
  bool is_usable = true;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--tsv=", 0) == 0)
      is_usable = file.open(word.substr(6)) && is_usable;
    else
      words.push_back(word);
  }
  if (words.empty() || !is_usable) {
    std::printf("usage: vps_peer_scenes FOLDER [SCENE...] [--tsv=FILE]\nscenes:");
    for (const std::string& scene : peerScenes()) std::printf(" %s", scene.c_str());
    std::printf("\n");
    return 2;
  }
  std::vector<std::string> scenes(words.begin() + 1, words.end());
  if (scenes.empty()) scenes = peerScenes();
  bool is_good = true;
  std::printf(
      "| scene | simulated [s] | deepest [um] | pair | energy gained / limit [J] | has to | does | p99 of a "
      "step [us] | good |\n|---|---|---|---|---|---|---|---|---|\n");
  try {
    for (const std::string& scene : scenes) {
      const PeerResult r = runPeer(words[0], scene);
      std::printf("| %s | %.1f | %.2f | %s | %.2g / %.2g | %s | %s: %s | %.0f | %s |\n", r.scene.c_str(),
                  r.seconds, 1e6 * r.deepest_m, r.deepest_pair.c_str(), r.energy_rise_J, r.energy_limit_J,
                  r.expected.c_str(), r.happens ? "yes" : "no", r.found.c_str(), r.step_p99_us,
                  r.isGood() ? "yes" : "**no**");
      std::fflush(stdout);
      writeRows(r, file);
      is_good = is_good && r.isGood();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return is_good ? 0 : 1;
}
