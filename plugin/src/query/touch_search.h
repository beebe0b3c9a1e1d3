// SPDX-License-Identifier: BSD-3-Clause
// Which corners of a part can touch which facets of another, for parts with many of both.
#pragma once

#include <cstdint>
#include <vector>

#include "query/direction_cone.h"
#include "query/edge_pair_search.h"
#include "vps/mesh.h"

namespace vps {

class FeatureSet;

/// A tree whose nodes hold items that are near each other and point in similar directions.
struct DirectedTree {
  struct Node {
    std::uint32_t first = 0, end = 0, left = 0;  ///< its part of the order; its left child, or 0
  };
  struct Item {
    Vec3 p, direction;
  };
  std::vector<Node> nodes;
  std::vector<std::uint32_t> order;

  /// Halves by place or direction, by what differs more. O(n log n).
  void build(const std::vector<Item>& items);
};

/// Facets with bounds of their places and normals, as nodes of a tree.
struct FacetTree {
  struct Bounds {
    Box box;
    DirectionCone normals;
    double low_m = 0, high_m = 0;  ///< of the corners along the cone's axis
    double spread_m = 0;           ///< size of a box around the facets' centres; 0: a single one
    bool is_curved = true;         ///< all of them
  };
  DirectedTree tree;
  std::vector<Bounds> bounds;  ///< of the nodes

  void build(const FeatureSet& part);
};

/// Corners with bounds of their places and of the planes that they can touch.
struct CornerTree {
  struct Bounds {
    Vec3 center, half;  ///< of a box around their places
    double radius_m = 0;
    DirectionCone touch;
    DirectionCone faces[2];  ///< each corner has a face with its normal in each
  };
  DirectedTree tree;  ///< without the corners that can touch nothing
  std::vector<Bounds> bounds;

  void build(const FeatureSet& part);
};

/// A corner of one part and a facet of another.
struct TouchPair {
  std::uint32_t corner, facet;
};

/// Lists the corners of a part and the facets of another that can touch while the parts turn by less than
/// slack_rad, and of which the corner comes nearer than margin_m to the facet; with them some that come as
/// near only to the facet's box and to its plane. In a fixed order. Corners with faces that lie flush on a
/// facet of a curved surface are left out. Clears `found`. Cost: some 50 ns for each pair of nodes that are
/// looked at; features of a thread in its nut are left out by hundreds at once. Source: spatialised normal
/// cones (Johnson and Cohen 2001).
void findTouchPairs(const FeatureSet& with_corners, const FeatureSet& with_facets, const Sweep& X_fc,
                    double margin_m, double slack_rad, std::vector<TouchPair>& found);

}  // namespace vps
