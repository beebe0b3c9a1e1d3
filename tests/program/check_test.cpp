// SPDX-License-Identifier: BSD-3-Clause
// `vps check` as its users run it.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/lathe.h"

namespace vps {
namespace {

using nlohmann::json;

/// A mesh as ASCII STL in millimetres.
std::string stlText(const Mesh& mesh) {
  std::string out = "solid part\n";
  for (const auto& triangle : mesh.triangles) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t corner : triangle) {
      char line[120];
      const Vec3 p = 1e3 * mesh.vertices[corner];
      std::snprintf(line, sizeof line, "vertex %.9g %.9g %.9g\n", p.x(), p.y(), p.z());
      out += line;
    }
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid part\n";
}

class Check : public Program {
 protected:
  /// A plate, and a pin of 8 mm in height whose foot is gap_mm above the top of the plate.
  std::string scene(double gap_mm, const std::string& more = "") const {
    return "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n[[part]]\nfile = 'pin.stl'\n" + more +
           "pose = {position = [0, 0, " + std::to_string(9 + gap_mm) + "]}\n";
  }
};

TEST_F(Check, AGapAContactAndAClashHaveTheirExitStatusAndNumbers) {
  struct Case {
    double gap_mm;
    int status;
    const char* state;
  };
  // With an overlap of 20 um, the pin is free at a place that is 20 um higher; 1.2 mm would be too far from
  // the drawn place.
  for (const Case& c :
       {Case{0.02, 0, "apart"}, Case{0, 0, "contact"}, Case{-0.02, 0, "clash"}, Case{-1.2, 1, "clash"}}) {
    write("drawn.toml", scene(c.gap_mm));
    const Ran ran = run("check drawn.toml --json check.json");
    EXPECT_EQ(ran.status, c.status) << ran.out << ran.err;
    const json found = json::parse(slurp(folder_ / "check.json"));
    ASSERT_EQ(found["pairs"].size(), 1U);
    const json& pair = found["pairs"][0];
    EXPECT_EQ(pair["state"], c.state);
    EXPECT_NEAR(pair["clearance_m"], std::max(0.0, 1e-3 * c.gap_mm), 1e-9);  // single precision of the file
    EXPECT_NEAR(pair["interference_depth_m"], std::max(0.0, -1e-3 * c.gap_mm), 0.2e-6);
    const bool is_clash = c.gap_mm < 0;
    EXPECT_EQ(found["clashes"], is_clash ? 1 : 0);
    EXPECT_EQ(found["parts"].size(), 2U);
    EXPECT_EQ(found["parts"][1].contains("play_m"), !is_clash);
    EXPECT_EQ(found["verdict"], c.status == 0 ? "fits" : "blocked");
    EXPECT_EQ(found["places"]["moved"].size(), is_clash && c.status == 0 ? 1U : 0U);
  }
}

TEST_F(Check, TheHeadlineCountsAndThePageNamesFilesWithoutFolders) {
  const std::string folder = folder_.string();
  const Ran ran =
      run("check '" + folder + "/plate.stl' '" + folder + "/pin.stl' --units mm --no-play --html check.html");
  EXPECT_NE(ran.out.find("2 parts, 1 pair near each other"), std::string::npos) << ran.out;
  EXPECT_NE(slurp(folder_ / "check.html").find("<title>Check of plate.stl, pin.stl</title>"),
            std::string::npos);
}

TEST_F(Check, AStepsTargetIsWhereThePartIsChecked) {
  write("drawn.toml", scene(5) + "[[step]]\npart = 'pin'\ntarget = {position = [0, 0, 8.95]}\n");
  const Ran ran = run("check drawn.toml --no-play");
  // The pin is free at a place that is higher by the overlap.
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("can be assembled: free if 'pin' moves by 0.0500 mm along +z"), std::string::npos)
      << ran.out;
  EXPECT_NE(ran.out.find("1 clash: plate and pin by 50.00 um"), std::string::npos) << ran.out;
}

