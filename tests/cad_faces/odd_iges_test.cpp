// SPDX-License-Identifier: BSD-3-Clause
// IGES files with one oddity each: a red block and an L-shaped plate of known size are read with the right
// unit, place, name and colour; a file that lost geometry is refused.
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <array>
#include <sstream>

#include "support/odd_files.h"

namespace vps::scenes::odd {
namespace {

constexpr std::size_t kIgesSection = 72;  // the column of the section's letter, from 0

/// The lines of an IGES file, whose global section can be written anew.
struct IgesText {
  std::vector<std::string> lines;

  explicit IgesText(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
  }
  [[nodiscard]] std::string text(const std::string& end = "\n") const {
    std::string out;
    for (const std::string& line : lines) out += line + end;
    return out;
  }
  /// The text of the global section.
  [[nodiscard]] std::string global() const {
    std::string out;
    for (const std::string& line : lines)
      if (line[kIgesSection] == 'G') out += line.substr(0, kIgesSection);
    return out.substr(0, out.find_last_not_of(' ') + 1);
  }
  void setGlobal(const std::string& text) {
    const auto first =
        std::ranges::find_if(lines, [](const std::string& line) { return line[kIgesSection] == 'G'; });
    const auto at = first - lines.begin();
    std::erase_if(lines, [](const std::string& line) { return line[kIgesSection] == 'G'; });
    std::vector<std::string> anew;
    for (std::size_t from = 0; from < text.size(); from += kIgesSection) {
      std::string line = text.substr(from, kIgesSection);
      line.resize(kIgesSection, ' ');
      std::string number = std::to_string(anew.size() + 1);
      anew.push_back(line + "G" + std::string(7 - number.size(), ' ') + number);
    }
    std::string count = std::to_string(anew.size());
    lines.back().replace(8, 8, "G" + std::string(7 - count.size(), ' ') + count);
    lines.insert(lines.begin() + at, anew.begin(), anew.end());
  }
};

class OddIges : public OddFiles {
 protected:
  static std::string rig(bool is_solid) {
    IGESControl_Controller::Init();
    Interface_Static::SetIVal("write.iges.brep.mode", is_solid ? 1 : 0);
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    const auto add = [&](const TopoDS_Shape& shape, const char* name, const Color& color) {
      const TDF_Label part = shapes->AddShape(shape, false);
      TDataStd_Name::Set(part, name);
      XCAFDoc_DocumentTool::ColorTool(document->Main())
          ->SetColor(part, Quantity_Color(color[0], color[1], color[2], Quantity_TOC_RGB), XCAFDoc_ColorGen);
    };
    add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "block", kRed);
    BRepBuilderAPI_MakePolygon outline;
    for (const auto& [x, y] : {std::pair(100, 0), std::pair(130, 0), std::pair(130, 10), std::pair(110, 10),
                               std::pair(110, 30), std::pair(100, 30)})
      outline.Add(gp_Pnt(x, y, 0));
    outline.Close();
    add(BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()).Face(), gp_Vec(0, 0, 10)).Shape(),
        "ell", {0.2F, 0.5F, 0.8F});
    IGESCAFControl_Writer writer;
    writer.SetColorMode(true);
    writer.SetNameMode(true);
    EXPECT_TRUE(writer.Transfer(document));
    std::stringstream out;
    EXPECT_TRUE(writer.Write(out));
    XCAFApp_Application::GetApplication()->Close(document);
    Interface_Static::SetIVal("write.iges.brep.mode", 0);
    return out.str();
  }
  static std::vector<OddPart> parts(double unit_m = 1e-3) {
    return {oddBlock(unit_m, "block", kRed), oddEll(unit_m, "ell", Color{0.2F, 0.5F, 0.8F})};
  }
};

