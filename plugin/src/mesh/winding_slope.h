// SPDX-License-Identifier: BSD-3-Clause
// A bound of how fast the winding number of an open mesh changes away from its triangles.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// A bound of the gradient of the winding number away from triangles. The gradient is the field of a current
/// along the mesh's border (Biot and Savart), so it is at most the sum of length / distance^2 over border
/// edges, over 4 pi; zero for a closed mesh. An edge belongs to the border unless it has as many facets in
/// one direction as in the other.
class WindingSlope {
 public:
  explicit WindingSlope(const Mesh& mesh);
  [[nodiscard]] bool isZero() const noexcept { return nodes_.empty(); }
  /// A bound [1/m] of the gradient's length anywhere in the box; infinite where the border enters it.
  [[nodiscard]] double bound(const Box& box) const noexcept;

 private:
  struct Node {
    Box box;
    double length_m = 0;
    std::uint32_t first = 0, count = 0;  ///< edges of a leaf; in an inner node the left child and 0
  };
  std::vector<Node> nodes_;
  std::vector<std::pair<Box, double>> edges_;  // box and length [m]
};

}  // namespace vps
