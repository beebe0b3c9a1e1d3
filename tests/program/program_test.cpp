// SPDX-License-Identifier: BSD-3-Clause
// The program `vps` as its users run it: exit status, messages and files.
#include "program.h"
#include "vps_scenes/scene/scene.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace vps {
namespace {

using nlohmann::json;

TEST_F(Program, SimulatingInRealTimeTakesThatLongAndGivesTheSameBodies) {
  ASSERT_EQ(run("simulate scene.toml --seconds 0.5 --json steps.json").status, 0);
  const auto begun = std::chrono::steady_clock::now();
  const Ran ran = run("simulate scene.toml --seconds 0.5 --real-time --json clock.json");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_GE(took.count(), 0.5);
  EXPECT_NE(ran.out.find("real time: "), std::string::npos) << ran.out;
  json steps = json::parse(slurp(folder_ / "steps.json")), clock = json::parse(slurp(folder_ / "clock.json"));
  EXPECT_TRUE(clock["wall"]["physics"].contains("missed_periods"));
  EXPECT_FALSE(steps["wall"].contains("physics"));
  steps.erase("wall");
  clock.erase("wall");
  EXPECT_EQ(steps, clock);
}

TEST_F(Program, TradePrintsAFidelityToPasteOrReportsThatNoneQualifies) {
  const Ran picked = run("trade scene.toml --tolerance 20um");
  EXPECT_EQ(picked.status, 0) << picked.err;
  EXPECT_NE(picked.out.find("[fidelity]\nvoxel = \""), std::string::npos) << picked.out;
  // A scene file accepts the printed lines.
  write("picked.toml", std::string(kScene) + picked.out);
  EXPECT_EQ(run("simulate picked.toml --seconds 0.01").status, 0);

  const Ran said = run("trade scene.toml --tolerance 20um --json picked.json");
  ASSERT_EQ(said.status, 0) << said.out << said.err;
  const json chosen = json::parse(slurp(folder_ / "picked.json"));
  EXPECT_TRUE(chosen["is_met"]);
  EXPECT_LE(chosen["error_m"], 20e-6);
  write("misspelt.toml", "fidelity = 'autp'\n" + std::string(kScene));
  expectRefused("simulate misspelt.toml --seconds 0.01", "fast, normal, fine, auto");

  const Ran none = run("trade scene.toml --budget-hz 500000");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("no fidelity meets the requirements"), std::string::npos) << none.err;
  EXPECT_EQ(none.out, "");
  expectRefused("trade scene.toml --tolerance -1um", "--tolerance");
  expectRefused("trade scene.toml --tolerance soon", "--tolerance");
  expectRefused("trade scene.toml --tolerance ''", "--tolerance");
  expectRefused("trade scene.toml --tolerance 0um", "more than 0");
  expectRefused("trade scene.toml --tolerance 10kg", "'kg'");
  expectRefused("trade scene.toml --tolerance 1um --csv rows.csv", "--csv");
  expectRefused("trade nowhere.toml --tolerance 1um", "nowhere.toml");
  expectRefused("trade scene.toml --budget-hz 0", "--budget-hz");
  expectRefused("trade scene.toml --memory 3parsec", "--memory");
  expectRefused("trade scene.toml --budget-hz nan", "--budget-hz");
  expectRefused("trade scene.toml --voxle 1mm", "see vps trade --help");
  expectRefused("trade scene.toml", "has no [[step]]");
}

