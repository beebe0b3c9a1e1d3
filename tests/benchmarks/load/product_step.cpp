// SPDX-License-Identifier: BSD-3-Clause
// The product is two gears on two shafts in bearings between two walls on a perforated base:
//
//        cover -> ||  wall   gear   wall  || <- cover
//                 ||--[]------##-----[]---||        shafts along y
//                 ||  []      ##     []   ||
//              ===+=======================+===      base, screwed to the walls from below
#include "products.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>

namespace vps::bench {
namespace {

constexpr double kPi = std::numbers::pi;
/// All lengths are in millimetres.
constexpr double kShaftX = 40, kShaftZ = 80, kWallIn = 42, kWallOut = 58;
constexpr double kScrewCircle = 25, kThread = 3, kThreadHole = 3.05, kPassage = 3.3, kWasher = 1.2;

using Profile = std::vector<std::array<double, 2>>;  ///< (r, z)

gp_Trsf shifted(double x, double y, double z) {
  gp_Trsf t;
  t.SetTranslation(gp_Vec(x, y, z));
  return t;
}

/// A transform that rotates z into the direction `direction` and moves the origin to the point `at`.
gp_Trsf along(const gp_Dir& direction, const gp_Pnt& at) {
  gp_Trsf t;
  t.SetTransformation(gp_Ax3(at, direction), gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)));
  return t;
}

TopoDS_Shape turned(const Profile& profile) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [r, z] : profile) polygon.Add(gp_Pnt(r, 0, z));
  polygon.Close();
  const gp_Ax1 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), axis).Shape();
}

TopoDS_Shape prism(const std::vector<std::array<double, 2>>& outline, double z, double height) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [x, y] : outline) polygon.Add(gp_Pnt(x, y, z));
  polygon.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, 0, height)).Shape();
}

TopoDS_Shape without(const TopoDS_Shape& from, const std::vector<TopoDS_Shape>& tools) {
  TopTools_ListOfShape arguments, cut;
  arguments.Append(from);
  for (const TopoDS_Shape& tool : tools) cut.Append(tool);
  BRepAlgoAPI_Cut operation;
  operation.SetArguments(arguments);
  operation.SetTools(cut);
  operation.Build();
  if (!operation.IsDone()) throw std::runtime_error("Open CASCADE did not cut a part of the product");
  return operation.Shape();
}

TopoDS_Shape placed(const TopoDS_Shape& shape, const gp_Trsf& t) {
  return BRepBuilderAPI_Transform(shape, t, true).Shape();  // a copy with its own geometry, not an instance
}

/// The material that a drill and a countersink remove, from z = 0 to `depth`.
TopoDS_Shape hole(double r, double depth, double chamfer) {
  return turned({{0, -1}, {r + chamfer + 1, -1}, {r, chamfer}, {r, depth}, {0, depth}});
}

/// A socket head cap screw. The screw's head rests on z = 0, and its shank points to -z.
TopoDS_Shape screw(double length) {
  const TopoDS_Shape body = turned({{0, -length},
                                    {kThread - 0.6, -length},
                                    {kThread, -length + 0.6},
                                    {kThread, -0.4},
                                    {kThread + 0.1, 0},
                                    {4.9, 0},
                                    {5, 0.1},
                                    {5, 5.4},
                                    {4.4, 6},
                                    {0, 6}});
  std::vector<std::array<double, 2>> socket;
  for (int i = 0; i < 6; ++i)
    socket.push_back(
        {2.5 / std::cos(kPi / 6) * std::cos(kPi / 3 * i), 2.5 / std::cos(kPi / 6) * std::sin(kPi / 3 * i)});
  return without(body, {prism(socket, 3, 4)});
}

TopoDS_Shape washer() {
  return turned({{3.2, 0.15},
                 {3.35, 0},
                 {5.35, 0},
                 {5.5, 0.15},
                 {5.5, kWasher - 0.15},
                 {5.35, kWasher},
                 {3.35, kWasher},
                 {3.2, kWasher - 0.15}});
}

