// SPDX-License-Identifier: BSD-3-Clause
// Products as STEP files: trees, names, several solids in one product, and faults.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax2.hxx>

#include "vps/errors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {
namespace {

/// A tree of products, written as STEP. Lengths in millimetres.
class Product : public testing::Test {
 protected:
  void SetUp() override {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
  }
  void TearDown() override {
    XCAFApp_Application::GetApplication()->Close(document_);
    std::filesystem::remove(file_);
  }

  static void setName(const TDF_Label& label, const std::string& utf8) {
    TDataStd_Name::Set(label, TCollection_ExtendedString(utf8.c_str(), true));
  }
  TDF_Label part(const TopoDS_Shape& shape, const std::string& name) {
    const TDF_Label label = shapes_->AddShape(shape, false);
    setName(label, name);
    return label;
  }
  TDF_Label assembly(const std::string& name) {
    const TDF_Label label = shapes_->NewShape();
    setName(label, name);
    return label;
  }
  void place(const TDF_Label& in, const TDF_Label& what, const gp_Vec& at, const std::string& name = "") {
    gp_Trsf shift;
    shift.SetTranslation(at);
    const TDF_Label component = shapes_->AddComponent(in, what, TopLoc_Location(shift));
    if (!name.empty()) setName(component, name);
  }
  ImportedCad written() {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    writer.SetNameMode(true);
    EXPECT_TRUE(writer.Transfer(document_, STEPControl_AsIs));
    EXPECT_EQ(writer.Write(file_.c_str()), IFSelect_RetDone);
    return importCad(file_.string());
  }
  static TopoDS_Shape box(double size, double x = 0) {
    return BRepPrimAPI_MakeBox(gp_Pnt(x, 0, 0), size, size, size).Shape();
  }
  static std::vector<std::string> namesOf(const ImportedCad& cad) {
    std::vector<std::string> names;
    for (const ImportedPart& one : cad.parts) names.push_back(one.name);
    return names;
  }

  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() /
      ("vps_product_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".step");
};

using Names = std::vector<std::string>;

TEST_F(Product, OfTwelveSolidsIsOneGroupBesideItsSocket) {
  TopoDS_Compound solids;
  const BRep_Builder builder;
  builder.MakeCompound(solids);
  for (int i = 0; i < 12; ++i) builder.Add(solids, box(2, 2 * i));  // each solid touches the next solid
  const TDF_Label plug = part(solids, "plug"), socket = part(box(30), "socket"), all = assembly("product");
  place(all, socket, gp_Vec(0, 0, 0));
  place(all, plug, gp_Vec(0, 0, 40));
  place(all, plug, gp_Vec(0, 40, 40));
  ImportedCad cad = written();
  ASSERT_EQ(cad.parts.size(), 25U);
  const std::vector<PartGroup> groups = partGroups(cad, {});
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].name, "plug");
  EXPECT_EQ(groups[1].name, "plug_2_2");  // "plug_2" is a solid of the first group
  for (const PartGroup& group : groups) EXPECT_EQ(group.parts.size(), 12U);
  EXPECT_EQ(cad.parts[0].within, (Names{"product", "socket"}));
  EXPECT_EQ(partGroups(cad, {.is_proposed = false, .names = {"product"}})[0].parts.size(), 25U);
}

TEST_F(Product, WithMangledInstanceNamesHasThoseOfItsProducts) {
  const TDF_Label bolt = part(BRepPrimAPI_MakeCylinder(3, 20).Shape(), "bolt M6"), all = assembly("unit");
  place(all, bolt, gp_Vec(0, 0, 0), "NAUO12");
  place(all, bolt, gp_Vec(20, 0, 0), "bolt M6:2");
  place(all, bolt, gp_Vec(40, 0, 0), "left bolt");
  place(all, bolt, gp_Vec(60, 0, 0), "5f0c1a7e-90d2-4c3b-8a11-6e0f33a1b2c4");
  EXPECT_EQ(namesOf(written()), (Names{"bolt M6", "bolt M6_2", "left bolt", "bolt M6_3"}));
}

TEST_F(Product, NamesThatClashOrAreNotAsciiAreKeptAndUnique) {
  const std::string greek = "\xce\xb2\xce\xac\xcf\x83\xce\xb7";
  const TDF_Label all = assembly(greek);
  place(all, part(box(5), greek), gp_Vec(0, 0, 0), greek);
  place(all, part(box(6), greek), gp_Vec(10, 0, 0), greek);
  place(all, part(box(7), "a/b\\c\"d"), gp_Vec(20, 0, 0));
  const ImportedCad cad = written();
  EXPECT_EQ(namesOf(cad), (Names{greek, greek + "_2", "a/b\\c\"d"}));
  EXPECT_NE(cad.parts[0].within, cad.parts[1].within);
}

TEST_F(Product, AnAssemblyWithoutPartsIsRefusedInWords) {
  const TDF_Label all = assembly("nothing"), inner = assembly("inner");
  place(all, inner, gp_Vec(0, 0, 0));
  try {
    written();
    ADD_FAILURE() << "was read";
  } catch (const LoadError& error) {
    EXPECT_EQ(std::string(error.what()).find("crashed"), std::string::npos) << error.what();
  }
}

TEST_F(Product, AnEmptyAssemblyBesidePartsIsNothing) {
  const TDF_Label all = assembly("product"), inner = assembly("inner");
  place(all, inner, gp_Vec(0, 0, 0));
  place(all, part(box(5), "block"), gp_Vec(0, 0, 0));
  EXPECT_EQ(namesOf(written()), Names{"block"});
}

// A ball needs four times as many triangles for a quarter of the deflection, a box needs no more.
TEST_F(Product, DeflectionFollowsThePart) {
  const TDF_Label all = assembly("product");
  place(all, part(BRepPrimAPI_MakeCylinder(200, 5).Shape(), "disc"), gp_Vec(0, 0, 0));
  place(all, part(box(5), "block"), gp_Vec(0, 0, 50));
  written();
  ImportSettings settings;
  const ImportedCad fine = importCad(file_.string(), settings);
  settings.most_triangles = fine.parts[0].mesh.triangles.size() / 3;
  const ImportedCad cad = importCad(file_.string(), settings);
  ASSERT_EQ(cad.parts.size(), 2U);
  EXPECT_LE(cad.parts[0].mesh.triangles.size(), settings.most_triangles);
  EXPECT_GT(*cad.parts[0].deflection_m, settings.deflection_m);
  EXPECT_EQ(*cad.parts[1].deflection_m, settings.deflection_m);
  ASSERT_EQ(cad.warnings.size(), 1U);
  EXPECT_NE(cad.warnings[0].find("'disc': is read within"), std::string::npos) << cad.warnings[0];
}

}  // namespace
}  // namespace vps::scenes
