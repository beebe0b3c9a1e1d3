// SPDX-License-Identifier: BSD-3-Clause
// vps trade: speed against accuracy on a scene.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "terminal.h"
#include "trade_report.h"
#include "vps/load_error.h"
#include "vps_scenes/fidelity_choice.h"
#include "vps_scenes/import.h"
#include "vps_scenes/trade.h"

namespace vps::viewer {

namespace {

constexpr double kSeconds = 46;  ///< of the fifty that a trade may take

void print(const scenes::TradeResult& result) {
  std::printf("%s, %s; models asked at %zu poses, %zu of them inside\n", result.scene.c_str(),
              result.excerpt.c_str(), result.poses, result.poses_inside);
  std::fputs(tradeTable(result).c_str(), stdout);
  std::printf("\nAgainst the scene as it is:\n");
  for (const std::string& words : scenes::tradeKnobs(result)) std::printf("  %s\n", words.c_str());
  std::printf("\n");
  for (const std::string& words : scenes::tradeAnswers(result)) std::printf("%s\n", words.c_str());
  for (const std::string& words : result.fixed) std::printf("not a scene's choice: %s\n", words.c_str());
  for (const std::string& words : result.left_out) std::printf("left out: %s\n", words.c_str());
}

/// "64MB", "1.5GB".
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
    throw LoadError("", "", "--memory is '" + text + "'; expected more than 0 with kB, MB or GB, as 64MB");
  return scale * number;
}

std::optional<scenes::FidelityWish> wishFrom(const TradeArguments& given) {
  if (!given.budget_hz && !given.tolerance && !given.memory) return std::nullopt;
  if (given.is_thorough || !given.out.empty() || !given.csv.empty())
    throw LoadError("", "",
                    "--thorough, --out and --csv are for what is measured; with --tolerance, --budget-hz or "
                    "--memory nothing is: leave out one or the other");
  scenes::FidelityWish wish;
  // The command line has looked at its range, which lets nan through.
  if (given.budget_hz && !std::isfinite(*given.budget_hz))
    throw LoadError("", "", "--budget-hz must be a finite number of more than 0");
  wish.budget_hz = given.budget_hz;
  if (given.tolerance) {
    wish.tolerance_m = scenes::lengthFromText(*given.tolerance, "--tolerance");
    if (!(*wish.tolerance_m > 0))
      throw LoadError("", "", "--tolerance is " + *given.tolerance + "; expected more than 0");
  }
  if (given.memory) wish.memory_bytes = bytesFromText(*given.memory);
  return wish;
}

/// Picks, and says what to paste into the scene.
int pick(scenes::Scene scene, const scenes::FidelityWish& wish, OutputFile& json, ProgressBar& bar) {
  const scenes::FidelityChoice choice = scenes::chooseFidelity(scene, wish, {.progress = bar.progress()});
  json.write(toJson(scene.name, choice));
  bar.clear();
  if (!choice.is_met) {
    say("no fidelity will do: " + choice.failure_reason);
    return kBad;
  }
  std::printf("# %s\n%s", scenes::describe(choice).c_str(), scenes::toToml(choice.fidelity).c_str());
  return kGood;
}

}  // namespace

int runTrade(const TradeArguments& given) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  const std::optional<scenes::FidelityWish> wish = wishFrom(given);
  OutputFile json(given.json, {given.scene}), csv(given.csv, {given.scene});
  std::optional<OutputFolder> out;
  if (!given.out.empty()) out.emplace(given.out);
  ProgressBar bar;
  const scenes::Scene scene = sceneFrom(given.scene, given.fidelity, {given.json, given.csv});
  if (wish) return pick(scene, *wish, json, bar);
  scenes::TradeOptions options;
  // Without throwing when it is stopped: what was finished is kept.
  options.progress = [show = bar.progress()](std::string_view doing, double share) {
    if (!stopRequested()) show(doing, share);
  };
  options.warn = warn;
  options.is_thorough = given.is_thorough;
  options.stop = &stopRequested();
  // ModelResponse the scene counts, and plots come after.
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
  say("stopped; what was measured by then is above" +
      std::string(out || !given.csv.empty() || !given.json.empty() ? ", and saved" : ""));
  return kCouldNot;
}

}  // namespace vps::viewer
