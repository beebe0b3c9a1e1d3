// SPDX-License-Identifier: BSD-3-Clause
// IGES files with damaged entities are read exactly if no geometry is lost; otherwise they are refused, or
// the fault is reported.
#include <algorithm>
#include <map>
#include <sstream>

#include <BRepPrimAPI_MakeBox.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Quantity_Color.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "cad_faces/damaged_file.h"

namespace vps::scenes {
namespace {

using DamagedIges = DamagedFile;

/// The lines of an IGES file with a box of 10 x 20 x 30 mm, in the given unit.
std::vector<std::string> igesLines(const char* unit) {
  IGESControl_Controller::Init();
  IGESControl_Writer writer(unit, 1);
  writer.AddShape(BRepPrimAPI_MakeBox(10, 20, 30).Shape());
  writer.ComputeModel();
  std::stringstream out;
  EXPECT_TRUE(writer.Write(out));
  std::vector<std::string> lines;
  for (std::string line; std::getline(out, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines, const char* end) {
  std::string text;
  for (const std::string& line : lines) text.append(line).append(end);
  return text;
}

// References of the solid, a face and a point to line fonts, levels, views, labels and colours that do not
// exist.
TEST_F(DamagedIges, AFileIsReadInItsUnitWhateverItsStyles) {
  std::string error;
  for (const char* unit : {"MM", "CM", "M", "IN", "FT", "UM"}) {
    const std::vector<std::string> sound = igesLines(unit);
    const std::vector<Truth> truth = {{"box", 6e-6, Vec3::Zero()}};
    for (const char* end : {"\n", "\r\n"}) {
      const auto cad = read(joined(sound, end), error, "box.igs");
      ASSERT_TRUE(cad) << unit << ": " << error;
      expectSame(*cad, truth, true, unit);
    }
    for (const char* type : {"186", "510", "116"})
      for (const int field :
           {3, 4, 5, 7, 12}) {  // fields have eight columns; fields from 10 on are in the second line
        std::vector<std::string> lines = sound;
        auto line = std::ranges::find_if(lines, [&](const std::string& each) {
          return each.size() > 72 && each[72] == 'D' && each.substr(5, 3) == type;
        });
        ASSERT_NE(line, lines.end()) << type;
        if (field >= 10) ++line;
        line->replace(static_cast<std::size_t>(field % 10) * 8, 8, "  -99999");
        const std::string what = std::string(unit) + ", field " + std::to_string(field + 1) + " of a " + type;
        const auto cad = read(joined(lines, "\n"), error, "box.igs");
        EXPECT_TRUE(cad) << what << ": " << error;
        if (cad) expectSame(*cad, truth, true, what);
      }
  }
}

// A colour without a number in IGES is an entity; here a text replaces its red value.
TEST_F(DamagedIges, AColourThatIsDamagedIsNoGeometry) {
  IGESControl_Controller::Init();
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
  const TDF_Label box = XCAFDoc_DocumentTool::ShapeTool(document->Main())
                            ->AddShape(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), false);
  XCAFDoc_DocumentTool::ColorTool(document->Main())
      ->SetColor(box, Quantity_Color(0.3, 0.6, 0.1, Quantity_TOC_RGB), XCAFDoc_ColorGen);
  IGESCAFControl_Writer writer;
  ASSERT_TRUE(writer.Transfer(document));
  std::stringstream out;
  ASSERT_TRUE(writer.Write(out));
  XCAFApp_Application::GetApplication()->Close(document);
  std::string text = out.str();
  const std::size_t at = text.find("\n314,");
  ASSERT_NE(at, std::string::npos);
  const std::size_t from = at + 5, length = text.find(',', from) - from;
  ASSERT_GE(length, 3U);
  const std::string count = std::to_string(length - (length < 12 ? 2 : 3));
  text.replace(from, length, count + "H" + std::string(length - count.size() - 1, 'x'));
  std::string error;
  const auto cad = read(text, error, "box.igs");
  ASSERT_TRUE(cad) << error;
  EXPECT_NEAR(massProperties(cad->parts.at(0).mesh).volume_m3, 6e-6, 1e-14);
}

// Damages the parameters of one entity of each type of an IGES box, one after the other. If a text is in a
// list of vertices, Open CASCADE drops a face without a message; the import then reports the open edges.
TEST_F(DamagedIges, AFileIsReadWholeOrRefusedOrItsFaultIsTold) {
  std::vector<std::string> lines = igesLines("MM");
  constexpr std::size_t kData = 64, kSection = 72;  // columns
  std::map<std::string, int> count;
  std::string error;
  int refused = 0, read_whole = 0;
  for (std::string& line : lines) {
    if (line.size() <= kSection || line[kSection] != 'P' || line.find(';') > kData) continue;
    if (++count[line.substr(0, line.find(','))] > 2) continue;
    const std::string sound = line;
    for (std::size_t comma = sound.find(','); comma < kData; comma = sound.find(',', comma + 1)) {
      const std::size_t end = sound.find_first_of(",;", comma + 1);
      if (end > kData) break;
      const bool is_real = sound.substr(comma, end - comma).find('.') != std::string::npos;
      std::string data = sound.substr(0, comma + 1) + (is_real ? "4Htext" : "99999") + sound.substr(end);
      data.erase(data.find(';') + 1);
      if (data.size() > kData) continue;
      line = data + std::string(kData - data.size(), ' ') + sound.substr(kData);
      const auto cad = read(joined(lines, "\n"), error, "box.igs");
      ++(cad ? read_whole : refused);
      const bool is_told = cad && std::ranges::any_of(cad->warnings, [](const std::string& warning) {
                             return warning.find("part 'box'") != std::string::npos;
                           });
      if (cad && !is_told) expectSame(*cad, {{"box", 6e-6, Vec3::Zero()}}, false, data);
    }
    line = sound;
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(read_whole, 10);
}

}  // namespace
}  // namespace vps::scenes
