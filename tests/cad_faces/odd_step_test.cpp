// SPDX-License-Identifier: BSD-3-Clause
// STEP files with one or two oddities each: a red block and a blue L-shaped plate of known size are read with
// the right unit, place, name and colour; a file that lost geometry is refused.
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <algorithm>
#include <cctype>
#include <sstream>

#include "cad_faces/step_rig.h"
#include "support/odd_files.h"

namespace vps::scenes::odd {
namespace {

TopoDS_Shape ellShape() {
  BRepBuilderAPI_MakePolygon outline;
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(30, 0), std::pair(30, 10), std::pair(10, 10),
                             std::pair(10, 30), std::pair(0, 30)})
    outline.Add(gp_Pnt(x, y, 0));
  outline.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()).Face(), gp_Vec(0, 0, 10)).Shape();
}

/// The text with one entity a line, and without what the writer numbers anew in each process.
std::string oneEntityALine(const std::string& text) {
  std::string out;
  bool is_first = true;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    out += line.substr(is_first ? 0 : std::min(line.find_first_not_of(' '), line.size()));
    is_first = line.ends_with(';');
    if (is_first) out += '\n';
  }
  return out;
}

class OddStep : public OddFiles {
 protected:
  /// The assembly "rig" of the two parts, in millimetres.
  std::string rig() {
    const auto inColor = [](const Color& color) {
      return Quantity_Color(color[0], color[1], color[2], Quantity_TOC_RGB);
    };
    StepRig rig;
    rig.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "block", 0, inColor(kRed));
    rig.add(ellShape(), "ell", 100, inColor({0.25F, 0.5F, 0.75F}));
    return oneEntityALine(rig.written((folder_.path() / "sound.step").string()));
  }
  /// The block alone, in another representation.
  std::string block(STEPControl_StepModelType type) {
    STEPControl_Writer writer;
    const std::string file = (folder_.path() / "block.step").string();
    EXPECT_EQ(writer.Transfer(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), type), IFSelect_RetDone);
    EXPECT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
    return oneEntityALine(vps::test::bytesOf(file));
  }
  static std::vector<OddPart> parts(double unit_m = 1e-3) {
    return {oddBlock(unit_m, "block", kRed), oddEll(unit_m, "ell", Color{0.25F, 0.5F, 0.75F})};
  }
  static std::vector<OddPart> named(const std::string& block, const std::string& ell = "ell") {
    std::vector<OddPart> all = parts();
    all[0].name = block;
    all[1].name = ell;
    return all;
  }
  void readAll(std::vector<OddFile> all) { expectAll(all, "odd.step"); }
};

std::string withEntities(const std::string& text, const std::string& lines) {
  return replacedOnce(text, "ENDSEC;\nEND-ISO", lines + "\nENDSEC;\nEND-ISO");
}
/// The line of the first entity with this text in it.
std::string lineWith(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  const std::size_t from = text.rfind('\n', at) + 1;
  return text.substr(from, text.find('\n', at) + 1 - from);
}
std::string withoutLine(const std::string& text, const std::string& part) {
  return replacedOnce(text, lineWith(text, part), "");
}
/// The text with another first parameter in the block's names of product and instance.
std::string withName(const std::string& text, const std::string& name) {
  return replacedAll(text, "'block'", name);
}
std::string reversedEntities(const std::string& text) {
  const std::size_t from = text.find("DATA;\n") + 6, end = text.find("ENDSEC;\nEND-ISO");
  std::string out;
  for (std::size_t at = from; at < end;) {
    const std::size_t next = text.find('\n', at) + 1;
    out.insert(0, text.substr(at, next - at));
    at = next;
  }
  return text.substr(0, from) + out + text.substr(end);
}
/// The text with entity numbers that are greater by `by`.
std::string renumbered(const std::string& text, std::size_t by) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    if (text[i] != '#') continue;
    std::size_t end = i + 1;
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
    out += std::to_string(std::stoul(text.substr(i + 1, end - i - 1)) + by);
    i = end - 1;
  }
  return out;
}

