// SPDX-License-Identifier: BSD-3-Clause
#include "occt/tessellation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Geom_Surface.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Face.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include "occt/occt_progress.h"

namespace vps::scenes::import {

namespace {

/// Greatest accepted deviation, in deflections (assumed). Open CASCADE keeps the deflection along edges and
/// checks it at some points within faces.
constexpr double kTimes = 3;

/// Points inside faces. Planes and cylinders keep the deflection through the points on their boundary alone,
/// but Open CASCADE 7.6 can span a cylinder with many boundary curves by triangles that are millimetres off.
enum class Inner { None, AsAsked, Finer };

/// True if a face has so many holes that Open CASCADE's algorithm Delabella is faster than its default: 3.4 s
/// instead of 6.4 s with 84 to 120 holes. On a torus Delabella is slower: 14 s instead of 8 s.
bool hasManyHoles(const TopoDS_Shape& shape) {
  constexpr int kMany = 20;  // assumed
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    if (face.Current().NbChildren() > kMany) return true;
  return false;
}

/// Number of triangles that are inverted in the face's parameters, as in a folded face.
int foldedTriangles(const TopoDS_Face& face) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
  if (triangulation.IsNull() || !triangulation->HasUVNodes()) return 0;
  int count = 0;
  for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    triangulation->Triangle(i).Get(a, b, c);
    const gp_XY p = triangulation->UVNode(a).XY(), ab = triangulation->UVNode(b).XY() - p,
                ac = triangulation->UVNode(c).XY() - p;
    // Rounding may invert slivers.
    count += (ab ^ ac) < -1e-9 * ab.Modulus() * ac.Modulus();
  }
  return count;
}

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

/// Greatest distance of the triangles' centres from the face's surface. The surface point at the mean of the
/// corners' parameters is near the centre, so the nearest point is only searched for where that point is
/// farther away than `enough`.
double deviationOf(const TopoDS_Face& face, double enough) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
  if (triangulation.IsNull() || !triangulation->HasUVNodes()) return 0;
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);  // placed by the face's location
  if (surface.IsNull()) return 0;
  Handle(ShapeAnalysis_Surface) nearest;
  double worst = 0;
  for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
    int corner[3];
    triangulation->Triangle(i).Get(corner[0], corner[1], corner[2]);
    gp_XYZ center;
    gp_XY middle;
    for (const int c : corner) {
      center += triangulation->Node(c).Transformed(location.Transformation()).XYZ() / 3;
      middle += triangulation->UVNode(c).XY() / 3;
    }
    double distance = surface->Value(middle.X(), middle.Y()).Distance(gp_Pnt(center));
    if (distance > std::max(enough, worst)) {
      if (nearest.IsNull()) nearest = new ShapeAnalysis_Surface(surface);
      const gp_Pnt2d at = nearest->ValueOfUV(gp_Pnt(center), Precision::Confusion());
      distance = std::min(distance, nearest->Value(at).Distance(gp_Pnt(center)));
      // ValueOfUV() starts at the nearest point of a grid, from which it may reach another local minimum.
      if (distance > std::max(enough, worst)) {
        const GeomAPI_ProjectPointOnSurf all(gp_Pnt(center), surface);
        if (all.NbPoints() > 0) distance = std::min(distance, all.LowerDistance());
      }
    }
    worst = std::max(worst, distance);
  }
  return worst;
}

using Tell = std::function<void(double)>;

/// Progress over tries of which the number is not known.
class Tries {
 public:
  explicit Tries(const Tell& tell) : tell_(tell) {}

  /// The callback of the next piece of work.
  Tell next() {
    from_ = to_;
    to_ = from_ + 0.5 * (1 - from_);
    if (!tell_) return {};
    return [this, from = from_, to = to_](double share) { tell_(from + (to - from) * share); };
  }

 private:
  const Tell& tell_;
  double from_ = 0, to_ = 0;
};

