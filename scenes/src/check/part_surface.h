// SPDX-License-Identifier: BSD-3-Clause
// A part's surface, prepared for the measures of a check.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/triangle_gap.h"
#include "check/triangle_tree.h"
#include "vps/mesh_overlap.h"
#include "vps/solid.h"

namespace vps::scenes::inline v0 {

/// Facets that meet at less than this belong to one curved face; import makes them meet at 0.35 at most.
inline constexpr double kCurved_rad = 0.4;

/// The facet beyond each edge of each triangle (edge i from corner i to the next); kNoFacet at an edge that
/// does not have exactly two facets.
inline constexpr std::uint32_t kNoFacet = ~std::uint32_t{0};
std::vector<std::array<std::uint32_t, 3>> neighboursOf(const Mesh& mesh);

class PartSurface {
 public:
  /// @param chord_m see DrawnPart; empty: estimated
  PartSurface(std::shared_ptr<const Solid> solid, std::optional<double> chord_m);

  [[nodiscard]] const Solid& solid() const { return overlap_.solid(); }
  [[nodiscard]] const Mesh& mesh() const { return overlap_.mesh(); }
  [[nodiscard]] const Box& box() const { return overlap_.box(); }
  [[nodiscard]] const OverlapMesh& overlap() const { return overlap_; }
  [[nodiscard]] const TriangleTree& tree() const { return tree_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& neighbours() const { return neighbours_; }
  [[nodiscard]] Triangle triangle(std::uint32_t i) const;
  [[nodiscard]] Vec3 normal(std::uint32_t i) const { return solid().featureNormal(i, 0); }

  /// The different outward normals of the facets around a vertex.
  [[nodiscard]] std::span<const Vec3> normalsAround(std::uint32_t vertex) const {
    return std::span(around_).subspan(first_around_[vertex],
                                      first_around_[vertex + 1] - first_around_[vertex]);
  }

  /// By node of the tree: the outward normal if all facets of the node share it, else zero; and how far its
  /// facets reach along it.
  struct NodePlane {
    Vec3 n = Vec3::Zero();
    double highest_m = 0;
    [[nodiscard]] bool isFlat() const { return n != Vec3::Zero(); }
  };
  [[nodiscard]] const std::vector<NodePlane>& planes() const { return planes_; }

  /// By node of the tree: the mean outward normal, by area, of at most kFacetsOfPatch facets that face nearly
  /// one way; else zero.
  static constexpr std::uint32_t kFacetsOfPatch = 64;
  [[nodiscard]] const std::vector<Vec3>& patches() const { return patches_; }
  /// The highest point of a node's facets along n.
  [[nodiscard]] double highest_m(std::uint32_t node, const Vec3& n) const;

  /// Why the surface, or parts of it, has no inside; empty: it has one.
  [[nodiscard]] const std::string& noInside() const { return no_inside_; }

  /// Greatest distance of a facet from the curved face that it stands for.
  [[nodiscard]] double chord_m(std::uint32_t i) const { return chord_m_[i]; }
  /// The greatest of the facets whose boxes meet this one.
  [[nodiscard]] double chordIn(const Box& box_P) const;

 private:
  void estimateChords(std::optional<double> most_m);
  void findPlanes();
  void findPatches();
  void tellInside();
  void gatherNormals();
  OverlapMesh overlap_;
  TriangleTree tree_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<double> chord_m_;
  std::vector<NodePlane> planes_;
  std::vector<Vec3> patches_;
  std::string no_inside_;
  std::vector<Vec3> around_;
  std::vector<std::uint32_t> first_around_;  // by vertex, and the end
};

}  // namespace vps::scenes::inline v0
