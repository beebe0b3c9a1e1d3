// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"
#include "vps/load_error.h"
#include "vps_scenes/import.h"

namespace vps {

namespace {

void readLength(const std::string& text, const std::string& option, double& out_m) {
  if (text.empty()) return;
  out_m = lengthFromText(text, option);
  if (!(out_m > 0)) throw LoadError("", "", option + " is " + text + "; expected more than 0");
}

}  // namespace

Fidelity fidelityFrom(const FidelityArguments& given, Fidelity base) {
  if (!given.preset.empty()) base = fidelityPreset(given.preset);
  readLength(given.voxel, "--voxel", base.voxel_m);
  readLength(given.spacing, "--spacing", base.spacing_m);
  if (!given.sides.empty()) {
    if (given.sides != "one" && given.sides != "both")
      throw LoadError("", "", "--sides is '" + given.sides + "'; expected one or both");
    base.sides = given.sides == "one" ? Sides::One : Sides::Both;
  }
  return base;
}

}  // namespace vps
