// SPDX-License-Identifier: BSD-3-Clause
// Tells which closed shells lie within others.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"
#include "vps/winding_number.h"

namespace vps {

/// Shells are cut along each other as in unite(). No piece of a shell then crosses another shell, so one
/// point of each patch of pieces tells where the patch is. The orientation of the shells does not matter.
class ShellNesting {
 public:
  /// O(n log n) for the boxes of shells that overlap.
  /// @param shell_of  by triangle: its shell, counted from 0; each shell is closed and has one orientation
  ShellNesting(Mesh mesh, std::vector<std::uint32_t> shell_of);

  ShellNesting(const ShellNesting&) = delete;  // the tree refers to the boxes
  ShellNesting& operator=(const ShellNesting&) = delete;

  /// True if no point of shell `inner` is outside of shell `outer` by more than twice touchDistance(), and
  /// some point is inside by more than this distance. So `inner` may touch `outer` from within but not reach
  /// through its surface, and a copy of all or part of `outer` does not lie within it. If facets cannot be
  /// cut, their corners and middles decide. One winding number for each patch.
  [[nodiscard]] bool liesWithin(std::uint32_t inner, std::uint32_t outer);

 private:
  enum class Place { Inside, On, Outside };

  void addPatches();
  void addCornersAndMiddles();
  Place placeOf(const Vec3& p, std::uint32_t shell);
  [[nodiscard]] bool isOn(const Vec3& p, std::uint32_t shell) const;

  const Mesh mesh_;
  const std::vector<std::uint32_t> shell_of_;
  const double touch_m_;
  const std::vector<Box> facet_boxes_;
  const BoxTree facets_;
  std::vector<std::vector<std::uint32_t>> triangles_;   // by shell
  std::vector<std::vector<Vec3>> points_;               // by shell: one point of each patch
  std::vector<std::optional<WindingNumber>> windings_;  // by shell: built when first needed
};

}  // namespace vps