TEST_F(OddStep, LayoutOfTheTextChangesNothing) {
  const std::string s = rig();
  const std::string header = s.substr(0, s.find("DATA;"));
  std::string one_line = replacedAll(s, "\n", "");
  readAll({
      {"none", s, parts()},
      {"line ends of two bytes", replacedAll(s, "\n", "\r\n"), parts()},
      {"line ends of old computers", replacedAll(s, "\n", "\r"), parts()},
      {"one line", one_line, parts()},
      {"no line end at the end", s.substr(0, s.size() - 1), parts()},
      {"tabs", replacedAll(s, ",", ",\t"), parts()},
      {"blanks around everything",
       replacedAll(replacedAll(replacedAll(s, " = ", "   =   "), ",#", " , #"), ";\n", " ; \n"), parts()},
      {"no blanks", replacedAll(s, " = ", "="), parts()},
      {"a line for each parameter", replacedAll(s, ",#", ",\n#"), parts()},
      {"comments between entities", replacedAll(s, ";\n#", ";\n/* it's an entity; #1 = */\n#"), parts()},
      {"comments within entities", replacedAll(s, ",#", ",/* # */#"), parts()},
      {"comments of several lines", replacedAll(s, ";\n#2", ";\n/*\n * two\n * lines **/\n#2"), parts()},
      {"a comment before the header", "/* made by hand */\n" + s, parts()},
      {"blank lines before the header", "\n\n  " + s, parts()},
      {"blank lines at the end", s + std::string(3000, '\n'), parts()},
      {"zero bytes at the end", s + std::string(2048, '\0'), parts()},
      {"a byte order mark", "\xef\xbb\xbf" + s, parts()},
      {"a byte order mark and line ends of two bytes", "\xef\xbb\xbf" + replacedAll(s, "\n", "\r\n"),
       parts()},
      {"small exponents", replacedAll(replacedAll(s, "(10.,", "(1.e1,"), "1.E-07", "1.e-07"), parts()},
      {"signs", replacedAll(s, "(10.,", "(+10.,"), parts()},
      {"integers for reals", replacedAll(s, "10.,", "10,"), parts()},
      {"many digits", replacedAll(s, "10.,", "10.00000000000000000000000,"), parts()},
      {"entities in reverse order", reversedEntities(s), {parts()[1], parts()[0]}},
      {"great numbers of entities", renumbered(s, 1000000000), parts()},
      {"numbers of entities beyond 32 bits", renumbered(s, 5000000000), parts()},
      {"numbers of entities with zeros before", replacedAll(replacedAll(s, "#1 ", "#0001 "), "#1,", "#0001,"),
       parts()},
      {"an extension in capitals", s, parts(), "", false, "ODD.STP"},
      {"another extension", s, parts(), "", false, "odd.txt"},
      {"blanks and umlauts in the name", s, parts(), "", false, "odd \xc3\xa4 (1).step"},
      {"the schema of 1994",
       replacedAll(
           s, s.substr(s.find("FILE_SCHEMA"), s.find(";", s.find("FILE_SCHEMA")) - s.find("FILE_SCHEMA")),
           "FILE_SCHEMA(('CONFIG_CONTROL_DESIGN'))"),
       parts()},
      {"the schema of 2014",
       replacedAll(
           s, s.substr(s.find("FILE_SCHEMA"), s.find(";", s.find("FILE_SCHEMA")) - s.find("FILE_SCHEMA")),
           "FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }'))"),
       parts()},
      {"a schema that nobody knows",
       replacedAll(
           s, s.substr(s.find("FILE_SCHEMA"), s.find(";", s.find("FILE_SCHEMA")) - s.find("FILE_SCHEMA")),
           "FILE_SCHEMA(('MY_SCHEMA'))"),
       parts()},
      {"more in the header",
       replacedOnce(s, "ENDSEC;\nDATA;",
                    "FILE_POPULATION('A','B',$);\nSECTION_LANGUAGE($,'de');\nENDSEC;\nDATA;"),
       parts()},
      {"names of the header of another encoding",
       replacedOnce(s, "'Author'",
                    "'Gr\xf6\xdf"
                    "e'"),
       parts()},
      {"data with parameters", replacedOnce(s, "DATA;", "DATA('one',('AUTOMOTIVE_DESIGN'));"), parts()},
      {"an anchor section", replacedOnce(s, "DATA;", "ANCHOR;\n<a>=#1;\nENDSEC;\nDATA;"), parts()},
      {"a reference section", replacedOnce(s, "DATA;", "REFERENCE;\nENDSEC;\nDATA;"), parts()},
      {"a signature", s + "SIGNATURE\n" + std::string(2000, 'A') + "\nENDSEC;\n", parts()},
      {"two data sections",
       replacedOnce(s, lineWith(s, "PLANE("), "ENDSEC;\nDATA;\n" + lineWith(s, "PLANE(")), parts()},
  });
}

