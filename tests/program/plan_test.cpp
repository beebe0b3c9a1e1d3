// SPDX-License-Identifier: BSD-3-Clause
// `vps plan` as its users run it.
#include <nlohmann/json.hpp>

#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "program.h"

namespace vps {
namespace {

using nlohmann::json;

class Plan : public Program {
 protected:
  /// A plate, and a pin that stands on the plate.
  static std::string scene() {
    return "name = 'pin \"1\"'\nunit = 'mm'\n[[part]]\nfile = 'plate.stl'\n[[part]]\nfile = 'pin.stl'\n"
           "friction = 0.3\npose = {position = [0, 0, 9]}\n[[step]]\npart = 'pin'\ntimeout_s = 7\n"
           "[operator]\nseed = 5\n";
  }
};

TEST_F(Plan, WritesASceneThatCanBeVerifiedAndKeepsItsSettings) {
  write("drawn.toml", scene());
  const Ran ran = run("plan drawn.toml -o planned --json plan.json");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  const json plan = json::parse(slurp(folder_ / "plan.json"));
  ASSERT_EQ(plan["assemblies"].size(), 1U);
  EXPECT_EQ(plan["assemblies"][0]["fixed"][0], "plate");
  EXPECT_EQ(plan["assemblies"][0]["steps"][0]["name"], "pin");
  EXPECT_EQ(plan["blocked_count"], 0);
  EXPECT_NE(slurp(folder_ / "planned/plan.dot").find("\"0/plate\" -> \"0/pin\""), std::string::npos);
  const std::string text = slurp(folder_ / "planned/scene.toml");
  for (const char* kept :
       {"seed = 5", "timeout_s = 7", "friction = 0.3", "fixed = true", "name = \"pin \\\"1\\\"\""})
    EXPECT_NE(text.find(kept), std::string::npos) << kept << "\n" << text;
  EXPECT_EQ(run("plan --verify planned/scene.toml").status, 0);
  // The plan is made again from the scene that was written.
  EXPECT_EQ(run("plan planned/scene.toml -o again").status, 0);
}

TEST_F(Plan, AnEditThatBreaksAWayIsNamed) {
  write("drawn.toml", scene() +
                          "[[part]]\nfile = 'plate.stl'\nname = 'roof'\nfixed = true\n"
                          "pose = {position = [0, 0, 30]}\n");
  const Ran ran = run("plan --verify drawn.toml");  // the pin goes in from above, through the roof
  EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("leads through 'roof'"), std::string::npos) << ran.out;
}

TEST_F(Plan, RefusesABaseThatIsNoPartAndAFolderWithAScene) {
  write("drawn.toml", scene());
  const Ran ran = run("plan drawn.toml -o planned --base nobody");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("'nobody'"), std::string::npos) << ran.err;
  ASSERT_EQ(run("plan drawn.toml -o planned").status, 0);
  EXPECT_EQ(run("plan drawn.toml -o planned").status, 2);
  EXPECT_EQ(run("plan drawn.toml -o planned --force").status, 0);
}

TEST_F(Plan, TheBookHasASheetForTheStepAndNamesItsParts) {
  write("drawn.toml", scene());
  const Ran ran = run("plan drawn.toml -o planned --book book.html");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("book: book.html, 1 step\n"), std::string::npos) << ran.out;
  const std::string page = slurp(folder_ / "book.html");
  for (const char* words : {"Instruction book: pin &quot;1&quot;", "Step 1 of 1: pin", "<h2>Parts</h2>",
                            "Move &#39;pin&#39; straight down (-z) by ", "A path was found for every part."})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  // Balloons for both parts on the cover and on the sheet, unless this machine cannot draw.
  if (page.find("The pictures are missing") == std::string::npos) {
    EXPECT_NE(page.find("href=\"data:image/png;base64,"), std::string::npos);
    std::size_t balloons = 0;
    for (std::size_t at = page.find("class=\"balloon\""); at != std::string::npos;
         at = page.find("class=\"balloon\"", at + 1))
      ++balloons;
    EXPECT_EQ(balloons, 4U);
  }
  expectRefused("plan drawn.toml -o planned --force --book book.txt", "ends in .html or .pdf");
  EXPECT_EQ(run("plan --verify planned/scene.toml --book book.html").status, 2);
}

