// SPDX-License-Identifier: BSD-3-Clause
// vps_make_products FOLDER     writes products as STEP whose answer is known by construction, and
// answers.txt:
//                              name, verdict of `vps assemble`, and how many of its steps fit
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Trsf.hxx>

namespace vps::bench {
namespace {

// All lengths are in millimetres.
using Point = std::array<double, 2>;
using Solids = std::vector<TopoDS_Shape>;

struct Product {
  const char* name;
  const char* verdict;  ///< as in `vps assemble --json`
  int fits;             ///< steps
  std::function<Solids()> make;
};

TopoDS_Shape at(const TopoDS_Shape& shape, double x, double y, double z) {
  gp_Trsf t;
  t.SetTranslation(gp_Vec(x, y, z));
  return BRepBuilderAPI_Transform(shape, t, true).Shape();
}

/// The shape rotated so that its z axis becomes x.
TopoDS_Shape lying(const TopoDS_Shape& shape) {
  gp_Trsf t;
  t.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0)), std::numbers::pi / 2);
  return BRepBuilderAPI_Transform(shape, t, true).Shape();
}

/// A box that is centred in x and y and extends upwards from z = 0.
TopoDS_Shape box(double x, double y, double z) {
  return BRepPrimAPI_MakeBox(gp_Pnt(-x / 2, -y / 2, 0), x, y, z).Shape();
}

TopoDS_Shape turned(const std::vector<Point>& profile) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [r, z] : profile) polygon.Add(gp_Pnt(r, 0, z));
  polygon.Close();
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(),
                               gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)))
      .Shape();
}

/// A prism over an outline in x and z, from y = -depth / 2 to depth / 2.
TopoDS_Shape prism(const std::vector<Point>& outline, double depth) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [x, z] : outline) polygon.Add(gp_Pnt(x, -depth / 2, z));
  polygon.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, depth, 0)).Shape();
}

TopoDS_Shape cut(const TopoDS_Shape& from, const TopoDS_Shape& tool) {
  return BRepAlgoAPI_Cut(from, tool).Shape();
}
TopoDS_Shape joined(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Fuse(a, b).Shape();
}

/// A chamfered pin that extends upwards from z = 0.
TopoDS_Shape pin(double d, double length, double chamfer = 0.5) {
  const double r = d / 2;
  return turned(
      {{0, 0}, {r - chamfer, 0}, {r, chamfer}, {r, length - chamfer}, {r - chamfer, length}, {0, length}});
}

/// The material that a drill removes upwards from z = 0; in a part that is thicker than `depth` it makes a
/// blind hole.
TopoDS_Shape hole(double d, double depth) {
  return turned({{0, 0}, {d / 2, 0}, {d / 2, depth}, {0, depth}});
}

TopoDS_Shape screw(double d, double length) {  // the head is above z = 0
  const double r = d / 2;
  return turned(
      {{0, -length}, {r - 0.5, -length}, {r, -length + 0.5}, {r, 0}, {1.7 * r, 0}, {1.7 * r, d}, {0, d}});
}

/// A pin of 10 mm in a blind hole of a block.
Solids pegIn(double hole_d) {
  return {cut(box(40, 40, 30), at(hole(hole_d, 25), 0, 0, 10)), at(pin(10, 35), 0, 0, 10)};
}

/// A cover on a block with screws in four holes.
Solids coverWithScrews(double hole_d) {
  TopoDS_Shape block = box(60, 60, 25), cover = at(box(60, 60, 6), 0, 0, 25);
  Solids all;
  for (const double x : {-22.0, 22.0})
    for (const double y : {-22.0, 22.0}) {
      block = cut(block, at(hole(hole_d, 30), x, y, 7));
      cover = cut(cover, at(hole(6.6, 20), x, y, 20));
      all.push_back(at(screw(6, 20), x, y, 31));
    }
  all.insert(all.begin(), {block, cover});
  return all;
}

/// An open box with a block inside, and a lid that stands in the box's mouth.
Solids boxWithLid(double height_inside) {
  const TopoDS_Shape open = cut(box(60, 60, 40), at(box(50, 50, 40), 0, 0, 5));
  const TopoDS_Shape lid = joined(at(box(60, 60, 5), 0, 0, 40), at(box(49.8, 49.8, 5), 0, 0, 35));
  return {open, at(box(30, 30, height_inside), 0, 0, 5), lid};
}

