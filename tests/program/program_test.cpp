// SPDX-License-Identifier: BSD-3-Clause
// The program `vps` as its users run it: exit status, messages and files, on valid and invalid input.
#include "program.h"

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

const std::vector<std::string> kReady = {"assemble", "replay",   "simulate", "query", "import",
                                         "export",   "snapshot", "explain",  "trade", "device"};
const std::vector<std::string> kPlanned = {"check", "view", "render", "watch"};

TEST_F(Program, EveryCommandHasHelpWithAnExample) {
  std::vector<std::string> all = kReady;
  all.insert(all.end(), kPlanned.begin(), kPlanned.end());
  const std::string overview = run("--help").out;
  for (const std::string& command : all) {
    const Ran ran = run(command + " --help");
    EXPECT_EQ(ran.status, 0) << command;
    EXPECT_EQ(ran.err, "") << command;
    EXPECT_NE(ran.out.find("Example:\n  vps " + command), std::string::npos) << ran.out;
    EXPECT_NE(overview.find(command), std::string::npos) << overview;
  }
  EXPECT_EQ(run("--version").status, 0);
}

TEST_F(Program, PlannedCommandsSayThatTheyAreNotImplemented) {
  for (const std::string& command : kPlanned) {
    expectRefused(command, command + " is not implemented yet");
    expectRefused(command + " scene.toml --and whatever", command + " is not implemented yet");
  }
}

TEST_F(Program, WrongUseIsOneLineAndStatusTwo) {
  expectRefused("", "see vps --help");
  expectRefused("asemble scene.toml", "unknown command 'asemble'; see vps --help");
  expectRefused("--fast", "unknown option '--fast'; see vps --help");
  expectRefused("assemble", "see vps assemble --help");
  expectRefused("assemble scene.toml --fast", "see vps assemble --help");
  expectRefused("simulate scene.toml --seconds soon", "--seconds");
  expectRefused("simulate scene.toml --seconds nan", "--seconds");
  expectRefused("simulate scene.toml --seconds -1", "--seconds");
  expectRefused("snapshot scene.toml", "-o FILE.png");
  expectRefused("snapshot scene.toml -o a.png --size 10", "--size");
  expectRefused("snapshot scene.toml -o a.png --view north", "--view");
  expectRefused("snapshot scene.toml --compare gone.png", "gone.png");
  expectRefused("query plate.stl", "see vps query --help");
}

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
  // A scene file accepts what was printed.
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
  EXPECT_NE(none.err.find("no fidelity meets this"), std::string::npos) << none.err;
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
  expectRefused("device", "the device node is not implemented yet");
  expectRefused("device --json a.json", "--characterise");
}

TEST_F(Program, ABadSceneIsNamedByFileLineAndKey) {
  const std::string scene = kScene;
  write("nan.toml", scene + "friction = nan\n");
  write("key.toml", scene + "frcition = 1\n");
  write("unit.toml", scene.substr(scene.find('\n') + 1));
  write("cut.toml", scene + "[[part]]\nfile = 'cut.stl'\n");
  write("gone.toml", scene + "[[part]]\nfile = 'gone.stl'\n");
  for (const std::string command : {"assemble", "simulate", "snapshot -o a.png"}) {
    expectRefused(command + " no_such.toml", "no_such.toml: no such file");
    expectRefused(command + " nan.toml", "nan.toml:8: key 'friction' is nan");
    expectRefused(command + " key.toml", "key.toml:8: key 'frcition' is unknown; did you mean 'friction'?");
    expectRefused(command + " unit.toml", "unit.toml:2: key 'file' cannot be used: plate.stl");
    expectRefused(command + " cut.toml", "cut.toml:9: key 'file' cannot be used: cut.stl");
    expectRefused(command + " gone.toml", "gone.toml:9: key 'file' cannot be used: gone.stl");
  }
}

