// SPDX-License-Identifier: BSD-3-Clause
// Finds the corners of a part that can touch facets of another part, for parts with many of both.
#pragma once

#include <cstdint>
#include <vector>

#include "query/features/direction_cone.h"
#include "query/motion/edge_pair_search.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"

namespace vps {

class FeatureSet;

/// Facets with bounds of their places and normals, as nodes of a tree.
struct FacetTree {
  struct Bounds {
    Box box;
    DirectionCone normals;
    double low_m = 0, high_m = 0;  ///< range of the corners along the cone's axis
    double spread_m = 0;           ///< size of a box around the facets' centres; 0 for a single facet
    bool is_curved = true;         ///< all facets approximate curved surfaces
  };
  Hierarchy tree;              ///< a leaf has one facet
  std::vector<Bounds> bounds;  ///< the bounds of the nodes

  void build(const FeatureSet& part);
};

/// A tree of corners with bounds of their places and of the planes that they can touch.
struct CornerTree {
  struct Bounds {
    Vec3 center, half;  ///< centre and half size of a box around the corners
    double radius_m = 0;
    DirectionCone touch;
    DirectionCone faces[2];  ///< each corner has a face with its normal in each of the two cones
  };
  Hierarchy tree;  ///< a leaf has one corner; corners that can touch nothing are left out
  std::vector<Bounds> bounds;

  void build(const FeatureSet& part);
};

/// A corner of one part and a facet of another.
struct TouchPair {
  std::uint32_t corner, facet;
};

/// Lists pairs of a corner of one part and a facet of another that can touch while the parts turn by less
/// than slack_rad, and of which the corner comes nearer than margin_m to the facet. The list also contains
/// some pairs of which the corner comes nearer than margin_m only to the facet's box and plane. The order is
/// fixed. Corners with faces that lie flush on a facet of a curved surface are left out. Clears `found`.
/// Cost: about 50 ns for each pair of nodes that is tested; features of a thread in its nut are left out by
/// hundreds at once. Source: spatialised normal cones (Johnson and Cohen 2001).
void findTouchPairs(const FeatureSet& with_corners, const FeatureSet& with_facets, const Sweep& X_fc,
                    double margin_m, double slack_rad, std::vector<TouchPair>& found);

}  // namespace vps