/// A dovetail rail along y with a slide, and with stops at none, one or both ends.
Solids dovetail(int stops) {
  const double c = 0.1;
  TopoDS_Shape rail = joined(box(50, 70.2, 10), prism({{-8, 10}, {8, 10}, {13, 18}, {-13, 18}}, 70.2));
  const TopoDS_Shape groove = prism(
      {{-8 - c, 9}, {8 + c, 9}, {8 + c, 10}, {13 + 2 * c, 18 + c}, {-13 - 2 * c, 18 + c}, {-8 - c, 10}}, 80);
  const TopoDS_Shape slide = cut(at(box(40, 60, 20), 0, 0, 10), groove);
  if (stops > 0) rail = joined(rail, at(box(50, 5, 30), 0, 32.6, 0));
  if (stops > 1) rail = joined(rail, at(box(50, 5, 30), 0, -32.6, 0));
  return {rail, slide};
}

/// A board in the slot of a base.
Solids board(double slot) {
  return {cut(box(80, 60, 30), at(box(slot, 50.2, 30), 0, 0, 10)), at(box(20, 50, 60), 0, 0, 10)};
}

/// A plate on two posts that are 60 mm apart.
Solids onPosts(double between_holes) {
  const TopoDS_Shape base =
      joined(joined(box(100, 40, 10), at(pin(10, 30), -30, 0, 9)), at(pin(10, 30), 30, 0, 9));
  const double x = between_holes / 2;
  const TopoDS_Shape plate =
      cut(cut(at(box(100, 40, 8), 0, 0, 10), at(hole(10.1, 30), -x, 0, 0)), at(hole(10.1, 30), x, 0, 0));
  return {base, plate};
}

Solids ballInShell() {
  return {cut(box(50, 50, 50), BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 25), 20).Shape()),
          BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 20.05), 15).Shape()};
}

/// A pin with a head at both ends through a plate.
Solids headedPin() {
  return {cut(box(60, 60, 12), at(hole(10.2, 30), 0, 0, -1)),
          turned({{0, -6}, {9, -6}, {9, 0}, {5, 0}, {5, 12.1}, {9, 12.1}, {9, 18}, {0, 18}})};
}

Solids linkedRings() {
  gp_Trsf quarter;
  quarter.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), std::numbers::pi / 2);
  const TopoDS_Shape ring = BRepPrimAPI_MakeTorus(20, 4).Shape();
  return {ring, at(BRepBuilderAPI_Transform(ring, quarter, true).Shape(), 20, 0, 0)};
}

Solids cups() {
  const auto cup = [](double r, double z) {
    return at(turned({{0, 0}, {r, 0}, {r, 30}, {r - 3, 30}, {r - 3, 3}, {0, 3}}), 0, 0, z);
  };
  return {cup(30, 0), cup(26.9, 3), cup(23.8, 6)};
}

/// A hub with a key on a shaft that stands in a foot.
Solids keyedHub() {
  const TopoDS_Shape keyway = at(box(8, 6.05, 20.1), 8, 0, 30), key = at(box(6, 6, 20), 9, 0, 30.05);
  TopoDS_Shape shaft =
      cut(joined(joined(box(60, 60, 10), at(hole(24, 20), 0, 0, 9)), at(pin(20, 50), 0, 0, 10)), keyway);
  const TopoDS_Shape hub =
      cut(cut(at(hole(50, 18), 0, 0, 31), at(hole(20.1, 30), 0, 0, 25)), at(box(12.3, 6.1, 30), 6.15, 0, 25));
  return {shaft, key, at(hub, 0, 0, 0)};
}