TEST_F(Program, ABadMeshOrNumberIsNamed) {
  expectRefused("query plate.stl gone.stl --units mm", "gone.stl");
  expectRefused("query plate.stl cut.stl --units mm", "cut.stl");
  expectRefused("query plate.stl pin.stl", "plate.stl");
  expectRefused("query plate.stl pin.stl --units furlong", "--units is 'furlong'");
  expectRefused("query plate.stl pin.stl --units mm --voxel -0.2mm",
                "--voxel is -0.2mm; expected more than 0");
  expectRefused("query plate.stl pin.stl --units mm --voxel 0.2", "--voxel");
  expectRefused("query plate.stl pin.stl --units mm --spacing nanmm", "--spacing");
  expectRefused("query plate.stl pin.stl --units mm --sides three", "--sides is 'three'");
  expectRefused("query plate.stl pin.stl --units mm --fidelity finest", "finest");
  expectRefused("query plate.stl pin.stl --units mm --stiffness nan", "--stiffness");
  expectRefused("query plate.stl pin.stl --units mm --pose 0,0,0", "--pose: '0,0,0' is not a pose");
  expectRefused("query plate.stl pin.stl --units mm --pose 0,0,nan,0,0,0,1", "is not a pose");
  expectRefused("query plate.stl pin.stl --units mm --pose 0,0,0,0,0,0,0", "is not a pose");
  write("poses.txt", "# one pose a line\n0,0,0,0,0,0,1\n0,0,x,0,0,0,1\n");
  expectRefused("query plate.stl pin.stl --units mm --poses poses.txt",
                "poses.txt:3: '0,0,x,0,0,0,1' is not a pose");
  expectRefused("query plate.stl pin.stl --units mm --poses gone.txt", "gone.txt: no such file");
  expectRefused("query plate.stl pin.stl --units mm --poses .", ".: is a folder");
  expectRefused("import cut.stl -o imported --units mm", "cut.stl");
  expectRefused("import plate.stl -o imported", "plate.stl");
  EXPECT_FALSE(fs::exists(folder_ / "imported"));
}

TEST_F(Program, AFileOfAnotherKindIsRefusedWithTheCommandThatReadsIt) {
  write("part.STEP", "ISO-10303-21;");
  write("run.mcap", "");
  write("map.vdb", "");
  for (const std::string command : {"snapshot -o a.png", "simulate", "assemble", "explain", "trade"}) {
    expectRefused(command + " part.STEP",
                  "part.STEP: is a CAD file, not a scene; make a scene of it first: vps import");
    expectRefused(command + " run.mcap", "vps replay run.mcap");
    expectRefused(command + " map.vdb", "map.vdb: is a level set, not a scene");
  }
  expectRefused("import map.vdb -o new", "map.vdb: is a level set and has no mesh; vps query");
  expectRefused("import scene.toml -o new", "scene.toml: is a scene already");
}

TEST_F(Program, RenamedOptionsAreRefused) {
  expectRefused("assemble scene.toml --no-degrade", "--no-degrade");
}

TEST_F(Program, APlaceThatCannotBeWrittenIsReportedBeforeTheWork) {
  // /dev/null is not a folder, not even for root. The input is missing too, but the place is reported first.
  expectRefused("assemble gone.toml --out /dev/null/out", "/dev/null/out");
  expectRefused("assemble gone.toml --json /dev/null/a.json", "/dev/null/a.json");
  expectRefused("simulate gone.toml --trace /dev/null/a.csv", "/dev/null/a.csv");
  expectRefused("query plate.stl gone.stl --json /dev/null/a.json", "/dev/null/a.json");
  expectRefused("import gone.step -o plate.stl", "plate.stl");
  expectRefused("snapshot gone.toml -o /dev/null/a.png", "/dev/null/a.png");
}

TEST_F(Program, AnInputIsNeverOverwritten) {
  const std::string plate = slurp(folder_ / "plate.stl"), words = "which would overwrite it";
  fs::create_symlink("plate.stl", folder_ / "link.json");
  expectRefused("query plate.stl pin.stl --units mm --json ./plate.stl", words);
  expectRefused("query plate.stl pin.stl --units mm --json link.json", words);
  expectRefused("simulate scene.toml --trace scene.toml", words);
  expectRefused("assemble scene.toml --json scene.toml", words);
  expectRefused("simulate scene.toml --json plate.stl", words);
  expectRefused("assemble scene.toml --json plate.stl", words);
  expectRefused("snapshot scene.toml -o scene.toml", words);
  expectRefused("snapshot scene.toml -o plate.stl", words);
  expectRefused("import plate.stl -o . --units mm", "has a scene.toml already");
  expectRefused("import plate.stl -o . --units mm --force", words);
  EXPECT_EQ(slurp(folder_ / "plate.stl"), plate);
  EXPECT_EQ(slurp(folder_ / "scene.toml"), kScene);
  ASSERT_EQ(run("import pin.stl -o new --units mm").status, 0);
  EXPECT_EQ(run("import pin.stl -o new --units mm").status, 2);
  EXPECT_EQ(run("import pin.stl -o new --units mm --force").status, 0);
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

  // Opened for reading first, so that the program finds a reader; a pipe's buffer holds all that it writes.
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
  // One triangle of twelve left out: the count at byte 80, then 50 bytes each.
  std::string open_box = stlBox(Vec3(4, 4, 8));
  open_box[80] = 11;
  open_box.resize(84 + 11 * 50);
  write("open.stl", open_box);
  const std::string settings = " --units mm --spacing 2mm --voxel ";
  EXPECT_TRUE(run("query plate.stl open.stl" + settings + "1mm").err.starts_with("vps: warning: open.stl: "));
  EXPECT_TRUE(run("import open.stl -o new --units mm").err.starts_with("vps: warning: open.stl: "));
  EXPECT_NE(run("query plate.stl pin.stl" + settings + "6mm")
                .err.find("vps: warning: plate.stl: is 10.000 mm thin"),
            std::string::npos);
  EXPECT_EQ(run("query plate.stl pin.stl" + settings + "1mm").err, "");
}

