// SPDX-License-Identifier: BSD-3-Clause
// Invalid input and use: the exit status is 2, one line says what is wrong and what would help, and no file
// is changed.
#include "program.h"

namespace vps {
namespace {

TEST_F(Program, WrongUseIsOneLineAndStatusTwo) {
  expectRefused("", "see vps --help");
  expectRefused("asemble scene.toml", "unknown command 'asemble'; see vps --help");
  expectRefused("--fast", "unknown option '--fast'; see vps --help");
  expectRefused("assemble", "see vps assemble --help");
  expectRefused("assemble scene.toml --fast", "unknown option '--fast'; see vps assemble --help");
  expectRefused("simulate a.toml b.toml c.toml d.toml",
                "these arguments are too many: 'b.toml' 'c.toml' 'd.toml'; see vps simulate --help");
  expectRefused("simulate a.toml b.toml", "one argument is too many: 'b.toml'; see vps simulate --help");
  expectRefused("simulate scene.toml --seconds soon", "--seconds");
  expectRefused("simulate scene.toml --seconds nan", "--seconds");
  expectRefused("simulate scene.toml --seconds -1", "--seconds");
  expectRefused("snapshot scene.toml", "-o FILE.png");
  expectRefused("snapshot scene.toml -o a.png --size 10", "--size");
  expectRefused("snapshot scene.toml -o a.png --view north", "--view");
  expectRefused("snapshot scene.toml --compare gone.png", "gone.png");
  expectRefused("query plate.stl", "see vps query --help");
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
  for (const std::string command : {"snapshot -o a.png", "simulate", "explain", "trade"}) {
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
  // /dev/null is not a folder, not even for root. The input is missing too, but the output folder is reported
  // first.
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

TEST_F(Program, APartTooFarFromTheOriginIsRefused) {
  std::string far = "solid far\n";
  for (const char* facet :
       {"1e9 0 0 vertex 1e9 9 0 vertex 1e9 0 9", "1e9 0 0 vertex 1000000099 0 0 vertex 1e9 9 0"})
    far += std::string("facet normal 0 0 1 outer loop vertex ") + facet + " endloop endfacet\n";
  write("far.stl", far + "endsolid far\n");
  const Ran ran = run("query far.stl pin.stl --units m --voxel 0.25mm");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("far.stl': the part lies 1e+09 m from the origin, too far for 0.25 mm voxels"),
            std::string::npos)
      << ran.err;
}

TEST_F(Program, AFileThatIsNotARecordingIsNotOverwritten) {
  const std::string step = "[[step]]\npart = 'pin'\n";
  write("steps.toml", kScene + step);
  write("letter.txt", "dear reader");
  expectRefused("assemble steps.toml --record letter.txt --out out",
                "letter.txt: exists and is not a recording");
  expectRefused("assemble steps.toml --record steps.toml --out out", "steps.toml: is read by this command");
  expectRefused("assemble steps.toml --record no/run.mcap --out out", "no/run.mcap: cannot be written");
  expectRefused("assemble steps.toml --record run.mcap --out out --local-contact",
                "run.mcap: a run with local contact cannot be replayed");
  EXPECT_EQ(slurp(folder_ / "letter.txt"), "dear reader");
  EXPECT_EQ(slurp(folder_ / "steps.toml"), kScene + step);
}

TEST_F(Program, ReplayRefusesFilesThatAreNotRecordings) {
  expectRefused("replay missing.mcap", "missing.mcap: no such file");
  expectRefused("replay plate.stl", "plate.stl: is not a recording (MCAP)");
  expectRefused("replay plate.stl --no-run", "--no-run leaves nothing to do without --csv");
}

}  // namespace
}  // namespace vps
