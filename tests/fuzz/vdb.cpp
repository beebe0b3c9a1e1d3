// SPDX-License-Identifier: BSD-3-Clause
// Reads the bytes as a voxmap's .vdb. A changed file of saveVdb() is refused by its checksum before OpenVDB,
// which trusts the file, reads it. Other files go to OpenVDB unchecked, and are not fuzzed here.
#include <cmath>

#include "fuzz.h"
#include "vps/errors.h"
#include "vps/vdb.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.find("vps_parts") == std::string::npos && bytes.find("vps-end1") == std::string::npos && size > 4)
    return 0;
  try {
    const vps::VoxMap map = vps::loadVdb(vps::fuzz::fileOf(data, size));
    vps::fuzz::require(map.voxel_m() > 0, "voxels have a size");
    vps::fuzz::require(std::isfinite(map.distance(map.bounds().center())), "distances are finite");
  } catch (const vps::LoadError&) {
  }
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  const std::string file = fileOf(nullptr, 0);
  saveVdb(buildVoxMap(makeSphere(1e-3, 1), {1e-3, 3}), file);
  return {bytesOf(file)};
}
