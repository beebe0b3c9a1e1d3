// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/assemble.h"

#include "procedure/assembly_run.h"

namespace vps::scenes {

AssembleResult assemble(Scene& scene, const AssembleOptions& options) {
  requireSteps(scene);
  const std::unique_ptr<Hand> hand = makeHand(scene, options);
  return runProcedure(scene, *hand, nullptr, loopSettings(scene, hand->device()), options);
}

}  // namespace vps::scenes
