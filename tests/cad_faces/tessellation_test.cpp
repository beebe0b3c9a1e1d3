// SPDX-License-Identifier: BSD-3-Clause
// Families of solids whose triangles are correct, and the same solids with a fault whose effect is known.
#include "occt/tessellation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Ax2.hxx>

namespace vps::scenes::import {
namespace {

constexpr double kDeflection_mm = 1e-2;

ImportSettings settings() {
  ImportSettings out;
  out.deflection_m = 1e-3 * kDeflection_mm;
  return out;
}

/// A plate of 100 x 20 x 5 mm with holes in a row.
TopoDS_Shape plate(int holes, double radius_mm) {
  TopoDS_Shape out = BRepPrimAPI_MakeBox(100, 20, 5).Shape();
  for (int i = 0; i < holes; ++i) {
    const gp_Ax2 axis(gp_Pnt(100 * (i + 0.5) / holes, 10, -1), gp_Dir(0, 0, 1));
    out = BRepAlgoAPI_Cut(out, BRepPrimAPI_MakeCylinder(axis, radius_mm, 7).Shape()).Shape();
  }
  return out;
}

void mesh(const TopoDS_Shape& shape) {
  BRepMesh_IncrementalMesh(shape, kDeflection_mm, false, settings().angle_rad);
}

TopoDS_Face faceAt(const TopoDS_Shape& shape, double z_mm) {
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    TopLoc_Location location;
    const Handle(Poly_Triangulation) own = BRep_Tool::Triangulation(face, location);
    bool is_there = !own.IsNull();
    for (int i = 1; is_there && i <= own->NbNodes(); ++i) is_there = std::abs(own->Node(i).Z() - z_mm) < 1e-9;
    if (is_there) return face;
  }
  return {};
}

void setTriangles(const TopoDS_Face& face, const std::vector<gp_Pnt>& corners,
                  const std::vector<Poly_Triangle>& triangles) {
  const Handle(Poly_Triangulation) own =
      new Poly_Triangulation(static_cast<int>(corners.size()), static_cast<int>(triangles.size()), false);
  for (std::size_t i = 0; i < corners.size(); ++i) own->SetNode(static_cast<int>(i) + 1, corners[i]);
  for (std::size_t i = 0; i < triangles.size(); ++i) own->SetTriangle(static_cast<int>(i) + 1, triangles[i]);
  BRep_Builder().UpdateFace(face, own);
}

TEST(Tessellation, PlatesWithAnyNumberOfHolesAreRight) {
  for (const int holes : {0, 1, 3, 7})
    for (const double radius_mm : {0.2, 2.0, 5.0}) {
      const TopoDS_Shape shape = plate(holes, radius_mm);
      mesh(shape);
      const Tessellation found = compared(shape, settings(), 1000);
      EXPECT_TRUE(found.isTrusted()) << holes << " " << radius_mm << ": " << inWords(found, settings());
      EXPECT_EQ(found.open_edges, 0U);
      const double volume_mm3 =
          1e4 - holes * 5 * std::numbers::pi * radius_mm * radius_mm;  // volume of the exact plate
      const double slack_mm3 = 3 * kDeflection_mm * holes * 5 * 2 * std::numbers::pi * radius_mm;
      EXPECT_NEAR(massProperties(found.mesh).volume_m3, volume_mm3, slack_mm3 + 1e-6);
    }
}

TEST(Tessellation, ATriangleAcrossAHoleOfAFlatFaceIsSeen) {
  const TopoDS_Shape shape = plate(1, 2);
  mesh(shape);
  setTriangles(faceAt(shape, 5), {{0, 0, 5}, {100, 0, 5}, {100, 20, 5}, {0, 20, 5}}, {{1, 2, 3}, {1, 3, 4}});
  const Tessellation found = compared(shape, settings(), 1000);
  EXPECT_FALSE(found.isTrusted());
  EXPECT_EQ(found.uncovered, 1);
  EXPECT_EQ(found.off, 0);  // all triangles lie on the face
  EXPECT_GT(found.open_edges, 0U);
  // The deviation is the width of the hole, the square root of its area.
  EXPECT_NEAR(found.deviation_m, 1e-3 * std::sqrt(std::numbers::pi * 4), 0.2e-3);
  EXPECT_NE(inWords(found, settings()).find("span a hole"), std::string::npos);
}

TEST(Tessellation, AHoleIsSeenFromTheAreaThatChordsOfItsRimCanHave) {
  // The rim of the hole is 2 pi r long and the outline of the plate 240 mm; chords may deviate by three
  // deflections from both.
  for (const double radius_mm : {0.5, 2.0}) {
    const TopoDS_Shape shape = plate(1, radius_mm);
    mesh(shape);
    setTriangles(faceAt(shape, 5), {{0, 0, 5}, {100, 0, 5}, {100, 20, 5}, {0, 20, 5}},
                 {{1, 2, 3}, {1, 3, 4}});
    const double hole_mm2 = std::numbers::pi * radius_mm * radius_mm;
    const double chords_mm2 = 3 * kDeflection_mm * (240 + 2 * std::numbers::pi * radius_mm);
    EXPECT_EQ(compared(shape, settings(), 1000).uncovered, hole_mm2 > chords_mm2 ? 1 : 0) << radius_mm;
  }
}

TEST(Tessellation, ATriangleThatIsMissingOpensASolid) {
  const TopoDS_Shape shape = plate(0, 1);
  mesh(shape);
  setTriangles(faceAt(shape, 5), {{0, 0, 5}, {100, 0, 5}, {100, 20, 5}}, {{1, 2, 3}});
  const Tessellation found = compared(shape, settings(), 1000);
  EXPECT_EQ(found.uncovered, 1);
  EXPECT_EQ(found.open_edges, 3U);
  EXPECT_FALSE(found.isTrusted());
}

TEST(Tessellation, TrianglesOutsideOfTheirFacesBoundsAreSeen) {
  const TopoDS_Shape shape = plate(0, 1);
  mesh(shape);
  // Triangles with the same area, moved along the face.
  setTriangles(faceAt(shape, 5), {{1, 0, 5}, {101, 0, 5}, {101, 20, 5}, {1, 20, 5}}, {{1, 2, 3}, {1, 3, 4}});
  const Tessellation found = compared(shape, settings(), 1000);
  EXPECT_EQ(found.outside, 1);
  EXPECT_FALSE(found.isTrusted());
}

/// Faces without a solid, as in IGES.
TEST(Tessellation, LooseFacesThatCloseHaveTheirVolumeChecked) {
  BRepBuilderAPI_Sewing sewing(1e-3);
  for (TopExp_Explorer it(plate(2, 3), TopAbs_FACE); it.More(); it.Next()) sewing.Add(it.Current());
  sewing.Perform();
  const TopoDS_Shape shell = sewing.SewedShape();
  ASSERT_NE(shell.ShapeType(), TopAbs_SOLID);
  mesh(shell);
  const Tessellation right = compared(shell, settings(), 1000);
  EXPECT_TRUE(right.isTrusted()) << inWords(right, settings());
  // A face is turned inside out: each triangle is in its right place, but the volume is wrong.
  const TopoDS_Face top = faceAt(shell, 5);
  TopLoc_Location location;
  const Handle(Poly_Triangulation) own = BRep_Tool::Triangulation(top, location);
  for (int i = 1; i <= own->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    own->Triangle(i).Get(a, b, c);
    own->SetTriangle(i, Poly_Triangle(a, c, b));
  }
  const Tessellation wrong = compared(shell, settings(), 1000);
  EXPECT_FALSE(wrong.isTrusted());
  EXPECT_EQ(wrong.faults(), 0);
  EXPECT_NE(inWords(wrong, settings()).find("its volume differs"), std::string::npos);
}

}  // namespace
}  // namespace vps::scenes::import
