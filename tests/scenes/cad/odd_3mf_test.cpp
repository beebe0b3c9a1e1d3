// SPDX-License-Identifier: BSD-3-Clause
// 3MF files with one oddity each: a block and an L-shaped plate of known size are read with the right unit,
// place, name and colour. Files with damages and extensions are in import_3mf_test.cpp.
#include <functional>

#include "lib3mf/stored_archive.h"
#include "support/odd_files.h"

namespace vps::scenes::odd {
namespace {

/// A 3MF file of the two parts, whose pieces can be changed.
struct Odd3mf {
  std::string unit = " unit=\"millimeter\"", resources, block = R"(name="block")", ell = R"(name="ell")",
              triangles;
  std::string more_objects,
      items = R"(<item objectid="1"/><item objectid="2" transform="1 0 0 0 1 0 0 0 1 100 0 0"/>)";
  std::string head = R"(<?xml version="1.0" encoding="UTF-8"?>)", metadata, more_attributes;
  std::string path = "3D/3dmodel.model", target = "/3D/3dmodel.model", types, relations;
  std::vector<std::pair<std::string, std::string>> files;
  std::function<std::string(std::string)> edited;

  static std::string mesh(const Mesh& mesh, const std::string& attributes) {
    std::string text = "<mesh><vertices>";
    for (const Vec3& p : mesh.vertices)
      text += "<vertex x=\"" + std::to_string(p.x()) + "\" y=\"" + std::to_string(p.y()) + "\" z=\"" +
              std::to_string(p.z()) + "\"/>";
    text += "</vertices><triangles>";
    for (const auto& t : mesh.triangles)
      text += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
              std::to_string(t[2]) + "\"" + attributes + "/>";
    return text + "</triangles></mesh>";
  }
  [[nodiscard]] std::string bytes() const {
    std::string model =
        head + "<model" + unit +
        R"( xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02")" +
        more_attributes + ">" + metadata + "<resources>" + resources + R"(<object id="1" type="model" )" +
        block + ">" + mesh(oddBlockMesh(), triangles) + R"(</object><object id="2" type="model" )" + ell +
        ">" + mesh(oddEllMesh(), "") + "</object>" + more_objects + "</resources><build>" + items +
        "</build></model>";
    if (edited) model = edited(model);
    import::StoredArchive zip;
    zip.add(
        "[Content_Types].xml",
        R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>)" +
            types + "</Types>");
    zip.add(
        "_rels/.rels",
        R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" Target=")" +
            target + "\"/>" + relations + "</Relationships>");
    zip.add(path, model);
    for (const auto& [name, text] : files) zip.add(name, text);
    return std::move(zip).finish();
  }
};

class Odd3mfFiles : public OddFiles {};

