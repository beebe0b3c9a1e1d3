// SPDX-License-Identifier: BSD-3-Clause
#include "occt/tessellate_all.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

#include "import/child_processes.h"
#include "import/part_bytes.h"
#include "occt/occt_progress.h"

namespace vps::scenes::import {

namespace {

/// Properties that a rigid copy of a shape shares with the shape, in one order: kinds and counts of its faces
/// and edges, and points on them.
struct ShapeTrace {
  std::vector<int> kinds;
  std::vector<Vec3> points;
};

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
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);  // placed by the face's location
  if (surface.IsNull()) {
    trace.kinds.push_back(-1);
    return;
  }
  const int kind = GeomAdaptor_Surface(surface).GetType();
  trace.kinds.push_back(kind);
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  // Few points determine a plane, a cylinder or another elementary surface.
  const int cells = kind < GeomAbs_BezierSurface ? 2 : 8;
  for (int i = 0; i <= cells; ++i)
    for (int k = 0; k <= cells; ++k)
      trace.points.push_back(toVec3(surface->Value(u0 + (u1 - u0) * i / cells, v0 + (v1 - v0) * k / cells)));
}

/// Faces, their orientation, surfaces and edges in the shape's order; for each edge five points, and for each
/// face a grid of its surface. O(faces + edges). Empty for a damaged shape, which counts as no copy of
/// another.
ShapeTrace traceOf(const TopoDS_Shape& shape) try {
  ShapeTrace trace;
  trace.kinds = {shape.ShapeType(), shape.Orientation()};
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    addFace(TopoDS::Face(face.Current()), trace);
    for (TopExp_Explorer edge(face.Current(), TopAbs_EDGE); edge.More(); edge.Next())
      addEdge(TopoDS::Edge(edge.Current()), trace);
  }
  return trace;
} catch (const Standard_Failure&) {
  return {};
}

/// Whether all distances from the first point agree, as after a motion; each point may be off by the
/// tolerance. Ends at the first difference, so that different shapes cost little.
bool haveSameDistances(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double tolerance) {
  for (std::size_t i = 1; i < a.size(); ++i)
    if (!(std::abs((a[i] - a[0]).norm() - (b[i] - b[0]).norm()) <= 2 * tolerance)) return false;
  return true;
}

/// The motion X with X a = b, if all points of b are then within `tolerance` of those of a; never a mirror
/// image. Two shapes with the same trace are taken for equal: surfaces that agree at their edges and at the
/// grid could still differ in between, such as free-form faces that were edited between the grid's points.
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

/// Transfers a tessellation without the handles of its faces.
template <class Io>
void transfer(Io& io, Tessellation& t) {
  transfer(io, t.mesh);
  transferEach(io, t.faces, [&](Tessellation::Face& face) {
    transfer(io, face.triangles);
    transfer(io, face.is_good);
  });
  transfer(io, t.deviation_m);
  transfer(io, t.deflection_m);
  for (int* count : {&t.missing, &t.off, &t.folded, &t.uncovered, &t.outside}) transfer(io, *count);
  transfer(io, t.open_edges);
}

std::string bytesOf(Tessellation t) {
  ToBytes io;
  transfer(io, t);
  return std::move(io.out);
}

Tessellation tessellationFrom(const std::string& bytes) {
  FromBytes io(bytes);
  Tessellation t;
  transfer(io, t);
  return t;
}

/// Finds for each shape the first shape of which it is a rigid copy.
class Different {
 public:
  explicit Different(double tolerance) : tolerance_(tolerance) {}

  TessellatedShape findOrAdd(const TopoDS_Shape& shape) {
    ShapeTrace trace = traceOf(shape);
    std::vector<std::size_t>& alike = with_kinds_[trace.kinds];
    for (const std::size_t i : alike)
      if (const auto X = motionBetween(traces_[i], trace, tolerance_)) return {i, *X};
    alike.push_back(traces_.size());
    traces_.push_back(std::move(trace));
    shapes_.push_back(shape);
    return {shapes_.size() - 1, Eigen::Affine3d::Identity()};
  }
  [[nodiscard]] const std::vector<TopoDS_Shape>& shapes() const { return shapes_; }