TEST_F(Program, DevicePrintsTableOneAndRefusesABadFile) {
  const Ran ran = run("device --characterise --json arm.json --plot fig");
  EXPECT_EQ(ran.status, 0) << ran.err;
  for (const char* words : {"this device", "the paper", "400 x 600 x 400", "14 - 18", "both, handle carried"})
    EXPECT_NE(ran.out.find(words), std::string::npos) << words;
  const json arm = json::parse(slurp(folder_ / "arm.json"));
  EXPECT_GT(arm["force_N"]["up_both"]["continuous"]["least"], 12);
  EXPECT_EQ(arm["parameters"]["handle"]["mass_kg"]["value"], 0.2);
  EXPECT_TRUE(arm["parameters"]["handle"]["mass_kg"].contains("sourced"));
  EXPECT_GT(arm["coupling"]["at_1kHz"]["k_N_per_m"], 100);
  // With a handle of half a kilogram instead of 0.2 kg the greatest upward force is 3 N less.
  write("heavy.toml", "[handle]\nmass_kg = 0.5\n");
  EXPECT_EQ(run("device --characterise --parameters heavy.toml --json heavy.json --plot ''").status, 0);
  const json heavy = json::parse(slurp(folder_ / "heavy.json"));
  EXPECT_LT(heavy["force_N"]["up_both"]["continuous"]["least"], 10);
  EXPECT_TRUE(heavy["parameters"]["handle"]["mass_kg"].contains("given"));
  write("bad.toml", "[handle]\nmass_kg = -1\n");
  expectRefused("device --characterise --parameters bad.toml",
                "bad.toml:2: [handle] mass_kg is -1; expected more than 0 and at most 100");
  expectRefused("device --characterise --parameters gone.toml", "gone.toml: no such file");
  expectRefused("device", "give --session NAME");
  expectRefused("device --json a.json", "--characterise");
}

TEST_F(Program, LinksAndPipesAreNotReplacedByFiles) {
  const std::string call = "query plate.stl pin.stl --units mm --voxel 1mm --spacing 2mm --repeats 1 --json ";
  write("old.json", "old");
  fs::create_symlink("old.json", folder_ / "link.json");
  fs::create_symlink("new.json", folder_ / "dangling.json");
  ASSERT_EQ(run(call + "link.json").status, 0);
  ASSERT_EQ(run(call + "dangling.json").status, 0);
  for (const char* link : {"link.json", "dangling.json"}) EXPECT_TRUE(fs::is_symlink(folder_ / link)) << link;
  for (const char* file : {"old.json", "new.json"}) EXPECT_TRUE(json::accept(slurp(folder_ / file))) << file;

  // The pipe is opened for reading first, so that the program finds a reader. The pipe's buffer holds all
  // output.
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_EQ(run(call + "pipe").status, 0);
  std::string bytes(65536, ' ');
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(reader, bytes.data(), bytes.size()))));
  close(reader);
  EXPECT_TRUE(json::accept(bytes)) << bytes;
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(Program, MeshesThatMakeTheAnswerUncertainGiveWarnings) {
  // One of twelve triangles is left out. The number of triangles is at byte 80, followed by 50 bytes for each
  // triangle.
  std::string open_box = stlBox(Vec3(4, 4, 8));
  open_box[80] = 11;
  open_box.resize(84 + 11 * 50);
  write("open.stl", open_box);
  const std::string settings = " --units mm --spacing 2mm --voxel ";
  EXPECT_TRUE(run("query plate.stl open.stl" + settings + "1mm").err.starts_with("vps: warning: open.stl: "));
  EXPECT_TRUE(run("import open.stl -o new --units mm").err.starts_with("vps: warning: open.stl: "));
  write("patch.obj",
        "o tip\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
        "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n");
  EXPECT_EQ(run("import patch.obj -o lacking --units mm").status, 0);
  EXPECT_NE(run("simulate lacking/scene.toml --seconds 0.001 --voxel 1mm --spacing 2mm")
                .err.find("lacks geometry of its CAD file: has 1 free-form surface"),
            std::string::npos);
  const std::string block = VPS_SOURCE_DIR "/scenes/bearing_block/bearing_block.glb";
  EXPECT_NE(run("import " + block + " -o block --units inch").err.find("--units is not used"),
            std::string::npos);
  EXPECT_NE(run("query plate.stl pin.stl" + settings + "6mm")
                .err.find("vps: warning: plate.stl: is 10.000 mm thin"),
            std::string::npos);
  EXPECT_EQ(run("query plate.stl pin.stl" + settings + "1mm").err, "");
}

