// SPDX-License-Identifier: BSD-3-Clause
#include "occt/congruent.h"

#include <cmath>

#include <BRepAdaptor_Curve.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace vps::scenes::import {

namespace {

Vec3 toVec3(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}

void addEdge(const TopoDS_Edge& edge, ShapeTrace& trace) {
  constexpr int kPoints = 5;
  trace.kinds.push_back(edge.Orientation());
  if (BRep_Tool::Degenerated(edge)) {
    trace.kinds.push_back(-1);
    return;
  }
  const BRepAdaptor_Curve curve(edge);
  trace.kinds.push_back(curve.GetType());
  const double from = curve.FirstParameter(), to = curve.LastParameter();
  for (int i = 0; i < kPoints; ++i)
    trace.points.push_back(toVec3(curve.Value(from + (to - from) * i / (kPoints - 1))));
}

void addFace(const TopoDS_Face& face, ShapeTrace& trace) {
  trace.kinds.push_back(face.Orientation());
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);  // where the face is
  if (surface.IsNull()) {
    trace.kinds.push_back(-1);
    return;
  }
  const int kind = GeomAdaptor_Surface(surface).GetType();
  trace.kinds.push_back(kind);
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  // Where a plane, a cylinder or the like is, few points tell.
  const int cells = kind < GeomAbs_BezierSurface ? 2 : 8;
  for (int i = 0; i <= cells; ++i)
    for (int k = 0; k <= cells; ++k)
      trace.points.push_back(toVec3(surface->Value(u0 + (u1 - u0) * i / cells, v0 + (v1 - v0) * k / cells)));
}

}  // namespace

ShapeTrace traceOf(const TopoDS_Shape& shape) try {
  ShapeTrace trace;
  trace.kinds = {shape.ShapeType(), shape.Orientation()};
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    addFace(TopoDS::Face(face.Current()), trace);
    for (TopExp_Explorer edge(face.Current(), TopAbs_EDGE); edge.More(); edge.Next())
      addEdge(TopoDS::Edge(edge.Current()), trace);
  }
  return trace;
} catch (const Standard_Failure&) {  // of a damaged shape, which is nothing's copy
  return {};
}

namespace {

/// Whether distances from the first point agree, as a motion keeps them: each of two points may be off by the
/// tolerance. Ends at the first that does not, so that different shapes cost little.
bool haveSameDistances(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double tolerance) {
  for (std::size_t i = 1; i < a.size(); ++i)
    if (!(std::abs((a[i] - a[0]).norm() - (b[i] - b[0]).norm()) <= 2 * tolerance)) return false;
  return true;
}

}  // namespace

std::optional<Eigen::Affine3d> motionBetween(const ShapeTrace& a, const ShapeTrace& b, double tolerance) {
  if (a.kinds != b.kinds || a.points.size() != b.points.size() || a.points.empty()) return std::nullopt;
  if (!haveSameDistances(a.points, b.points, tolerance)) return std::nullopt;
  using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  const auto columns = [](const std::vector<Vec3>& points) {
    return Eigen::Map<const Columns>(points.front().data(), 3, static_cast<Eigen::Index>(points.size()));
  };
  const Columns from = columns(a.points), to = columns(b.points);
  if (!from.allFinite() || !to.allFinite()) return std::nullopt;
  constexpr bool kWithScale = false;
  Eigen::Affine3d X;
  X.matrix() = Eigen::umeyama(from, to, kWithScale);
  if (!X.matrix().allFinite()) return std::nullopt;
  const Columns moved = (X.linear() * from).colwise() + X.translation();
  if (!((moved - to).colwise().norm().maxCoeff() <= tolerance)) return std::nullopt;
  return X;
}

}  // namespace vps::scenes::import
