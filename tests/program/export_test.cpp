// SPDX-License-Identifier: BSD-3-Clause
// vps export, and vps query of the exported files.
#include <nlohmann/json.hpp>

#include "program.h"

namespace vps {
namespace {

using nlohmann::json;

class Export : public Program {
 protected:
  json read(const std::string& name) const { return json::parse(slurp(folder_ / name)); }
};

// One pose is 10 um inside and one 10 um outside: see QueryWritesTheDocumentedKeys.
constexpr const char* kPoses = "0,0,0.00901,0,0,0,1\n0,0,0.00899,0,0,0,1\n";

TEST_F(Export, TheExportedModelsGiveTheSameAnswerAsTheMeshes) {
  write("poses.txt", kPoses);
  const Ran exported = run("export plate.stl --units mm --voxel 0.5mm -o plate.vdb --json a.json");
  ASSERT_EQ(exported.status, 0) << exported.err;
  EXPECT_EQ(read("a.json")["files"][0]["model"], "voxmap");
  EXPECT_EQ(read("a.json")["files"][0]["voxel_m"], 0.5e-3);
  ASSERT_EQ(run("export pin.stl --units mm --spacing 1mm -o pin.ply").status, 0);

  const std::string options = " --sides one --poses poses.txt --json ";
  ASSERT_EQ(
      run("query plate.stl pin.stl --units mm --voxel 0.5mm --spacing 1mm" + options + "mesh.json").status,
      0);
  const Ran both = run("query plate.vdb pin.ply" + options + "models.json");
  ASSERT_EQ(both.status, 0) << both.err;
  EXPECT_NE(both.out.find("one-sided query"), std::string::npos) << both.out;
  // Both formats store every value exactly, so the answers are equal to the bit.
  const json mesh = read("mesh.json"), models = read("models.json");
  EXPECT_EQ(mesh["poses"], models["poses"]);
  EXPECT_EQ(mesh["voxel_m"], models["voxel_m"]);

  // A query of one exported file and one mesh.
  ASSERT_EQ(run("query plate.vdb pin.stl --units mm --spacing 1mm" + options + "map.json").status, 0);
  ASSERT_EQ(run("query plate.stl pin.ply --units mm --voxel 0.5mm" + options + "shell.json").status, 0);
  EXPECT_EQ(read("map.json")["poses"], mesh["poses"]);
  EXPECT_EQ(read("shell.json")["poses"], mesh["poses"]);
}

TEST_F(Export, SeveralFilesAreWrittenAtOnceAndThePartOfASceneIsChosenByName) {
  const Ran ran =
      run("export scene.toml --part pin --voxel 0.5mm --points 500 -o a.vdb -o a.ply -o a.stl --json a.json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json files = read("a.json")["files"];
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[2]["triangles"], 12);
  // "About 500": edges and corners add points of their own.
  EXPECT_GT(files[1]["points"], 250);
  EXPECT_LT(files[1]["points"], 2000);
  for (const char* file : {"a.vdb", "a.ply", "a.stl"}) EXPECT_GT(fs::file_size(folder_ / file), 100u) << file;
  // The file is in the part's own frame: the scene places the pin 9.1 mm higher, in the file it is at the
  // origin.
  const Ran imported = run("import a.stl -o again --units m");
  EXPECT_NE(imported.out.find("4.00 x 4.00 x 8.00"), std::string::npos) << imported.out;
}

TEST_F(Export, WhatCannotBeExportedIsRefusedAndLeavesNoFile) {
  expectRefused("export plate.stl --units mm", "see vps export --help");
  expectRefused("export plate.stl --units mm -o plate.xyz", "plate.xyz: cannot be exported; expected .vdb");
  expectRefused("export plate.stl --units mm -o plate.stl", "which would overwrite it");
  expectRefused("export plate.stl -o plate.vdb", "plate.stl");
  expectRefused("export plate.stl --units mm --part pin -o a.vdb", "--part needs a scene");
  expectRefused("export scene.toml -o a.vdb", "has several parts; choose one with --part: plate, pin");
  expectRefused("export scene.toml --part screw -o a.vdb",
                "part 'screw': is not in the scene; its parts are: plate, pin");
  // The first file can be written and the second cannot, so neither file must appear.
  expectRefused("export plate.stl --units mm -o good.stl -o /dev/null/a.vdb", "/dev/null/a.vdb");
  EXPECT_FALSE(fs::exists(folder_ / "good.stl"));
  ASSERT_EQ(run("export plate.stl --units mm --voxel 1mm -o plate.vdb").status, 0);
  expectRefused("export plate.vdb -o plate.ply", "plate.vdb: is a level set and has no mesh");
}

TEST_F(Export, AQueryOfModelFilesRefusesWhatTheyCannotGive) {
  ASSERT_EQ(run("export plate.stl --units mm --voxel 1mm --spacing 2mm -o plate.vdb -o plate.ply").status, 0);
  expectRefused("query plate.ply pin.stl --units mm", "plate.ply: is a pointshell");
  expectRefused("query pin.stl plate.vdb --units mm",
                "plate.vdb: is a level set, but B provides the pointshell");
  expectRefused("query plate.vdb plate.ply --voxel 1mm",
                "plate.vdb: holds a voxmap already; leave --voxel out");
  expectRefused("query plate.vdb plate.ply --spacing 1mm", "leave --spacing out");
  expectRefused("query plate.vdb plate.ply --points 100", "leave --points out");
  expectRefused("query plate.vdb plate.ply --sides both", "--sides both needs the meshes of both parts");
  const std::string bytes = slurp(folder_ / "plate.vdb");
  write("half.vdb", bytes.substr(0, bytes.size() / 2));
  expectRefused("query half.vdb plate.ply", "half.vdb");
}

}  // namespace
}  // namespace vps
