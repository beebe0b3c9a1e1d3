// SPDX-License-Identifier: BSD-3-Clause
#include "run/neighbours.h"
#include "vps_scenes/fits/check.h"

#include <chrono>
#include <cstdio>

namespace vps::viewer {
namespace {

std::string describe(const std::string& other, const scenes::CheckedPair& pair) {
  char words[80];
  switch (pair.state) {
    case scenes::PairState::Apart:
      std::snprintf(words, sizeof words, ": %.4g µm apart", pair.clearance_m * 1e6);
      break;
    case scenes::PairState::Contact:
      std::snprintf(words, sizeof words, ": contact");
      break;
    case scenes::PairState::PressFit:
    case scenes::PairState::Clash:
      std::snprintf(words, sizeof words, ": %s, %.4g µm deep", toText(pair.state),
                    pair.interference_depth_m * 1e6);
      break;
  }
  return other + words;
}

}  // namespace

std::vector<std::string> Neighbours::of(const std::string& part) {
  if (!checked_.valid())
    checked_ = std::async(std::launch::async, [this] {
                 scenes::CheckSettings settings;
                 settings.has_fits = settings.has_play = false;
                 return scenes::checkAssembly(scene_.name, scenes::drawnParts(scene_), settings);
               }).share();
  if (checked_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {"measuring ..."};
  std::vector<std::string> lines;
  try {
    for (const scenes::CheckedPair& pair : checked_.get().pairs) {
      if (pair.a == part) lines.push_back(describe(pair.b, pair));
      if (pair.b == part) lines.push_back(describe(pair.a, pair));
    }
  } catch (const std::exception& error) {
    return {std::string("not measured: ") + error.what()};
  }
  if (lines.empty()) lines.push_back("nothing within 1 mm");
  return lines;
}

}  // namespace vps::viewer