void triangulate(const TopoDS_Shape& shape, const ImportSettings& settings, double units_per_m, Inner inner,
                 const Tell& tell, IMeshTools_MeshAlgoType algorithm = IMeshTools_MeshAlgoType_DEFAULT) {
  const double finer = inner == Inner::Finer ? 0.25 : 1;
  IMeshTools_Parameters parameters;
  parameters.Deflection = finer * settings.deflection_m * units_per_m;
  parameters.Angle = finer * settings.angle_rad;
  parameters.InParallel = !settings.in_own_process;  // a forked process may start no threads
  parameters.InternalVerticesMode = inner != Inner::None;
  parameters.MeshAlgo = algorithm;
  // A BREP file can hold triangles, which may no longer fit the shape.
  BRepTools::Clean(shape);
  const Handle(OcctProgress) progress = new OcctProgress(tell);
  BRepMesh_IncrementalMesh(shape, parameters, progress->Start());
  progress->rethrow();
}

std::size_t triangleCount(const TopoDS_Shape& shape) {
  std::size_t count = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation =
        BRep_Tool::Triangulation(TopoDS::Face(it.Current()), location);
    if (!triangulation.IsNull()) count += static_cast<std::size_t>(triangulation->NbTriangles());
  }
  return count;
}

struct Affordable {
  double deflection_m = 0;
  bool is_triangulated =
      false;  ///< the shape has the triangles of this deflection, by firstAlgorithm() and Inner::None
};

/// The algorithm that is tried first.
IMeshTools_MeshAlgoType firstAlgorithm(const TopoDS_Shape& shape) {
  return hasManyHoles(shape) ? IMeshTools_MeshAlgoType_Delabella : IMeshTools_MeshAlgoType_DEFAULT;
}

/// The least deflection, the requested one times a power of four, with which the shape has no more triangles
/// than allowed. Tries the coarsest first, so that too many triangles are never made: a quarter of the
/// deflection doubles the triangles of a cylinder, and makes four times as many on a ball.
Affordable affordable(const TopoDS_Shape& shape, ImportSettings settings, double units_per_m, Tries& tries) {
  constexpr double kStep = 4, kRounding = 1.01;
  const double asked_m = settings.deflection_m;
  if (settings.most_triangles == 0 || settings.coarsest_m < kStep * asked_m) return {asked_m};
  double deflection_m = asked_m;
  while (kStep * deflection_m < kRounding * settings.coarsest_m) deflection_m *= kStep;
  const IMeshTools_MeshAlgoType algorithm = firstAlgorithm(shape);
  const auto countAt = [&](double d_m) {
    settings.deflection_m = d_m;
    triangulate(shape, settings, units_per_m, Inner::None, tries.next(), algorithm);
    return triangleCount(shape);
  };
  const auto most = static_cast<double>(settings.most_triangles);
  for (auto count = static_cast<double>(countAt(deflection_m)); deflection_m > kRounding * asked_m;
       deflection_m /= kStep) {
    if (count * deflection_m / asked_m <= most) return {asked_m};
    if (2 * count > most) return {deflection_m, true};
    count = static_cast<double>(countAt(deflection_m / kStep));
    if (count > most) return {deflection_m};
  }
  return {asked_m, true};
}

/// The difference between the area of a face and of its triangles, if it is more than tessellation explains;
/// else 0. On a flat face only chords along the boundary change the area, so that a triangle across a hole is
/// detected. On a curved face the angle a between triangles also counts: a strip of a cylinder has (a / 2) /
/// sin(a / 2) times their area, 0.5 % more at 20 degrees, and a doubly curved face has twice that excess.
double areaError(const TopoDS_Face& face, const Mesh& mesh, std::size_t from, double enough,
                 double angle_rad) {
  double covered = 0;
  for (std::size_t i = from; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3 &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
    covered += 0.5 * (q - p).cross(r - p).norm();
  }
  GProp_GProps exact, rim;
  BRepGProp::SurfaceProperties(face, exact);
  BRepGProp::LinearProperties(face, rim);
  const bool is_flat = BRepAdaptor_Surface(face, false).GetType() == GeomAbs_Plane;
  constexpr double kSides = 2,
                   kIntegration =
                       1e-2;  // curved in two directions; error of Open CASCADE's areas of splines, assumed
  const double x = 0.5 * angle_rad, curved = is_flat ? 1e-6 : kSides * (x / std::sin(x) - 1) + kIntegration;
  const double error = std::abs(covered - exact.Mass());
  return error > enough * rim.Mass() + curved * exact.Mass() ? error : 0;
}