TEST_F(Check, PartsThatAreNowhereNearEachOtherAreNotShown) {
  write("drawn.toml", scene(30));
  const Ran ran = run("check drawn.toml --no-play --json check.json --html check.html");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("not shown: 'plate' and 1 other are nowhere near another part"), std::string::npos)
      << ran.out;
  EXPECT_EQ(json::parse(slurp(folder_ / "check.json"))["alone"], json({"plate", "pin"}));
  EXPECT_NE(slurp(folder_ / "check.html").find("nowhere near another part"), std::string::npos);
}

TEST_F(Check, WhatFreesAnOverlapIsSaidBesideWhatIsNotShown) {
  write("drawn.toml",
        scene(-0.02) + "[[part]]\nname = 'far'\nfile = 'pin.stl'\npose = {position = [90, 0, 90]}\n");
  const Ran ran = run("check drawn.toml --no-play");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("not shown: 'far' is nowhere near another part"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("; the overlapping parts are free if 'pin' moves by 0.0200 mm along +z"),
            std::string::npos)
      << ran.out;
}

TEST_F(Check, TheTextSaysWhatAnOverlapIs) {
  write("drawn.toml", scene(0));
  EXPECT_EQ(run("check drawn.toml --no-play").out.find("greatest depth of a point"), std::string::npos);
  write("drawn.toml", scene(-0.02));
  EXPECT_NE(run("check drawn.toml --no-play").out.find("greatest depth of a point"), std::string::npos);
}

TEST_F(Check, AnAllowedOverlapIsNoClash) {
  write("drawn.toml", scene(-0.02, "allow_overlap = true\n"));
  const Ran ran = run("check drawn.toml");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("clash (allowed)"), std::string::npos) << ran.out;
}

TEST_F(Check, ADeclaredPressFitIsNoClashAndAGreaterOverlapIs) {
  write("drawn.toml", scene(-0.02, "press_fit = '25um'\n"));
  Ran ran = run("check drawn.toml --json check.json --html check.html");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("press fit"), std::string::npos) << ran.out;
  const json found = json::parse(slurp(folder_ / "check.json"));
  const std::string page = slurp(folder_ / "check.html");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("<b>plate</b> and <b>pin</b> overlap by 20.0"), std::string::npos);
  EXPECT_EQ(found["pairs"][0]["state"], "press fit");
  EXPECT_NEAR(found["pairs"][0]["press_fit_m"], 25e-6, 1e-12);
  write("drawn.toml", scene(-0.03, "press_fit = '25um'\n"));
  EXPECT_NE(run("check drawn.toml").out.find("1 clash"), std::string::npos);
  write("drawn.toml", scene(0.03, "press_fit = '25um'\n"));
  ran = run("check drawn.toml");
  EXPECT_EQ(ran.status, 0);
  EXPECT_NE(ran.out.find("25.00 um of press fit are declared, but the parts are drawn without"),
            std::string::npos)
      << ran.out;
}

TEST_F(Check, WritesCsvAndAPageAndRepeatsByteForByte) {
  write("drawn.toml", scene(0.02));
  ASSERT_EQ(run("check drawn.toml --json a.json --csv a.csv --html a.html").status, 0);
  ASSERT_EQ(run("check drawn.toml --json b.json --csv b.csv --html b.html").status, 0);
  EXPECT_EQ(slurp(folder_ / "a.csv"), slurp(folder_ / "b.csv"));
  EXPECT_EQ(slurp(folder_ / "a.html"), slurp(folder_ / "b.html"));
  json a = json::parse(slurp(folder_ / "a.json")), b = json::parse(slurp(folder_ / "b.json"));
  a.erase("wall");
  b.erase("wall");
  EXPECT_EQ(a, b);
  EXPECT_TRUE(
      slurp(folder_ / "a.csv").starts_with("what,a,b,quantity,value,error\npair,plate,pin,clearance_m,"));
  EXPECT_NE(slurp(folder_ / "a.html").find("No parts overlap as drawn"), std::string::npos);
  EXPECT_NE(slurp(folder_ / "a.html").find("Clearance on the surfaces"), std::string::npos);
  // The pin is free sideways and upwards, and has the gap downwards.
  const json& pin = a["parts"][1];
  EXPECT_TRUE(pin["play_m"][4].is_null());
  EXPECT_NEAR(pin["play_m"][5], 20e-6, 1e-6);
  EXPECT_FALSE(pin["ways_out"].empty());
}