TEST_F(Odd3mfFiles, AreReadAsTheyAreMeant) {
  const std::string file = (folder_.path() / "first.3mf").string();
  vps::test::write(file, Odd3mf().bytes());
  try {
    importCad(file);
  } catch (const LoadError& e) {
    if (std::string(e.what()).find("build again") != std::string::npos)
      GTEST_SKIP() << "this build has no lib3mf";
  }
  const auto parts = [](double unit_m = 1e-3, const std::string& block = "block",
                        const std::string& ell = "ell", std::optional<Color> color = {}) {
    return std::vector<OddPart>{oddBlock(unit_m, block, color), oddEll(unit_m, ell)};
  };
  std::vector<OddFile> all;
  const auto add = [&](const std::string& oddity, const std::function<void(Odd3mf&)>& change,
                       std::vector<OddPart> truth) -> OddFile& {
    Odd3mf odd;
    change(odd);
    all.push_back({oddity, odd.bytes(), std::move(truth)});
    return all.back();
  };
  const std::pair<const char*, double> units[] = {{"micron", 1e-6},     {"millimeter", 1e-3},
                                                  {"centimeter", 1e-2}, {"inch", 25.4e-3},
                                                  {"foot", 0.3048},     {"meter", 1.0}};
  for (const auto& [unit, unit_m] : units) {
    add(
        unit, [&](Odd3mf& f) { f.unit = std::string(" unit=\"") + unit + "\""; }, parts(unit_m));
    add(
        std::string(unit) + ", and a unit of the settings",
        [&](Odd3mf& f) { f.unit = std::string(" unit='") + unit + "'"; }, parts(unit_m))
        .unit_m = 0.5;
  }
  add(
      "no unit", [](Odd3mf& f) { f.unit = ""; }, parts());
  add(
      "a component",
      [](Odd3mf& f) {
        f.more_objects =
            R"(<object id="3" type="model" name="rig"><components><component objectid="1"/><component objectid="2" transform="1 0 0 0 1 0 0 0 1 100 0 0"/></components></object>)";
        f.items = R"(<item objectid="3"/>)";
      },
      parts());
  add(
      "components of components",
      [](Odd3mf& f) {
        f.more_objects =
            R"(<object id="3" type="model" name="inner"><components><component objectid="2" transform="1 0 0 0 1 0 0 0 1 60 0 0"/></components></object><object id="4" type="model" name="rig"><components><component objectid="1"/><component objectid="3" transform="1 0 0 0 1 0 0 0 1 40 0 0"/></components></object>)";
        f.items = R"(<item objectid="4"/>)";
      },
      parts());
  add("an object that is built twice",
      [](Odd3mf& f) { f.items += R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 50 0"/>)"; },
      {oddBlock(1e-3), oddEll(1e-3), {"block_2", Vec3(0, 0.05, 0), Vec3(0.01, 0.07, 0.03), 6e-6, {}}});
  add("an object that is not built", [](Odd3mf& f) { f.items = R"(<item objectid="1"/>)"; },
      {oddBlock(1e-3)});
  add("a scale", [](Odd3mf& f) { f.items = R"(<item objectid="1" transform="2 0 0 0 2 0 0 0 2 0 0 0"/>)"; },
      {oddBlock(2e-3)});
  add("a mirror",
      [](Odd3mf& f) { f.items = R"(<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 10 0 0"/>)"; },
      {oddBlock(1e-3)});
  add("a turn", [](Odd3mf& f) { f.items = R"(<item objectid="1" transform="0 1 0 -1 0 0 0 0 1 20 0 0"/>)"; },
      {{"block", Vec3::Zero(), Vec3(0.02, 0.01, 0.03), 6e-6, {}}});
  add("attributes of items",
      [](Odd3mf& f) { f.items = R"(<item objectid="1" partnumber="A-1" printable="0"/>)"; },
      {oddBlock(1e-3)});
  add(
      "no names", [](Odd3mf& f) { f.block = f.ell = ""; }, parts(1e-3, "odd", "odd_2"));
  add(
      "empty names", [](Odd3mf& f) { f.block = R"(name="")"; }, parts(1e-3, "odd"));
  add(
      "equal names", [](Odd3mf& f) { f.ell = f.block; }, parts(1e-3, "block", "block_2"));
  add(
      "part numbers beside names", [](Odd3mf& f) { f.block += R"( partnumber="A-1")"; }, parts());
  add(
      "entities in names", [](Odd3mf& f) { f.block = R"(name="a/b &quot;c&quot; &amp; &#228;")"; },
      parts(1e-3, "a/b \"c\" & \xc3\xa4"));
  add(
      "a name of another script", [](Odd3mf& f) { f.block = "name='\xe6\x9d\xbf'"; },
      parts(1e-3, "\xe6\x9d\xbf"));
  add(
      "a long name", [](Odd3mf& f) { f.block = "name=\"" + std::string(300, 'n') + '"'; },
      parts(1e-3, std::string(300, 'n')));
  for (const char* color : {"#FF0000", "#ff0000", "#FF0000FF", "#FF000080"})
    for (const bool is_base : {false, true})
      add(
          std::string(is_base ? "a base material " : "a colour group ") + color,
          [&](Odd3mf& f) {
            f.resources = is_base ? std::string(R"(<basematerials id="5"><base name="x" displaycolor=")") +
                                        color + R"("/></basematerials>)"
                                  : std::string(R"(<m:colorgroup id="5"><m:color color=")") + color +
                                        R"("/></m:colorgroup>)";
            f.block += R"( pid="5" pindex="0")";
          },
          parts(1e-3, "block", "ell", kRed));
  add(
      "colours of triangles",
      [](Odd3mf& f) {
        f.resources =
            R"(<m:colorgroup id="5"><m:color color="#00FF00"/><m:color color="#FF0000"/></m:colorgroup>)";
        f.block += R"( pid="5" pindex="0")";
        f.triangles = R"( pid="5" p1="1")";
      },
      parts(1e-3, "block", "ell", kRed));
  add(
      "a material without use",
      [](Odd3mf& f) {
        f.resources = R"(<basematerials id="5"><base name="x" displaycolor="#FF0000"/></basematerials>)";
      },
      parts(1e-3, "block", "ell", ImportedPart().color));
  add(
      "metadata",
      [](Odd3mf& f) {
        f.metadata = R"(<metadata name="Title">a &amp; b</metadata><metadata name="Designer">x</metadata>)";
      },
      parts());
  add(
      "metadata of another vendor",
      [](Odd3mf& f) {
        f.more_attributes = R"( xmlns:v="http://vendor.example/2020")";
        f.metadata = R"(<metadata name="v:thing" preserve="1" type="xs:string">1</metadata>)";
      },
      parts());
  add(
      "attributes of another vendor",
      [](Odd3mf& f) {
        f.more_attributes = R"( xmlns:v="http://vendor.example/2020" v:version="3")";
        f.block += R"( v:color="red")";
        f.triangles = R"( v:face="1")";
      },
      parts());
  add(
      "identifiers of the production extension",
      [](Odd3mf& f) {
        f.more_attributes =
            R"( xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" requiredextensions="p")";
        f.block += R"( p:UUID="11111111-2222-3333-4444-555555555555")";
      },
      parts());
  add(
      "a thumbnail",
      [](Odd3mf& f) {
        f.types = R"(<Default Extension="png" ContentType="image/png"/>)";
        f.relations =
            R"(<Relationship Id="rel1" Target="/Metadata/thumbnail.png" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>)";
        f.files.emplace_back("Metadata/thumbnail.png", std::string("\x89PNG\r\n\x1a\n", 8));
      },
      parts());
  add(
      "a thumbnail that is missing",
      [](Odd3mf& f) {
        f.types = R"(<Default Extension="png" ContentType="image/png"/>)";
        f.relations =
            R"(<Relationship Id="rel1" Target="/Metadata/gone.png" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>)";
      },
      parts());
  add(
      "a thumbnail of an object",
      [](Odd3mf& f) {
        f.block += R"( thumbnail="/Metadata/thumbnail.png")";
        f.types = R"(<Default Extension="png" ContentType="image/png"/>)";
        f.files.emplace_back("Metadata/thumbnail.png", "x");
      },
      parts())
      .has_remark = true;
  add(
      "files of slicers",
      [](Odd3mf& f) {
        f.files.emplace_back("Metadata/model_settings.config", "<config/>");
        f.types = R"(<Default Extension="config" ContentType="text/xml"/>)";
      },
      parts());
  add(
      "files without a type", [](Odd3mf& f) { f.files.emplace_back("Metadata/notes.xyz", "x"); }, parts());
  add(
      "another name of the model",
      [](Odd3mf& f) {
        f.path = "models/rig.model";
        f.target = "/models/rig.model";
      },
      parts());
  add(
      "a path without its slash", [](Odd3mf& f) { f.target = "3D/3dmodel.model"; }, parts());
  add(
      "a byte order mark", [](Odd3mf& f) { f.head.insert(0, "\xef\xbb\xbf"); }, parts());
  add(
      "no head", [](Odd3mf& f) { f.head = ""; }, parts());
  add(
      "line ends of two bytes",
      [](Odd3mf& f) { f.edited = [](const std::string& m) { return replacedAll(m, "><", ">\r\n\t<"); }; },
      parts());
  add(
      "comments",
      [](Odd3mf& f) {
        f.edited = [](const std::string& m) {
          return replacedAll(m, "<object", "<!-- <object id=\"9\"/> --><object");
        };
      },
      parts());
  add(
      "single quotes",
      [](Odd3mf& f) { f.edited = [](const std::string& m) { return replacedAll(m, "\"", "'"); }; }, parts());
  add(
      "elements with two tags",
      [](Odd3mf& f) {
        f.edited = [](const std::string& m) {
          return replacedAll(m, "<item objectid=\"1\"/>", "<item objectid=\"1\"></item>");
        };
      },
      parts());
  add(
      "exponents and signs",
      [](Odd3mf& f) {
        f.edited = [](const std::string& m) {
          return replacedAll(replacedAll(m, "\"10.000000\"", "\"+1.0E+01\""), "\"20.000000\"", "\"2e1\"");
        };
      },
      parts());
  add(
      "a prefix of the namespace",
      [](Odd3mf& f) {
        f.edited = [](std::string m) {
          m = replacedAll(replacedAll(replacedAll(m, "<", "<c:"), "<c:/", "</c:"), "<c:?", "<?");
          return replacedAll(m, " xmlns=\"", " xmlns:c=\"");
        };
      },
      parts());
  add(
      "an object for supports",
      [](Odd3mf& f) {
        f.more_objects =
            R"(<object id="7" type="support" name="s">)" + Odd3mf::mesh(oddBlockMesh(), "") + "</object>";
        f.items += R"(<item objectid="7"/>)";
      },
      parts())
      .has_remark = true;
  add(
      "vertices without use",
      [](Odd3mf& f) {
        f.edited = [](const std::string& m) {
          return replacedAll(m, "</vertices>", "<vertex x=\"0\" y=\"0\" z=\"900\"/></vertices>");
        };
      },
      parts());
  add(
      "an extension in capitals", [](Odd3mf&) {}, parts())
      .name = "ODD.3MF";
  // What is lost is told.
  const auto refuse = [&](const std::string& oddity, const std::function<void(Odd3mf&)>& change,
                          const std::string& lost) { add(oddity, change, {}).lost = lost; };
  refuse(
      "an extension that is needed",
      [](Odd3mf& f) {
        f.more_attributes = R"( xmlns:v="http://vendor.example/2020" requiredextensions="v")";
      },
      "needs an extension");
  refuse(
      "a triangle with a corner that is missing",
      [](Odd3mf& f) {
        f.edited = [](const std::string& m) {
          return replacedOnce(m, "<triangle v1=\"", "<triangle v1=\"9");
        };
      },
      "odd.3mf");
  refuse(
      "a component that is missing", [](Odd3mf& f) { f.items = R"(<item objectid="77"/>)"; }, "odd.3mf");
  refuse(
      "a coordinate with a comma",
      [](Odd3mf& f) {
        f.edited = [](const std::string& m) { return replacedOnce(m, "\"10.000000\"", "\"10,5\""); };
      },
      "10,5");
  add(
      "a unit that nobody knows", [](Odd3mf& f) { f.unit = " unit=\"furlong\""; }, parts())
      .has_remark = true;
  add("cut", [](Odd3mf&) {}, {}).lost = "odd.3mf";
  all.back().bytes.resize(all.back().bytes.size() / 2);
  expectAll(all, "odd.3mf");
}

}  // namespace
}  // namespace vps::scenes::odd