/// Whether the triangles are in the box of the exact face; Open CASCADE's box may be too large but not too
/// small.
bool isInItsBox(const TopoDS_Face& face, const Mesh& mesh, std::size_t from, double enough) {
  Bnd_Box box;
  BRepBndLib::Add(face, box, false);
  if (box.IsVoid()) return true;
  box.Enlarge(enough);
  for (std::size_t i = from; i < mesh.vertices.size(); ++i) {
    const Vec3& p = mesh.vertices[i];
    if (box.IsOut(gp_Pnt(p.x(), p.y(), p.z()))) return false;
  }
  return true;
}

/// Whether the shape is a solid or a set of sewn faces, without an open edge.
bool isClosedShape(const TopoDS_Shape& shape) {
  bool has_shell = false;
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next()) {
    has_shell = true;
    if (!BRep_Tool::IsClosed(it.Current())) return false;
  }
  return has_shell;
}

/// The shape after healing the faces that are not `is_good`.
TopoDS_Shape withFacesHealed(const TopoDS_Shape& shape, const Tessellation& tessellation) {
  const Handle(ShapeBuild_ReShape) changes = new ShapeBuild_ReShape;
  for (const Tessellation::Face& face : tessellation.faces) {
    if (face.is_good) continue;
    ShapeFix_Face fix(face.face);
    fix.SetContext(changes);
    fix.Perform();
    fix.FixOrientation();
    if (!fix.Result().IsNull() && !fix.Result().IsSame(face.face)) changes->Replace(face.face, fix.Result());
  }
  return changes->Apply(shape);
}

}  // namespace

Tessellation compared(const TopoDS_Shape& shape, const ImportSettings& settings, double units_per_m,
                      const std::function<void(double)>& tell) {
  constexpr double kMostWeld_m = 1e-6;
  Tessellation out;
  out.deflection_m = settings.deflection_m;
  const double enough = kTimes * settings.deflection_m * units_per_m;
  double deviation = 0, faces = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); tell && it.More(); it.Next()) ++faces;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    if (tell) tell(static_cast<double>(out.faces.size()) / faces);
    const TopoDS_Face face = TopoDS::Face(it.Current());
    const std::size_t before = out.mesh.triangles.size(), first = out.mesh.vertices.size();
    appendFace(face, out.mesh);
    Tessellation::Face& own = out.faces.emplace_back(face, out.mesh.triangles.size() - before);
    out.folded += foldedTriangles(face);
    const double of_face = deviationOf(face, enough);
    deviation = std::max(deviation, of_face);
    const bool is_missing = own.triangles == 0, is_off = of_face > enough;
    const double area_error = areaError(face, out.mesh, before, enough, settings.angle_rad);
    deviation = std::max(deviation,
                         std::sqrt(area_error));  // side of a square of the area that is missing or in excess
    const bool is_uncovered = !is_missing && area_error > 0;
    const bool is_outside = !isInItsBox(face, out.mesh, first, enough);
    out.missing += is_missing;
    out.off += is_off;
    out.uncovered += is_uncovered;
    out.outside += is_outside;
    own.is_good = !is_missing && !is_off && !is_uncovered && !is_outside;
  }
  if (isClosedShape(shape) && !out.mesh.triangles.empty()) {
    out.open_edges = checkMesh(welded(out.mesh, kMostWeld_m * units_per_m)).open_edges;
    GProp_GProps exact;
    BRepGProp::VolumeProperties(shape, exact, 1e-4);  // relative accuracy
    const double volume = std::abs(massProperties(out.mesh).volume_m3),
                 error = std::abs(volume - std::abs(exact.Mass()));
    if (error > 1e-3 * volume) deviation = std::max(deviation, error / area(out.mesh));
  }
  out.deviation_m = deviation / units_per_m;
  return out;
}