 private:
  double tolerance_;
  std::vector<TopoDS_Shape> shapes_;
  std::vector<ShapeTrace> traces_;
  std::map<std::vector<int>, std::vector<std::size_t>> with_kinds_;
};

/// The number of edges of each shape, as a measure of its work.
std::vector<int> edgesOf(const std::vector<TopoDS_Shape>& shapes) {
  std::vector<int> edges;
  for (const TopoDS_Shape& shape : shapes) {
    edges.push_back(0);
    for (TopExp_Explorer it(shape, TopAbs_EDGE); it.More(); it.Next()) ++edges.back();
  }
  return edges;
}

/// Shapes with many edges first, since they take longest.
std::vector<std::size_t> longestFirst(const std::vector<TopoDS_Shape>& shapes,
                                      const std::vector<int>& edges) {
  std::vector<std::size_t> order(shapes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return edges[a] > edges[b]; });
  return order;
}

}  // namespace

std::vector<TopoDS_Shape> pieces(
    const TopoDS_Shape& shape, const std::function<void(double)>& tell,
    const std::function<void(const TopoDS_Shape& sewn, const TopoDS_Shape& face)>& remember) {
  std::vector<TopoDS_Shape> found;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) found.push_back(it.Current());
  // Tolerance of sewing in mm: 1 um, which is enough for most IGES edges, and less for a tiny part.
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  const double tolerance = box.IsVoid() ? 1e-3 : std::min(1e-3, 1e-5 * std::sqrt(box.SquareExtent()));
  BRepBuilderAPI_Sewing sewing(tolerance);
  int loose = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next(), ++loose)
    sewing.Add(it.Current());
  if (loose > 0) {
    const Handle(OcctProgress) progress = new OcctProgress(tell);
    sewing.Perform(progress->Start());
    progress->rethrow();
    if (!sewing.SewedShape().IsNull()) found.push_back(sewing.SewedShape());
    for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); remember && it.More(); it.Next())
      if (sewing.IsModified(it.Current())) remember(sewing.Modified(it.Current()), it.Current());
  }
  return found;
}

TessellatedShapes tessellateAll(const std::vector<TopoDS_Shape>& shapes, const ImportSettings& settings,
                                double units_per_m, const Progress& progress) {
  constexpr double kSame_m = 1e-9;
  Different different(kSame_m * units_per_m);
  TessellatedShapes out;
  for (const TopoDS_Shape& shape : shapes) out.shapes.push_back(different.findOrAdd(shape));
  const std::vector<TopoDS_Shape>& own = different.shapes();
  // Copies of this process add to the counter as well, but only this process calls `progress`.
  constexpr double kPerEdge = 1024;
  const std::vector<int> edges = edgesOf(own);
  const double all = kPerEdge * std::accumulate(edges.begin(), edges.end(), 1.0);
  SharedCounter done;
  const auto look = [&] {
    if (progress) progress("meshing", std::min(1.0, static_cast<double>(done.value()) / all));
  };
  const long here = processNumber();
  const auto make = [&](std::size_t i) {
    std::size_t told = 0;
    const auto tell = [&](double share) {
      const auto now = static_cast<std::size_t>(share * kPerEdge * edges[i]);
      done.add(now - std::min(now, told));
      told = std::max(now, told);
      if (processNumber() == here) look();
    };
    Tessellation made = tessellate(own[i], settings, units_per_m, tell);
    tell(1);
    return made;
  };
  if (!settings.in_own_process) {  // Open CASCADE then uses threads itself
    for (std::size_t i = 0; i < own.size(); ++i) out.tessellations.push_back(make(i));
    return out;
  }
  const auto makeBytes = [&](std::size_t i) { return bytesOf(make(i)); };
  for (const std::string& bytes : madeInCopies(longestFirst(own, edges), makeBytes, {}, 0, look))
    out.tessellations.push_back(tessellationFrom(bytes));
  return out;
}

}  // namespace vps::scenes::import