TEST_F(OddIges, FilesAreReadAsTheyAreMeant) {
  std::vector<OddFile> all;
  for (const bool is_solid : {true, false}) {
    const std::string kind = is_solid ? "solids, " : "trimmed surfaces, ";
    const IgesText sound(rig(is_solid));
    const std::string text = sound.text();
    const auto add = [&](const std::string& oddity, const std::string& bytes,
                         std::vector<OddPart> truth = parts()) -> OddFile& {
      all.push_back({kind + oddity, bytes, std::move(truth)});
      return all.back();
    };
    add("none", text);
    add("line ends of two bytes", sound.text("\r\n"));
    add("no line end at the end", text.substr(0, text.size() - 1));
    add("blank lines at the end", text + "\n\n   \n");
    add("many blank lines at the end", text + std::string(3000, '\n'));
    add("blanks behind the lines", sound.text("   \n"));
    add("a byte order mark", "\xef\xbb\xbf" + text);
    add("an extension in capitals", text).name = "ODD.IGS";
    add("another extension", text).name = "odd.dat";
    add("a unit of the settings that is not used", text).unit_m = 0.5;
    const auto withGlobal = [&](const std::string& from, const std::string& to) {
      IgesText changed = sound;
      changed.setGlobal(replacedOnce(sound.global(), from, to));
      return changed.text();
    };
    const std::pair<const char*, double> units[] = {{"1,4HINCH", 25.4e-3},   {"1,2HIN", 25.4e-3},
                                                    {"2,2HMM", 1e-3},        {"3,2HMM", 1e-3},
                                                    {"3,2HIN", 25.4e-3},     {"3,4HINCH", 25.4e-3},
                                                    {"3,2HFT", 0.3048},      {"3,1HM", 1},
                                                    {"3,2HCM", 1e-2},        {"3,2HUM", 1e-6},
                                                    {"3,3HMIL", 25.4e-6},    {"4,2HFT", 0.3048},
                                                    {"5,2HMI", 1609.344},    {"6,1HM", 1},
                                                    {"7,2HKM", 1e3},         {"8,3HMIL", 25.4e-6},
                                                    {"9,2HUM", 1e-6},        {"10,2HCM", 1e-2},
                                                    {"11,3HUIN", 25.4e-9},   {"2,", 1e-3},
                                                    {"1,", 25.4e-3},         {"6,", 1},
                                                    {"2,2Hmm", 1e-3},        {"10,10HCENTIMETER", 1e-2},
                                                    {"3,2Hmm", 1e-3},        {"3,4Hinch", 25.4e-3},
                                                    {"3,2Hin", 25.4e-3},     {"3,1Hm", 1},
                                                    {"3,2Hcm", 1e-2},        {"3,10HMILLIMETER", 1e-3},
                                                    {"3,6HINCHES", 25.4e-3}, {"3,3H MM", 1e-3}};
    for (const auto& [unit, unit_m] : units)
      add(std::string("unit ") + unit, withGlobal(",2,2HMM,", std::string(",") + unit + ","), parts(unit_m));
    for (const char* unit : {"3,2HXY", "3,4HYARD"}) {
      OddFile& odd = add(std::string("unknown unit ") + unit,
                         withGlobal(",2,2HMM,", std::string(",") + unit + ","), parts());
      odd.has_remark = true;
      add(std::string("given unit ") + unit, withGlobal(",2,2HMM,", std::string(",") + unit + ","),
          parts(1e-2))
          .unit_m = 1e-2;
    }
    IgesText long_start = sound;
    std::string note = "made by hand, with some words on how";
    note.resize(kIgesSection, ' ');
    long_start.lines[0] = note + long_start.lines[0].substr(kIgesSection);
    add("words at the start", long_start.text());
    IgesText d_exponents = sound;
    bool is_changed = false;
    for (std::string& line : d_exponents.lines)
      if (line[kIgesSection] == 'P')
        for (std::size_t at = 0;
             (at = line.find(",10.,", at)) != std::string::npos && line.find("    ") != std::string::npos;) {
          const std::size_t pad = line.find("    ");
          if (pad > 60) break;
          line.erase(pad, 3);
          line.replace(at, 5, ",1.0D+1,"), is_changed = true;
          line.resize(line.size());
          at += 5;
          break;
        }
    EXPECT_TRUE(is_changed);
    add("exponents of FORTRAN", d_exponents.text());
    add("small exponents of FORTRAN", replacedAll(d_exponents.text(), "1.0D+1", "1.0d+1"));
    add("small exponents", replacedAll(d_exponents.text(), "1.0D+1", "1.0e+1"));
    // What is lost is told.
    const auto refuse = [&](const std::string& oddity, const std::string& bytes, const std::string& lost) {
      add(oddity, bytes, {}).lost = lost;
    };
    refuse("cut", text.substr(0, text.size() / 2), "truncated");
    refuse("cut at the last section", text.substr(0, text.size() - 81), "truncated");
    IgesText no_parameters = sound;
    for (std::string& line : no_parameters.lines)
      if (line[kIgesSection] == 'P' && line.starts_with(is_solid ? "186," : "144,")) {
        line.replace(0, 4, is_solid ? "186;" : "144;");
        break;
      }
    refuse("a shape without parameters", no_parameters.text(), "cannot be read");
  }
  expectAll(all, "odd.igs");
}

}  // namespace
}  // namespace vps::scenes::odd