TEST_F(OddStep, NamesAreRead) {
  const std::string s = rig();
  readAll({
      {"an escape of 16 bits", withName(s, "'W\\X2\\00E4\\X0\\lz'"), named("W\xc3\xa4lz")},
      {"an escape of several characters", withName(s, "'\\X2\\677F4E00\\X0\\'"),
       named("\xe6\x9d\xbf\xe4\xb8\x80")},
      {"an escape of 32 bits", withName(s, "'a\\X4\\0001F600\\X0\\'"), named("a\xf0\x9f\x98\x80")},
      {"an escape of 8 bits", withName(s, "'W\\X\\E4lz'"), named("W\xc3\xa4lz")},
      {"an escape of a page", withName(s, "'W\\S\\dlz'"), named("W\xc3\xa4lz")},
      {"UTF-8", withName(s, "'W\xc3\xa4lz'"), named("W\xc3\xa4lz")},
      {"a quote", withName(s, "'it''s'"), named("it's")},
      {"double quotes", withName(s, "'a \"b\"'"), named("a \"b\"")},
      {"a slash", withName(s, "'a/b'"), named("a/b")},
      {"a backslash", withName(s, "'a\\\\b'"), named("a\\b")},
      {"signs of comments", withName(s, "'a/*b*/'"), named("a/*b*/")},
      {"a number sign", withName(s, "'block #12'"), named("block #12")},
      {"a semicolon and brackets", withName(s, "'a;(b),c'"), named("a;(b),c")},
      {"a long name", withName(s, "'" + std::string(400, 'n') + "'"), named(std::string(400, 'n'))},
      {"a name on two lines", withName(s, "'bl\nock'"), named("block")},
      {"equal names", replacedAll(s, "'ell'", "'block'"), named("block", "block_2")},
      {"empty names", withName(s, "''"), named("rig")},
      {"blanks for a name", withName(s, "' '"), named("rig")},
      {"no name", withName(s, "$"), named("rig"), "", true},
      {"a name that is a number", withName(s, "3"), named("rig"), "", true},
      {"a counter of the instance", replacedOnce(s, "'block'", "'block:3'"), named("block")},
      {"leading and trailing blanks", withName(s, "'block '"), named("block")},
  });
}

