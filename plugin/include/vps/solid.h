// SPDX-License-Identifier: BSD-3-Clause
// A part's surface and its inside: the one place where the sign of a distance is decided.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/mesh_distance.h"

namespace vps {

class Interior;
struct RepairedMesh;

/// A repaired mesh (see repairMesh()) with its exact signed distance. The voxmap, the pointshell, the overlap
/// judge and the Bullet bridge all take surface and sign from the same Solid, so that they agree.
///
/// The sign is that of the angle-weighted pseudonormal at the nearest point if the mesh is closed,
/// consistently oriented and free of crossings. Otherwise a point is inside if the generalised winding number
/// of the repaired mesh exceeds 0.5 and the point lies within the mesh's box. Facets around which both rules
/// are known to give the same answer are found in advance, so that most queries need no winding number.
///
/// In the middle of a hole the sign changes where there is no surface: there the signed distance jumps by up
/// to the hole's width.
class VPS_API Solid {
 public:
  using Closest = MeshDistance::Closest;

  /// Merges equal vertices, repairs the mesh and prepares it for queries. A mesh with shared vertices and
  /// without faults keeps its facets in their order. O(n log n); with faults about six winding numbers for
  /// each facet. Throws LoadError as requireUsable(), naming the part.
  explicit Solid(const Mesh& mesh, const std::string& part = "");
  /// A surface without an inside, not repaired: every point is outside, and normals are the facets' own. Use
  /// a sheet for surfaces that other parts touch from either side. Accepts an empty mesh.
  static Solid sheet(const Mesh& mesh);
  /// The same solid, scaled by a factor. Costs as much as building a solid.
  [[nodiscard]] Solid scaled(double factor) const;
  Solid(Solid&&) noexcept;
  Solid& operator=(Solid&&) noexcept;
  ~Solid();

  /// The nearest point of the surface; as MeshDistance::closest(), but the normal points out of the solid:
  /// its product with p - q has the sign of the distance. If the facets' pseudonormal has the wrong sign, the
  /// normal is the direction between p and q. Thread-safe; never allocates. O(log n) typical.
  [[nodiscard]] Closest closest(const Vec3& p, double max_m = 1e300) const noexcept;
  /// Negative inside; +max_m if no surface is nearer than that, on either side.
  [[nodiscard]] double signedDistance(const Vec3& p, double max_m = 1e300) const noexcept;
  [[nodiscard]] bool isInside(const Vec3& p) const noexcept;
  /// True if the solid was made by sheet().
  [[nodiscard]] bool isSheet() const noexcept { return is_sheet_; }

  /// The places where segment ab crosses the surface; see MeshDistance.
  void appendCrossings(const Vec3& a, const Vec3& b, std::vector<double>& out) const {
    distance_.appendCrossings(a, b, out);
  }
  /// Normals of single facets; see MeshDistance. Triangles are numbered as in mesh().
  [[nodiscard]] Vec3 featureNormal(std::uint32_t triangle, int feature) const noexcept {
    return distance_.featureNormal(triangle, feature);
  }
  [[nodiscard]] Vec3 smoothNormal(std::uint32_t triangle, const Vec3& q) const noexcept {
    return distance_.smoothNormal(triangle, q);
  }
  [[nodiscard]] Mat3 smoothCurvature(std::uint32_t triangle) const noexcept {
    return distance_.smoothCurvature(triangle);
  }

  /// The repaired surface: facets face out, without duplicates, inner walls and facets within the solid. For
  /// shells that touch or cross each other it is the surface of their union.
  [[nodiscard]] const Mesh& mesh() const noexcept { return distance_.mesh(); }
  /// The faults found and repaired. `certain_share` belongs to a voxmap and is not set.
  [[nodiscard]] const MeshReport& report() const noexcept { return report_; }
  /// Volume, centre and inertia of the solid: of the repaired mesh, as by massOf() in mesh_repair.h. All zero
  /// for a sheet.
  [[nodiscard]] const MassProperties& mass() const noexcept { return mass_; }
  /// True if winding numbers, and not pseudonormals alone, decide which points are inside.
  [[nodiscard]] bool isByWinding() const noexcept { return interior_ != nullptr; }

  /// For the library's own use; null if pseudonormals decide everywhere.
  [[nodiscard]] const Interior* interior() const noexcept { return interior_.get(); }

 private:
  explicit Solid(RepairedMesh&& repaired);
  Solid(const Mesh& surface, const MeshReport& report);

  MeshDistance distance_;
  MeshReport report_;
  MassProperties mass_;
  std::unique_ptr<const Interior> interior_;
  /// By triangle, if interior_ is not null: up to this distance the pseudonormal's sign is the winding
  /// number's.
  std::vector<float> sure_m_;
  bool is_sheet_ = false;
};

}  // namespace vps
