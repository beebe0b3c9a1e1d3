// SPDX-License-Identifier: BSD-3-Clause
#include "import/occt/shape_mesh.h"

#include <algorithm>
#include <cmath>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

namespace vps::scenes::inline v0::import {
namespace {

void appendFace(const TopoDS_Face& face, Mesh& mesh) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
  if (triangulation.IsNull()) return;
  const gp_Trsf transform = location.Transformation();
  const auto base = std::uint32_t(mesh.vertices.size());
  for (int i = 1; i <= triangulation->NbNodes(); ++i) {
    const gp_Pnt p = triangulation->Node(i).Transformed(transform);
    mesh.vertices.emplace_back(p.X(), p.Y(), p.Z());
  }
  const bool is_flipped = (face.Orientation() == TopAbs_REVERSED) != transform.IsNegative();
  for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    triangulation->Triangle(i).Get(a, b, c);
    if (is_flipped) std::swap(b, c);
    mesh.triangles.push_back(
        {base + std::uint32_t(a - 1), base + std::uint32_t(b - 1), base + std::uint32_t(c - 1)});
  }
}

}  // namespace

std::vector<TopoDS_Shape> pieces(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> found;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) found.push_back(it.Current());
  // 1 um [mm], which suffices for most IGES edges; far less where the file states that the part is tiny.
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  const double tolerance = box.IsVoid() ? 1e-3 : std::min(1e-3, 1e-5 * std::sqrt(box.SquareExtent()));
  BRepBuilderAPI_Sewing sewing(tolerance);
  int loose = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next(), ++loose)
    sewing.Add(it.Current());
  if (loose > 0) {
    sewing.Perform();
    if (!sewing.SewedShape().IsNull()) found.push_back(sewing.SewedShape());
  }
  return found;
}

Mesh meshOf(const TopoDS_Shape& shape, const ImportSettings& settings, double units_per_m) {
  IMeshTools_Parameters parameters;
  parameters.Deflection = settings.deflection_m * units_per_m;
  parameters.Angle = settings.angle_rad;
  parameters.InParallel = !settings.in_own_process;  // a forked process may start no threads
  // Planes and cylinders keep the deflection by their rims alone; other surfaces still get inner points.
  parameters.InternalVerticesMode = false;
  BRepMesh_IncrementalMesh(shape, parameters);
  Mesh mesh;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
    appendFace(TopoDS::Face(it.Current()), mesh);
  return mesh;
}

}  // namespace vps::scenes::inline v0::import