TEST_F(OddStep, UnitsAreKept) {
  const std::string s = rig();
  const std::string unit = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) )";
  std::vector<OddFile> all;
  for (const auto& [prefix, unit_m] :
       {std::pair("$", 1.0), std::pair(".CENTI.", 1e-2), std::pair(".DECI.", 0.1), std::pair(".MICRO.", 1e-6),
        std::pair(".KILO.", 1e3)})
    all.push_back({std::string("prefix ") + prefix,
                   replacedAll(s, ".MILLI.,.METRE.", std::string(prefix) + ",.METRE."), parts(unit_m)});
  const auto converted = [&](const std::string& name, const std::string& factor, const std::string& of) {
    return withEntities(
        replacedAll(s, unit,
                    "( CONVERSION_BASED_UNIT('" + name + "',#900001) LENGTH_UNIT() NAMED_UNIT(#900003) )"),
        "#900001 = LENGTH_MEASURE_WITH_UNIT(" + factor + ",#900002);\n#900002 = " + of +
            ";\n#900003 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);");
  };
  const std::string metre = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.) )",
                    centi = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.CENTI.,.METRE.) )";
  for (const char* name : {"INCH", "inch", "IN", "Zoll", ""}) {
    all.push_back({std::string("inches of millimetres called ") + name,
                   converted(name, "LENGTH_MEASURE(25.4)", unit), parts(25.4e-3)});
    all.push_back({std::string("inches of metres called ") + name,
                   converted(name, "LENGTH_MEASURE(0.0254)", metre), parts(25.4e-3)});
  }
  all.push_back({"inches of centimetres", converted("INCH", "LENGTH_MEASURE(2.54)", centi), parts(25.4e-3)});
  all.push_back({"feet", converted("FOOT", "LENGTH_MEASURE(0.3048)", metre), parts(0.3048)});
  all.push_back({"mils", converted("MIL", "LENGTH_MEASURE(0.0254)", unit), parts(25.4e-6)});
  all.push_back({"millimetres of metres", converted("MILLIMETRE", "LENGTH_MEASURE(1.E-3)", metre), parts()});
  all.push_back(
      {"a factor of another kind", converted("INCH", "POSITIVE_LENGTH_MEASURE(25.4)", unit), parts(25.4e-3)});
  all.push_back(
      {"feet of inches",
       withEntities(
           converted("FOOT", "LENGTH_MEASURE(12.)",
                     "( CONVERSION_BASED_UNIT('INCH',#900004) LENGTH_UNIT() NAMED_UNIT(#900003) )"),
           "#900004 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#900005);\n#900005 = " + unit + ";"),
       parts(0.3048)});
  // The block has a context of its own, as each part has.
  std::vector<OddPart> both = {oddBlock(25.4e-3, "block", kRed), oddEll(1e-3)};
  const std::string solid = lineWith(s, "ADVANCED_BREP_SHAPE_REPRESENTATION(");
  const std::string own = solid.substr(0, solid.rfind(',') + 1) + "#900010);\n";
  all.push_back(
      {"two units in one file",
       withEntities(replacedOnce(s, solid, own),
                    "#900010 = ( GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#900011)) "
                    "REPRESENTATION_CONTEXT('','') );\n"
                    "#900011 = ( CONVERSION_BASED_UNIT('INCH',#900012) LENGTH_UNIT() NAMED_UNIT(#900014) );\n"
                    "#900012 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#900013);\n#900013 = " +
                        unit + ";\n#900014 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);"),
       both});
  const std::string radian = "( NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.) )";
  const std::string degree = replacedAll(
      s, radian, "( CONVERSION_BASED_UNIT('DEGREE',#900020) NAMED_UNIT(#900021) PLANE_ANGLE_UNIT() )");
  const std::string of_degree =
      "#900020 = PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.01745329252),#900022);\n#900021 = "
      "DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.);\n#900022 = " +
      radian + ";";
  all.push_back({"degrees", withEntities(degree, of_degree), parts()});
  all.push_back({"degrees of a name in small letters",
                 withEntities(replacedAll(degree, "DEGREE", "degree"), of_degree), parts()});
  all.push_back({"degrees without exponents",
                 withEntities(replacedAll(degree, "NAMED_UNIT(#900021)", "NAMED_UNIT(*)"), of_degree),
                 parts(), "", true});
  all.push_back(
      {"degrees of another measure",
       withEntities(degree, replacedAll(of_degree, "PLANE_ANGLE_MEASURE_WITH_UNIT", "MEASURE_WITH_UNIT")),
       parts()});
  const std::string solid_angle = lineWith(s, "SOLID_ANGLE_UNIT()");
  all.push_back({"no solid angle",
                 replacedAll(replacedOnce(s, solid_angle, ""),
                             "," + solid_angle.substr(0, solid_angle.find(' ')) + ")", ")"),
                 parts()});
  all.push_back({"a unit of the settings that is not used", s, parts(), "", false, "", 25.4e-3});
  readAll(all);
}