TEST_F(Check, ACadFileNeedsItsUnitAndASceneDoesNotTakeOne) {
  expectRefused("check plate.stl", "--units");
  EXPECT_EQ(run("check plate.stl --units mm").status, 0);
  write("drawn.toml", scene(0.02));
  expectRefused("check drawn.toml --units mm", "leave out --units");
  expectRefused("check drawn.toml --near 2", "--near");
  expectRefused("check plate.stl --units um --json plate.stl", "plate.stl");
}

// The pin stands on a sheet of two facets, which has no inside.
TEST_F(Check, ASheetInAPartIsNotShownAndSaysWhy) {
  write("sheet.obj", "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3\nf 1 3 4\n");
  write("drawn.toml", "unit = 'mm'\n[[part]]\nfile = 'sheet.obj'\n[[part]]\nfile = 'pin.stl'\n");
  const Ran ran = run("check drawn.toml --no-play");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("it cannot be told whether sheet and pin overlap"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("2 of 2 facets belong to surfaces without an inside"), std::string::npos) << ran.out;
}

TEST_F(Check, PartsOfTheWrongUnitAreNamed) {
  write("speck.stl", stlBox(Vec3(1e-3, 1e-3, 1e-3)));
  const Ran ran = run("check speck.stl --units um");  // the import warns about the size as well
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("part 'speck': is 1e-09 m large; a check measures parts of 10 um to 1 km"),
            std::string::npos)
      << ran.err;
}

TEST_F(Check, AThreadThatIsDrawnAsCylindersIsNoClashUnlessItIsRefused) {
  write("block.stl", stlText(makeTube(20e-3, 3.3235e-3, 10e-3, 48)));
  write("screw.stl",
        stlText(test::lathe(
            {{0, -15e-3}, {4e-3, -15e-3}, {4e-3, 5e-3}, {7e-3, 5e-3}, {7e-3, 9e-3}, {0, 9e-3}}, 48)));
  write("drawn.toml",
        "unit = 'mm'\n[[part]]\nfile = 'block.stl'\nfixed = true\n[[part]]\nfile = 'screw.stl'\n");
  const Ran ran = run("check drawn.toml --no-play --json check.json --csv check.csv --html check.html");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("block and screw: taken for a thread M8"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("1 overlap is no clash: 1 thread; --strict-overlaps"), std::string::npos) << ran.out;
  const json found = json::parse(slurp(folder_ / "check.json"));
  EXPECT_EQ(found["verdict"], "fits");
  EXPECT_EQ(found["clashes"], 0);
  EXPECT_EQ(found["pairs"][0]["state"], "thread");
  EXPECT_EQ(found["pairs"][0]["nominal"], "M8");
  EXPECT_EQ(found["pairs"][0]["fastener"], "screw");
  EXPECT_NE(slurp(folder_ / "check.csv").find("thread,block,screw,interference_depth_m,"), std::string::npos);
  EXPECT_NE(slurp(folder_ / "check.html").find("taken for a thread M8"), std::string::npos);
  EXPECT_EQ(run("check drawn.toml --no-play --strict-overlaps").status, 1);
  write("rules.toml", "[[overlap]]\nbetween = ['screw', 'block']\nkind = 'clash'\n");
  EXPECT_EQ(run("check drawn.toml --no-play --rules rules.toml").status, 1);
}

}  // namespace
}  // namespace vps
