// SPDX-License-Identifier: BSD-3-Clause
// The table of verdicts and exit statuses in viewer/cli/COMMANDS.md, row by row: `verdict` in the JSON file
// and the exit status say the same, and all commands say the same about the same parts.
#include <nlohmann/json.hpp>

#include <sstream>
#include <string>

#include "program.h"

namespace vps {
namespace {

using nlohmann::json;

class VerdictStatus : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("floor.stl", stlBox(Vec3(40, 40, 4)));
    write("wall.stl", stlBox(Vec3(40, 4, 4)));
    write("key.stl", stlBox(Vec3(16, 10.02, 3)));
  }

  static std::string part(const std::string& file, const std::string& name, const std::string& position,
                          const std::string& more = "fixed = true\n") {
    return "[[part]]\nfile = '" + file + "'\nname = '" + name + "'\npose = {position = [" + position +
           "]}\n" + more;
  }
  static std::string movedPart(const std::string& file, const std::string& name,
                               const std::string& position) {
    return part(file, name, position, "size_lower = '-1um'\nsize_upper = '1um'\n") + "[[step]]\npart = '" +
           name + "'\ntimeout_s = 0.5\n";
  }
  /// A pin of 8 mm that stands on a plate of 10 mm, `into_mm` too deep.
  static std::string pinScene(double into_mm) {
    std::ostringstream z;
    z << "0, 0, " << 9 - into_mm;
    return "unit = 'mm'\n" + part("plate.stl", "plate", "0, 0, 0") + movedPart("pin.stl", "pin", z.str());
  }
  /// A key that is 20 um wider than the space between two walls. No pair of parts alone shows that there is
  /// no place for the key.
  static std::string keyScene() {
    return "unit = 'mm'\n" + part("floor.stl", "floor", "0, 0, -2") + part("wall.stl", "left", "0, 7, 2") +
           part("wall.stl", "right", "0, -7, 2") + movedPart("key.stl", "key", "0, 0, 1.5");
  }

  void expectVerdict(const std::string& arguments, const std::string& verdict, int status) const {
    const Ran ran = run(arguments + " --json verdict.json");
    EXPECT_EQ(ran.status, status) << arguments << "\n" << ran.out << ran.err;
    ASSERT_NE(ran.status, 2) << arguments << "\n" << ran.err;
    EXPECT_EQ(json::parse(slurp(folder_ / "verdict.json"))["verdict"], verdict) << arguments << "\n"
                                                                                << ran.out;
  }
};

TEST_F(VerdictStatus, OfPartsThatFitIsGoodForEveryCommand) {
  write("fits.toml", pinScene(0));
  expectVerdict("check fits.toml", "fits", 0);
  expectVerdict("plan fits.toml -o planned", "fits", 0);
  expectVerdict("plan --verify planned/scene.toml", "fits", 0);
  expectVerdict("study fits.toml --geometry --runs 2", "fits", 0);
  expectVerdict("margin fits.toml --geometry", "fits", 0);
}

TEST_F(VerdictStatus, OfPartsThatOverlapAsDrawnButHaveFreePlacesIsGood) {
  write("moved.toml", pinScene(0.05));
  expectVerdict("check moved.toml", "fits", 0);
  expectVerdict("study moved.toml --geometry --runs 2", "fits", 0);
  expectVerdict("margin moved.toml --geometry", "fits", 0);
}

TEST_F(VerdictStatus, OfAProvenOverlapIsBlocked) {
  write("deep.toml", pinScene(1));
  expectVerdict("check deep.toml", "blocked", 1);
  expectVerdict("study deep.toml --geometry --runs 2", "blocked", 1);
  expectVerdict("margin deep.toml --geometry", "blocked", 1);
  expectVerdict("assemble deep.toml --out run --no-pictures", "blocked", 1);
}

TEST_F(VerdictStatus, OfAnOverlapWithoutPlacesAndWithoutProofIsNotShown) {
  write("open.toml", keyScene());
  expectVerdict("check open.toml", "not_shown", 3);
  expectVerdict("study open.toml --geometry --runs 1", "not_shown", 3);
  expectVerdict("margin open.toml --geometry --resolution 10um", "not_shown", 3);
}

TEST_F(VerdictStatus, OfAPathThatASceneStatesThroughAPartIsBlocked) {
  write("roof.toml", pinScene(0) + part("plate.stl", "roof", "0, 0, 30"));
  expectVerdict("plan --verify roof.toml", "blocked", 1);
}

}  // namespace
}  // namespace vps