TEST_F(OddStep, ColorsAndStylesAreRead) {
  const std::string s = rig();
  const std::string red = "COLOUR_RGB('',1.,0.,0.)";
  const std::string used = s.find(red) != std::string::npos ? red : "DRAUGHTING_PRE_DEFINED_COLOUR('red')";
  const auto colored = [&](const std::string& by) { return replacedAll(s, used, by); };
  const auto withColor = [&](const Color& color) {
    std::vector<OddPart> all = parts();
    all[0].color = color;
    return all;
  };
  std::vector<OddFile> all;
  for (const auto& [name, color] : {std::pair("red", kRed), std::pair("green", kGreen),
                                    std::pair("blue", kBlue), std::pair("yellow", Color{1, 1, 0}),
                                    std::pair("magenta", Color{1, 0, 1}), std::pair("cyan", Color{0, 1, 1}),
                                    std::pair("black", Color{0, 0, 0}), std::pair("white", Color{1, 1, 1})})
    all.push_back({std::string("predefined ") + name,
                   colored(std::string("DRAUGHTING_PRE_DEFINED_COLOUR('") + name + "')"), withColor(color)});
  all.push_back(
      {"predefined, in capitals", colored("DRAUGHTING_PRE_DEFINED_COLOUR('RED')"), withColor(kRed)});
  all.push_back(
      {"predefined of the general kind", colored("PRE_DEFINED_COLOUR('green')"), withColor(kGreen)});
  all.push_back({"a named colour", colored("COLOUR_RGB('my red',1.,0.,0.)"), withColor(kRed)});
  all.push_back({"integers in a colour", colored("COLOUR_RGB('',0,1,0)"), withColor(kGreen)});
  all.push_back(
      {"a colour a little beyond 1", colored("COLOUR_RGB('',1.0000001,0.,-1.E-9)"), withColor(kRed)});
  all.push_back({"a colour of 0 to 255", colored("COLOUR_RGB('',255.,0.,0.)"), withColor(kRed)});
  std::vector<OddPart> uncolored = parts();
  uncolored[0].color = ImportedPart().color;
  all.push_back(
      {"a colour without numbers", colored("COLOUR_RGB('',$,$,$)"), {oddBlock(1e-3), parts()[1]}, "", true});
  all.push_back({"a colour that nobody knows", colored("MY_COLOUR('x')"), uncolored, "", true});
  for (const char* line :
       {"STYLED_ITEM('',(#900101),#900102);", "STYLED_ITEM('color',(),$);",
        "OVER_RIDING_STYLED_ITEM('',(#900101),#900102,#900103);", "DRAUGHTING_PRE_DEFINED_COLOUR(3);",
        "DRAUGHTING_PRE_DEFINED_CURVE_FONT(7);",
        "CURVE_STYLE('',#900101,POSITIVE_LENGTH_MEASURE(0.1),#900102);",
        "POINT_STYLE('',#900101,POSITIVE_LENGTH_MEASURE(0.1),#900102);",
        "POINT_STYLE('',MARKER_TYPE(.BLOB.),$,$);", "FILL_AREA_STYLE('',(#900101));",
        "SURFACE_STYLE_USAGE(.SIDEWAYS.,#900101);", "PRESENTATION_LAYER_ASSIGNMENT('1','',(#900101));",
        "INVISIBILITY((#900101));", "DATE_AND_TIME(#900101,#900102);",
        "PERSON_AND_ORGANIZATION(#900101,#900102);", "APPROVAL(#900101,'');",
        "SECURITY_CLASSIFICATION('','',#900101);", "SHAPE_ASPECT('','',#900101,.T.);",
        "DATUM('','',#900101,.F.,'A');", "MY_THING_OF_ANOTHER_VENDOR(#900101,.X.);"})
    all.push_back({line, withEntities(s, std::string("#900100 = ") + line), parts(), "", true});
  for (const char* line :
       {"DRAUGHTING_PRE_DEFINED_COLOUR('mauve');", "DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous');",
        "DRAUGHTING_PRE_DEFINED_CURVE_FONT('my font');", "PRE_DEFINED_POINT_MARKER_SYMBOL('asterisk');",
        "CURVE_STYLE_FONT('',(#900101));\n#900101 = CURVE_STYLE_FONT_PATTERN(1.,1.);",
        "APPROVAL_STATUS('approved');", "DESCRIPTIVE_REPRESENTATION_ITEM('a','b');",
        "POINT_STYLE('',MARKER_TYPE(.DOT.),POSITIVE_LENGTH_MEASURE(0.1),#900101);\n#900101 = "
        "COLOUR_RGB('',1.,1.,0.);"})
    all.push_back({line, withEntities(s, std::string("#900100 = ") + line), parts()});
  const std::string styled = lineWith(s, "STYLED_ITEM(");
  const std::string number = styled.substr(0, styled.find(' '));
  all.push_back({"an invisible part", withEntities(s, "#900100 = INVISIBILITY((" + number + "));"), parts()});
  all.push_back(
      {"an opacity",
       replacedAll(s, "SURFACE_SIDE_STYLE('',(", "SURFACE_SIDE_STYLE('',(#900100,")
           .insert(s.find("DATA;\n") + 6,
                   "#900100 = "
                   "SURFACE_STYLE_RENDERING_WITH_PROPERTIES(.NORMAL_SHADING.,#900101,(#900102));\n#900101 = "
                   "COLOUR_RGB('',0.,1.,0.);\n#900102 = SURFACE_STYLE_TRANSPARENT(0.5);\n"),
       {oddBlock(1e-3), oddEll(1e-3)}});
  readAll(all);
}

