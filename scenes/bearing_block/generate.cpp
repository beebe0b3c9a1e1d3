// SPDX-License-Identifier: BSD-3-Clause
// Models the sample assembly "bearing block" and writes it as STEP and glTF, after checking its fits.
// Usage: setarch -R vps_make_bearing_block DIR     writes DIR/bearing_block.step and DIR/bearing_block.glb
// setarch is used since Open CASCADE orders colours in STEP by address. Without random addresses one build
// writes the same bytes each time; another build may order the colours differently, but the .glb is the same.
//
// All lengths are in mm, z is up. The frame of a part has its origin on the part's axis at its seat, so poses
// in the assembly are translations. Section through the bore; the shaft is inserted after the lower bushing:
//
//        |=======|  shaft  |=======|   58.0  cover
//   50.0 |_______|         |_______|   50.0
//        |    |up|         |  |    |   49.5  upper bushing's top
//        |    |per         |  |    |
//   34.0 |    |__|  _____  |__|    |         upper ledge
//        |     |   |     |   |     |   31.0  shoulder
//   26.0 |     |___|_____|___|     |
//        |     |lower|  |    |     |
//   10.0 |     |__ __|  |____|     |         lower ledge
//        |       |   |  |  |       |    5.0  shaft's end
//    0.0 |_______|         |_______|
//
// The chamfers guide a rim that enters, and keep the rims of inserted parts out of the concave corners of
// their seats, where two normals would meet: at least 0.6 mm are free there.
// More than 400 lines, since the checks of the fits use the dimensions of all parts.
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GProp_GProps.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_ProgressRange.hxx>
#include <RWGltf_CafWriter.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

namespace {

constexpr double kPi = 3.14159265358979323846;

// --- Sizes [mm]. A fit is nominal plus clearance on the hole's side; all shafts and pins are nominal. ---
constexpr double kTop = 50, kCover = 8;
constexpr double kLowerLedge = 10, kUpperLedge = 34;
constexpr double kLowerBushing = 16, kUpperBushing = 15.5;
constexpr double kShaftBelow = 21, kShaftAbove = 54, kShoulder = 5;  // from the shoulder's underside
constexpr double kDowel = 16, kDowelHole = 8.5, kDowelX = 23, kDowelY = 18;
constexpr double kKeyY = 21, kKeyDepth = 3, kKeyPocket = 3;
constexpr double kScrewShank = 16, kScrewHead = 4, kScrewHole = 14, kCounterbore = 4.4;

using Point2 = std::array<double, 2>;  // r, z

TopoDS_Shape checked(const TopoDS_Shape& shape, const char* what) {
  if (shape.IsNull() || !BRepCheck_Analyzer(shape).IsValid())
    throw std::runtime_error(std::string("invalid: ") + what);
  return shape;
}

TopoDS_Shape translated(const TopoDS_Shape& shape, double x, double y, double z) {
  gp_Trsf t;
  t.SetTranslation(gp_Vec(x, y, z));
  return shape.Moved(TopLoc_Location(t));
}

/// The solid that a closed profile (r, z) sweeps around the z axis.
TopoDS_Shape revolved(const std::vector<Point2>& profile) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const Point2& q : profile) polygon.Add(gp_Pnt(q[0], 0, q[1]));
  polygon.Close();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(polygon.Wire(), true);
  return checked(BRepPrimAPI_MakeRevol(face, gp::OZ()).Shape(), "revolution");
}

/// Hole from z = 0 down, with a mouth chamfer at 45 degrees; extends 1 above so that a cut leaves no skin.
TopoDS_Shape hole(double diameter, double depth, double chamfer) {
  const double r = diameter / 2;
  return revolved({{0, -depth}, {r, -depth}, {r, -chamfer}, {r + chamfer + 1, 1}, {0, 1}});
}

/// Pin along +z from z = 0, its ends chamfered (radially, at 30 degrees to the axis).
TopoDS_Shape pin(double diameter, double length, double chamfer) {
  const double r = diameter / 2, axial = chamfer * std::sqrt(3.0);
  return revolved(
      {{0, 0}, {r - chamfer, 0}, {r, axial}, {r, length - axial}, {r - chamfer, length}, {0, length}});
}

/// Bushing along +z from z = 0; outer ends chamfered at 30 degrees to the axis, mouths at 45 degrees.
TopoDS_Shape bushing(double outer, double inner, double length, double chamfer, double mouth) {
  const double R = outer / 2, r = inner / 2, axial = chamfer * std::sqrt(3.0);
  return revolved({{r + mouth, 0},
                   {R - chamfer, 0},
                   {R, axial},
                   {R, length - axial},
                   {R - chamfer, length},
                   {r + mouth, length},
                   {r, length - mouth},
                   {r, mouth}});
}

TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return checked(BRepAlgoAPI_Cut(a, b).Shape(), "cut");
}

/// Prism with rounded ends, along x, centred at the origin, from z = 0 up.
TopoDS_Shape roundedBar(double length, double width, double height) {
  const double r = width / 2, x = length / 2 - r;
  const gp_Pnt a(-x, -r, 0), b(x, -r, 0), c(x + r, 0, 0), d(x, r, 0), e(-x, r, 0), f(-x - r, 0, 0);
  BRepBuilderAPI_MakeWire wire;
  wire.Add(BRepBuilderAPI_MakeEdge(a, b));
  wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(b, c, d).Value()));
  wire.Add(BRepBuilderAPI_MakeEdge(d, e));
  wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(e, f, a).Value()));
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(wire.Wire(), true);
  return checked(BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, height)).Shape(), "bar");
}

TopoDS_Shape hexagon(double across_flats, double height) {
  BRepBuilderAPI_MakePolygon polygon;
  for (int i = 0; i < 6; ++i) {
    const double r = across_flats / std::sqrt(3.0), angle = kPi / 3 * i;
    polygon.Add(gp_Pnt(r * std::cos(angle), r * std::sin(angle), 0));
  }
  polygon.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire(), true).Face(), gp_Vec(0, 0, height))
      .Shape();
}

Bnd_Box boxOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, false, false);
  return box;
}

/// Chamfers at 45 degrees all edges whose bounding box the predicate accepts.
TopoDS_Shape chamfered(const TopoDS_Shape& shape, double size,
                       const std::function<bool(const gp_Pnt& low, const gp_Pnt& high)>& accepts) {
  BRepFilletAPI_MakeChamfer maker(shape);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(i));
    const Bnd_Box box = boxOf(edge);
    // An edge that is tangent to an added edge belongs to the contour of the added edge.
    if (accepts(box.CornerMin(), box.CornerMax()) && maker.Contour(edge) == 0) maker.Add(size, edge);
  }
  return checked(maker.Shape(), "chamfer");
}

bool isAt(double z, const gp_Pnt& low, const gp_Pnt& high) {
  return std::abs(low.Z() - z) < 1e-4 && std::abs(high.Z() - z) < 1e-4;
}

TopoDS_Shape makeHousing() {
  TopoDS_Shape body = BRepPrimAPI_MakeBox(gp_Pnt(-35, -30, 0), gp_Pnt(35, 30, kTop)).Shape();
  const TopoDS_Shape feet = BRepPrimAPI_MakeBox(gp_Pnt(-49, -30, 0), gp_Pnt(49, 30, 10)).Shape();
  BRepAlgoAPI_Fuse fuse(body, feet);
  ShapeUpgrade_UnifySameDomain unify(fuse.Shape());
  unify.Build();
  body = chamfered(checked(unify.Shape(), "body"), 1, [](const gp_Pnt& low, const gp_Pnt& high) {
    const bool is_top = isAt(kTop, low, high);
    const bool is_foot_end = std::abs(low.X() - high.X()) < 1e-4 && std::abs(low.X()) > 48 && low.Z() > 9;
    return is_top || is_foot_end;
  });
  // One tool for the stepped bore, its three mouths chamfered.
  const double r1 = 8, r2 = 24.030 / 2, r3 = 30.040 / 2, c = 0.6;
  body = cut(body, revolved({{0, -1},
                             {r1, -1},
                             {r1, kLowerLedge - c},
                             {r1 + c, kLowerLedge},
                             {r2, kLowerLedge},
                             {r2, kUpperLedge - c},
                             {r2 + c, kUpperLedge},
                             {r3, kUpperLedge},
                             {r3, kTop - c},
                             {r3 + c + 1, kTop + 1},
                             {0, kTop + 1}}));
  for (const int side : {-1, 1}) {
    body = cut(body, translated(hole(4.020, kDowelHole, 0.6), side * kDowelX, side * kDowelY, kTop));
    body = cut(body, translated(hole(4.200, kScrewHole, 0.6), side * kDowelX, -side * kDowelY, kTop));
    for (const int end : {-1, 1})
      body = cut(body, translated(hole(6.6, 11, 0.5), side * 42.0, end * 18.0, 10));
  }
  body = cut(body, translated(roundedBar(18.040, 5.040, kKeyDepth + 1), 0, kKeyY, kTop - kKeyDepth));
  return chamfered(body, 0.6, [](const gp_Pnt& low, const gp_Pnt& high) {
    return isAt(kTop, low, high) && low.Y() > 18 && high.Y() < 24 && low.X() > -9.1 && high.X() < 9.1;
  });
}

