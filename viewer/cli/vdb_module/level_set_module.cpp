// SPDX-License-Identifier: BSD-3-Clause
// The part of the program that needs OpenVDB. The program loads this module only when a .vdb file is read or
// written, because resolving the symbols of OpenVDB takes a third of the start time.
#include "input/level_set_file.h"

#include "vps/vdb.h"
#include "vps/version.h"

extern "C" {
extern const vps::viewer::LevelSetModule vps_level_set_module;
const vps::viewer::LevelSetModule vps_level_set_module = {
    VPS_VERSION_STRING, sizeof(vps::VoxMap), [](const std::string& file) { return vps::loadVdb(file); },
    [](const vps::VoxMap& map, const std::string& file) { vps::saveVdb(map, file); }};
}
