// SPDX-License-Identifier: BSD-3-Clause
// Which closed shells lie within others.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/box_tree.h"
#include "vps/mesh.h"
#include "vps/winding_number.h"

namespace vps {

/// Shells are cut along each other as unite() cuts them. No cut piece of a shell crosses another shell, so
/// that one point of each patch of pieces tells where the patch is. Which way shells face does not matter.
class ShellNesting {
 public:
  /// O(n log n) for the boxes of shells that overlap.
  /// @param shell_of  by triangle, counted from 0; each shell is closed and has one orientation
  ShellNesting(Mesh mesh, std::vector<std::uint32_t> shell_of);

  ShellNesting(const ShellNesting&) = delete;  // the tree refers to the boxes
  ShellNesting& operator=(const ShellNesting&) = delete;

  /// True if no point of shell `inner` is outside of shell `outer` by more than twice touchDistance(), and
  /// some point is inside by more than that. So it may touch the other from within; it may not reach through
  /// its surface; and a copy of the whole shell or of a part of it does not lie within it. Where facets
  /// cannot be cut, their corners and middles decide. One winding number a patch.
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
  std::vector<std::vector<Vec3>> points_;               // by shell: of each patch one
  std::vector<std::optional<WindingNumber>> windings_;  // by shell: made at first need
};

}  // namespace vps