TopoDS_Shape makeShaft() {
  const double r = 6, shoulder = 9, c = 1, axial = c * std::sqrt(3.0), k = 0.5;
  return revolved({{0, -kShaftBelow},
                   {r - c, -kShaftBelow},
                   {r, -kShaftBelow + axial},
                   {r, 0},
                   {shoulder - k, 0},
                   {shoulder, k},
                   {shoulder, kShoulder - k},
                   {shoulder - k, kShoulder},
                   {r, kShoulder},
                   {r, kShaftAbove - axial},
                   {r - c, kShaftAbove},
                   {0, kShaftAbove}});
}

TopoDS_Shape makeKey() {
  return chamfered(roundedBar(18, 5, 5), 0.6, [](const gp_Pnt& low, const gp_Pnt& high) {
    return isAt(0, low, high) || isAt(5, low, high);
  });
}

TopoDS_Shape makeCover() {
  TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(-30, -27, 0), gp_Pnt(30, 27, kCover)).Shape();
  plate = chamfered(plate, 0.8, [](const gp_Pnt& low, const gp_Pnt& high) {
    return isAt(kCover, low, high) || high.Z() - low.Z() > kCover - 0.1;
  });
  const double r = 12.5 / 2;
  plate = cut(
      plate,
      revolved({{0, -1}, {r + 2, -1}, {r, 1}, {r, kCover - 0.5}, {r + 1.5, kCover + 1}, {0, kCover + 1}}));
  for (const int side : {-1, 1}) {
    const double d = 4.060 / 2, s = 4.5 / 2, b = 8.0 / 2, floor = kCover - kCounterbore;
    plate = cut(
        plate,
        translated(
            revolved(
                {{0, -1}, {d + 2, -1}, {d, 1}, {d, kCover - 0.5}, {d + 1.5, kCover + 1}, {0, kCover + 1}}),
            side * kDowelX, side * kDowelY, 0));
    plate = cut(plate, translated(revolved({{0, -1},
                                            {s + 1.5, -1},
                                            {s, 0.5},
                                            {s, floor - 0.4},
                                            {s + 0.4, floor},
                                            {b, floor},
                                            {b, kCover - 0.5},
                                            {b + 1.5, kCover + 1},
                                            {0, kCover + 1}}),
                                  side * kDowelX, -side * kDowelY, 0));
  }
  plate = cut(plate, translated(roundedBar(18.3, 5.3, kKeyPocket + 1), 0, kKeyY, -1));
  return chamfered(plate, 0.8, [](const gp_Pnt& low, const gp_Pnt& high) {
    return isAt(0, low, high) && low.Y() > 18 && high.Y() < 24 && low.X() > -9.3 && high.X() < 9.3;
  });
}

/// Cap screw after ISO 4762 M4 x 16, with a smooth shank for its thread. The origin is under the head.
TopoDS_Shape makeScrew() {
  const double r = 2, head = 3.5, c = 0.6, axial = c * std::sqrt(3.0);
  const TopoDS_Shape body = revolved({{0, -kScrewShank},
                                      {r - c, -kScrewShank},
                                      {r, -kScrewShank + axial},
                                      {r, 0},
                                      {head - 0.2, 0},
                                      {head, 0.2},
                                      {head, kScrewHead - 0.4},
                                      {head - 0.4, kScrewHead},
                                      {0, kScrewHead}});
  return cut(body, translated(hexagon(3, 3), 0, 0, kScrewHead - 2));
}

struct Product {
  std::string name;
  TopoDS_Shape shape;
  double density;               // kg/m^3
  std::array<double, 3> color;  // linear RGB
};

struct Instance {
  std::string name;
  int product;
  std::array<double, 3> at;
  std::string group;  // sub-assembly
};

struct Fit {
  int hole, shaft;  // instances
  double hole_diameter, shaft_diameter;
  const char* what;
};

struct Assembly {
  std::vector<Product> products;
  std::vector<Instance> instances;
  std::vector<Fit> fits;

  [[nodiscard]] TopoDS_Shape placed(int i) const {
    const Instance& it = instances[i];
    return translated(products[it.product].shape, it.at[0], it.at[1], it.at[2]);
  }
};

