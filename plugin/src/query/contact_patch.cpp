// SPDX-License-Identifier: BSD-3-Clause
#include "vps/contact_patch.h"

#include <algorithm>
#include <array>

namespace vps {
namespace {

constexpr std::uint32_t kFacings = 6;

/// Which of the six main directions a normal faces most.
std::uint32_t facingOf(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::uint32_t>(2 * axis + (n[axis] > 0));
}

/// Sums over one patch.
struct Sums {
  Vec3 p = Vec3::Zero(), n = Vec3::Zero();  // weighted by area times depth
  double weight = 0, depth = 0, area_m2 = 0, max_depth_m = 0;
  Wrench F_M;  // about M's origin
  std::uint32_t count = 0;
  std::uint16_t owner = 0;
  double owner_weight = 0;

  void add(const Contact& c, double k_N_per_m3) noexcept {
    const double depth_m = -c.distance_m, w = c.area_m2 * depth_m;
    const Vec3 f_M = k_N_per_m3 * w * c.n_M;
    p += w * c.p_M;
    n += w * c.n_M;
    weight += w;
    depth += w * depth_m;
    area_m2 += c.area_m2;
    max_depth_m = std::max(max_depth_m, depth_m);
    F_M += {c.p_M.cross(f_M), f_M};
    ++count;
    if (w > owner_weight) owner_weight = w, owner = c.owner;
  }

  [[nodiscard]] ContactPatch patch(std::uint32_t id) const noexcept {
    ContactPatch out;
    out.id = id;
    out.count = count;
    out.owner = owner;
    out.area_m2 = area_m2;
    out.max_depth_m = max_depth_m;
    out.p_M = p / weight;
    out.depth_m = depth / weight;
    const double length = n.norm();
    // Opposite normals that cancel leave no direction.
    if (length > 1e-9 * weight) out.n_M = n / length;
    out.F_p_M = shifted(F_M, -out.p_M);
    return out;
  }
};

}  // namespace

Status contactPatches(std::span<const Contact> contacts, const PointShell& shell, double k_N_per_m3,
                      std::uint32_t points_per_patch, PatchSet& out) noexcept {
  out.patches.clear();
  out.rest = Wrench();
  out.left_out = 0;
  const std::uint32_t run_points = std::max(points_per_patch, std::uint32_t{1});
  std::array<Sums, kFacings> sums;
  std::uint32_t run = 0;
  const auto finishRun = [&] {
    for (std::uint32_t facing = 0; facing < kFacings; ++facing) {
      Sums& s = sums[facing];
      if (s.weight > 0 && out.patches.size() < out.patches.capacity()) {
        out.patches.push_back(s.patch(kFacings * run + facing));
      } else if (s.weight > 0) {
        out.rest += s.F_M;
        ++out.left_out;
      }
      s = Sums();
    }
  };
  for (const Contact& c : contacts) {
    if (!(c.distance_m < 0)) continue;
    if (c.id / run_points != run) finishRun();
    run = c.id / run_points;
    sums[facingOf(shell.inward[c.id])].add(c, k_N_per_m3);
  }
  finishRun();
  return out.left_out > 0 ? Status::Truncated : Status::Ok;
}

}  // namespace vps
