// SPDX-License-Identifier: BSD-3-Clause
// vps_hand: how many seeds of the virtual operator bring a peg into its hole, and how long they take; and the
// table of verdicts at the edge between fit and misfit.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "edge_case.h"
#include "hand_scenes.h"
#include "support/table_rows.h"
#include "vps_scenes/run/assemble.h"

namespace {

using vps::hand::PegScene;

std::vector<PegScene> allScenes() {
  std::vector<PegScene> scenes = vps::hand::pegScenes();
  const std::vector<PegScene>& threads = vps::hand::threadScenes();
  scenes.insert(scenes.end(), threads.begin(), threads.end());
  return scenes;
}

int usage() {
  std::printf(
      "usage: vps_hand CASE [FIRST [LAST]] [--trace FILE] [--tsv FILE]\n"
      "Runs the seeds FIRST to LAST (default 1 to 100) and prints a line for each, then their share.\n"
      "  --trace  writes time, phase, pose error and force of every 10th physics step of the last seed\n"
      "       vps_hand edge [--every N] [--from K] [--seed S] [--only WORDS] [--no-wall] [--verbose] [--tsv "
      "FILE]\n"
      "Pegs from 50 um too large to 50 um of clearance; the exit status is 1 if a verdict is wrong.\n"
      "  --no-wall  removes the bores' walls; a verdict 'by contact' is then wrong\n"
      "cases:\n");
  for (const PegScene& scene : allScenes()) std::printf("  %-13s %s\n", scene.name, scene.description);
  return 2;
}

void writeTrace(const vps::scenes::AssembleResult& result, const vps::Pose& X_target, const char* file) {
  std::FILE* out = std::fopen(file, "w");
  if (out == nullptr) return;
  for (std::size_t i = 0; i < result.trace.size(); i += 10) {
    const vps::scenes::TraceRow& row = result.trace[i];
    const vps::Vec3 off_um = 1e6 * (row.X_WP.p - X_target.p);
    const vps::Vec3 turn_mrad = 1e3 * vps::rotationVector(row.X_WP.R * X_target.R.transpose());
    std::fprintf(out,
                 "%.3f %d  %8.1f %8.1f %8.1f  %7.2f %7.2f %7.2f  %6.2f %6.2f %6.2f  %7.3f %7.3f %7.3f %d\n",
                 row.time_s, row.phase, off_um.x(), off_um.y(), off_um.z(), turn_mrad.x(), turn_mrad.y(),
                 turn_mrad.z(), row.F_hand_W.f.x(), row.F_hand_W.f.y(), row.F_hand_W.f.z(),
                 row.F_hand_W.tau.x(), row.F_hand_W.tau.y(), row.F_hand_W.tau.z(), row.contacts);
  }
  std::fclose(out);
}

void writeRows(const std::string& name, const vps::scenes::StepResult& step, vps::test::TableRows& file) {
  char value[96];
  std::snprintf(value, sizeof value, "%s, %.2f s, deepest %.2f um",
                step.completed ? "done" : step.failure_reason.c_str(), step.duration_s,
                1e6 * step.max_penetration_m);
  file.add(name, "completed", value, step.completed ? vps::test::kMet : vps::test::kFailed);
}

int runEdgeTable(const std::vector<std::string>& words, const std::string& rows_file) {
  vps::hand::EdgeTableSettings settings;
  settings.rows_file = rows_file;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const bool has_value = i + 1 < words.size();
    const auto number = [&] { return std::strtoull(words[++i].c_str(), nullptr, 10); };
    if (words[i] == "--no-wall")
      settings.has_wall = false;
    else if (words[i] == "--verbose")
      settings.is_verbose = true;
    else if (words[i] == "--every" && has_value)
      settings.every = std::max<std::size_t>(1, number());
    else if (words[i] == "--from" && has_value)
      settings.first = number();
    else if (words[i] == "--seed" && has_value)
      settings.seed = number();
    else if (words[i] == "--only" && has_value)
      settings.only = words[++i];
    else
      return usage();
  }
  return vps::hand::printEdgeTable(settings) == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::string trace, rows_file;
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--trace" && i + 1 < argc)
      trace = argv[++i];
    else if (std::string(argv[i]) == "--tsv" && i + 1 < argc)
      rows_file = argv[++i];
    else
      words.emplace_back(argv[i]);
  }
  if (words.empty()) return usage();
  if (words[0] == "edge") return runEdgeTable(words, rows_file);
  vps::test::TableRows file;
  if (!rows_file.empty() && !file.open(rows_file)) return usage();
  const std::vector<PegScene> scenes = allScenes();
  const auto chosen =
      std::find_if(scenes.begin(), scenes.end(), [&](const PegScene& s) { return words[0] == s.name; });
  if (chosen == scenes.end()) return usage();
  const std::uint64_t first = words.size() > 1 ? std::strtoull(words[1].c_str(), nullptr, 10) : 1;
  const std::uint64_t last =
      words.size() > 2 ? std::strtoull(words[2].c_str(), nullptr, 10) : (words.size() > 1 ? first : 100);
  int good = 0, runs = 0;
  double total_s = 0;
  for (std::uint64_t seed = first; seed <= last; ++seed, ++runs) {
    vps::scenes::Scene scene = chosen->make(seed);
    vps::scenes::AssembleOptions options;
    options.judge_stride = 1000;
    const vps::scenes::AssembleResult result = vps::scenes::assemble(scene, options);
    const vps::scenes::StepResult& step = result.steps.at(0);
    if (step.completed) {
      ++good;
      total_s += step.duration_s;
    }
    std::printf("seed %llu: %s, %.2f s, peak %.1f N, deepest %.1f um, error %.1f um %.2f mrad %s\n",
                static_cast<unsigned long long>(seed), step.completed ? "done" : "failed", step.duration_s,
                step.peak_force_N, 1e6 * step.max_penetration_m, 1e6 * step.final_error_m,
                1e3 * step.final_error_rad, step.failure_reason.c_str());
    if (step.turns != 0)
      std::printf("  %.2f turns, %.3f mm a turn, leaning %.2f mrad, re-grasped %d times; %s: %s\n",
                  step.turns, 1e3 * step.advance_per_turn_m, 1e3 * step.lean_rad, step.index_count,
                  vps::scenes::toText(step.verdict), step.reason.c_str());
    std::fflush(stdout);
    writeRows("hand " + std::string(chosen->name) + ", seed " + std::to_string(seed), step, file);
    if (!trace.empty() && seed == last) writeTrace(result, scene.steps[0].X_WP_target, trace.c_str());
  }
  std::printf("%s: %d of %d seeds succeed, mean %.2f s\n", chosen->name, good, runs,
              good > 0 ? total_s / good : 0);
}