TEST_F(OddStep, OtherRepresentationsOfOneSolidAreRead) {
  const std::vector<OddPart> truth = {oddBlock(1e-3, "odd")};
  std::vector<OddFile> all;
  int number = 0;
  for (const STEPControl_StepModelType type : {STEPControl_AsIs, STEPControl_ManifoldSolidBrep,
                                               STEPControl_FacetedBrep, STEPControl_ShellBasedSurfaceModel})
    all.push_back({"representation " + std::to_string(number++), block(type), truth});
  readAll(all);
}

TEST_F(OddStep, WhatIsLostIsTold) {
  const std::string s = rig();
  const auto without = [&](const std::string& kind) { return withoutLine(s, kind + "("); };
  std::vector<OddFile> all;
  for (const char* kind :
       {"CARTESIAN_POINT('',(0.,0.,30.))", "VERTEX_POINT('',", "EDGE_CURVE('',", "LINE('',",
        "ORIENTED_EDGE('',", "EDGE_LOOP('',", "FACE_BOUND('',", "PLANE('',", "ADVANCED_FACE('',",
        "CLOSED_SHELL('',", "MANIFOLD_SOLID_BREP('',", "ITEM_DEFINED_TRANSFORMATION('',"})
    all.push_back(
        {std::string("without ") + kind, withoutLine(s, kind), {}, "of its geometry cannot be read"});
  all.push_back({"a surface that nobody knows",
                 replacedOnce(s, "PLANE('',", "MY_SURFACE('',"),
                 {},
                 "of its geometry cannot be read"});
  all.push_back({"without a placement", without("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION"), {}, "place"});
  all.push_back({"cut", s.substr(0, s.size() / 2), {}, "truncated"});
  all.push_back(
      {"without data", s.substr(0, s.find("DATA;")) + "DATA;\nENDSEC;\nEND-ISO-10303-21;\n", {}, "odd.step"});
  readAll(all);
}

}  // namespace
}  // namespace vps::scenes::odd