/// An OBJ file of boxes in millimetres: name, least and greatest corner. Consecutive boxes with the same name
/// are one part.
struct NamedBox {
  std::string name;
  std::array<double, 3> min, max;
};
std::string objOf(const std::vector<NamedBox>& boxes) {
  constexpr std::array<std::array<int, 4>, 6> kFaces = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::ostringstream out;
  out.precision(12);
  int first = 1;
  std::string name;
  for (const NamedBox& box : boxes) {
    if (box.name != name) out << "o " << box.name << '\n';
    name = box.name;
    for (unsigned i = 0; i < 8; ++i) {
      out << 'v';
      for (unsigned axis = 0; axis < 3; ++axis)
        out << ' ' << ((i >> axis & 1U) != 0 ? box.max : box.min)[axis];
      out << '\n';
    }
    for (const std::array<int, 4>& face : kFaces) {
      out << 'f';
      for (const int v : face) out << ' ' << first + v;
      out << '\n';
    }
    first += 8;
  }
  return out.str();
}
const NamedBox kPlate = {"plate", {0, 0, 0}, {60, 60, 10}};

TEST_F(Plan, ACadFileIsPlannedAndAssembledInOneGoAsItsSceneIs) {
  write("product.obj", objOf({kPlate, {"block", {20, 20, 10}, {40, 40, 30}}}));
  const Ran once = run("assemble product.obj --units mm --out once --no-pictures --json once.json");
  ASSERT_NE(once.status, 2) << once.out << once.err;
  const Ran scene = run("assemble once/plan/scene.toml --out again --no-pictures --json again.json");
  EXPECT_EQ(once.status, scene.status);
  json first = json::parse(slurp(folder_ / "once.json")), second = json::parse(slurp(folder_ / "again.json"));
  first.erase("wall");
  second.erase("wall");
  EXPECT_EQ(first, second);
  EXPECT_EQ(first["steps"].size(), 1U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "once/report.html"));
  EXPECT_NE(once.out.find("all parts planned"), std::string::npos) << once.out;
  EXPECT_EQ(run("assemble once/plan/scene.toml --units mm --out other").status, 2);
}

TEST_F(Plan, NothingToAssembleIsSaid) {
  write("plate.obj", objOf({kPlate}));
  const Ran one = run("assemble plate.obj --units mm --out one");
  EXPECT_EQ(one.status, 2);
  EXPECT_NE(one.err.find("plate.obj: has one part, so there is nothing to assemble"), std::string::npos)
      << one.err;
  // A block in a closed box.
  const auto wall = [](const char* name, std::array<double, 3> min, std::array<double, 3> max) {
    return NamedBox{name, min, max};
  };
  write("closed.obj", objOf({wall("box", {0, 0, 0}, {30, 30, 5}),
                             wall("box", {0, 0, 25}, {30, 30, 30}),
                             wall("box", {0, 0, 5}, {5, 30, 25}),
                             wall("box", {25, 0, 5}, {30, 30, 25}),
                             wall("box", {5, 0, 5}, {25, 5, 25}),
                             wall("box", {5, 25, 5}, {25, 30, 25}),
                             {"block", {10, 10, 5}, {20, 20, 15}}}));
  const Ran ran = run("assemble closed.obj --units mm --out none --no-pictures");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("The plan found no path for any part"), std::string::npos) << ran.out << ran.err;
}

