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

#include "surface/round_face.h"
#include "surface/triangle_gap.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"
#include "vps/mesh_overlap.h"
#include "vps/solid.h"

namespace vps::scenes {

/// The facet on the other side of each edge of each triangle (edge i leads from corner i to the next corner).
/// kNoFacet for an edge that does not have exactly two facets.
inline constexpr std::uint32_t kNoFacet = ~std::uint32_t{0};
std::vector<std::array<std::uint32_t, 3>> neighboursOf(const Mesh& mesh);

/// A narrow gap between open edges of a mesh.
struct Crack {
  Vec3 p_P;        ///< a corner of an open edge
  double width_m;  ///< distance of the corner from the nearest other open edge
};

/// Whether as many facets pass each edge in one direction as in the other. Such a surface has no border, so
/// that its winding number is an integer that changes at facets only. O(n log n).
bool isBalanced(const Mesh& mesh);

/// Finds the cracks of a mesh. A crack is narrow compared with the edges along it and with the part; a wider
/// gap is a hole. A corner at which a crack ends is not listed. O(n log n).
std::vector<Crack> cracksOf(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                            const BoxTree& tree);

/// Facets that meet at a smaller angle belong to one curved face. Imported curved faces have angles of 0.35
/// at most.
inline constexpr double kCurved_rad = 0.4;

/// The surface of a part, in the part's frame.
class PartSurface {
 public:
  /// @param chord_m see DrawnPart; estimated if empty
  PartSurface(std::shared_ptr<const Solid> solid, std::optional<double> chord_m);

  [[nodiscard]] const Solid& solid() const { return overlap_.solid(); }
  [[nodiscard]] const Mesh& mesh() const { return overlap_.mesh(); }
  [[nodiscard]] const Box& box() const { return overlap_.box(); }
  [[nodiscard]] const OverlapMesh& overlap() const { return overlap_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& neighbours() const { return neighbours_; }
  [[nodiscard]] Triangle triangle(std::uint32_t i) const;
  [[nodiscard]] Vec3 normal(std::uint32_t i) const { return solid().featureNormal(i, 0); }

  /// The distinct outward normals of the facets around a vertex.
  [[nodiscard]] std::span<const Vec3> normalsAround(std::uint32_t vertex) const {
    return std::span(around_).subspan(first_around_[vertex],
                                      first_around_[vertex + 1] - first_around_[vertex]);
  }

  /// The plane of a tree node: the outward normal if all facets of the node share it, else zero; and the
  /// greatest coordinate of the facets along the normal.
  struct NodePlane {
    Vec3 n = Vec3::Zero();
    double highest_m = 0;
    [[nodiscard]] bool isFlat() const { return n != Vec3::Zero(); }
  };
  [[nodiscard]] const std::vector<NodePlane>& planes() const { return planes_; }

  /// For each node of the tree: the mean outward normal, weighted by area, if the node has at most
  /// kFacetsOfPatch facets that face nearly the same direction; else zero.
  static constexpr std::uint32_t kFacetsOfPatch = 64;
  [[nodiscard]] const std::vector<Vec3>& patches() const { return patches_; }
  /// The greatest coordinate of a node's facets along n.
  [[nodiscard]] double highest_m(std::uint32_t node, const Vec3& n) const;

  /// The reason why the surface, or a part of it, encloses no volume; empty if it is a solid.
  [[nodiscard]] const std::string& noInside() const { return no_inside_; }
  /// Whether the surface, after its repair, encloses a volume and has no border.
  [[nodiscard]] bool isClosed() const { return no_inside_.empty() && is_balanced_; }

  /// The cylindrical faces, see roundFaces().
  [[nodiscard]] const std::vector<RoundFace>& round() const { return round_; }

  /// Greatest distance of a facet from the curved face that it approximates: for a facet of a cylindrical
  /// face, its distance from the fitted cylinder; for other facets, estimated from the angles between them.
  [[nodiscard]] double chord_m(std::uint32_t i) const { return chord_m_[i]; }
  /// Upper bound of chord_m() that also holds where facets of one face differ in width; equal to it for
  /// facets of a cylindrical face. The bound is zero for flat faces only. O(1).
  [[nodiscard]] double chordBound_m(std::uint32_t i) const;
  /// The greatest chordBound_m() of all facets. O(1).
  [[nodiscard]] double mostChordBound_m() const { return most_bound_m_; }
  /// The greatest chord_m() of the facets whose boxes meet the given box.
  [[nodiscard]] double chordIn(const Box& box_P) const;

  /// Greatest width of the cracks in this box. The true surface may be anywhere within a crack's width.
  [[nodiscard]] double crackIn(const Box& box_P) const;

 private:
  void estimateChords();
  void measureRoundChords();
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
  double most_bound_m_ = 0;
  std::vector<RoundFace> round_;
  std::vector<bool> is_round_;  // by facet: whether it belongs to a face of round_
  std::vector<NodePlane> planes_;
  std::vector<Vec3> patches_;
  std::string no_inside_;
  bool is_balanced_ = false;  // isBalanced()
  std::vector<Vec3> around_;
  std::vector<std::uint32_t> first_around_;  // by vertex: first index in around_; and the end
};

}  // namespace vps::scenes
