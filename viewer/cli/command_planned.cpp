// SPDX-License-Identifier: BSD-3-Clause
// Commands that are planned. They are in the help, and running one says so and fails.
#include "command.h"
#include "vps/load_error.h"

namespace vps::viewer::inline v0 {

namespace {

void addPlanned(CommandLine& line, const std::string& name, const std::string& summary,
                const std::string& example) {
  addCommand(line, name, summary + " (not implemented yet)", example, [name, summary]() -> int {
    throw LoadError("", "", name + " is not implemented yet; planned: " + summary);
  }).allow_extras();
}

}  // namespace

void addPlannedCommands(CommandLine& line) {
  addPlanned(line, "render", "the haptic rendering node", "vps render scene.toml");
  addPlanned(line, "watch", "the viewer node", "vps watch");
}

}  // namespace vps::viewer::inline v0