Assembly makeAssembly() {
  const std::array<double, 3> iron{0.10, 0.13, 0.17}, bronze{0.52, 0.26, 0.06}, steel{0.42, 0.44, 0.47};
  const std::array<double, 3> alu{0.20, 0.34, 0.50}, black{0.03, 0.03, 0.035}, brass{0.65, 0.47, 0.12};
  Assembly a;
  a.products = {
      {"housing", makeHousing(), 7200, iron},
      {"bushing_lower", bushing(24, 12.024, kLowerBushing, 0.8, 1), 8800, bronze},
      {"shaft", makeShaft(), 7850, steel},
      {"bushing_upper", bushing(30, 12.040, kUpperBushing, 0.8, 1), 8800, bronze},
      {"key", makeKey(), 7850, brass},
      {"dowel", pin(4, kDowel, 0.6), 7850, steel},
      {"cover", makeCover(), 2700, alu},
      {"screw", makeScrew(), 7850, black},
  };
  const double screw_z = kTop + kCover - kCounterbore;
  a.instances = {
      {"housing", 0, {0, 0, 0}, ""},
      {"bushing_lower", 1, {0, 0, kLowerLedge}, "bearing"},
      {"shaft", 2, {0, 0, kLowerLedge + kLowerBushing}, "bearing"},
      {"bushing_upper", 3, {0, 0, kUpperLedge}, "bearing"},
      {"key", 4, {0, kKeyY, kTop - kKeyDepth}, ""},
      {"dowel_1", 5, {-kDowelX, -kDowelY, kTop - kDowelHole}, "closure"},
      {"dowel_2", 5, {kDowelX, kDowelY, kTop - kDowelHole}, "closure"},
      {"cover", 6, {0, 0, kTop}, "closure"},
      {"screw_1", 7, {-kDowelX, kDowelY, screw_z}, "closure"},
      {"screw_2", 7, {kDowelX, -kDowelY, screw_z}, "closure"},
  };
  a.fits = {
      {0, 1, 24.030, 24, "lower bushing in housing"},
      {0, 3, 30.040, 30, "upper bushing in housing"},
      {1, 2, 12.024, 12, "shaft in lower bushing"},
      {3, 2, 12.040, 12, "shaft in upper bushing"},
      {0, 4, 5.040, 5, "key in housing"},
      {0, 5, 4.020, 4, "dowel 1 in housing"},
      {0, 6, 4.020, 4, "dowel 2 in housing"},
      {7, 5, 4.060, 4, "dowel 1 in cover"},
      {7, 6, 4.060, 4, "dowel 2 in cover"},
      {7, 4, 5.300, 5, "key in cover"},
      {7, 2, 12.5, 12, "shaft in cover"},
      {0, 8, 4.200, 4, "screw 1 in housing"},
      {0, 9, 4.200, 4, "screw 2 in housing"},
      {7, 8, 4.5, 4, "screw 1 in cover"},
      {7, 9, 4.5, 4, "screw 2 in cover"},
  };
  return a;
}

double volume(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

/// The cylindrical faces of one diameter as one compound: one side of a fit.
TopoDS_Shape cylinders(const TopoDS_Shape& shape, double diameter) {
  TopoDS_Compound found;
  BRep_Builder builder;
  builder.MakeCompound(found);
  int count = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const BRepAdaptor_Surface surface(TopoDS::Face(it.Current()));
    if (surface.GetType() != GeomAbs_Cylinder || std::abs(2 * surface.Cylinder().Radius() - diameter) > 1e-9)
      continue;
    builder.Add(found, it.Current());
    ++count;
  }
  if (count == 0) throw std::runtime_error("no cylinder of diameter " + std::to_string(diameter));
  return found;
}

/// Prints masses and fits; throws if two parts overlap or a clearance differs from the stated one.
void verify(const Assembly& a) {
  std::printf("%-14s %10s %9s\n", "part", "volume/mm3", "mass/g");
  for (const Product& p : a.products) {
    std::printf("%-14s %10.1f %9.3f\n", p.name.c_str(), volume(p.shape), volume(p.shape) * p.density * 1e-6);
  }
  const int count = int(a.instances.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const TopoDS_Shape x = a.placed(i), y = a.placed(j);
      if (boxOf(x).IsOut(boxOf(y))) continue;
      const double common = volume(BRepAlgoAPI_Common(x, y).Shape());
      if (std::abs(common) > 1e-9)
        throw std::runtime_error(a.instances[i].name + " overlaps " + a.instances[j].name);
    }
  }
  std::printf("\n%-26s %9s %9s %14s\n", "fit", "hole/mm", "shaft/mm", "clearance/um");
  for (const Fit& f : a.fits) {
    const TopoDS_Shape outer = cylinders(a.placed(f.hole), f.hole_diameter);
    const TopoDS_Shape inner = cylinders(a.placed(f.shaft), f.shaft_diameter);
    const double gap = 2 * BRepExtrema_DistShapeShape(outer, inner).Value();
    std::printf("%-26s %9.3f %9.3f %14.1f\n", f.what, f.hole_diameter, f.shaft_diameter, gap * 1e3);
    if (std::abs(gap - (f.hole_diameter - f.shaft_diameter)) > 1e-6) throw std::runtime_error(f.what);
  }
}

