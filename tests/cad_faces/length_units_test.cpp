// SPDX-License-Identifier: BSD-3-Clause
// STEP and IGES files whose length unit is missing or invalid, and files with other notations of numbers.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include <BRepPrimAPI_MakeBox.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>

#include "cad_faces/damaged_file.h"
#include "occt/file_faults.h"

namespace vps::scenes {
namespace {

class LengthUnits : public DamagedFile {
 protected:
  /// A box of 10 x 20 x 30 in the given unit; each entity is one line.
  std::string step(const char* unit = "MM") {
    const std::string file = (folder_.path() / "sound.step").string();
    STEPControl_Writer writer;
    Interface_Static::SetCVal("write.step.unit", unit);
    EXPECT_EQ(writer.Transfer(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), STEPControl_ManifoldSolidBrep),
              IFSelect_RetDone);
    EXPECT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
    Interface_Static::SetCVal("write.step.unit", "MM");
    std::ifstream in(file, std::ios::binary);
    std::string text;
    for (std::string line; std::getline(in, line);) {
      const bool is_first = text.empty() || text.back() == '\n';
      text += line.substr(is_first ? 0 : std::min(line.find_first_not_of(' '), line.size()));
      if (line.ends_with(';')) text += '\n';
    }
    return text;
  }
  ImportedCad readIn(const std::string& text, std::optional<double> unit_m, const char* name = "box.step") {
    const std::string file = (folder_.path() / name).string();
    std::ofstream(file, std::ios::binary) << text;
    ImportSettings settings;
    settings.unit_m = unit_m;
    return importCad(file, settings);
  }
};

/// Replaces the text from `from` up to, but without, `end`.
std::string replacedFrom(std::string text, const std::string& from, const std::string& end,
                         const std::string& by) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, text.find(end, at) - at, by);
}

std::string withoutUnit(const std::string& step) {
  return replacedFrom(step, "( GEOMETRIC_REPRESENTATION_CONTEXT(3)", ";",
                      "GEOMETRIC_REPRESENTATION_CONTEXT('','',3)");
}

double volumeOf(const ImportedCad& cad) {
  return massProperties(cad.parts.at(0).mesh).volume_m3;
}

const char* const kAssumed =
    "states no unit of length: millimetres are assumed; set unit or --units for another unit";

TEST_F(LengthUnits, AStepFileWithoutOneIsInMillimetresOrInThatOfTheSettings) {
  const std::string sound = step();
  EXPECT_TRUE(readIn(sound, 25.4e-3).states_unit);
  EXPECT_NEAR(volumeOf(readIn(sound, 25.4e-3)), 6e-6, 1e-14);
  // The file without any units, and the file without the length unit.
  const std::size_t at = sound.find("GLOBAL_UNIT_ASSIGNED_CONTEXT((") + 30, comma = sound.find(',', at) + 1;
  for (const std::string& text : {withoutUnit(sound), std::string(sound).erase(at, comma - at)}) {
    const ImportedCad assumed = readIn(text, std::nullopt);
    EXPECT_FALSE(assumed.states_unit);
    EXPECT_EQ(assumed.warnings, std::vector<std::string>{kAssumed});
    EXPECT_NEAR(volumeOf(assumed), 6e-6, 1e-14);
    const ImportedCad given = readIn(text, 1e-2);
    EXPECT_FALSE(given.states_unit);
    EXPECT_TRUE(given.warnings.empty()) << given.warnings.front();
    EXPECT_NEAR(volumeOf(given), 6e-3, 1e-11);
  }
}