TEST_F(Program, ADepthBeyondTheBandIsReportedAsABound) {
  // The plate is 10 mm thick. In the middle of the plate the pin is 5 mm deep, and the band is 4 voxels wide.
  const std::string call = "query plate.stl pin.stl --units mm --spacing 1mm --json a.json --voxel ";
  const Ran deep = run(call + "0.25mm");
  EXPECT_NE(deep.out.find("< -1000.00"), std::string::npos) << deep.out;
  EXPECT_EQ(json::parse(slurp(folder_ / "a.json"))["poses"][0]["is_depth_saturated"], true);
  const Ran shallow = run(call + "0.25mm --pose 0,0,0.0085,0,0,0,1");
  const json pose = json::parse(slurp(folder_ / "a.json"))["poses"][0];
  EXPECT_EQ(shallow.out.find("< -"), std::string::npos) << shallow.out;
  // The tolerance is half the step in which the map stores distances, 1 mm / 32767.
  EXPECT_NEAR(pose["min_distance_m"], -500e-6, 0.51e-3 / 32767);
  EXPECT_EQ(pose["is_depth_saturated"], false);
}

TEST_F(Program, ACacheGivesTheSameAnswerAndADamagedOneAWarning) {
  const std::string call =
      "query plate.stl pin.stl --units mm --spacing 1mm --voxel 0.25mm --repeats 1 --cache maps";
  const auto answer = [](const Ran& ran) { return ran.out.substr(0, ran.out.find("-sided query")); };
  const Ran without = run(call.substr(0, call.find(" --cache"))), first = run(call), second = run(call);
  EXPECT_EQ(answer(first), answer(without));
  EXPECT_EQ(answer(second), answer(without));
  EXPECT_EQ(second.err, "");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "maps")) {
    std::filesystem::resize_file(entry.path(), 1000);
    ++files;
  }
  EXPECT_GE(files, 1u);
  const Ran third = run(call);
  EXPECT_EQ(answer(third), answer(without));
  EXPECT_NE(third.err.find("built again"), std::string::npos) << third.err;
}

TEST_F(Program, ModelsAreKeptInTheUsersCacheUnlessToldNotTo) {
  const fs::path cache = folder_.string() + ".cache/bullet-vps";
  const auto answer = [&](const std::string& options) {
    const Ran ran = run("simulate scene.toml --seconds 0.05 --json a.json" + options);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err.find("kept"), std::string::npos) << ran.err;
    auto data = nlohmann::json::parse(slurp(folder_ / "a.json"));
    data.erase("wall");
    return data.dump();
  };
  const std::string without = answer(" --no-cache");
  EXPECT_FALSE(fs::exists(cache));
  EXPECT_EQ(answer(""), without);
  EXPECT_GE(std::distance(fs::directory_iterator(cache), {}), 2) << "a map and a shell";
  EXPECT_EQ(fs::status(cache).permissions(), fs::perms::owner_all);
  EXPECT_EQ(answer(""), without) << "read from the cache";
  EXPECT_EQ(answer(" --cache-limit 1e-6"), without) << "with no room in the cache";

  fs::remove_all(cache);
  std::ofstream(cache) << "a file where the folder should be";
  const Ran ran = run("simulate scene.toml --seconds 0.05 --json a.json");
  EXPECT_EQ(ran.status, 0);
  EXPECT_NE(ran.err.find("could not be kept"), std::string::npos) << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
}

TEST_F(Program, AFailedRunLeavesEarlierResultsAlone) {
  fs::create_directories(folder_ / "out");
  write("out/report.html", "earlier");
  write("out/assemble.json", "{}");
  write("broken.toml", std::string(kScene) + "friction = nan\n");
  expectRefused("assemble broken.toml --out out --json out/assemble.json", "friction");
  EXPECT_EQ(slurp(folder_ / "out/report.html"), "earlier");
  EXPECT_EQ(slurp(folder_ / "out/assemble.json"), "{}");
}

