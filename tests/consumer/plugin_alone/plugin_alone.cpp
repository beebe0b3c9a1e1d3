// SPDX-License-Identifier: BSD-3-Clause
// A user's program without Bullet: the depth of a point in a ball, and an error that
// crosses the library's border.
#include <vps/errors.h>
#include <vps/version.h>
#include <vps/voxmap.h>

#include <cmath>
#include <cstdio>
#include <cstring>

int main() {
  constexpr double kRadius_m = 0.01;
  vps::VoxMapSettings settings;
  settings.voxel_m = 0.5e-3;
  const vps::VoxMap map = vps::buildVoxMap(vps::makeSphere(kRadius_m, 5), settings);
  const double depth_m = -map.distance(vps::Vec3(kRadius_m - 1e-3, 0, 0));
  std::printf("vps %s: the point is %.4f mm deep (1 mm by geometry)\n", VPS_VERSION_STRING, depth_m * 1e3);
  // The facets of a ball of 20480 triangles are up to r (1 - cos(edge / 2r)) = 1.3 um inside the ball; the
  // field adds its own error.
  if (std::abs(depth_m - 1e-3) > 2e-6 + map.sampleError_m() / 20) return 1;

  settings.voxel_m = 0;
  try {
    static_cast<void>(vps::buildVoxMap(vps::makeSphere(kRadius_m, 2), settings));
  } catch (const vps::LoadError& error) {
    return std::strlen(error.what()) > 0 ? 0 : 1;
  }
  return 1;
}