/// The tree: bearing_block / {housing, bearing / {...}, key, closure / {...}}; names on products and on
/// instances.
Handle(TDocStd_Document) makeDocument(const Assembly& a) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colors = XCAFDoc_DocumentTool::ColorTool(document->Main());
  std::vector<TDF_Label> products;
  for (const Product& p : a.products) {
    const TDF_Label label = shapes->AddShape(p.shape, false);
    TDataStd_Name::Set(label, p.name.c_str());
    colors->SetColor(label, Quantity_Color(p.color[0], p.color[1], p.color[2], Quantity_TOC_RGB),
                     XCAFDoc_ColorGen);
    products.push_back(label);
  }
  const TDF_Label root = shapes->NewShape();
  TDataStd_Name::Set(root, "bearing_block");
  std::vector<std::pair<std::string, TDF_Label>> groups;
  for (const Instance& it : a.instances) {
    TDF_Label parent = root;
    if (!it.group.empty()) {
      if (groups.empty() || groups.back().first != it.group) {
        groups.emplace_back(it.group, shapes->NewShape());
        TDataStd_Name::Set(groups.back().second, it.group.c_str());
        TDataStd_Name::Set(shapes->AddComponent(root, groups.back().second, TopLoc_Location()),
                           it.group.c_str());
      }
      parent = groups.back().second;
    }
    gp_Trsf t;
    t.SetTranslation(gp_Vec(it.at[0], it.at[1], it.at[2]));
    TDataStd_Name::Set(shapes->AddComponent(parent, products[it.product], TopLoc_Location(t)),
                       it.name.c_str());
  }
  shapes->UpdateAssemblies();
  return document;
}

void writeStep(const Handle(TDocStd_Document) & document, const std::string& file) {
  STEPCAFControl_Controller::Init();  // defines the statics below
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.product.name", "bearing_block");
  STEPCAFControl_Writer writer;
  writer.SetNameMode(true);
  writer.SetColorMode(true);
  if (!writer.Transfer(document, STEPControl_AsIs)) throw std::runtime_error("STEP transfer failed");
  APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
  header.SetTimeStamp(new TCollection_HAsciiString("2000-01-01T00:00:00"));
  header.SetName(new TCollection_HAsciiString("bearing_block"));
  if (writer.Write(file.c_str()) != IFSelect_RetDone) throw std::runtime_error("cannot write " + file);
}

void writeGltf(const Handle(TDocStd_Document) & document, const Assembly& a, const std::string& file) {
  // 1 um of sagitta: a tenth of half the smallest clearance (20 um on diameter). Planes, cylinders and cones
  // hold it with the vertices of their rims alone.
  IMeshTools_Parameters meshing;
  meshing.Deflection = 1e-3;
  meshing.Angle = 0.35;
  meshing.InternalVerticesMode = false;
  for (const Product& p : a.products) BRepMesh_IncrementalMesh(p.shape, meshing);
  RWGltf_CafWriter writer(file.c_str(), true);
  writer.SetTransformationFormat(RWGltf_WriterTrsfFormat_TRS);
  writer.SetNodeNameFormat(RWMesh_NameFormat_Instance);
  writer.ChangeCoordinateSystemConverter().SetInputLengthUnit(1e-3);
  writer.ChangeCoordinateSystemConverter().SetInputCoordinateSystem(RWMesh_CoordinateSystem_Zup);
  if (!writer.Perform(document, TColStd_IndexedDataMapOfStringString(), Message_ProgressRange())) {
    throw std::runtime_error("cannot write " + file);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: vps_make_bearing_block DIR");
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const Assembly assembly = makeAssembly();
  verify(assembly);
  const Handle(TDocStd_Document) document = makeDocument(assembly);
  writeStep(document, std::string(argv[1]) + "/bearing_block.step");
  writeGltf(document, assembly, std::string(argv[1]) + "/bearing_block.glb");
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
} catch (const Standard_Failure& e) {
  std::fprintf(stderr, "Open CASCADE: %s\n", e.GetMessageString());
  return 2;
}
