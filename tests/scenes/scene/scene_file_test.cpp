// SPDX-License-Identifier: BSD-3-Clause
// The scene file: its values arrive in Scene, and each mistake is reported with line and key.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "support/stl_box.h"
#include "vps/errors.h"
#include "vps_scenes/scene/scene.h"
#include "vps_scenes/scene/scene_text.h"

namespace vps::scenes {
namespace {

namespace fs = std::filesystem;

/// A temporary folder with a plate of 40 x 40 x 10 and a pin of 4 x 4 x 20, both in millimetres.
class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("vps_scene_file_" + std::string(info->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("plate.stl", stlBox(Vec3(40, 40, 10)));
    write("pin.stl", stlBox(Vec3(4, 4, 20)));
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  [[nodiscard]] std::string file() const { return (folder_ / "scene.toml").string(); }

  Scene load(const std::string& text) const {
    write("scene.toml", text);
    return loadScene(file());
  }

  /// The message of the error, without the folder; "" when the file loads.
  std::string messageOf(const std::string& text) const {
    try {
      load(text);
      return "";
    } catch (const LoadError& error) {
      std::string words = error.what();
      const std::string prefix = folder_.string() + "/";
      for (auto at = words.find(prefix); at != std::string::npos; at = words.find(prefix))
        words.erase(at, prefix.size());
      EXPECT_EQ(words.find('\n'), std::string::npos) << words;
      return words;
    }
  }

  fs::path folder_;
};

const std::string kPlate = "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n";  // lines 1 to 4
const std::string kPin = kPlate + "[[part]]\nfile = 'pin.stl'\n";                        // lines 5 and 6
const std::string kStep = kPin + "[[step]]\npart = 'pin'\n";                             // lines 7 and 8

TEST_F(SceneFile, TwoMeshesAndOneStepAreAScene) {
  const Scene scene = load(kStep);
  ASSERT_EQ(scene.parts.size(), 2u);
  EXPECT_EQ(scene.parts[0].part.name, "plate");
  EXPECT_TRUE(scene.parts[0].is_fixed);
  EXPECT_EQ(scene.parts[1].part.name, "pin");
  EXPECT_FALSE(scene.parts[1].is_fixed);
  EXPECT_NEAR(bounds(scene.parts[1].part.mesh).size().z(), 0.020, 1e-12);  // 20 is exact in float
  ASSERT_EQ(scene.steps.size(), 1u);
  EXPECT_EQ(scene.steps[0].part, 1u);
  EXPECT_EQ(scene.gravity_W, Vec3(0, 0, -9.81));
}

TEST_F(SceneFile, AStepStartsAboveThePartsInPlace) {
  // The plate's top is at 5 mm, the pin's lower end at its target at -10 mm: a lift of 15 mm clears the
  // plate, and half the pin's height of 20 mm is added.
  const Scene scene = load(kStep);
  EXPECT_NEAR(scene.steps[0].X_WP_start.p.z(), 0.025, 1e-12);
  EXPECT_EQ(scene.steps[0].X_WP_target.p, Vec3(Vec3::Zero()));
}

TEST_F(SceneFile, ApproachIsAnOffsetFromTheTarget) {
  const Scene scene = load(kStep + "target = {position = [1, 2, 3]}\napproach = [0, '2cm', 30]\n");
  EXPECT_NEAR((scene.steps[0].X_WP_target.p - Vec3(1e-3, 2e-3, 3e-3)).norm(), 0, 1e-15);
  EXPECT_NEAR((scene.steps[0].X_WP_start.p - Vec3(1e-3, 22e-3, 33e-3)).norm(), 0, 1e-15);
}

TEST_F(SceneFile, EveryKeyArrivesInSi) {
  const Scene scene = load(R"(
name = "all keys"
unit = "cm"
gravity = [0, -1.5, 0]
release_s = 0.5
[material]
density = 2700
[[part]]
name = "base"
file = "plate.stl"
fixed = true
[[part]]
file = "pin.stl"
pose = {position = [1, 0, "3mm"], rpy_deg = [0, 0, 90]}
friction = 0.3
restitution = 0.4
stiffness = 2e12
color = "#ff0000"
allow_overlap = true
[[step]]
part = "pin"
start = {position = [0, 0, 9]}
way_points = [{position = [0, 0, 5]}, {rotation_xyzw = [1, 0, 0, 0]}]
tolerance = "50um"
tolerance_deg = 1
clearance = "20um"
timeout_s = 7
[device]
kind = "dual_arm"
scale = 2
quantised_encoders = false
indexing = false
[operator]
seed = 42
aim_error = "1mm"
aim_error_deg = 2
speed_m_s = 0.1
press_N = 6
force_limit_N = 20
[coupling]
k_N_per_m = 1
b_Ns_per_m = 2
k_Nm_per_rad = 3
b_Nms_per_rad = 4
max_force_N = 5
max_torque_Nm = 6
[fidelity]
preset = "fine"
voxel = "0.1mm"
spacing = 0.02
sides = "one"
gradient = "trilinear"
contact_limit = 10
haptic_rate_hz = 4000
physics_rate_hz = 2000
substeps = "auto"
solver_iterations = 50
contact = "penalty"
[record]
csv_rate_hz = 100
)");
  EXPECT_EQ(scene.name, "all keys");
  EXPECT_EQ(scene.gravity_W, Vec3(0, -1.5, 0));
  EXPECT_EQ(scene.release_s, 0.5);
  EXPECT_EQ(scene.parts[0].part.name, "base");
  EXPECT_EQ(scene.parts[0].part.material.density_kg_m3, 2700);
  EXPECT_NEAR(bounds(scene.parts[0].part.mesh).size().x(), 0.40, 1e-12);

  const ScenePart& pin = scene.parts[1];
  EXPECT_NEAR((pin.X_WP.p - Vec3(0.01, 0, 0.003)).norm(), 0, 1e-15);
  EXPECT_NEAR((pin.X_WP.R * Vec3::UnitX() - Vec3::UnitY()).norm(), 0, 1e-15);
  EXPECT_EQ(pin.part.material.density_kg_m3, 2700);
  EXPECT_EQ(pin.part.material.friction, 0.3);
  EXPECT_EQ(pin.part.material.restitution, 0.4);
  EXPECT_EQ(pin.part.material.stiffness_N_per_m3, 2e12);
  EXPECT_EQ(pin.part.color, (std::array<float, 3>{1, 0, 0}));
  EXPECT_TRUE(pin.allow_overlap);

  const SceneStep& step = scene.steps[0];
  EXPECT_NEAR(step.X_WP_start.p.z(), 0.09, 1e-15);
  EXPECT_NEAR((step.X_WP_start.R - pin.X_WP.R).norm(), 0,
              1e-15);  // a rotation that a pose leaves out is the target's
  ASSERT_EQ(step.way_points.size(), 2u);
  EXPECT_NEAR(step.way_points[0].p.z(), 0.05, 1e-15);
  EXPECT_NEAR((step.way_points[1].R - Vec3(1, -1, -1).asDiagonal().toDenseMatrix()).norm(), 0, 1e-15);
  EXPECT_EQ(step.way_points[1].p, step.X_WP_target.p);
  EXPECT_NEAR(step.tolerance_m, 50e-6, 1e-18);
  EXPECT_NEAR(step.tolerance_rad, std::numbers::pi / 180, 1e-16);
  EXPECT_NEAR(step.clearance_m, 20e-6, 1e-18);
  EXPECT_EQ(step.timeout_s, 7);

  EXPECT_EQ(scene.device.scale, 2);
  EXPECT_FALSE(scene.device.has_quantised_encoders);
  EXPECT_FALSE(scene.device.has_indexing);
  EXPECT_EQ(scene.hand.seed, 42u);
  EXPECT_NEAR(scene.hand.aim_error_m, 1e-3, 1e-17);
  EXPECT_NEAR(scene.hand.aim_error_rad, std::numbers::pi / 90, 1e-16);
  EXPECT_EQ(scene.hand.speed_m_s, 0.1);
  EXPECT_EQ(scene.hand.press_N, 6);
  EXPECT_EQ(scene.hand.force_limit_N, 20);
  EXPECT_EQ(scene.coupling.k_N_per_m, 1);
  EXPECT_EQ(scene.coupling.b_Ns_per_m, 2);
  EXPECT_EQ(scene.coupling.k_Nm_per_rad, 3);
  EXPECT_EQ(scene.coupling.b_Nms_per_rad, 4);
  EXPECT_EQ(scene.coupling.max_force_N, 5);
  EXPECT_EQ(scene.coupling.max_torque_Nm, 6);
  EXPECT_NEAR(scene.fidelity.voxel_m, 0.1e-3, 1e-18);
  EXPECT_NEAR(scene.fidelity.spacing_m, 0.2e-3, 1e-18);
  EXPECT_EQ(scene.fidelity.sides, Sides::One);
  EXPECT_EQ(scene.fidelity.gradient, Gradient::Trilinear);
  EXPECT_EQ(scene.fidelity.contact_limit, 10);
  EXPECT_EQ(scene.fidelity.haptic_rate_hz, 4000);
  EXPECT_EQ(scene.fidelity.physics_rate_hz, 2000);
  EXPECT_EQ(scene.fidelity.substeps, 0);
  EXPECT_EQ(scene.fidelity.solver_iterations, 50);
  EXPECT_EQ(scene.fidelity.contact_method, ContactMethod::Penalty);
  EXPECT_EQ(scene.record.csv_rate_hz, 100);
}

TEST_F(SceneFile, TheSubstepsOfAStepAreANumberOrAuto) {
  EXPECT_EQ(load(kPin).fidelity.substeps, 1);
  EXPECT_EQ(load(kPin + "[fidelity]\nsubsteps = 12\n").fidelity.substeps, 12);
  EXPECT_THROW(load(kPin + "[fidelity]\nsubsteps = 'many'\n"), LoadError);
  EXPECT_THROW(load(kPin + "[fidelity]\nsubsteps = -1\n"), LoadError);
  EXPECT_THROW(load(kPin + "[fidelity]\nsubsteps = 0\n"), LoadError);
}

TEST_F(SceneFile, AScrewHasAPitchWithASign) {
  EXPECT_DOUBLE_EQ(load(kStep + "motion = 'screw'\npitch = '-1.5mm'\n").steps[0].pitch_m, -1.5e-3);
}

TEST_F(SceneFile, APresetMayBeGivenByItsName) {
  EXPECT_EQ(load("fidelity = 'fast'\n" + kPin).fidelity.voxel_m, fidelityPreset("fast").voxel_m);
}

// The spacing is a quarter of the smallest part that moves, between two and four voxels of 0.25 mm.
TEST_F(SceneFile, WithoutASpacingThePointsAreAsFarApartAsTheSmallestMovedPartAllows) {
  const auto spacing_m = [&](double across_mm, const std::string& fidelity) {
    write("small.stl", stlBox(Vec3(across_mm, 40, 40)));
    return load(kStep + "[[part]]\nfile = 'small.stl'\n[[step]]\npart = 'small'\n" + fidelity)
        .fidelity.spacing_m;
  };
  EXPECT_NEAR(spacing_m(8, ""), 1e-3, 1e-9);
  EXPECT_NEAR(spacing_m(3, ""), 0.75e-3, 1e-9);
  EXPECT_NEAR(spacing_m(1, ""), 0.5e-3, 1e-9);
  EXPECT_NEAR(spacing_m(1, "[fidelity]\nvoxel = '0.1mm'\n"), 0.25e-3, 1e-9);
  EXPECT_NEAR(spacing_m(8, "[fidelity]\ncontact = 'penalty'\n"), 0.5e-3, 1e-9);
  EXPECT_EQ(spacing_m(8, "[fidelity]\npreset = 'normal'\n"), fidelityPreset("normal").spacing_m);
  EXPECT_NEAR(spacing_m(1, "[fidelity]\nspacing = '2mm'\n"), 2e-3, 1e-12);
}

TEST_F(SceneFile, AnAutomaticFidelityIsReadAsAWishAndBuildsNothing) {
  const Scene scene =
      load(kPin + "[fidelity]\nauto = true\nbudget_hz = 500\nmemory_MB = 200\ncontact_limit = 7\n");
  ASSERT_TRUE(scene.fidelity_wish);
  EXPECT_EQ(scene.fidelity_wish->budget_hz, 500);
  EXPECT_EQ(scene.fidelity_wish->memory_bytes, 200e6);
  EXPECT_FALSE(scene.fidelity_wish->tolerance_m);
  EXPECT_EQ(scene.fidelity_wish->place, file() + ":7");
  EXPECT_EQ(scene.fidelity.contact_limit, 7);
  for (const ScenePart& part : scene.parts) EXPECT_FALSE(part.model);
  EXPECT_EQ(load("fidelity = 'auto'\n" + kPin).fidelity_wish->tolerance_m, 10e-6);
  EXPECT_FALSE(load(kPin).fidelity_wish);
}

TEST_F(SceneFile, ACadFileGivesAllItsPartsAndPartsRefineThem) {
  const Scene scene = load("unit = 'mm'\ncad = 'plate.stl'\n[[part]]\nname = 'plate'\nfixed = true\n");
  ASSERT_EQ(scene.parts.size(), 1u);
  EXPECT_TRUE(scene.parts[0].is_fixed);
}

struct Mistake {
  std::string text;   ///< follows a scene of two parts and one step (8 lines); with '!' at its beginning, it
                      ///< is the whole file
  std::string line;   ///< number of the line that the message must name
  std::string words;  ///< text that the message must have
};

TEST_F(SceneFile, AFileOfSeveralObjectsIsOnePartIfAskedFor) {
  std::string two;
  for (const char* name : {"left", "right"}) {
    two += "o " + std::string(name) + "\n";
    for (int i = 0; i < 4; ++i)
      two += "v " + std::to_string((*name == 'l' ? 0 : 50) + (i == 1 ? 10 : 0)) + (i == 2 ? " 10" : " 0") +
             (i == 3 ? " 10\n" : " 0\n");
    two += "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n";
  }
  write("two.obj", two);
  const std::string part = kPin + "[[part]]\nfile = 'two.obj'\n";
  EXPECT_NE(messageOf(part).find(
                "has 2 parts; name one of them with 'node', or write node = \"*\" for the whole file"),
            std::string::npos)
      << messageOf(part);
  const Scene scene = load(part + "node = '*'\n[[part]]\nfile = 'two.obj'\nnode = 'right'\n");
  ASSERT_EQ(scene.parts.size(), 4U);
  EXPECT_EQ(scene.parts[2].part.name, "two");
  EXPECT_NEAR(bounds(scene.parts[2].part.mesh).size().x(), 60e-3, 1e-8);
  EXPECT_EQ(scene.parts[3].part.name, "right");
  EXPECT_NEAR(bounds(scene.parts[3].part.mesh).size().x(), 10e-3, 1e-8);
}

TEST_F(SceneFile, GeometryThatNoPartHasIsToldOfEachTime) {
  const Scene scene = load("missing = '2 solids are left out'\n" + kPin);
  EXPECT_EQ(scene.warnings,
            std::vector<std::string>{"lacks geometry of its CAD file: 2 solids are left out"});
  EXPECT_NE(sceneText(scene, {"plate.stl", "pin.stl"}, "").find("\nmissing = \"2 solids are left out\"\n"),
            std::string::npos);
  EXPECT_EQ(sceneText(load(kPin), {"plate.stl", "pin.stl"}, "").find("missing"), std::string::npos);
}

TEST_F(SceneFile, EveryMistakeIsReportedWithLineAndKey) {
  const std::vector<Mistake> mistakes = {
      {"frcition = 1\n", "9", "key 'frcition' is unknown"},
      {"tolerence = 1\n", "9", "key 'tolerence' is unknown; did you mean 'tolerance'?"},
      {"xyz = 1\n", "9", "key 'xyz' is unknown; [[step]] may have part"},
      {"clearance = 'wide'\n", "9", "key 'clearance'"},
      {"clearance = true\n", "9", "key 'clearance' is true; expected a length"},
      {"clearance = -1\n", "9", "key 'clearance' is -1; expected at least 0"},
      {"clearance = nan\n", "9", "key 'clearance'"},
      {"clearance = '5'\n", "9", "key 'clearance'"},
      {"timeout_s = inf\n", "9", "key 'timeout_s' is inf; expected a finite number"},
      {"timeout_s = 0\n", "9", "key 'timeout_s' is 0; expected more than 0"},
      {"timeout_s = '1'\n", "9", "key 'timeout_s' is the text '1'; expected a number"},
      {"approach = [0, 1]\n", "9", "key 'approach' is a list of 2; expected 3 lengths"},
      {"approach = [0, nan, 1]\n", "9", "key 'approach'"},
      {"approach = [0, 0, 1]\nstart = {}\n", "9", "key 'approach' cannot be combined with 'start'"},
      {"start = [0, 0, 1]\n", "9", "key 'start' is a list of 3; expected {position"},
      {"start = {positon = [0, 0, 1]}\n", "9", "did you mean 'position'?"},
      {"start = {rotation_xyzw = [0, 0, 0, 0]}\n", "9", "key 'rotation_xyzw' has the length 0"},
      {"start = {rotation_xyzw = [0, 0, 0, 1], rpy_deg = [0, 0, 0]}\n", "9", "key 'rpy_deg'"},
      {"motion = 'screw'\n", "9", "key 'motion' is a screw, but the mesh has no thread"},
      {"pitch = '2mm'\n", "9", "key 'pitch' applies to a screw only"},
      {"motion = 'screw'\npitch = 1\nstart = {rpy_deg = [0, 0, 9]}\n", "9", "but the path rotates the part"},
      {"way_points = 3\n", "9", "key 'way_points' is 3; expected a list of poses"},
      {"way_points = [1]\n", "9", "key 'way_points'"},
      {"[[step]]\n", "9", "[[step]] has no 'part'"},
      {"[[step]]\npart = 'pin'\n", "10", "key 'part' names 'pin', which an earlier step mounts"},
      {"[[step]]\npart = 'plate'\n", "10", "key 'part' names 'plate', which is fixed"},
      {"[[step]]\npart = 'pim'\n", "10",
       "key 'part' names 'pim', which is not the name of a part; did you mean 'pin'?"},
      {"[[part]]\n", "9", "[[part]] has neither 'name' nor 'file'"},
      {"[[part]]\nname = 'x'\n", "9", "[[part]] has no 'file'"},
      {"[[part]]\nfile = 'pin.stl'\n", "9", "[[part]] is the second part named 'pin'"},
      {"[[part]]\nfile = 'gone.stl'\n", "10", "key 'file' cannot be used: gone.stl"},
      {"[[part]]\nfile = 3\n", "10", "key 'file' is 3; expected text in quotes"},
      {"[[part]]\nfile = ''\n", "10", "key 'file' is empty"},
      {"[[part]]\nfile = 'pin.stl'\nnode = 'lid'\n", "11",
       "key 'node' names 'lid', which is not the name of a part"},
      {"[[part]]\nname = 'x'\nfile = 'pin.stl'\nfixed = 1\n", "12",
       "key 'fixed' is 1; expected true or false"},
      {"[[part]]\nname = 'x'\nfile = 'pin.stl'\nfriction = -0.1\n", "12", "key 'friction' is -0.1"},
      {"[[part]]\nname = 'x'\nfile = 'pin.stl'\nrestitution = 2\n", "12", "key 'restitution' is 2"},
      {"[[part]]\nname = 'x'\nfile = 'pin.stl'\ncolor = 'red'\n", "12", "key 'color' is 'red'"},
      {"[[part]]\nname = 'x'\nfile = 'pin.stl'\ncolor = [1, 2, 3]\n", "12", "key 'color' is 2"},
      {"[operator]\nseed = 1.5\n", "10", "key 'seed' is 1.5; expected a whole number"},
      {"[operator]\nseed = -1\n", "10", "key 'seed' is -1"},
      {"[fidelity]\nsides = 'none'\n", "10", "key 'sides' is 'none'; expected one of: one, both"},
      {"[fidelity]\nvoxel = -0.1\n", "10", "key 'voxel' is -0.1; expected more than 0"},
      {"[fidelity]\npreset = 'finest'\n", "10",
       "key 'preset' is 'finest'; expected one of: fast, normal, fine"},
      {"[device]\nratchet = false\n", "10", "key 'ratchet' was renamed; write 'indexing'"},
      {"[fidelity]\ncontact = 'rigid'\n", "10",
       "key 'contact' is 'rigid', which was renamed; write 'constraint'"},
      {"[fidelity]\ncontact = 'compliant'\n", "10", "which was renamed; write 'penalty'"},
      {"[fidelity]\ncontact = 'soft'\n", "10",
       "key 'contact' is 'soft'; expected one of: constraint, penalty"},
      {"[fidelity]\nauto = true\ntolerance = -1\n", "11", "key 'tolerance' is -1; expected more than 0"},
      {"[fidelity]\ntolerance = 1\n", "10", "key 'tolerance' has an effect with 'auto = true' only"},
      {"[fidelity]\nauto = true\nvoxel = 1\n", "11", "key 'voxel' cannot be combined with 'auto = true'"},
      {"[fidelity]\ncontact_limit = 3\n", "10", "key 'contact_limit' is 3; expected at least 4"},
      {"[[part]]\nname = 'x'\nfile = 'pin.stl'\nvelocity_m_s = [1, 0, 0]\nfixed = true\n", "12",
       "key 'velocity_m_s' has no effect on a fixed part"},
      {"[[part]]\nname = 'x'\nfile = 'pin.stl'\nfixed = true\nangular_velocity_rad_s = [1, 0, 0]\n", "13",
       "key 'angular_velocity_rad_s' has no effect on a fixed part"},
      {"[record]\ncsv_rate_hz = 0\n", "10", "key 'csv_rate_hz' is 0"},
      {"clearance = \n", "9", "not valid TOML"},
      {"part = 'pin'\n", "9", "not valid TOML"},
      {"!", "1", "the scene has no part"},
      {"!unit = 'furlong'\n", "1", "key 'unit' is 'furlong'; expected one of: mm"},
      {"!unit = 'mm'\nstep = 3\n[[part]]\nfile = 'pin.stl'\n", "2", "key 'step'"},
      {"!part = [1]\n", "1", "key 'part' has 1 in it"},
      {"!device = 1\n[[part]]\nfile = 'pin.stl'\n", "3",
       "key 'file' cannot be used: pin.stl"},  // the file states no unit
      {"!\n[[part]]\nfile = 'pin.stl'\npose = {position = [1, 0, 0]}\n", "3", "key 'file' cannot be used"},
      {"!cad = 'gone.step'\nunit = 'mm'\n", "1", "key 'cad' cannot be used: gone.step"},
      {"!cad_fallback = 'pin.stl'\nunit = 'mm'\n", "1", "key 'cad_fallback' replaces a 'cad'"},
      {"!unit = 'mm'\ncad = 'plate.stl'\n[[part]]\nname = 'plat'\n", "4", "did you mean 'plate'?"},
      {"!unit = 'mm'\ncad = 'plate.stl'\n[[part]]\nname = 'plate'\n[[part]]\nname = 'plate'\n", "5",
       "second time"},
  };
  for (const Mistake& mistake : mistakes) {
    const bool is_alone = mistake.text.starts_with('!');
    const std::string words = messageOf(is_alone ? mistake.text.substr(1) : kStep + mistake.text);
    EXPECT_TRUE(words.starts_with("scene.toml:" + mistake.line + ": ")) << mistake.text << "-> " << words;
    EXPECT_NE(words.find(mistake.words), std::string::npos) << mistake.text << "-> " << words;
  }
}

TEST_F(SceneFile, PartsFartherAwayThan1000KmAreRefused) {
  const std::string pin = kPin + "pose = {position = [0, ";
  EXPECT_EQ(messageOf(pin + "0.99e9, 0]}\n"), "");
  for (const char* far_mm : {"1.01e9", "-1.01e9", "1e300"}) {
    EXPECT_EQ(messageOf(pin + far_mm + ", 0]}\n"),
              "scene.toml: part 'pin': is more than 1000 km from the origin; check its unit, its pose and "
              "the poses of its steps");
    EXPECT_NE(messageOf(kStep + "target = {position = [" + far_mm + ", 0, 0]}\n").find("more than 1000 km"),
              std::string::npos);
  }
}

TEST_F(SceneFile, AMissingSceneOrAFolderIsRefused) {
  EXPECT_THROW(loadScene((folder_ / "gone.toml").string()), LoadError);
  EXPECT_THROW(loadScene(folder_.string()), LoadError);
}

TEST_F(SceneFile, ATruncatedMeshIsNamedByItsLine) {
  write("pin.stl", stlBox(Vec3(4, 4, 20)).substr(0, 300));
  const std::string words = messageOf(kStep);
  EXPECT_TRUE(words.starts_with("scene.toml:6: key 'file' cannot be used: pin.stl")) << words;
}

TEST_F(SceneFile, CutAtEveryByteItLoadsOrIsRefused) {
  const std::string whole = kStep +
                            "start = {position = [0, '2cm', 3], rpy_deg = [0, 1, 2]}\nclearance = \"20um\"\n"
                            "[fidelity]\nsides = 'one'\n[operator]\nseed = 7\n# \xC3\xA9nd\n";
  int scenes = 0;
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    try {
      load(whole.substr(0, length));
      ++scenes;
    } catch (const LoadError&) {
    }
  }
  EXPECT_GT(scenes, 0);
}

TEST_F(SceneFile, TheDualArmMayHaveParametersOfTheUser) {
  const std::string scene = "unit = 'mm'\n[[part]]\nfile = 'pin.stl'\n[device]\nparameters = 'arms.toml'\n";
  EXPECT_NE(messageOf(scene).find("scene.toml:5: key 'parameters' cannot be used: arms.toml"),
            std::string::npos)
      << messageOf(scene);
  write("arms.toml", "[handle]\nmass_kg = 'heavy'\n");
  EXPECT_NE(messageOf(scene).find("key 'parameters' cannot be used: arms.toml"), std::string::npos);
  write("arms.toml", "[handle]\nmass_kg = {value = 0.3, assumed = 'mine is heavier'}\n");
  EXPECT_EQ(load(scene).device.data, (folder_ / "arms.toml").string());
}

TEST_F(SceneFile, ATableHeaderWithoutAKeyIsRefused) {
  // toml++ 3.3 would abort at these headers in a build with assertions.
  for (const char* header : {"[=]\n", "[[#]]\n", "[\n", "[[{x]]\n"})
    EXPECT_NE(messageOf(kStep + header).find("not valid TOML"), std::string::npos) << header;
}

TEST_F(SceneFile, AnyChangedByteLoadsOrIsRefused) {
  // Replaces each byte by characters with a meaning in TOML, and by forbidden characters.
  for (std::size_t at = 0; at < kStep.size(); ++at)
    for (const char byte : {'\0', '"', '\'', '[', ']', '{', '=', '\n', '#', '9', '\xFF', '\\'}) {
      std::string text = kStep;
      text[at] = byte;
      messageOf(text);
    }
}

}  // namespace
}  // namespace vps::scenes
