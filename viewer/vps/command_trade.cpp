// SPDX-License-Identifier: BSD-3-Clause
// vps trade: speed against accuracy on a scene.
#include <chrono>
#include <cstdio>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "terminal.h"
#include "trade_report.h"
#include "vps_scenes/trade.h"

namespace vps {

namespace {

constexpr double kSeconds = 46;  ///< of the fifty that a trade may take

void print(const TradeResult& result) {
  std::printf("%s, %s; models asked at %zu poses, %zu of them inside\n", result.scene.c_str(),
              result.excerpt.c_str(), result.poses, result.poses_inside);
  std::fputs(tradeTable(result).c_str(), stdout);
  std::printf("\nAgainst the scene as it is:\n");
  for (const std::string& words : tradeKnobs(result)) std::printf("  %s\n", words.c_str());
  std::printf("\n");
  for (const std::string& words : tradeAnswers(result)) std::printf("%s\n", words.c_str());
  for (const std::string& words : result.fixed) std::printf("not a scene's choice: %s\n", words.c_str());
  for (const std::string& words : result.left_out) std::printf("left out: %s\n", words.c_str());
}

}  // namespace

int runTrade(const TradeArguments& given) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  OutputFile json(given.json, {given.scene}), csv(given.csv, {given.scene});
  std::optional<OutputFolder> out;
  if (!given.out.empty()) out.emplace(given.out);
  ProgressBar bar;
  const Scene scene = sceneFrom(given.scene, given.fidelity, {given.json, given.csv});
  TradeOptions options;
  options.progress = bar.progress();
  options.warn = warn;
  options.is_thorough = given.is_thorough;
  options.stop = &stopRequested();
  // Reading the scene counts, and plots come after.
  options.seconds = kSeconds - std::chrono::duration<double>(Clock::now() - begun).count();
  const TradeResult result = trade(scene, options);
  throwIfStopped();

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
  if (!plot) warn("no plot: " + plot.why_not);
  return kGood;
}

}  // namespace vps
