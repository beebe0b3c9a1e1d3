// SPDX-License-Identifier: BSD-3-Clause
// Parts whose faces have different colours: a box with six colours, written by Open CASCADE as STEP and as
// glTF.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_ProgressRange.hxx>
#include <RWGltf_CafWriter.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TColStd_IndexedDataMapOfStringString.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "vps_scenes/cad/import.h"
#include "vps_scenes/planning/plan.h"
#include "vps_viewer/draw/renderer.h"

namespace vps::scenes {
namespace {

// Colours of the faces that point to -x, x, -y, y, -z, z, which is the order of the faces in Open CASCADE's
// box.
constexpr std::array<Color, 6> kColors = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}}};

std::size_t faceOf(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::size_t>(2 * axis + (n[axis] > 0 ? 1 : 0));
}

class ColoredBox : public testing::Test {
 protected:
  void SetUp() override {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colors_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    XCAFApp_Application::GetApplication()->Close(document_);
    std::filesystem::remove_all(folder_);
  }

  static Quantity_Color inOcct(const Color& c) { return {c[0], c[1], c[2], Quantity_TOC_RGB}; }

  /// A box of which the first `count` faces have colours.
  TDF_Label box(std::size_t count = 6) {
    const TopoDS_Shape shape = BRepPrimAPI_MakeBox(gp_Pnt(-5, -10, -15), 10, 20, 30).Shape();
    BRepMesh_IncrementalMesh(shape, 0.1);
    const TDF_Label label = shapes_->AddShape(shape, false);
    std::size_t face = 0;
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More() && face < count; it.Next())
      colors_->SetColor(shapes_->AddSubShape(label, it.Current()), inOcct(kColors[face++]),
                        XCAFDoc_ColorSurf);
    return label;
  }
  std::string step() {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    writer.SetColorMode(true);
    const std::string file = (folder_ / "box.step").string();
    EXPECT_TRUE(writer.Transfer(document_, STEPControl_AsIs));
    EXPECT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
    return file;
  }
  std::string glb() {
    const std::string file = (folder_ / "box.glb").string();
    RWGltf_CafWriter writer(file.c_str(), true);
    writer.ChangeCoordinateSystemConverter().SetInputLengthUnit(1e-3);
    writer.ChangeCoordinateSystemConverter().SetInputCoordinateSystem(RWMesh_CoordinateSystem_Zup);
    EXPECT_TRUE(writer.Perform(document_, TColStd_IndexedDataMapOfStringString(), Message_ProgressRange()));
    return file;
  }

  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("vps_colors_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

Vec3 normalOf(const Mesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
}

/// Each triangle has the colour of the side that it faces.
void expectSixColors(const ImportedPart& part) {
  ASSERT_EQ(part.mesh.triangles.size(), 12U);
  ASSERT_EQ(part.face_colors.of_triangle.size(), 12U);
  EXPECT_EQ(part.face_colors.palette.size(), 6U);
  for (std::size_t i = 0; i < 12; ++i) {
    const Color &found = part.face_colors.at(i),
                &truth = kColors[faceOf(part.X_WP.R * normalOf(part.mesh, i))];
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], truth[k], 1e-3) << i;  // glTF writes few digits
  }
}

/// In a picture of each side, the middle has the colour of this side: a channel is bright if it is 1, and at
/// most as bright as the reflection of the sky if it is 0.
void expectSixColorsInPictures(const Scene& scene) {
  viewer::Renderer renderer(viewer::drawnMeshes(scene));
  Snapshot shot;
  shot.bodies = {{0, scene.parts[0].X_WP, BodyRole::Mounted}};
  viewer::DrawOptions options;
  options.width = options.height = 120;
  options.show_legend = options.show_ground = false;
  for (const bool is_draft : {false, true}) {
    options.is_draft = is_draft;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        const Vec3 n = side * Vec3::Unit(axis);
        viewer::Camera camera;
        camera.eye_W = 0.1 * n;
        camera.target_W = Vec3::Zero();
        camera.up_W = axis == 2 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ());
        const viewer::Image picture = renderer.render(shot, camera, options);
        const unsigned char* pixel = picture.at(60, 60);
        const Color& truth = kColors[faceOf(n)];
        for (std::size_t k = 0; k < 3; ++k) {
          if (truth[k] > 0.5f)
            EXPECT_GT(int{pixel[k]}, 150) << "axis " << axis << ", " << side;
          else
            EXPECT_LT(int{pixel[k]}, 110) << "axis " << axis << ", " << side;
        }
      }
  }
}

TEST_F(ColoredBox, OfAStepFileHasAColorOnEachSide) {
  box();
  const ImportedCad cad = importCad(step());
  ASSERT_EQ(cad.parts.size(), 1U);
  expectSixColors(cad.parts[0]);
  expectSixColorsInPictures(sceneOf(cad));
}

TEST_F(ColoredBox, OfAGltfFileHasAColorOnEachSide) {
  box();
  const ImportedCad cad = importCad(glb());
  ASSERT_EQ(cad.parts.size(), 1U);
  expectSixColors(cad.parts[0]);
  expectSixColorsInPictures(sceneOf(cad));
}

TEST_F(ColoredBox, HasItsOwnColorOnFacesWithout) {
  const TDF_Label label = box(2);
  colors_->SetColor(label, inOcct({0.2f, 0.3f, 0.4f}), XCAFDoc_ColorGen);
  const ImportedCad cad = importCad(step());
  const ImportedPart& part = cad.parts.at(0);
  ASSERT_EQ(part.face_colors.of_triangle.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    const std::size_t face = faceOf(normalOf(part.mesh, i));
    const Color truth = face < 2 ? kColors[face] : Color{0.2f, 0.3f, 0.4f};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(part.face_colors.at(i)[k], truth[k], 1e-3) << face;
  }
  EXPECT_NEAR(part.color[2], 0.4f, 1e-3);
}

TEST_F(ColoredBox, WithOneColorOnAllFacesHasOnlyThat) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  const TDF_Label label = shapes_->AddShape(shape, false);
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
    colors_->SetColor(shapes_->AddSubShape(label, it.Current()), inOcct(kColors[0]), XCAFDoc_ColorSurf);
  const ImportedCad cad = importCad(step());
  EXPECT_TRUE(cad.parts.at(0).face_colors.isNone());
  EXPECT_NEAR(cad.parts.at(0).color[0], 1, 1e-3);
  EXPECT_NEAR(cad.parts.at(0).color[1], 0, 1e-3);
}

}  // namespace
}  // namespace vps::scenes