// A block that has 20 um of play in a closed box, and a cap on the box: the block is proven to be shut in,
// and the cap is mounted nevertheless.
TEST_F(Plan, APartThatIsProvenToBeShutInBlocksTheProductWhoseOtherStepsAreRun) {
  write("sealed.obj", objOf({{"box", {0, 0, 0}, {30, 30, 5}},
                             {"box", {0, 0, 15.02}, {30, 30, 20}},
                             {"box", {0, 0, 5}, {10, 30, 15.02}},
                             {"box", {20.02, 0, 5}, {30, 30, 15.02}},
                             {"box", {10, 0, 5}, {20.02, 10, 15.02}},
                             {"box", {10, 20.02, 5}, {20.02, 30, 15.02}},
                             {"block", {10.01, 10.01, 5.01}, {20.01, 20.01, 15.01}},
                             {"cap", {10, 10, 20}, {20, 20, 26}}}));
  const Ran ran = run("assemble sealed.obj --units mm --base box --out run --no-pictures");
  EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("blocked at 'block', which cannot be taken off 'box' on any path"),
            std::string::npos)
      << ran.out << ran.err;
  const json plan = json::parse(slurp(folder_ / "run/plan/plan.json"));
  EXPECT_EQ(plan["verdict"], "blocked");
  const json product = json::parse(slurp(folder_ / "run/assemble.json"));
  ASSERT_EQ(product["steps"].size(), 1U);
  EXPECT_EQ(product["steps"][0]["part"], "cap");
}

// The files as `vps import` accepts them.
TEST_F(Plan, SeveralCadFilesAreOneAssemblyForPlanAssembleAndCheck) {
  write("plate.obj", objOf({kPlate}));
  write("block.obj", objOf({{"block", {20, 20, 10}, {40, 40, 30}}}));
  const Ran plan = run("plan plate.obj block.obj --units mm -o planned");
  ASSERT_EQ(plan.status, 0) << plan.out << plan.err;
  EXPECT_NE(slurp(folder_ / "planned/scene.toml").find("\"plate.obj\", \"block.obj\""), std::string::npos);
  const Ran check = run("check plate.obj block.obj --units mm --json check.json --no-play");
  ASSERT_EQ(check.status, 0) << check.out << check.err;
  EXPECT_EQ(json::parse(slurp(folder_ / "check.json"))["parts"].size(), 2U);
  const Ran both =
      run("assemble plate.obj block.obj --units mm --out run --no-pictures --base block --bench");
  ASSERT_NE(both.status, 2) << both.out << both.err;
  const json plan_json = json::parse(slurp(folder_ / "run/plan/plan.json"));
  EXPECT_EQ(plan_json["assemblies"][0]["fixed"][0], "block");
  EXPECT_EQ(plan_json["assemblies"][0]["steps"][0]["is_on_bench"], true) << plan_json.dump(1);

  expectRefused("check plate.obj scene.toml --units mm", "is a scene, which must be the only file");
  expectRefused("plan --verify planned/scene.toml block.obj", "--verify checks one scene");
  expectRefused("assemble planned/scene.toml --out again --bench", "leave out --base, --bench");
}

TEST_F(Plan, PartsFarFromTheirOriginKeepTheirGap) {
  write("far.obj", objOf({{"plate", {300000, 0, 0}, {300060, 60, 10}},
                          {"post", {300010, 10, 10}, {300020, 20, 30}},
                          {"block", {300020.04, 10, 10}, {300040, 40, 30}}}));
  ASSERT_EQ(run("plan far.obj --units mm -o planned").status, 0);
  const Ran check = run("check planned/scene.toml --no-play --json check.json");
  ASSERT_EQ(check.status, 0) << check.out << check.err;
  const json found = json::parse(slurp(folder_ / "check.json"));
  bool is_found = false;
  for (const json& pair : found["pairs"])
    if ((pair["a"] == "post" && pair["b"] == "block") || (pair["a"] == "block" && pair["b"] == "post")) {
      is_found = true;
      // The tolerance is the rounding of floats in parts of 60 mm.
      EXPECT_NEAR(pair["clearance_m"].get<double>(), 40e-6, 2 * 0.06 * 0x1p-24);
    }
  EXPECT_TRUE(is_found) << found["pairs"].dump(1);
}