/// A ring of a ball bearing around z with a groove for balls around the circle of radius 14, without balls.
TopoDS_Shape bearingRing(double inner, double outer) {
  constexpr double kHalf = 6, kChamfer = 0.4;
  const TopoDS_Shape ring = turned({{inner, -kHalf + kChamfer},
                                    {inner + kChamfer, -kHalf},
                                    {outer - kChamfer, -kHalf},
                                    {outer, -kHalf + kChamfer},
                                    {outer, kHalf - kChamfer},
                                    {outer - kChamfer, kHalf},
                                    {inner + kChamfer, kHalf},
                                    {inner, kHalf - kChamfer}});
  return without(ring, {BRepPrimAPI_MakeTorus(14, 2.7).Shape()});
}

/// A shaft around z. The shaft's larger journal, which stops the gear, is at negative z.
TopoDS_Shape shaft() {
  return turned({{0, -72},
                 {7.5, -72},
                 {8, -71.5},
                 {8, -44},
                 {12, -44},
                 {12.5, -43.5},
                 {12.5, -10.5},
                 {12, -10},
                 {10, -10},
                 {10, 11.5},
                 {9.8, 12},
                 {9.8, 44},
                 {8, 44},
                 {8, 71.5},
                 {7.5, 72},
                 {0, 72}});
}

