// SPDX-License-Identifier: BSD-3-Clause
// The assembly "rig" of named parts beside each other, written by Open CASCADE as STEP in millimetres.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "support/temporary_folder.h"

namespace vps::scenes {

class StepRig {
 public:
  StepRig() {
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    rig_ = shapes_->NewShape();
    TDataStd_Name::Set(rig_, "rig");
  }
  ~StepRig() { XCAFApp_Application::GetApplication()->Close(document_); }
  StepRig(const StepRig&) = delete;
  StepRig& operator=(const StepRig&) = delete;

  /// Adds a part, moved along x. Part and instance have the same name.
  void add(const TopoDS_Shape& shape, const char* name, double x_mm,
           const std::optional<Quantity_Color>& color = {}) {
    const TDF_Label part = shapes_->AddShape(shape, false);
    TDataStd_Name::Set(part, name);
    gp_Trsf shift;
    shift.SetTranslation(gp_Vec(x_mm, 0, 0));
    TDataStd_Name::Set(shapes_->AddComponent(rig_, part, TopLoc_Location(shift)), name);
    if (color) XCAFDoc_DocumentTool::ColorTool(document_->Main())->SetColor(part, *color, XCAFDoc_ColorSurf);
  }

  /// Writes the file and returns its text.
  std::string written(const std::string& file) {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    writer.SetColorMode(true);
    writer.SetNameMode(true);
    EXPECT_TRUE(writer.Transfer(document_, STEPControl_AsIs));
    EXPECT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
    return vps::test::bytesOf(file);
  }

 private:
  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  TDF_Label rig_;
};

}  // namespace vps::scenes