// Planning is stopped at times that are spread evenly over its duration (multiples of the golden ratio),
// until one stop is after the first part was removed and before the end. On a loaded machine the search for
// such a stop takes more tries.
TEST_F(Plan, WhatItFoundWhenItWasStoppedIsKeptAndResumed) {
  std::vector<NamedBox> boxes = {kPlate};
  for (int i = 0; i < 120; ++i) {
    const double x = 5 * (i % 11), y = 5 * (i / 11);
    boxes.push_back({"block " + std::to_string(i), {x, y, 10}, {x + 4.9, y + 4.9, 14.0 + i % 3}});
  }
  write("many.obj", objOf(boxes));
  using Clock = std::chrono::steady_clock;
  const auto secondsSince = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  const Clock::time_point begun = Clock::now();
  ASSERT_EQ(run("plan many.obj --units mm -o whole").status, 0);
  double whole_s = secondsSince(begun);  // the duration of the whole plan at the present load
  constexpr int kMostTries = 300;
  constexpr double kGoldenRatio = 0.6180339887498949;
  const fs::path unfinished = folder_ / "planned/unfinished_plan.json";
  bool is_stopped = false;
  for (int k = 1; !is_stopped && k <= kMostTries; ++k) {
    fs::remove_all(folder_ / "planned");
    const double stop_s = 0.02 + 1.2 * whole_s * std::fmod(k * kGoldenRatio, 1.0);
    const std::string command = "cd '" + folder_.string() + "' && timeout -s INT " + std::to_string(stop_s) +
                                " '" VPS_PROGRAM
                                "' plan many.obj --units mm -o planned >out.txt 2>&1 </dev/null";
    const Clock::time_point from = Clock::now();
    const bool is_finished = std::system(command.c_str()) == 0;
    // If all tries stop too early, the machine has become slower.
    whole_s = is_finished ? secondsSince(from) : 1.05 * whole_s;
    is_stopped =
        !is_finished && fs::exists(unfinished) && !json::parse(slurp(unfinished))["taken_off"].empty();
  }
  ASSERT_TRUE(is_stopped) << "it was never stopped while it took apart; the last try:\n"
                          << slurp(folder_ / "out.txt");
  EXPECT_NE(slurp(folder_ / "out.txt").find("continue with --resume"), std::string::npos);

  expectRefused("plan many.obj --units mm -o planned --resume --base 'block 3'",
                "belongs to other parts or another base");
  ASSERT_EQ(run("plan many.obj --units mm -o planned --resume").status, 0);
  for (const char* file : {"scene.toml", "plan.dot", "plan.svg"})
    EXPECT_EQ(slurp(folder_ / "planned" / file), slurp(folder_ / "whole" / file)) << file;
  EXPECT_FALSE(fs::exists(folder_ / "planned/unfinished_plan.json"));
}

TEST_F(Plan, TheTableOfAFolderHasARowForEachAssembly) {
  if (std::system("command -v python3 >/dev/null 2>&1") != 0) GTEST_SKIP() << "python3 is not installed";
  fs::create_directories(folder_ / "cad/two");
  write("cad/two/a.obj", objOf({kPlate}));
  write("cad/two/b.obj", objOf({{"block", {20, 20, 10}, {40, 40, 30}}}));
  write("cad/c.step", "no STEP");
  const std::string command = "cd '" + folder_.string() +
                              "' && '" VPS_SOURCE_DIR
                              "/tests/cad_table/vps_bench_cad' cad --plan-only --vps '" VPS_PROGRAM
                              "' >table.txt 2>table.err";
  const int status = std::system(command.c_str());
  const std::string table = slurp(folder_ / "table.txt");
  EXPECT_EQ(WEXITSTATUS(status), 1) << table << slurp(folder_ / "table.err");  // of c.step
  EXPECT_NE(table.find("| two | 2 | 1 |  |"), std::string::npos) << table;
  EXPECT_NE(table.find("| c.step |"), std::string::npos) << table;
}