TEST_F(LengthUnits, AShapeWithoutOneBesideAnotherWithOneIsTold) {
  const std::string sound = step("INCH");
  const std::size_t solid = sound.find(" = MANIFOLD_SOLID_BREP("), from = sound.rfind('#', solid);
  const ImportedCad cad = readIn(
      replacedFrom(sound, "ENDSEC;\nEND-ISO", "END-ISO",
                   "#900100=ADVANCED_BREP_SHAPE_REPRESENTATION('',(" + sound.substr(from, solid - from) +
                       "),#900101);\n#900101=GEOMETRIC_REPRESENTATION_CONTEXT('','',3);\nENDSEC;\n"),
      std::nullopt);
  EXPECT_TRUE(cad.states_unit);
  EXPECT_NEAR(volumeOf(cad), 6000 * std::pow(25.4e-3, 3), 1e-9);
  EXPECT_NE(
      std::ranges::find(cad.warnings,
                        "1 shape states no unit of length, and is read in millimetres; the first: #900100"),
      cad.warnings.end());
}

TEST_F(LengthUnits, AFactorThatIsNotPositiveIsRefused) {
  const std::string sound = step("INCH");
  std::string error;
  ASSERT_TRUE(read(sound, error)) << error;
  const std::string measure = "LENGTH_MEASURE_WITH_UNIT(";
  for (const char* factor : {"0.", "-25.4", "-0."}) {
    EXPECT_FALSE(read(replacedFrom(sound, measure, ",", measure + factor), error)) << factor;
    EXPECT_NE(error.find("the conversion factor of its unit of length #"), std::string::npos) << error;
  }
}

TEST_F(LengthUnits, AnIgesFileThatNamesAnotherIsInMillimetresOrInThatOfTheSettings) {
  IGESControl_Controller::Init();
  IGESControl_Writer writer("MM", 1);
  writer.AddShape(BRepPrimAPI_MakeBox(10, 20, 30).Shape());
  writer.ComputeModel();
  std::stringstream out;
  ASSERT_TRUE(writer.Write(out));
  const std::string sound = out.str();
  const auto named = [&](const std::string& unit) { return replacedFrom(sound, ",2,2HMM,", ",1,", unit); };
  EXPECT_TRUE(readIn(named(",3,2HMM"), 1e-2, "box.igs").states_unit);
  const ImportedCad assumed = readIn(named(",3,2HXY"), std::nullopt, "box.igs");
  EXPECT_FALSE(assumed.states_unit);
  EXPECT_EQ(assumed.warnings, std::vector<std::string>{kAssumed});
  EXPECT_NEAR(volumeOf(assumed), 6e-6, 1e-14);
  EXPECT_NEAR(volumeOf(readIn(named(",3,2HXY"), 1e-2, "box.igs")), 6e-3, 1e-11);
}

TEST_F(LengthUnits, AByteOrderMarkAndSmallExponentsChangeNothing) {
  const std::string sound = step(), mark = "\xEF\xBB\xBF";
  std::string small = sound;
  for (const auto& [real, other] :
       {std::pair("10.", "1.0e1"), std::pair("20.", "2.e+01"), std::pair("30.", "300.e-1")})
    for (std::size_t at = 0; (at = small.find(real, at)) != std::string::npos; ++at)
      if (small[at - 1] == '(' || small[at - 1] == ',') small.replace(at, 3, other);
  ASSERT_NE(small, sound);
  std::string error;
  for (const std::string& text : {mark + sound, small, mark + small}) {
    const auto cad = read(text, error);
    ASSERT_TRUE(cad) << error;
    EXPECT_TRUE(cad->warnings.empty());
    EXPECT_NEAR(volumeOf(*cad), 6e-6, 1e-14);
  }
  const auto capitalized = [](std::string text) {
    const bool is_changed = import::capitalizeExponents(text);
    return (is_changed ? "changed " : "same ") + text;
  };
  EXPECT_EQ(capitalized("A('1.e5',2.e5,3e-1,/* ' 4.e5 */5.e+2);"),
            "changed A('1.e5',2.E5,3E-1,/* ' 4.e5 */5.E+2);");
  EXPECT_EQ(capitalized("e5,a.e,1.e,1e,1.E5,ce5,'it''s 1.e5'"), "same e5,a.e,1.e,1e,1.E5,ce5,'it''s 1.e5'");
}

}  // namespace
}  // namespace vps::scenes
