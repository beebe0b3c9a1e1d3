// SPDX-License-Identifier: BSD-3-Clause
// Reads the bytes as a pointshell's .ply.
#include <cmath>

#include "fuzz.h"
#include "vps/errors.h"
#include "vps/pointshell.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const vps::PointShell shell = vps::loadPly(vps::fuzz::fileOf(data, size));
    vps::fuzz::require(shell.inward.size() == shell.size(), "a normal for each point");
    for (const vps::Vec3& p : shell.points) vps::fuzz::require(p.allFinite(), "points are finite");
    for (const vps::Vec3& n : shell.inward)
      vps::fuzz::require(std::abs(n.norm() - 1) < 1e-2, "normals have length 1");
  } catch (const vps::LoadError&) {
  }
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  const std::string file = fileOf(nullptr, 0);
  savePly(buildPointShell(makeBox({1e-3, 1e-3, 1e-3}), {1e-3, 0.35}), file);
  return {
      bytesOf(file),
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "property double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty double area\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 1 0.5 0 0 255 4\n0 0 -1 1e-3 2 -3 0 1\n3 0 1 1\n"};
}