/// A gear with 40 teeth of module 2 with straight flanks.
TopoDS_Shape gear(double turn_rad) {
  constexpr int kTeeth = 40;
  constexpr double kTip = 41.9, kRoot = 37.3, kPitch = 40, kBacklash = 0.15;
  const double slope = std::tan(kPi / 9), half = kPi / 2 - kBacklash;
  std::vector<std::array<double, 2>> outline;
  for (int tooth = 0; tooth < kTeeth; ++tooth)
    for (const auto& [r, side] : {std::array<double, 2>{kRoot, -1}, {kTip, -1}, {kTip, 1}, {kRoot, 1}}) {
      const double angle = turn_rad + 2 * kPi * tooth / kTeeth + side * (half - (r - kPitch) * slope) / r;
      outline.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
  return without(prism(outline, -10, 20), {placed(hole(10.01, 30, 0.5), shifted(0, 0, -10))});
}

/// A cover that rests with z = 0 on a wall; its collar points to -z.
TopoDS_Shape cover() {
  std::vector<TopoDS_Shape> holes;
  for (int i = 0; i < 4; ++i) {
    const double angle = kPi / 4 + kPi / 2 * i;
    holes.push_back(placed(turned({{0, -1}, {kPassage, -1}, {kPassage, 9}, {0, 9}}),
                           shifted(kScrewCircle * std::cos(angle), kScrewCircle * std::sin(angle), 0)));
  }
  return without(turned({{9, -1.7},
                         {9.3, -2},
                         {19.5, -2},
                         {19.9, -1.6},
                         {19.9, 0},
                         {30, 0},
                         {30, 5},
                         {29, 6},
                         {10, 6},
                         {9, 5}}),
                 holes);
}

TopoDS_Shape wall() {
  std::vector<TopoDS_Shape> tools;
  const gp_Dir y(0, 1, 0);
  for (const double x : {-kShaftX, kShaftX}) {
    tools.push_back(placed(hole(20.01, 30, 0.5), along(y, gp_Pnt(x, kWallIn, kShaftZ))));
    for (int i = 0; i < 4; ++i) {
      const double angle = kPi / 4 + kPi / 2 * i;
      tools.push_back(
          placed(hole(kThreadHole, 30, 0.3), along(y, gp_Pnt(x + kScrewCircle * std::cos(angle), kWallIn,
                                                             kShaftZ + kScrewCircle * std::sin(angle)))));
    }
  }
  for (const double x : {-85.0, -30.0, 30.0, 85.0})
    tools.push_back(placed(hole(kThreadHole, 20, 0.3), shifted(x, 50, 20)));
  for (double x = -90; x <= 90; x += 10)
    for (double z = 50; z <= 130; z += 10)
      if (std::hypot(std::abs(x) - kShaftX, z - kShaftZ) > 35)
        tools.push_back(placed(hole(3, 30, 0.5), along(y, gp_Pnt(x, kWallIn, z))));
  return without(BRepPrimAPI_MakeBox(gp_Pnt(-100, kWallIn, 20), gp_Pnt(100, kWallOut, 140)).Shape(), tools);
}

TopoDS_Shape base() {
  std::vector<TopoDS_Shape> tools;
  for (const double x : {-85.0, -30.0, 30.0, 85.0})
    for (const double side : {-50.0, 50.0})
      tools.push_back(
          placed(turned({{0, -1}, {kPassage, -1}, {kPassage, 21}, {0, 21}}), shifted(x, side, 0)));
  for (double x = -104; x <= 104; x += 16)
    for (double side = -30; side <= 30; side += 12)
      tools.push_back(placed(hole(4, 30, 0.5), shifted(x, side, 0)));
  return without(BRepPrimAPI_MakeBox(gp_Pnt(-120, -80, 0), gp_Pnt(120, 80, 20)).Shape(), tools);
}

/// Places the solids of the product.
class Product {
 public:
  explicit Product(bool is_shared) : is_shared_(is_shared) { builder_.MakeCompound(all_); }

  void add(const TopoDS_Shape& shape, const gp_Trsf& t = {}) {
    builder_.Add(all_, is_shared_ ? shape.Located(TopLoc_Location(t)) : placed(shape, t));
  }
  [[nodiscard]] const TopoDS_Compound& shape() const { return all_; }

 private:
  bool is_shared_;
  BRep_Builder builder_;
  TopoDS_Compound all_;
};

TopoDS_Compound gearbox(bool is_shared) {
  Product product(is_shared);
  product.add(base());
  const TopoDS_Shape one_wall = wall(), ring_out = bearingRing(16, 20), ring_in = bearingRing(8.005, 12),
                     one_shaft = shaft(), one_cover = cover(), one_washer = washer(), short_screw = screw(16),
                     long_screw = screw(36);
  gp_Trsf half_turn;
  half_turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), kPi);
  product.add(one_wall);
  product.add(one_wall, half_turn);
  for (const double x : {-kShaftX, kShaftX}) {
    const gp_Dir y(0, 1, 0);
    product.add(one_shaft, along(y, gp_Pnt(x, 0, kShaftZ)));
    product.add(gear(x < 0 ? 0 : kPi / 40), along(y, gp_Pnt(x, 0, kShaftZ)));
    for (const double side : {-1.0, 1.0}) {
      const gp_Dir out(0, side, 0);
      product.add(ring_out, along(y, gp_Pnt(x, side * 50, kShaftZ)));
      product.add(ring_in, along(y, gp_Pnt(x, side * 50, kShaftZ)));
      product.add(one_cover, along(out, gp_Pnt(x, side * kWallOut, kShaftZ)));
      for (int i = 0; i < 4; ++i) {
        const double angle = kPi / 4 + kPi / 2 * i, at_x = x + kScrewCircle * std::cos(angle),
                     at_z = kShaftZ + kScrewCircle * std::sin(angle);
        product.add(one_washer, along(out, gp_Pnt(at_x, side * (kWallOut + 6), at_z)));
        product.add(short_screw, along(out, gp_Pnt(at_x, side * (kWallOut + 6 + kWasher), at_z)));
      }
    }
  }
  for (const double x : {-85.0, -30.0, 30.0, 85.0})
    for (const double side : {-50.0, 50.0}) {
      product.add(one_washer, along(gp_Dir(0, 0, -1), gp_Pnt(x, side, 0)));
      product.add(long_screw, along(gp_Dir(0, 0, -1), gp_Pnt(x, side, -kWasher)));
    }
  return product.shape();
}

int countOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  int count = 0;
  for (TopExp_Explorer it(shape, kind); it.More(); it.Next()) ++count;
  return count;
}

}  // namespace

ProductSize writeProduct(const std::string& file, bool is_shared) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const TopoDS_Compound product = gearbox(is_shared);
  if (is_shared) {
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(product, true);
    STEPCAFControl_Writer writer;
    if (!writer.Transfer(document) || writer.Write(file.c_str()) != IFSelect_RetDone)
      throw std::runtime_error("cannot write " + file);
  } else {
    STEPControl_Writer writer;
    writer.Transfer(product, STEPControl_AsIs);
    if (writer.Write(file.c_str()) != IFSelect_RetDone) throw std::runtime_error("cannot write " + file);
  }
  return {countOf(product, TopAbs_SOLID), countOf(product, TopAbs_FACE)};
}

}  // namespace vps::bench