// A tongue in its groove. The walls of the pocket keep tongue and groove together, so both are joined before
// they go into the pocket.
TEST_F(Plan, SubassembliesOfACadFileAreAssembledBeforeTheProductThatMountsThem) {
  write("product.obj", objOf({{"pocket", {-25, -15, -5}, {25, 15, 0}},
                              {"pocket", {-25, -15, -5}, {-20.1, 15, 20}},
                              {"pocket", {20.1, -15, -5}, {25, 15, 20}},
                              {"pocket", {-25, -15, -5}, {25, -10.1, 20}},
                              {"pocket", {-25, 10.1, -5}, {25, 15, 20}},
                              {"left", {-20, -10, 0}, {0, 10, 30}},
                              {"left", {-1, -10, 10.5}, {10, 10, 19.5}},
                              {"right", {0.1, -10, 0}, {20, 10, 10}},
                              {"right", {0.1, -10, 20}, {20, 10, 30}},
                              {"right", {10.5, -10, 5}, {20, 10, 25}}}));
  const Ran ran = run("assemble product.obj --units mm --out run --no-pictures --json whole.json");
  ASSERT_NE(ran.status, 2) << ran.out << ran.err;
  const std::string part = "run/subassembly_1/";
  ASSERT_TRUE(std::filesystem::exists(folder_ / part / "report.html")) << ran.out << ran.err;
  const json first = json::parse(slurp(folder_ / part / "assemble.json")),
             product = json::parse(slurp(folder_ / "run/assemble.json"));
  EXPECT_EQ(first["steps"].size(), 1U);
  EXPECT_EQ(product["steps"][0]["part"], "subassembly_1");
  EXPECT_EQ(json::parse(slurp(folder_ / "whole.json"))["steps"], product["steps"]);
  // The status is 0 only if both verdicts are good.
  const bool fits = first["verdict"] == "fits" && product["verdict"] == "fits";
  EXPECT_EQ(ran.status == 0, fits) << ran.out << ran.err;
  EXPECT_LT(ran.out.find("\nsubassembly_1\n"), ran.out.find("\nproduct\n")) << ran.out;
  EXPECT_NE(ran.out.rfind("run/subassembly_1/report.html"), std::string::npos) << ran.out;
}

// Two links of a chain leave a plate together and cannot be separated. The product is run nevertheless.
TEST_F(Plan, ASubassemblyThatCannotBeTakenApartDoesNotKeepTheProductFromBeingRun) {
  write("product.obj", objOf({{"plate", {-10, -10, -40}, {70, 50, -30}},
                              {"flat", {0, 0, -2}, {40, 4, 2}},
                              {"flat", {0, 36, -2}, {40, 40, 2}},
                              {"flat", {0, 0, -2}, {4, 40, 2}},
                              {"flat", {36, 0, -2}, {40, 40, 2}},
                              {"upright", {20, 18, -20}, {60, 22, -16}},
                              {"upright", {20, 18, 16}, {60, 22, 20}},
                              {"upright", {20, 18, -20}, {24, 22, 20}},
                              {"upright", {56, 18, -20}, {60, 22, 20}}}));
  const Ran ran = run("assemble product.obj --units mm --base plate --out run --no-pictures");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;
  EXPECT_NE(
      ran.out.find(
          "\nsubassembly_1\nThe plan found no path for any part of this subassembly, so it was not run"),
      std::string::npos)
      << ran.out << ran.err;
  const json product = json::parse(slurp(folder_ / "run/assemble.json"));
  ASSERT_EQ(product["steps"].size(), 1U);
  EXPECT_EQ(product["steps"][0]["part"], "subassembly_1");
}

// File names are shortened and made unique. Part names stay unchanged if they are text.
TEST_F(Plan, AnyNamesOfPartsMakeASceneThatIsReadAgain) {
  const std::string longest(300, 'x');
  write("product.obj", objOf({kPlate,
                              {longest, {2, 2, 10}, {6, 6, 14}},
                              {longest + "y", {10, 2, 10}, {14, 6, 14}},
                              {"../../up", {18, 2, 10}, {22, 6, 14}},
                              {"Stra\xDF"
                               "e",
                               {26, 2, 10},
                               {30, 6, 14}},
                              {"a \"b\" \\ [[part]] #", {34, 2, 10}, {38, 6, 14}},
                              {"scene", {42, 2, 10}, {46, 6, 14}},
                              {"Plate", {50, 2, 10}, {54, 6, 14}}}));
  const Ran ran = run("plan product.obj --units mm -o planned");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  const Ran verified = run("plan --verify planned/scene.toml");
  EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
  EXPECT_NE(verified.out.find("7 steps"), std::string::npos) << verified.out;
  std::size_t meshes = 0;
  std::set<std::string> lower;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "planned")) {
    std::string name = entry.path().filename().string();
    if (!name.ends_with(".stl")) continue;
    ++meshes;
    EXPECT_LT(name.size(), 120U);
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    EXPECT_TRUE(lower.insert(name).second) << name;
  }
  EXPECT_EQ(meshes, 8U);
}