/// A slot that goes in from above and then sideways; the block's head is wider than the slot's mouth.
/// @param gap  clearance of the mouth; farther in, the clearance is 0.2 mm
Solids elbowSlot(double gap) {
  TopoDS_Shape base = box(100, 60, 40);
  base = cut(base,
             at(box(24 + gap, 24 + gap, 40), -25, 0, 12));  // the path by which the block enters from above
  base = cut(base, at(box(70, 24.2, 16.2), 0, 0, 12));      // the path along which the block then moves
  base = cut(base, at(box(70, 12.2, 40), 0, 0, 12));        // the path of the neck
  const TopoDS_Shape tee = joined(at(box(24, 24, 16), 20, 0, 12), at(box(12, 12, 40), 20, 0, 20));
  return {base, tee};
}

/// A drawer of steel that is pushed in sideways.
Solids drawer(double gap) {
  const TopoDS_Shape cabinet = cut(box(140, 100, 80), at(box(120, 80 + gap, 40 + gap), 20, 0, 20 - gap / 2));
  return {cabinet, at(box(120, 80, 40), 20, 0, 20)};
}

/// A lying bushing on a lying bolt, and a nut-like ring that holds it.
Solids onAxle() {
  const TopoDS_Shape axle = lying(joined(hole(40, 8), at(pin(16, 70), 0, 0, 7)));
  const TopoDS_Shape wheel = lying(at(cut(hole(60, 20), at(hole(16.1, 30), 0, 0, -1)), 0, 0, 8));
  const TopoDS_Shape collar = lying(at(cut(hole(30, 10), at(hole(16.1, 30), 0, 0, -1)), 0, 0, 28));
  return {axle, wheel, collar};
}

const std::vector<Product>& products() {
  static const std::vector<Product> all = {
      {"peg_100um", "fits", 1, [] { return pegIn(10.1); }},
      {"peg_30um", "fits", 1, [] { return pegIn(10.03); }},
      {"peg_line_to_line", "fits", 1, [] { return pegIn(10); }},
      {"peg_100um_too_thick", "blocked", 0, [] { return pegIn(9.9); }},
      {"ball_in_shell", "blocked", 0, ballInShell},
      {"headed_pin", "blocked", 0, headedPin},
      {"linked_rings", "blocked", 0, linkedRings},
      {"box_with_lid", "fits", 2, [] { return boxWithLid(29); }},
      {"box_too_full", "blocked", 1, [] { return boxWithLid(31); }},
      {"cover_with_screws", "fits", 5, [] { return coverWithScrews(6.1); }},
      {"cover_with_drawn_threads", "fits", 5, [] { return coverWithScrews(5); }},
      {"cups", "fits", 2, cups},
      {"dovetail", "fits", 1, [] { return dovetail(0); }},
      {"dovetail_with_stop", "fits", 1, [] { return dovetail(1); }},
      {"dovetail_closed", "blocked", 0, [] { return dovetail(2); }},
      {"board_100um", "fits", 1, [] { return board(20.1); }},
      {"board_50um_too_thick", "blocked", 0, [] { return board(19.95); }},
      {"posts", "fits", 1, [] { return onPosts(60); }},
      {"posts_300um_off", "blocked", 0, [] { return onPosts(60.3); }},
      {"keyed_hub", "fits", 2, keyedHub},
      {"elbow_slot", "fits", 1, [] { return elbowSlot(0.2); }},
      {"elbow_slot_tight_mouth", "fits", 1, [] { return elbowSlot(0.06); }},
      {"drawer_3kg", "fits", 1, [] { return drawer(0.2); }},
      {"wheel_on_axle", "fits", 2, onAxle},
  };
  return all;
}

void write(const Solids& solids, const std::string& file) {
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& solid : solids) builder.Add(all, solid);
  STEPControl_Writer writer;
  writer.Transfer(all, STEPControl_AsIs);
  if (writer.Write(file.c_str()) != IFSelect_RetDone) throw std::runtime_error("cannot write " + file);
}

int run(const std::string& folder) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  std::filesystem::create_directories(folder);
  std::ofstream answers(folder + "/answers.txt");
  for (const Product& product : products()) {
    write(product.make(), folder + "/" + product.name + ".step");
    answers << product.name << ' ' << product.verdict << ' ' << product.fits << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace vps::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "vps_make_products FOLDER\n");
    return 2;
  }
  try {
    return vps::bench::run(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "vps_make_products: %s\n", e.what());
    return 2;
  }
}