TEST_F(Program, QuerySaysWhichVoxelsItChoseAndThoseOfB) {
  const std::string call = "query plate.stl pin.stl --repeats 1 --json ";
  ASSERT_EQ(run(call + "mm.json --units mm").status, 0);
  EXPECT_FALSE(json::parse(slurp(folder_ / "mm.json")).contains("voxel_b_m"));
  const Ran small = run(call + "um.json --units um");
  ASSERT_EQ(small.status, 0) << small.err;
  EXPECT_NE(small.err.find("vps: chosen by the sizes of the parts: voxels of "), std::string::npos)
      << small.err;
  for (const char* name : {"'plate.stl'", "'pin.stl'"})
    EXPECT_NE(small.err.find(name), std::string::npos) << small.err;
  const json answer = json::parse(slurp(folder_ / "um.json"));
  EXPECT_NE(answer["voxel_m"].get<double>(), answer.value("voxel_b_m", 0.0)) << small.err;
}

TEST_F(Program, QueryWritesTheDocumentedKeys) {
  // The pin's foot is at -4 mm and the plate's top at 5 mm, so at 9.01 mm there is a gap of 10 um, and at
  // 8.99 mm an overlap of 10 um.
  write("poses.txt", "0,0,0.00901,0,0,0,1\n0,0,0.00899,0,0,0,1\n0,0,1,0,0,0,1\n");
  const std::string call =
      "query plate.stl pin.stl --units mm --voxel 0.5mm --spacing 1mm --poses poses.txt --json ";
  const Ran ran = run(call + "a.json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  const json answer = json::parse(slurp(folder_ / "a.json"));
  for (const char* key : {"poses", "memory_bytes", "voxel_m", "point_spacing_m", "wall"})
    EXPECT_TRUE(answer.contains(key)) << key;
  for (const char* key : {"median", "p99", "max"}) EXPECT_GT(answer["wall"]["time_us"][key], 0) << key;
  EXPECT_GT(answer["wall"]["build_s"], 0);
  ASSERT_EQ(answer["poses"].size(), 3u);
  for (const json& pose : answer["poses"])
    for (const char* key : {"min_distance_m", "max_depth_m", "contact_count", "points_total", "points_tested",
                            "force_N", "torque_Nm"})
      EXPECT_TRUE(pose.contains(key)) << key;
  // At flat faces the field is exact except for its storage as int16 over a band of 4 voxels of 0.5 mm (61
  // nm).
  constexpr double kTol_m = 0.1e-6;
  EXPECT_NEAR(answer["poses"][0]["min_distance_m"], 10e-6, kTol_m);
  EXPECT_EQ(answer["poses"][0]["max_depth_m"], 0);
  EXPECT_EQ(answer["poses"][0]["contact_count"], 0);
  EXPECT_NEAR(answer["poses"][1]["min_distance_m"], -10e-6, kTol_m);
  EXPECT_NEAR(answer["poses"][1]["max_depth_m"], 10e-6, kTol_m);
  EXPECT_GT(answer["poses"][1]["contact_count"], 0);
  EXPECT_GT(answer["poses"][1]["force_N"][2], 0);  // B is pushed up, out of A
  EXPECT_TRUE(answer["poses"][2]["min_distance_m"].is_null());
  EXPECT_GT(answer["poses"][2]["beyond_m"], 0);

  ASSERT_EQ(run(call + "b.json").status, 0);
  json first = answer, second = json::parse(slurp(folder_ / "b.json"));
  first.erase("wall");
  second.erase("wall");
  EXPECT_EQ(first.dump(), second.dump());
}

TEST_F(Program, ImportWritesASceneThatLoads) {
  const Ran ran = run("import plate.stl -o imported --units mm --json import.json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("20.00 x 20.00 x 10.00"), std::string::npos) << ran.out;
  const std::string scene = slurp(folder_ / "imported/scene.toml");
  EXPECT_NE(scene.find("unit = \"m\""), std::string::npos) << scene;
  const json answer = json::parse(slurp(folder_ / "import.json"));
  ASSERT_EQ(answer["parts"].size(), 1u);
  EXPECT_EQ(answer["parts"][0]["closed"], true);
  // The written mesh is imported again; 20 mm must survive the conversion to metres as float and back.
  const Ran again =
      run("import imported/" + answer["parts"][0]["file"].get<std::string>() + " -o again --units m");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find("20.00 x 20.00 x 10.00"), std::string::npos) << again.out;
  const Ran simulated = run("simulate imported/scene.toml --seconds 0.002 --voxel 1mm --spacing 2mm");
  EXPECT_EQ(simulated.status, 0) << simulated.err;
}

TEST_F(Program, ImportKeepsTheColorsOfFaces) {
  // A tetrahedron [mm] with a red face, a blue one, and two without a colour.
  write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nnewmtl grey\nKd 0.5 0.5 0.5\n");
  write("two.obj",
        "mtllib two.mtl\no tip\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nusemtl red\nf 1 3 2\n"
        "usemtl blue\nf 1 2 4\nusemtl grey\nf 1 4 3\nf 2 3 4\n");
  const Ran ran = run("import two.obj -o imported --units mm --json import.json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(run("import two.obj -o whole --units mm --part-per file").out.find("two.obj"), std::string::npos);
  const scenes::Scene scene = scenes::loadScene((folder_ / "imported/scene.toml").string());
  ASSERT_EQ(scene.parts.size(), 1U);
  const scenes::Part& tip = scene.parts[0].part;
  ASSERT_EQ(tip.mesh.triangles.size(), 4U);
  ASSERT_EQ(tip.face_colors.of_triangle.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& t = tip.mesh.triangles[i];
    const Vec3& a = tip.mesh.vertices[t[0]];
    const Vec3 n = (tip.mesh.vertices[t[1]] - a).cross(tip.mesh.vertices[t[2]] - a).normalized();
    const float grey = 0.21404f;  // linear value of 0.5, IEC 61966-2-1
    const scenes::Color truth = n.z() < -0.9   ? scenes::Color{1, 0, 0}
                                : n.y() < -0.9 ? scenes::Color{0, 0, 1}
                                               : scenes::Color{grey, grey, grey};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(tip.face_colors.at(i)[k], truth[k], 1e-4) << i;
  }
  // A colour in the scene file applies to the whole part.
  const std::string text = slurp(folder_ / "imported/scene.toml");
  const std::size_t at = text.find("pose = ");
  ASSERT_NE(at, std::string::npos);
  write("imported/scene.toml", text.substr(0, at) + "color = \"#00ff00\"\n" + text.substr(at));
  const scenes::Scene green = scenes::loadScene((folder_ / "imported/scene.toml").string());
  EXPECT_TRUE(green.parts[0].part.face_colors.isNone());
  EXPECT_EQ(green.parts[0].part.color, (scenes::Color{0, 1, 0}));
}

TEST_F(Program, SimulateWritesTheDocumentedKeys) {
  const Ran ran =
      run("simulate scene.toml --seconds 0.01 --voxel 0.5mm --spacing 1mm --json a.json --trace a.csv");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json answer = json::parse(slurp(folder_ / "a.json"));
  ASSERT_EQ(answer["bodies"].size(), 1u);
  for (const char* key : {"name", "position_m", "rotation_xyzw", "velocity_m_s", "angular_velocity_rad_s"})
    EXPECT_TRUE(answer["bodies"][0].contains(key)) << key;
  for (const char* key : {"max_penetration_m", "kinetic_energy_J", "wall"})
    EXPECT_TRUE(answer.contains(key)) << key;
  for (const char* key : {"median", "p99", "max"}) {
    EXPECT_TRUE(answer["wall"]["step_us"].contains(key)) << key;
    EXPECT_TRUE(answer["wall"]["contact_step_us"].contains(key)) << key;
  }
  const std::string trace = slurp(folder_ / "a.csv");
  EXPECT_EQ(std::count(trace.begin(), trace.end(), '\n'), 1 + answer["steps"].get<int>());
  // In free fall from 0.1 mm the pin would fall g t^2 / 2 = 0.49 mm in 10 ms, so it has landed.
}

TEST_F(Program, SimulateJudgesOverlapByExactDistanceAndItsExitStatusTells) {
  const auto scene = [](const char* part) {
    return std::string("unit = \"mm\"\n[fidelity]\nvoxel = \"0.5mm\"\nspacing = \"1mm\"\n") + part +
           "[[part]]\nfile = \"plate.stl\"\nfixed = true\nstiffness = 1e8\n"
           "[[part]]\nfile = \"pin.stl\"\nstiffness = 1e8\n";
  };
  write("hard.toml", scene("") + "pose = {position = [0, 0, 9.5]}\n");
  const Ran hard = run("simulate hard.toml --seconds 0.05 --judge-every 1 --json hard.json");
  EXPECT_EQ(hard.status, 0) << hard.out << hard.err;
  EXPECT_NE(hard.out.find("deepest overlap by exact distance"), std::string::npos) << hard.out;
  const json judged = json::parse(slurp(folder_ / "hard.json"))["overlap"];
  EXPECT_EQ(judged["poses_judged"], 51);
  EXPECT_TRUE(judged["is_within_limit"]);
  EXPECT_LE(judged["max_depth_m"].get<double>(), judged["limit_m"].get<double>());

  // The pin falls on a soft plate: 1e8 N/m^3 on 16 mm^2 carry its weight of 10 mN at a depth of 6 um; the
  // impact is deeper.
  write("soft.toml", scene("contact = \"penalty\"\n") + "pose = {position = [0, 0, 9.5]}\n");
  const Ran soft = run("simulate soft.toml --seconds 0.05 --judge-every 1 --json soft.json");
  EXPECT_EQ(soft.status, 1) << soft.out << soft.err;
  EXPECT_FALSE(json::parse(slurp(folder_ / "soft.json"))["overlap"]["is_within_limit"]);
  EXPECT_EQ(run("simulate soft.toml --seconds 0.05").status, 0);

  write("inside.toml", scene("") + "pose = {position = [0, 0, 8.5]}\n");
  const Ran inside = run("simulate inside.toml --seconds 0.05 --judge-every 1 --json inside.json");
  EXPECT_EQ(inside.status, 0) << inside.out << inside.err;
  EXPECT_NE(inside.err.find("'pin' starts "), std::string::npos) << inside.err;
  const json starts = json::parse(slurp(folder_ / "inside.json"))["overlap"]["at_start"];
  ASSERT_EQ(starts.size(), 1U);
  EXPECT_NEAR(starts[0]["depth_m"].get<double>(), 0.5e-3, 1e-6);

  // The parts separate at 0.05 m/s, so 0.5 mm take 10 ms.
  const Ran stuck = run("simulate inside.toml --seconds 0.004 --judge-every 1 --json stuck.json");
  EXPECT_EQ(stuck.status, 1) << stuck.out << stuck.err;
  EXPECT_NE(stuck.err.find("these parts did not come apart"), std::string::npos) << stuck.err;
  EXPECT_NE(stuck.out.find("not within the limit: 1 pair of bodies overlapped from start to end"),
            std::string::npos)
      << stuck.out;
  const json never = json::parse(slurp(folder_ / "stuck.json"));
  EXPECT_FALSE(never["overlap"]["is_within_limit"]);
  EXPECT_GT(never["overlap"]["at_start"][0]["end_depth_m"].get<double>(), 10e-6);
  EXPECT_EQ(never["shortened_steps"], 0);

  expectRefused("simulate hard.toml --judge-every 1 --real-time", "real time");
  expectRefused("simulate hard.toml --judge-every 0", "--judge-every");
}

}  // namespace
}  // namespace vps