// Faults of drawings as designers make them: the answer names each fault.
TEST_F(Plan, FaultsOfTheDrawingAreNamed) {
  const auto wordsOf = [&](const std::vector<NamedBox>& boxes, int status) {
    write("product.obj", objOf(boxes));
    const Ran ran = run("plan product.obj --units mm -o planned --force --base plate");
    EXPECT_EQ(ran.status, status) << ran.out << ran.err;
    return ran.out + ran.err;
  };
  const NamedBox left = {"left", {10, 10, 10}, {20, 50, 40}}, right = {"right", {40, 10, 10}, {50, 50, 40}};
  const std::string large = wordsOf({kPlate, left, right, {"block", {19.9, 20, 10}, {40, 40, 30}}}, 0);
  EXPECT_NE(large.find("overlap by 0.100 mm as drawn"), std::string::npos) << large;
  EXPECT_NE(large.find("'left'"), std::string::npos) << large;

  const NamedBox block = {"block", {20, 20, 10}, {40, 40, 30}};
  const std::string sound = wordsOf({kPlate, block}, 0);
  for (const char* fault : {"overlap", "drawn twice", "Nothing carries"})
    EXPECT_EQ(sound.find(fault), std::string::npos) << sound;

  NamedBox twin = block;
  twin.name = "twin";
  const std::string twice = wordsOf({kPlate, block, twin}, 0);
  EXPECT_NE(twice.find("probably one part drawn twice"), std::string::npos) << twice;
  EXPECT_NE(twice.find("'twin'"), std::string::npos) << twice;

  const auto bar = [](const char* name, std::size_t axis) {
    NamedBox box = {name, {25, 25, 25}, {35, 35, 35}};
    box.min[axis] = 0;
    box.max[axis] = 60;
    return box;
  };
  const std::string frames =
      wordsOf({{"plate", {0, 0, 20}, {60, 60, 30}}, bar("x", 0), bar("y", 1), bar("z", 2)}, 3);
  EXPECT_NE(frames.find("each part seems to be drawn in a frame of its own"), std::string::npos) << frames;
  EXPECT_EQ(large.find("each part seems to be drawn in a frame of its own"), std::string::npos) << large;

  // Boxes in a row, each a little way into the next one.
  const auto row = [](double into_mm) {
    std::vector<NamedBox> boxes = {{"plate", {0, 0, -30}, {60, 60, -20}}};
    for (int i = 0; i < 6; ++i)
      boxes.push_back({"box" + std::to_string(i), {10.0 * i, 0, 0}, {10.0 * i + 10 + into_mm, 10, 10}});
    return boxes;
  };
  const std::string through = wordsOf(row(2), 0);
  EXPECT_NE(through.find("6 parts are connected by overlaps of up to 2.000 mm"), std::string::npos)
      << through;
  // Like panels of a box that are to be glued.
  const std::string glued = wordsOf(row(0.19), 0);
  EXPECT_EQ(glued.find("are connected by overlaps"), std::string::npos) << glued;
  EXPECT_EQ(glued.find("each part seems to be drawn in a frame of its own"), std::string::npos) << glued;

  const std::string floating = wordsOf({kPlate, {"block", {20, 20, 15}, {40, 40, 30}}}, 0);
  EXPECT_NE(floating.find("Nothing carries 'block'"), std::string::npos) << floating;
}

}  // namespace
}  // namespace vps
