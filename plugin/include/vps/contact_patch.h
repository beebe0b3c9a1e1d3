// SPDX-License-Identifier: BSD-3-Clause
// Many contacts as a few patches, for engines that want few.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/query.h"

namespace vps {

/// Touching points that lie together on the shell and face one way, as one.
struct ContactPatch {
  Vec3 p_M = Vec3::Zero();  ///< centre of pressure: mean of the points, weighted by area times depth
  Vec3 n_M = Vec3::Zero();  ///< unit mean normal, weighted the same; the way that frees the shell's part
  double depth_m = 0;       ///< mean depth, weighted the same
  double max_depth_m = 0;
  double area_m2 = 0;       ///< touching surface
  Wrench F_p_M;             ///< penalty wrench of the patch's points about p_M, in M
  std::uint32_t id = 0;     ///< the same from step to step: which run of points, and which way it faces
  std::uint32_t count = 0;  ///< points
  std::uint16_t owner = 0;  ///< part of a cooked map that its point with the greatest share is against
};

/// Room for patches, sized once. When it is full the wrench of the others is summed in `rest`.
struct VPS_API PatchSet {
  std::vector<ContactPatch> patches;  ///< ascending id; capacity is the limit; never grown
  Wrench rest;                        ///< about M's origin, of patches that found no room
  std::size_t left_out = 0;           ///< how many those were
  explicit PatchSet(std::size_t capacity = 0) { patches.reserve(capacity); }
};

/// Summarises contacts of one query (in its order, ascending id). A patch is a run of `points_per_patch`
/// points of the shell, which are neighbours, split by the six main directions that their own inward normals
/// face: membership never changes with the pose, and a point's share grows from zero with its depth. So
/// patches' wrenches are continuous in the pose, and sum to penaltyWrench() exactly but for rounding. Points
/// that do not touch are left out. Never throws, allocates, locks. Truncated when the set is full.
/// O(contacts).
VPS_API Status contactPatches(std::span<const Contact> contacts, const PointShell& shell, double k_N_per_m3,
                              std::uint32_t points_per_patch, PatchSet& out) noexcept;

}  // namespace vps
