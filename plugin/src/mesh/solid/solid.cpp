// SPDX-License-Identifier: BSD-3-Clause
#include "vps/solid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/solid/interior.h"
#include "vps/mesh_repair.h"

namespace vps {
namespace {

constexpr double kInPlane = 1e-9;  ///< a sine: above rounding errors, below any angle of a mesh

template <typename T>
bool contains(const std::vector<T>& flags, T value) {
  return std::find(flags.begin(), flags.end(), value) != flags.end();
}

/// True if the mesh crosses or touches itself. Pseudonormals may then be wrong although the mesh is closed
/// and consistent.
bool touchesItself(const MeshDistance& surface) {
  const std::size_t count = surface.mesh().triangles.size();
  return contains(regularVertices(surface.mesh()), std::uint8_t{0}) ||
         contains(crossedFacets(surface, count), Crossed::Yes);
}

RepairedMesh repaired(const Mesh& mesh, const std::string& part) {
  requireUsable(mesh, "", part);
  Mesh shared = welded(mesh);
  requireUsable(shared, "", part);
  return repairMesh(std::move(shared));
}

Mesh times(Mesh mesh, double factor) {
  for (Vec3& p : mesh.vertices) p *= factor;
  return mesh;
}

}  // namespace

Solid::Solid(const Mesh& mesh, const std::string& part) : Solid(repaired(mesh, part)) {}

Solid::Solid(RepairedMesh&& repaired)
    : distance_(repaired.surface), report_(repaired.report), mass_(massOf(repaired)) {
  if (repaired.is_sound) {
    if (!touchesItself(distance_)) return;
    repaired = repairCrossing(repaired);
    distance_ = MeshDistance(repaired.surface);
    report_ = repaired.report;
  }
  const Box box = bounds(repaired.surface);
  interior_ = std::make_unique<const Interior>(std::move(repaired.solid), box);
  report_.signed_by_winding = true;
  sure_m_ = sureDistances(distance_, *interior_);
}

Solid::Solid(const Mesh& surface, const MeshReport& report) : distance_(surface), report_(report) {}

Solid::Solid(Solid&&) noexcept = default;
Solid& Solid::operator=(Solid&&) noexcept = default;
Solid::~Solid() = default;

Solid Solid::sheet(const Mesh& mesh) {
  Solid sheet(mesh, MeshReport());
  sheet.is_sheet_ = true;
  return sheet;
}

Solid Solid::scaled(double factor) const {
  Solid larger(times(mesh(), factor), report_);
  larger.mass_ = {mass_.volume_m3 * std::pow(factor, 3), mass_.com * factor,
                  mass_.inertia_m5 * std::pow(factor, 5)};
  larger.is_sheet_ = is_sheet_;
  if (interior_ == nullptr) return larger;
  larger.interior_ =
      std::make_unique<const Interior>(times(interior_->mesh(), factor), bounds(larger.mesh()));
  larger.sure_m_ = sureDistances(larger.distance_, *larger.interior_);
  return larger;
}

Solid::Closest Solid::closest(const Vec3& p, double max_m) const noexcept {
  Closest nearest = distance_.closest(p, max_m);
  if (interior_ == nullptr || !nearest.found) return nearest;
  const Vec3 way = p - nearest.q;
  const double rise = nearest.normal.dot(way);
  const bool is_sure = nearest.distance_m <= static_cast<double>(sure_m_[nearest.triangle]);
  const bool is_inside = is_sure ? rise < 0 && interior_->mayHold(p) : interior_->isInside(p);
  // At an open edge the point may lie in the facet's plane, where the rounding of the product decides.
  const bool agrees =
      is_inside ? rise < -kInPlane * nearest.distance_m : rise > kInPlane * nearest.distance_m;
  if (nearest.distance_m > 0 && !agrees)
    nearest.normal = way / (is_inside ? -nearest.distance_m : nearest.distance_m);
  return nearest;
}

double Solid::signedDistance(const Vec3& p, double max_m) const noexcept {
  const Closest nearest = closest(p, max_m);
  const bool is_inside = !is_sheet_ && nearest.found && nearest.normal.dot(p - nearest.q) < 0;
  return is_inside ? -nearest.distance_m : nearest.distance_m;
}

MassProperties solidMass(const Mesh& mesh, const std::string& part) {
  return massOf(repaired(mesh, part));
}

bool Solid::isInside(const Vec3& p) const noexcept {
  return interior_ != nullptr ? interior_->isInside(p) : signedDistance(p) < 0;
}

}  // namespace vps