bool Tessellation::isTrusted() const {
  return faults() == 0 && deviation_m <= kTimes * deflection_m;
}

Tessellation tessellate(const TopoDS_Shape& shape, ImportSettings settings, double units_per_m,
                        const std::function<void(double)>& tell) {
  Tries tries(tell);
  const Affordable found = affordable(shape, settings, units_per_m, tries);
  settings.deflection_m = found.deflection_m;
  const IMeshTools_MeshAlgoType algorithm = firstAlgorithm(shape);
  if (!found.is_triangulated) triangulate(shape, settings, units_per_m, Inner::None, tries.next(), algorithm);
  Tessellation best = compared(shape, settings, units_per_m, tries.next());
  if (algorithm != IMeshTools_MeshAlgoType_DEFAULT) {
    if (best.isTrusted() && best.folded == 0) return best;
    triangulate(shape, settings, units_per_m, Inner::None, tries.next());
    best = compared(shape, settings, units_per_m, tries.next());
  }
  const auto tryThat = [&](const TopoDS_Shape& other, Inner inner) {
    if (best.isTrusted()) return;
    triangulate(other, settings, units_per_m, inner, tries.next());
    Tessellation next = compared(other, settings, units_per_m, tries.next());
    // Finer triangles without fewer faults only make the search for contacts slower.
    const bool is_better = next.faults() < best.faults() ||
                           (next.faults() == best.faults() && next.deviation_m < 0.5 * best.deviation_m);
    if (!is_better) return;
    best = std::move(next);
  };
  tryThat(shape, Inner::AsAsked);
  tryThat(shape, Inner::Finer);
  if (best.isTrusted()) return best;
  tryThat(withFacesHealed(shape, best), Inner::AsAsked);
  if (best.isTrusted()) return best;
  ShapeFix_Shape fix(shape);
  fix.Perform();
  tryThat(fix.Shape(), Inner::AsAsked);
  return best;
}

std::string inWords(const Tessellation& tessellation, const ImportSettings& settings) {
  std::string coarser;
  if (tessellation.deflection_m > settings.deflection_m) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "is read within %.4g um of its curved faces, since within %.4g um it would have more than "
                  "%zu triangles (--deflection %.4gum keeps them all)",
                  1e6 * tessellation.deflection_m, 1e6 * settings.deflection_m, settings.most_triangles,
                  1e6 * settings.deflection_m);
    coarser = text;
  }
  if (tessellation.isTrusted()) return coarser;
  std::string faults = coarser;
  const auto add = [&](const std::string& fault) { faults += (faults.empty() ? "" : "; ") + fault; };
  const auto ofFaces = [&](int count) {
    return std::to_string(count) + " of its " + std::to_string(tessellation.faces.size()) + " faces ";
  };
  char deviation[40], asked[40];
  std::snprintf(deviation, sizeof deviation, "%.3g mm", 1e3 * tessellation.deviation_m);
  std::snprintf(asked, sizeof asked, "%.4g um", 1e6 * settings.deflection_m);
  if (tessellation.missing > 0) add(ofFaces(tessellation.missing) + "have no triangles");
  if (tessellation.off > 0)
    add(ofFaces(tessellation.off) + "have triangles up to " + deviation + " off (" + asked +
        " was asked for)");
  if (tessellation.uncovered > 0)
    add(ofFaces(tessellation.uncovered) + "differ in area from their triangles, which may span a hole");
  if (tessellation.outside > 0) add(ofFaces(tessellation.outside) + "have triangles outside of their bounds");
  if (tessellation.open_edges > 0)
    add("its faces are closed, but its triangles have " + std::to_string(tessellation.open_edges) +
        " open edges");
  if (tessellation.off == 0 && tessellation.deviation_m > kTimes * tessellation.deflection_m)
    add(std::string("its volume differs from the exact volume by as much as a layer on its surface of ") +
        deviation);
  return faults +
         "; neither finer triangles nor healing the faces helped, so measurements near these faults may "
         "have errors of the same size; if greater accuracy is needed, export the part from the CAD program "
         "as a mesh (STL, OBJ), or model these faces again";
}

}  // namespace vps::scenes::import
