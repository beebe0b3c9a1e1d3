// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/blocks.h"

#include <algorithm>
#include <string>
#include <utility>

#include "vps_scenes/check.h"

namespace vps::scenes::inline v0 {

namespace {

/// Numbers of a file are rounded: to 0.1 um where a metre has seven digits.
constexpr double kFitCertain_m = 0.2e-6;

/// True if a part is in place when a step ends: fixed, or mounted by this step or an earlier one.
bool isInPlace(const Scene& scene, const std::string& name, std::size_t step) {
  for (const ScenePart& part : scene.parts)
    if (part.part.name == name && part.is_fixed) return true;
  for (std::size_t i = 0; i <= step; ++i)
    if (scene.parts[scene.steps[i].part].part.name == name) return true;
  return false;
}

/// Of two parts whose meshes overlap by no more than their error: the fit of a shaft and a bore between them,
/// which knows no error of the mesh, if it says that the shaft is too large by no more than that error. A
/// greater interference is none of the surfaces that meet, such as the crests of a thread.
const CheckedFit* interferenceOf(const CheckedPair& pair, const std::vector<CheckedFit>& fits) {
  if (pair.state != PairState::Contact || pair.is_allowed || !(pair.interference_depth_m > 0)) return nullptr;
  const auto isIt = [&](const CheckedFit& fit) {
    const bool is_pair =
        (fit.shaft == pair.a && fit.bore == pair.b) || (fit.shaft == pair.b && fit.bore == pair.a);
    const double too_large_m = -fit.diametral_clearance_m;
    return is_pair && fit.kind == FitKind::Shaft && too_large_m > fit.error_m + kFitCertain_m &&
           too_large_m <= 2 * pair.error_m;
  };
  const auto found = std::find_if(fits.begin(), fits.end(), isIt);
  return found == fits.end() ? nullptr : &*found;
}

/// The overlap of a pair that is proven: of the meshes, or else of the fit. Depth 0: none.
StepResult blockOf(const CheckedPair& pair, const std::vector<CheckedFit>& fits) {
  StepResult block;
  if (pair.isClash()) {
    block.blocked_at_W = pair.at_W;
    block.blocked_depth_m = pair.interference_depth_m;
    block.blocked_error_m = pair.error_m;
  } else if (const CheckedFit* fit = interferenceOf(pair, fits)) {
    block.blocked_at_W = pair.at_W;
    block.blocked_depth_m = -0.5 * fit->diametral_clearance_m;
    block.blocked_error_m = 0.5 * (fit->error_m + kFitCertain_m);
  }
  return block;
}

}  // namespace

std::vector<StepResult> blocksAtTargets(const Scene& scene, const Progress& progress) {
  CheckSettings settings;
  settings.has_play = false;
  const CheckResult checked = checkAssembly(scene.name, drawnParts(scene), settings, progress);
  std::vector<StepResult> blocks(scene.steps.size());
  for (std::size_t i = 0; i < scene.steps.size(); ++i) {
    const std::string& part = scene.parts[scene.steps[i].part].part.name;
    for (const CheckedPair& pair : checked.pairs) {
      if (pair.a != part && pair.b != part) continue;
      const std::string& other = pair.a == part ? pair.b : pair.a;
      StepResult block = blockOf(pair, checked.fits);
      if (block.blocked_depth_m <= blocks[i].blocked_depth_m || !isInPlace(scene, other, i)) continue;
      block.blocked_by = other;
      blocks[i] = std::move(block);
    }
  }
  return blocks;
}

}  // namespace vps::scenes::inline v0
