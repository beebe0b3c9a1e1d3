// SPDX-License-Identifier: BSD-3-Clause
// STEP files with one damaged or unknown entity are read exactly if no geometry is lost, and refused
// otherwise.
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>

#include "cad_faces/damaged_file.h"
#include "cad_faces/step_rig.h"
#include "occt/file_faults.h"

namespace vps::scenes {
namespace {

/// An assembly of a red box of 10 x 20 x 30 mm at 100 mm along x, a cylinder, and optionally a cone.
class DamagedEntities : public DamagedFile {
 protected:
  std::string written(bool has_cone, bool has_pin = true) {
    StepRig rig;
    rig.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "box", 100, Quantity_Color(1, 0, 0, Quantity_TOC_RGB));
    if (has_pin) rig.add(BRepPrimAPI_MakeCylinder(5, 20).Shape(), "pin", 0);
    if (has_cone) rig.add(BRepPrimAPI_MakeCone(5, 2, 20).Shape(), "cone", 200);
    return rig.written((folder_.path() / "sound.step").string());
  }

  std::vector<Truth> truthOf(const std::string& text) {
    std::string error;
    const auto cad = read(text, error);
    EXPECT_TRUE(cad) << error;
    if (!cad) return {};
    EXPECT_TRUE(cad->warnings.empty()) << cad->warnings.front();
    EXPECT_NEAR(massProperties(cad->parts.at(0).mesh).volume_m3, 6e-6, 1e-15);
    EXPECT_NEAR(cad->parts.at(0).X_WP.p.x(), 0.1, 1e-12);
    EXPECT_NEAR(cad->parts.at(0).color[0], 1, 1e-5);
    return factsOf(*cad);
  }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string withLines(const std::string& text, const std::string& lines) {
  return replaced(text, "ENDSEC;\nEND-ISO", lines + "\nENDSEC;\nEND-ISO");
}

/// An instance of one type, with the places of its parameters in the text.
struct Instance {
  std::string type;
  std::vector<std::pair<std::size_t, std::size_t>> parameters;  ///< from, length
};

/// The instances in a DATA section, each with its type; in (A() B()) each type is an instance of its own.
std::vector<Instance> instancesOf(const std::string& text) {
  std::vector<Instance> found;
  const auto isWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = text.find("DATA;"); at < text.size(); ++at) {
    if (text[at] == '\'') at = text.find('\'', at + 1);  // a string of this file has no quote in it
    if (at == std::string::npos || text[at] != '(' || !isWord(text[at - 1])) continue;
    std::size_t word = at;
    while (isWord(text[word - 1])) --word;
    Instance one{text.substr(word, at - word), {}};
    int depth = 0;
    std::size_t from = at + 1, end = at;
    for (; end < text.size(); ++end) {
      if (text[end] == '\'') end = text.find('\'', end + 1);
      depth += text[end] == '(' ? 1 : text[end] == ')' ? -1 : 0;
      if ((text[end] == ',' && depth == 1) || depth == 0) {
        one.parameters.emplace_back(from, end - from);
        from = end + 1;
      }
      if (depth == 0) break;
    }
    found.push_back(std::move(one));
  }
  return found;
}

TEST_F(DamagedEntities, WhatIsNoGeometryIsReadWithARemark) {
  const std::string sound = written(true);
  const std::vector<Truth> truth = truthOf(sound);
  // Lines that are added, and whether a remark is expected.
  const std::vector<std::pair<std::string, bool>> lines = {
      {"DRAUGHTING_PRE_DEFINED_COLOUR('red');", false},
      {"DRAUGHTING_PRE_DEFINED_COLOUR(3);", true},
      {"CONVERSION_BASED_UNIT('DEGREE',#99999);", true},
      {"(CONVERSION_BASED_UNIT('DEGREE',#99999)NAMED_UNIT(*)PLANE_ANGLE_UNIT());", true},
      {"STYLED_ITEM('',(#99999),#99998);", true},
      {"OVER_RIDING_STYLED_ITEM('',(#99999),#99998,#99997);", true},
      {"CURVE_STYLE('',#99999,POSITIVE_LENGTH_MEASURE(0.02),#99998);", true},
      {"CURVE_STYLE('',#900101,POSITIVE_LENGTH_MEASURE(0.02),$);\n#900101=MY_CURVE_FONT('x');", true},
      {"POINT_STYLE('',#900101,$,$);\n#900101=PRE_DEFINED_POINT_MARKER_SYMBOL('asterisk');", true},
      {"POINT_STYLE('',MARKER_TYPE(.BLOB.),$,$);", true},
      {"COLOUR_RGB('','much',0.,0.);", true},
      {"PRESENTATION_STYLE_ASSIGNMENT((#99999));", true},
      {"PRESENTATION_LAYER_ASSIGNMENT('1',$,(#99999));", true},
      {"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#99999),#99998);", true},
      {"DIMENSIONAL_SIZE(#99999,'diameter');", true},
      {"GEOMETRIC_TOLERANCE('','',#99999,#99998);", true},
      {"PROPERTY_DEFINITION('','',#99999);", true},
      {"PROPERTY_DEFINITION_REPRESENTATION(#99999,#99998);", true},
      {"CALENDAR_DATE(2020,1.5,'x');", true},
      {"PERSON(1,2,3,$,$,$);", true},
      {"ADVANCED_FACE('',(#99999),#99998,.F.);", true},  // this face belongs to no shape
      {"CARTESIAN_POINT('',('here'));", true},
      {"SOMETHING_THAT_NOBODY_KNOWS('a',#99999,3.);", true},
      {"(SOMETHING_ELSE('a')THAT_NOBODY_KNOWS(3.));", false},
  };
  std::string error;
  for (const auto& [line, has_remark] : lines) {
    const auto cad = read(withLines(sound, "#900100=" + line), error);
    ASSERT_TRUE(cad) << line << ": " << error;
    expectSame(*cad, truth, true, line);
    EXPECT_NEAR(cad->parts[0].color[0], 1, 1e-5) << line;
    ASSERT_EQ(cad->warnings.size(), has_remark ? 1U : 0U) << line;
    for (const std::string& remark : cad->warnings)
      EXPECT_TRUE(remark.starts_with("1 entity cannot be read, so that names")) << remark;
  }
}

/// The text with another item in the first representation of a solid.
std::string withItem(const std::string& text, const std::string& lines) {
  const std::size_t at = text.find(')', text.find("ADVANCED_BREP_SHAPE_REPRESENTATION("));
  return withLines(std::string(text).insert(at, ",#900100"), "#900100=" + lines);
}

TEST_F(DamagedEntities, AnItemOfAnUnknownKindIsReadOnlyIfItIsNoShape) {
  const std::string sound = written(false);
  const std::vector<Truth> truth = truthOf(sound);
  std::string error;
  for (const char* item : {"MY_ANNOTATION('note',(1.,2.));", "ANNOTATION_PLACEHOLDER_OCCURRENCE('',(),$);",
                           "TESSELLATED_ANNOTATION('',#99999);", "MY_PLACEMENT('');",
                           "ANNOTATION_TEXT_OCCURRENCE('',(#99999),#99998);"}) {
    const auto cad = read(withItem(sound, item), error);
    ASSERT_TRUE(cad) << item << ": " << error;
    expectSame(*cad, truth, true, item);
    EXPECT_EQ(cad->warnings.size(), 1U) << item;
  }
  for (const char* kind : {"TESSELLATED_SOLID", "SWEPT_DISK_SOLID", "MY_SOLID"}) {
    EXPECT_FALSE(read(withItem(sound, std::string(kind) + "('',(1.,2.));"), error)) << kind;
    EXPECT_NE(error.find(std::string(kind) + " is of a kind that is not read"), std::string::npos) << error;
  }
  EXPECT_FALSE(read(withItem(sound, "CARTESIAN_POINT('',#99999);"), error));
  EXPECT_FALSE(
      read(replaced(withItem(sound, "X();"), "#900100=X();", ""), error));  // the entity is not in the file
}

TEST_F(DamagedEntities, ASolidOfAPrimitiveKindIsLeftOutWithAWarning) {
  const std::string sound = written(false);
  const std::vector<Truth> truth = truthOf(sound);
  const std::size_t at = sound.find(" = AXIS2_PLACEMENT_3D("), from = sound.rfind('#', at);
  std::string error;
  const auto cad = read(withItem(sound, "BLOCK(''," + sound.substr(from, at - from) + ",1.,2.,3.);"), error);
  ASSERT_TRUE(cad) << error;
  expectSame(*cad, truth, true, "block");
  ASSERT_EQ(cad->warnings.size(), 1U);
  EXPECT_NE(cad->warnings[0].find("1 solid is left out"), std::string::npos) << cad->warnings[0];
  EXPECT_EQ(cad->missing, cad->warnings[0]);
  EXPECT_NE(cad->warnings[0].find("(Block) is of a kind that is not read"), std::string::npos)
      << cad->warnings[0];
}

TEST_F(DamagedEntities, ATessellationBesideTheExactShapeIsNotNeeded) {
  const std::string sound = written(false);
  const std::vector<Truth> truth = truthOf(sound);
  const std::size_t at = sound.find(" = ADVANCED_BREP_SHAPE_REPRESENTATION("), from = sound.rfind('#', at);
  const std::string brep = sound.substr(from, at - from);
  const std::string tessellation =
      "\n#900101=TESSELLATED_SHAPE_REPRESENTATION('',(#900102),#900103);"
      "\n#900102=TESSELLATED_SOLID('',$,$);\n#900103=MY_CONTEXT('');";
  std::string error;
  for (const std::string& both : {brep + ",#900101", "#900101," + brep}) {
    const auto cad = read(
        withLines(sound, "#900100=SHAPE_REPRESENTATION_RELATIONSHIP('',''," + both + ");" + tessellation),
        error);
    ASSERT_TRUE(cad) << error;
    expectSame(*cad, truth, true, both);
    EXPECT_EQ(cad->warnings.size(), 1U);
  }
  EXPECT_FALSE(
      read(withLines(sound, "#900100=SHAPE_REPRESENTATION_RELATIONSHIP('',''," + brep + ",#99999);"), error));
}

TEST_F(DamagedEntities, AnInstanceWithoutAPlacementIsRefused) {
  const std::string sound = written(false);
  std::string error;
  int count = 0;
  for (std::size_t at = 0;
       (at = sound.find("= CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(", at + 1)) != std::string::npos; ++count) {
    EXPECT_FALSE(read(std::string(sound).insert(at + 2, "MY_"), error));
    EXPECT_NE(error.find("1 instance of a part has no placement; the first: "), std::string::npos) << error;
    const std::size_t from = sound.rfind('#', at), end = sound.find(';', at) + 1;
    EXPECT_FALSE(read(std::string(sound).erase(from, end - from), error));
    EXPECT_NE(error.find("1 instance of a part has no placement"), std::string::npos) << error;
  }
  EXPECT_EQ(count, 2);
  // A product that has no shape needs no placement.
  const auto numberOf = [&](const char* type) {
    const std::size_t at = sound.find(std::string(" = ") + type), from = sound.rfind('#', at);
    return sound.substr(from, at - from);
  };
  const auto cad = read(withLines(sound,
                                  "#900100=PRODUCT_DEFINITION('','',#900101,#900103);\n"
                                  "#900101=PRODUCT_DEFINITION_FORMATION('','',#900102);\n"
                                  "#900102=PRODUCT('grease','grease','',(" +
                                      numberOf("PRODUCT_CONTEXT(") +
                                      "));\n#900103=PRODUCT_DEFINITION_CONTEXT('part definition'," +
                                      numberOf("APPLICATION_CONTEXT(") +
                                      ",'design');\n#900104=NEXT_ASSEMBLY_USAGE_OCCURRENCE('9','',''," +
                                      numberOf("PRODUCT_DEFINITION(") + ",#900100,$);"),
                        error);
  ASSERT_TRUE(cad) << error;
  EXPECT_EQ(cad->parts.size(), 2U);
}

// Damages a reference designator and the unit of an uncertainty.
TEST_F(DamagedEntities, DamageBesideTheShapeIsARemark) {
  const std::string sound = written(false);
  const std::vector<Truth> truth = truthOf(sound);
  std::string error;
  const std::vector<Instance> instances = instancesOf(sound);
  for (const auto& [type, parameter, damage] : {std::tuple("NEXT_ASSEMBLY_USAGE_OCCURRENCE", 5U, "5"),
                                                std::tuple("UNCERTAINTY_MEASURE_WITH_UNIT", 1U, "#99999")}) {
    const auto found = std::ranges::find(instances, type, &Instance::type);
    ASSERT_NE(found, instances.end()) << type;
    const auto [from, length] = found->parameters.at(parameter);
    const auto cad = read(std::string(sound).replace(from, length, damage), error);
    ASSERT_TRUE(cad) << type << ": " << error;
    expectSame(*cad, truth, true, type);
    EXPECT_EQ(cad->warnings.size(), 1U) << type;
  }
}

// Numbers of entities are read for any header, up to any size, and with comments after them.
TEST_F(DamagedEntities, NumbersOfEntitiesAreReadAsTheyAre) {
  const std::string sound = written(false);
  const std::vector<Truth> truth = truthOf(sound);
  const auto renumbered = [&](std::uint64_t more, std::uint64_t times) {
    std::string out;
    for (std::size_t at = 0; at < sound.size(); ++at) {
      out += sound[at];
      if (sound[at] != '#') continue;
      std::size_t length = 0;
      const std::uint64_t number = std::stoull(sound.substr(at + 1, 20), &length);
      out += std::to_string(number * times + more);
      at += length;
    }
    return out;
  };
  const std::string trap = replaced(sound, "('Author')", "('EXPORTED DATA;')");
  std::string commented = sound;
  for (std::size_t at = 0; (at = commented.find(" = ", at)) != std::string::npos; at += 13)
    commented.replace(at, 3, " /* c' */ = ");
  std::string error;
  for (const std::string& text :
       {trap, commented, renumbered(0, 1000), renumbered(1'999'999'990, 1), renumbered(2'100'000'000, 1),
        renumbered(std::uint64_t{1} << 32, 1), renumbered(7, 10'000'000'000)}) {
    const auto cad = read(text, error);
    ASSERT_TRUE(cad) << error;
    expectSame(*cad, truth, true, text.substr(0, 2000));
    EXPECT_TRUE(cad->warnings.empty());
    // The text without one point.
    const std::size_t at = text.find(" CARTESIAN_POINT("), from = text.rfind('\n', text.rfind('#', at)) + 1;
    EXPECT_FALSE(read(std::string(text).erase(from, text.find(';', at) + 1 - from), error));
    EXPECT_NE(error.find("of its geometry cannot be read"), std::string::npos) << error;
  }
}

TEST_F(DamagedEntities, ANameThatIsNoStringLosesTheNameAlone) {
  const std::string sound = written(true);
  const std::vector<Truth> truth = truthOf(sound);
  std::set<std::string> done;
  std::string error;
  for (const Instance& instance : instancesOf(sound)) {
    const auto [from, length] = instance.parameters.front();
    if (sound[from] != '\'' || !done.insert(instance.type).second) continue;
    for (const char* other : {"$", "5", ".NAME."}) {
      const std::string what = instance.type + "(" + other;
      const auto cad = read(std::string(sound).replace(from, length, other), error);
      EXPECT_TRUE(cad) << what << ": " << error;
      if (cad) expectSame(*cad, truth, false, what);
    }
  }
  EXPECT_GT(done.size(), 25U);
}

TEST_F(DamagedEntities, AnAngleUnitThatIsDamagedIsReadUnlessTheShapeDependsOnIt) {
  const std::string with_cone = written(true);
  const auto inDegrees = [](const std::string& text, const std::string& exponents,
                            const std::string& factor) {
    const std::string from = "( NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.) )";
    std::string out = text;
    for (std::size_t at = out.find(from); at != std::string::npos; at = out.find(from, at + 1))
      out.replace(at, from.size(),
                  "( CONVERSION_BASED_UNIT('DEGREE'," + factor + ") NAMED_UNIT(" + exponents +
                      ") PLANE_ANGLE_UNIT() )");
    return withLines(
        out,
        "#900100=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(1.745329251994E-2),#900101);\n"
        "#900101=( NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.) );\n"
        "#900102=DIMENSIONAL_EXPONENTS(0.E0,0.E0,0.E0,0.E0,0.E0,0.E0,0.E0);");
  };
  std::string error;
  const auto sound_degrees = read(inDegrees(with_cone, "#900102", "#900100"), error);
  ASSERT_TRUE(sound_degrees) << error;
  for (const char* exponents : {"*", "#99999", "$", "5"}) {
    const auto cad = read(inDegrees(with_cone, exponents, "#900100"), error);
    ASSERT_TRUE(cad) << exponents << ": " << error;
    expectSame(*cad, factsOf(*sound_degrees), true, exponents);
  }
  EXPECT_FALSE(read(inDegrees(with_cone, "#900102", "#99999"), error));
  EXPECT_NE(error.find("conversion_factor"), std::string::npos) << error;
  // A box does not depend on angles, unless a surface is trimmed by parameters.
  const std::string box = inDegrees(written(false, false), "#900102", "#99999");
  const auto cad = read(box, error);
  ASSERT_TRUE(cad) << error;
  EXPECT_NEAR(massProperties(cad->parts.at(0).mesh).volume_m3, 6e-6, 1e-14);
  const std::size_t at = box.find(" = PLANE("), from = box.rfind('#', at);
  const std::string plane = box.substr(from, at - from);
  EXPECT_FALSE(read(withLines(std::string(box).replace(from, at - from, "#900103"),
                              plane + "=RECTANGULAR_TRIMMED_SURFACE('',#900103,-99.,99.,-99.,99.,.T.,.T.);"),
                    error));
  EXPECT_NE(error.find("conversion_factor"), std::string::npos) << error;
}

TEST_F(DamagedEntities, LostGeometryIsRefused) {
  const std::string sound = written(true);
  // Types, each with the indices of the parameters that are geometry.
  const std::vector<std::pair<std::string, std::vector<std::size_t>>> places = {
      {"ADVANCED_FACE", {1, 2, 3}},
      {"FACE_BOUND", {1, 2}},
      {"EDGE_LOOP", {1}},
      {"ORIENTED_EDGE", {3, 4}},
      {"EDGE_CURVE", {1, 2, 3, 4}},
      {"VERTEX_POINT", {1}},
      {"CARTESIAN_POINT", {1}},
      {"DIRECTION", {1}},
      {"VECTOR", {1, 2}},
      {"LINE", {1, 2}},
      {"CIRCLE", {1, 2}},
      {"PLANE", {1}},
      {"CYLINDRICAL_SURFACE", {1, 2}},
      {"CONICAL_SURFACE", {1, 2, 3}},
      {"AXIS2_PLACEMENT_3D", {1}},
      {"CLOSED_SHELL", {1}},
      {"MANIFOLD_SOLID_BREP", {1}},
      {"ADVANCED_BREP_SHAPE_REPRESENTATION", {1, 2}},
      {"SHAPE_DEFINITION_REPRESENTATION", {0, 1}},
      {"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", {0, 1}},
      {"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", {0}},
      {"ITEM_DEFINED_TRANSFORMATION", {2, 3}},
      {"NEXT_ASSEMBLY_USAGE_OCCURRENCE", {3, 4}},
      {"GLOBAL_UNIT_ASSIGNED_CONTEXT", {0}},
  };
  std::map<std::string, Instance> first_of;
  for (const Instance& instance : instancesOf(sound)) first_of.emplace(instance.type, instance);
  std::string error;
  for (const auto& [type, parameters] : places) {
    ASSERT_TRUE(first_of.contains(type)) << type;
    for (const std::size_t k : parameters)
      for (const std::string& damage :
           {std::string("#99999"), std::string("'text'"), std::string("#900100")}) {
        const auto [from, length] = first_of.at(type).parameters.at(k);
        // In a list, the last entry is damaged.
        const bool is_list = sound[from] == '(';
        const std::size_t at = is_list ? sound.find_last_of("(,", from + length - 2) + 1 : from;
        const std::size_t end = from + length - (is_list ? 1 : 0);
        std::string text = std::string(sound).replace(at, end - at, damage);
        if (damage == "#900100") text = withLines(text, "#900100=KIND_THAT_NOBODY_KNOWS('',3.);");
        EXPECT_FALSE(read(text, error)) << type << ", parameter " << k + 1 << " is " << damage;
      }
  }
  // Entities that are missing, or whose type is unknown.
  for (const char* type : {"VERTEX_POINT", "ADVANCED_FACE", "CLOSED_SHELL", "MANIFOLD_SOLID_BREP", "CIRCLE",
                           "EDGE_CURVE", "PLANE", "ADVANCED_BREP_SHAPE_REPRESENTATION"}) {
    std::string text = sound;
    const std::size_t at = text.find(std::string(" = ") + type + "(") + 3;
    EXPECT_FALSE(read(std::string(text).insert(at, "MY_"), error)) << type;
    const std::size_t from = text.rfind('#', at), to = text.find(';', at) + 1;
    EXPECT_FALSE(read(text.erase(from, to - from), error)) << type;
    EXPECT_NE(error.find("of its geometry cannot be read"), std::string::npos) << error;
  }
}

// One entity of each type, and each entity of the assembly. Open CASCADE must not use another entity in its
// place.
TEST_F(DamagedEntities, AMissingEntityIsNotReplacedByAnother) {
  const std::string sound = written(false);
  const std::vector<Truth> truth = truthOf(sound);
  std::string error;
  std::map<std::string, int> count;
  int refused = 0, read_whole = 0;
  for (std::size_t at = sound.find("DATA;"); (at = sound.find("\n#", at)) != std::string::npos; ++at) {
    const std::size_t type = sound.find_first_not_of("= (", sound.find(' ', at)), end = sound.find(";\n", at);
    const std::string name = sound.substr(type, sound.find_first_of("( ", type) - type);
    const bool is_of_assembly = name.find("PRODUCT") != std::string::npos ||
                                name.find("ASSEMBLY") != std::string::npos ||
                                name.find("REPRESENTATION") != std::string::npos;
    if (++count[name] > 2 && !is_of_assembly) continue;
    const std::string what = sound.substr(at + 1, end - at);
    const auto cad = read(std::string(sound).erase(at, end + 1 - at), error);
    ++(cad ? read_whole : refused);
    if (cad && cad->parts.size() < truth.size())  // the shape belongs to no product
      EXPECT_NE(cad->warnings.at(0).find("belongs to no product that is placed"), std::string::npos) << what;
    else if (cad)
      expectSame(*cad, truth, false, what);
  }
  EXPECT_GT(refused, 40);
  EXPECT_GT(read_whole, 3);
}

// Wherever the damage is, the parts that are read must equal the parts of the sound file.
TEST_F(DamagedEntities, NoDamageGivesAnotherVolumeOrPlace) {
  const std::string sound = written(false);
  const std::vector<Truth> truth = truthOf(sound);
  std::map<std::string, int> count;
  std::string error;
  int refused = 0, read_whole = 0;
  for (const Instance& instance : instancesOf(sound)) {
    if (++count[instance.type] > 1) continue;
    for (const auto& [from, length] : instance.parameters) {
      if (length == 0) continue;
      for (const char* damage : {"#99999", "'text'"}) {
        if (sound[from] == '\'' && damage[0] == '\'') continue;
        const std::string what = instance.type + ": " + sound.substr(from, length) + " is " + damage;
        const auto cad = read(std::string(sound).replace(from, length, damage), error);
        ++(cad ? read_whole : refused);
        if (cad) expectSame(*cad, truth, false, what);
      }
    }
  }
  EXPECT_GT(refused, 60);
  EXPECT_GT(read_whole, 60);
}

TEST_F(DamagedEntities, LostReferencesAreFoundInAnyText) {
  using import::withReadableNumbers;
  const std::string head = "ISO-10303-21;HEADER;FILE_NAME('#9 DATA;');ENDSEC;DATA;";
  EXPECT_EQ(withReadableNumbers(head + "#1=A('#7',#2);#2 =B(/* #8 */ $);"), std::nullopt);
  EXPECT_EQ(withReadableNumbers(head + "#1=A('it''s #7',(#2,#3));#2=B(#1);"),
            head + "#1=A('it''s #7',(#2,#2000000000));#2=B(#1);");
  EXPECT_EQ(withReadableNumbers(head + "#1=A(#99999999999999999999,#,##2);"),
            head + "#1=A(#2000000000,#,##2000000000);");
  EXPECT_EQ(withReadableNumbers(head + "#2000000000=A(#3);"), head + "#2000000000=A(#1999999999);");
  EXPECT_EQ(withReadableNumbers(head + "#4294967301=A(#5);#5=B(#4294967301);"),
            head + "#1999999999=A(#5);#5=B(#1999999999);");
  EXPECT_EQ(withReadableNumbers(head + "#53 /* ' #4 */ = A(#53);"), head + "#53= A(#53);");
}

}  // namespace
}  // namespace vps::scenes
