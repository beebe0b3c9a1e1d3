// SPDX-License-Identifier: BSD-3-Clause
// vps trade: measures speed against accuracy on a scene, or picks a fidelity.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/planning/trade.h"

namespace vps::viewer {

namespace {

constexpr double kSeconds = 46;  ///< time for measurements; with loading and plotting the command takes 50 s

struct TradeArguments {
  std::string scene;
  FidelityArguments fidelity;
  bool is_thorough = false;
  std::string out, csv, json;  ///< folder and files for results; empty: none
  std::optional<double> budget_hz;
  std::optional<std::string> tolerance, memory;  ///< as text, such as "10um" and "64MB"
};

void print(const scenes::TradeResult& result) {
  std::printf("%s, %s; models queried at %zu poses, %zu of them with overlap\n", result.scene.c_str(),
              result.excerpt.c_str(), result.poses, result.poses_inside);
  std::fputs(tradeTable(result).c_str(), stdout);
  std::printf("\nCompared with the scene's own settings:\n");
  for (const std::string& words : scenes::tradeKnobs(result)) std::printf("  %s\n", words.c_str());
  std::printf("\n");
  for (const std::string& words : scenes::tradeAnswers(result)) std::printf("%s\n", words.c_str());
  for (const std::string& words : result.fixed) std::printf("fixed, not set by a scene: %s\n", words.c_str());
  for (const std::string& words : result.left_out) std::printf("left out: %s\n", words.c_str());
}

/// Number of bytes in a text such as "64MB" or "1.5GB". Throws LoadError.
double bytesFromText(const std::string& text) {
  std::size_t used = 0;
  double number = 0;
  try {
    number = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  const std::string unit = text.substr(used);
  const double scale = unit == "kB" ? 1e3 : unit == "MB" ? 1e6 : unit == "GB" ? 1e9 : 0;
  if (used == 0 || scale == 0 || !(number > 0) || !std::isfinite(number))
    throw LoadError(
        "", "",
        "--memory is '" + text + "'; expected a number greater than 0 with kB, MB or GB, such as 64MB");
  return scale * number;
}

/// The fidelity to pick, if the command line asks for one instead of a measurement.
std::optional<scenes::FidelityWish> wishFrom(const TradeArguments& given) {
  if (!given.budget_hz && !given.tolerance && !given.memory) return std::nullopt;
  if (given.is_thorough || !given.out.empty() || !given.csv.empty())
    throw LoadError(
        "", "",
        "--thorough, --out and --csv belong to a measurement, but --tolerance, --budget-hz and --memory "
        "pick a fidelity without measuring; leave out one or the other");
  scenes::FidelityWish wish;
  // CLI::Range accepts NaN.
  if (given.budget_hz && !std::isfinite(*given.budget_hz))
    throw LoadError("", "", "--budget-hz must be a finite number greater than 0");
  wish.budget_hz = given.budget_hz;
  if (given.tolerance) {
    wish.tolerance_m = scenes::lengthFromText(*given.tolerance, "--tolerance");
    if (!(*wish.tolerance_m > 0))
      throw LoadError("", "", "--tolerance is " + *given.tolerance + "; expected more than 0");
  }
  if (given.memory) wish.memory_bytes = bytesFromText(*given.memory);
  return wish;
}

/// Picks a fidelity and prints the lines to paste into the scene.
int pick(scenes::Scene scene, const scenes::FidelityWish& wish, OutputFile& json, ProgressBar& bar) {
  const scenes::FidelityChoice choice = scenes::chooseFidelity(scene, wish, {.progress = bar.progress()});
  json.write(toJson(scene.name, choice));
  bar.clear();
  if (!choice.is_met) {
    say("no fidelity meets the requirements: " + choice.failure_reason);
    return kBad;
  }
  std::printf("# %s\n%s", scenes::describe(choice).c_str(), scenes::toToml(choice.fidelity).c_str());
  return kGood;
}

int runTrade(const TradeArguments& given) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  const std::optional<scenes::FidelityWish> wish = wishFrom(given);
  OutputFile json(given.json, {given.scene}), csv(given.csv, {given.scene});
  std::optional<OutputFolder> out;
  if (!given.out.empty()) out.emplace(given.out);
  ProgressBar bar;
  const scenes::Scene scene = sceneFrom(given.scene, given.fidelity, {given.json, given.csv}, {});
  if (wish) return pick(scene, *wish, json, bar);
  scenes::TradeOptions options;
  // The callback does not throw after Ctrl-C, so that finished rows are kept.
  options.progress = [show = bar.progress()](std::string_view doing, double share) {
    if (!stopRequested()) show(doing, share);
  };
  options.warn = warn;
  options.is_thorough = given.is_thorough;
  options.stop = &stopRequested();
  // The time limit includes loading.
  options.seconds = kSeconds - std::chrono::duration<double>(Clock::now() - begun).count();
  const scenes::TradeResult result = scenes::trade(scene, options);
  const bool is_stopped = stopRequested();
  if (result.rows.empty()) throwIfStopped();

  PlotOutcome plot{true, {}};
  if (out) {
    plot = plotTrade(result, out->partial() + "/trade");
    out->write("trade.csv", tradeCsv(result));
    out->write("trade.json", toJson(result));
    out->commit();
  }
  csv.write(tradeCsv(result));
  json.write(toJson(result));
  bar.clear();
  print(result);
  if (!plot) warn("no plot: " + plot.failure_reason);
  if (!is_stopped) return kGood;
  say("stopped; the rows that were measured before the stop are above" +
      std::string(out || !given.csv.empty() || !given.json.empty() ? " and saved" : ""));
  return kCouldNot;
}

}  // namespace

std::function<int()> addTrade(CLI::App& command) {
  const auto given = std::make_shared<TradeArguments>();
  addSceneArgument(command, given->scene);
  command.add_flag("--thorough", given->is_thorough,
                   "measure all steps and settings without a time limit (default: 50 s in all)");
  command.add_option("--out", given->out, "folder for a plot, trade.csv and trade.json")->type_name("DIR");
  command
      .add_option("--budget-hz", given->budget_hz, "pick a fidelity that holds this physics rate, and stop")
      ->check(CLI::Range(1.0, 1e6));
  command.add_option("--tolerance", given->tolerance,
                     "pick a fidelity whose error of depth is at most this length, with unit");
  command.add_option("--memory", given->memory,
                     "pick a fidelity whose models need at most this much memory, such as 64MB or 1GB");
  command.add_option("--csv", given->csv, "write the table to this file")->type_name("FILE");
  addFidelityOptions(command, given->fidelity);
  addJsonOption(command, given->json);
  return [given] { return runTrade(*given); };
}

}  // namespace vps::viewer