TEST_F(Program, ADepthBeyondTheBandIsReportedAsABound) {
  // The plate is 10 mm thick: in its middle the pin is 5 mm deep, and the band is 4 voxels wide.
  const std::string call = "query plate.stl pin.stl --units mm --spacing 1mm --json a.json --voxel ";
  const Ran deep = run(call + "0.25mm");
  EXPECT_NE(deep.out.find("< -1000.00"), std::string::npos) << deep.out;
  EXPECT_EQ(json::parse(slurp(folder_ / "a.json"))["poses"][0]["is_depth_saturated"], true);
  const Ran shallow = run(call + "0.25mm --pose 0,0,0.0085,0,0,0,1");
  const json pose = json::parse(slurp(folder_ / "a.json"))["poses"][0];
  EXPECT_EQ(shallow.out.find("< -"), std::string::npos) << shallow.out;
  // Half the step in which the map stores distances: the 1 mm band / 32767.
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

TEST_F(Program, APartTooFarFromTheOriginIsRefused) {
  std::string far = "solid far\n";
  for (const char* facet :
       {"1e9 0 0 vertex 1e9 9 0 vertex 1e9 0 9", "1e9 0 0 vertex 1000000099 0 0 vertex 1e9 9 0"})
    far += std::string("facet normal 0 0 1 outer loop vertex ") + facet + " endloop endfacet\n";
  write("far.stl", far + "endsolid far\n");
  const Ran ran = run("query far.stl pin.stl --units m --voxel 0.25mm");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("far.stl': lies 1e+09 m from the origin, too far for 0.25 mm voxels"),
            std::string::npos)
      << ran.err;
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

TEST_F(Program, QueryWritesTheDocumentedKeys) {
  // The pin's foot is at -4 mm, the plate's top at 5 mm: 9.01 mm leave 10 um, 8.99 mm press 10 um.
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
  // Flat faces: the field is exact there but for its storage, int16 over a band of 4 voxels of 0.5 mm (61
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
  // The written mesh is imported again: 20 mm survive the conversion to float metres and back.
  const Ran again =
      run("import imported/" + answer["parts"][0]["file"].get<std::string>() + " -o again --units m");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find("20.00 x 20.00 x 10.00"), std::string::npos) << again.out;
  const Ran simulated = run("simulate imported/scene.toml --seconds 0.002 --voxel 1mm --spacing 2mm");
  EXPECT_EQ(simulated.status, 0) << simulated.err;
}

TEST_F(Program, AFileThatIsNotARecordingIsNotOverwritten) {
  const std::string step = "[[step]]\npart = 'pin'\n";
  write("steps.toml", kScene + step);
  write("letter.txt", "dear reader");
  expectRefused("assemble steps.toml --record letter.txt --out out",
                "letter.txt: is there and is no recording");
  expectRefused("assemble steps.toml --record steps.toml --out out", "steps.toml: is read by this command");
  expectRefused("assemble steps.toml --record no/run.mcap --out out", "no/run.mcap: cannot be written");
  expectRefused("assemble steps.toml --record run.mcap --out out --local-contact",
                "run.mcap: a run with local contact cannot be replayed");
  EXPECT_EQ(slurp(folder_ / "letter.txt"), "dear reader");
  EXPECT_EQ(slurp(folder_ / "steps.toml"), kScene + step);
}

TEST_F(Program, ReplayRefusesFilesThatAreNotRecordings) {
  expectRefused("replay missing.mcap", "missing.mcap: no such file");
  expectRefused("replay plate.stl", "plate.stl: is no recording (MCAP)");
  expectRefused("replay plate.stl --no-run", "--no-run leaves nothing to do without --csv");
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
  // Free fall from 0.1 mm: after 10 ms it has fallen g t^2 / 2 = 0.49 mm, so it has landed.
}

}  // namespace
}  // namespace vps
