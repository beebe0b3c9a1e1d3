// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/record.h"

#include "procedure/assembly_run.h"
#include "record/run_record.h"
#include "vps/errors.h"

namespace vps::scenes {

AssembleResult assembleAndRecord(Scene& scene, const std::string& file, const AssembleOptions& options) {
  requireSteps(scene);
  if (options.has_local_contact)
    throw LoadError(file, "",
                    "a run with local contact cannot be replayed bit for bit; record it without "
                    "--local-contact");
  const std::unique_ptr<Hand> hand = makeHand(scene, options);
  const device::LoopSettings settings = loopSettings(scene, hand->device());
  RunRecord record(file, scene, hand->device(), settings, options);
  AssembleResult result = runProcedure(scene, *hand, &record, settings, options);
  if (options.stop == nullptr || !options.stop->load()) record.finish();
  return result;
}

}  // namespace vps::scenes
