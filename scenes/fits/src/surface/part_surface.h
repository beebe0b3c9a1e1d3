// SPDX-License-Identifier: BSD-3-Clause
// A part's surface, prepared for the measures of a check: neighbours of facets, cracks, normals, chords.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surface/triangle_gap.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"
#include "vps/mesh_overlap.h"
#include "vps/solid.h"

namespace vps::scenes {

/// The facet beyond each edge of each triangle (edge i from corner i to the next); kNoFacet at an edge that
/// does not have exactly two facets.
inline constexpr std::uint32_t kNoFacet = ~std::uint32_t{0};
std::vector<std::array<std::uint32_t, 3>> neighboursOf(const Mesh& mesh);

struct Crack {
  Vec3 p_P;        ///< a corner of an open edge
  double width_m;  ///< to the nearest other open edge
};

/// Cracks are narrow beside the edges that they part, and beside the part; anything wider is a hole. A corner
/// in which a crack ends has none. O(n log n).
std::vector<Crack> cracksOf(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                            const BoxTree& tree);

/// Facets that meet at less than this belong to one curved face; import makes them meet at 0.35 at most.
inline constexpr double kCurved_rad = 0.4;

class PartSurface {
 public:
  /// @param chord_m see DrawnPart; empty: estimated
  PartSurface(std::shared_ptr<const Solid> solid, std::optional<double> chord_m);

  [[nodiscard]] const Solid& solid() const { return overlap_.solid(); }
  [[nodiscard]] const Mesh& mesh() const { return overlap_.mesh(); }
  [[nodiscard]] const Box& box() const { return overlap_.box(); }
  [[nodiscard]] const OverlapMesh& overlap() const { return overlap_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
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
  /// It has an inside everywhere, and no holes.
  [[nodiscard]] bool isClosed() const { return no_inside_.empty() && solid().report().isClosed(); }

  /// Greatest distance of a facet from the curved face that it stands for.
  [[nodiscard]] double chord_m(std::uint32_t i) const { return chord_m_[i]; }
  /// No less than that where facets of one face differ in width: zero only in flat faces. O(1).
  [[nodiscard]] double chordBound_m(std::uint32_t i) const;
  /// The greatest chord_m() of the facets whose boxes meet this one.
  [[nodiscard]] double chordIn(const Box& box_P) const;

  /// Greatest width of the cracks that this box meets: between a corner of an open edge and the nearest other
  /// open edge, where that is near beside their lengths. The surface may be anywhere between the two.
  [[nodiscard]] double crackIn(const Box& box_P) const;

 private:
  void estimateChords();
  void findPlanes();
  void findPatches();
  void tellInside();
  void gatherNormals();
  OverlapMesh overlap_;
  BoxTree tree_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<Crack> cracks_;
  std::optional<double> most_chord_m_;
  std::vector<double> chord_m_;
  std::vector<NodePlane> planes_;
  std::vector<Vec3> patches_;
  std::string no_inside_;
  std::vector<Vec3> around_;
  std::vector<std::uint32_t> first_around_;  // by vertex, and the end
};

}  // namespace vps::scenes
