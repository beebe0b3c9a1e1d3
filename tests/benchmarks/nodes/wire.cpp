// SPDX-License-Identifier: BSD-3-Clause
// Device and render on two machines, which are network namespaces here, joined by a wire with faults.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "lossy_wire.h"
#include "rows.h"
#include "support/process/node_processes.h"
#include "support/temporary_folder.h"

namespace vps::bench {

namespace {

using nlohmann::json;

constexpr double kInjectedBar_J = 1e-3;
constexpr double kBandwidthBar_Mbit = 4;

std::vector<std::string> inSpace(const std::string& side, std::vector<std::string> words) {
  words.insert(words.begin(), {"/usr/sbin/ip", "netns", "exec", "vpsbench-" + side});
  return words;
}

/// The line of render's output that contains these words.
std::string lineWith(const std::filesystem::path& file, const std::string& words) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (const std::size_t at = line.find(words); at != std::string::npos) return line.substr(at);
  return "";
}

/// A peg and its hole at 1600 Hz, as in the paper's system.
void writeFastScene(const std::filesystem::path& file) {
  std::ofstream(file) << "unit = 'mm'\n[[part]]\nfile = '" VPS_SCENE_FOLDER
                         "/peg_in_hole/hole.stl'\nfixed = true\n[[part]]\nfile = '" VPS_SCENE_FOLDER
                         "/peg_in_hole/peg.stl'\npose = {position = [0, 0, -15]}\n[[step]]\npart = 'peg'\n"
                         "clearance = 0.05\n[fidelity]\nhaptic_rate_hz = 1600\nphysics_rate_hz = 1600\n";
}

struct Bandwidth {
  double median_Mbit = 0;  ///< median of the seconds in which states are sent in both directions
  double most_Mbit = 0;    ///< the busiest second after the nodes have found each other
  double start_Mbit = 0;   ///< the busiest second of all, with discovery and the transfer of the scene
};

Bandwidth bandwidthOf(const std::vector<std::uint64_t>& per_second) {
  constexpr double kMbit = 8e-6;
  constexpr std::size_t kStart = 4;  // seconds, as the rows with all seconds show
  Bandwidth all;
  std::vector<double> running;
  for (std::size_t i = 0; i < per_second.size(); ++i) {
    const double Mbit = kMbit * static_cast<double>(per_second[i]);
    all.start_Mbit = std::max(all.start_Mbit, Mbit);
    if (i >= kStart) running.push_back(Mbit);
  }
  if (running.empty()) return all;
  std::sort(running.begin(), running.end());
  all.median_Mbit = running[running.size() / 2];
  all.most_Mbit = running.back();
  return all;
}

bool wireRow(const std::string& scene, const WireFaults& faults) {
  const test::TemporaryFolder folder;
  LossyWire wire(faults);
  const std::string render_text = folder.path() / "render.txt", json_file = folder.path() / "run.json";
  test::ChildProcess device(
      inSpace("b", {VPS_PROGRAM, "device", "--session", "wire", "--network", "wire", "--security", "none"}),
      folder.path() / "device.txt");
  test::ChildProcess render(
      inSpace("a", {VPS_PROGRAM, "render", scene, "--session", "wire", "--network", "wire", "--security",
                    "none", "--no-pictures", "--out", folder.path() / "out", "--json", json_file}),
      render_text);
  render.wait();
  char what[160];
  std::snprintf(
      what, sizeof what,
      "%s, UDP between two namespaces: loss %.0f %%, delay %.0f ms, jitter %.0f ms, doubled %.0f %%",
      std::filesystem::path(scene).stem().c_str(), 100 * faults.loss, 1e3 * faults.delay_s,
      1e3 * faults.jitter_s, 100 * faults.doubled);
  std::ifstream in(json_file);
  const json run = json::parse(in, nullptr, false);
  if (run.is_discarded()) {
    printRow(what, "all steps done, injected <= 1 mJ", "no result: " + lineWith(render_text, "vps: "), false);
    return false;
  }
  const double injected_J = run["energy"]["injected_J"];
  const auto done = std::count_if(run["steps"].begin(), run["steps"].end(),
                                  [](const json& step) { return step["completed"].get<bool>(); });
  const Bandwidth bandwidth = bandwidthOf(wire.perSecond());
  char words[360];
  std::snprintf(words, sizeof words,
                "%s, %ld of %zu steps done, injected %.3f mJ, peak %.1f N, safety faults %ld; %s; %.2f "
                "Mbit/s (median of a second), %.2f in the busiest second, %.2f with the start",
                run["verdict"].get<std::string>().c_str(), static_cast<long>(done), run["steps"].size(),
                1e3 * injected_J, run["steps"].empty() ? 0.0 : run["steps"][0]["peak_force_N"].get<double>(),
                run["wall"]["haptic"].contains("faults") ? run["wall"]["haptic"]["faults"].get<long>() : -1L,
                lineWith(render_text, "the coupling has").c_str(), bandwidth.median_Mbit, bandwidth.most_Mbit,
                bandwidth.start_Mbit);
  const bool has_faults = faults.delay_s > 0;
  const bool is_reached = injected_J <= kInjectedBar_J && done == static_cast<long>(run["steps"].size()) &&
                          (has_faults || bandwidth.most_Mbit <= kBandwidthBar_Mbit);
  printRow(what, has_faults ? "all steps done, injected <= 1 mJ" : "the same, and at most 4 Mbit/s", words,
           is_reached);
  return is_reached;
}

}  // namespace

bool wireRows(const std::string& scene) {
  bool is_good = true;
  try {
    is_good = wireRow(scene, {}) && is_good;
    const test::TemporaryFolder folder;
    const std::filesystem::path fast = folder.path() / "at_1600_Hz.toml";
    writeFastScene(fast);
    is_good = wireRow(fast, {}) && is_good;
    for (const double delay_s : {1e-3, 5e-3, 20e-3})
      is_good = wireRow(scene, {0.05, delay_s, 5e-3, 0.01}) && is_good;
  } catch (const std::runtime_error& error) {
    printRow("UDP between two namespaces", "", error.what(), false);
    return false;
  }
  return is_good;
}

}  // namespace vps::bench
