// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "vps/errors.h"
#include "vps/pointshell.h"

namespace vps {
namespace {

namespace fs = std::filesystem;

class PlyIo : public testing::Test {
 protected:
  PlyIo() : folder_(fs::temp_directory_path() / ("vps_ply_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~PlyIo() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  [[nodiscard]] std::string path(const std::string& name = "shell.ply") const {
    return (folder_ / name).string();
  }
  void write(const std::string& content) const { std::ofstream(path(), std::ios::binary) << content; }
  [[nodiscard]] std::string content() const {
    std::ifstream in(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  /// The error's text, or "accepted".
  [[nodiscard]] std::string refusal() const {
    try {
      static_cast<void>(loadPly(path()));
    } catch (const LoadError& error) {
      return error.what();
    }
    return "accepted";
  }
  fs::path folder_;
};

const std::string kAscii =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty float nx\nproperty float ny\n"
    "property float nz\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n"
    "property double area\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 1 0.5 0 0 255 4\n0 0 -1 1e-3 2 -3 0 1\n0.7071068 0.7071068 0 1 1 1 9 4\n3 0 1 2\n";

TEST_F(PlyIo, AShellIsReadBackToTheBit) {
  const PointShell saved = buildPointShell(makeCylinder(5e-3, 8e-3, 60), {0.7e-3, 0.35});
  savePly(saved, path());
  const PointShell loaded = loadPly(path());
  EXPECT_EQ(loaded.points, saved.points);
  EXPECT_EQ(loaded.inward, saved.inward);
  EXPECT_EQ(loaded.area_m2, saved.area_m2);
  EXPECT_EQ(loaded.order, saved.order);
  EXPECT_EQ(loaded.spacing_m, saved.spacing_m);
  ASSERT_EQ(loaded.nodes.size(), saved.nodes.size());
  for (std::size_t i = 0; i < saved.nodes.size(); ++i) {
    EXPECT_EQ(loaded.nodes[i].center, saved.nodes[i].center);
    EXPECT_EQ(loaded.nodes[i].radius_m, saved.nodes[i].radius_m);
    EXPECT_EQ(loaded.nodes[i].skip, saved.nodes[i].skip);
  }
}

TEST_F(PlyIo, AsciiOfAnotherProgramIsReadInAnyOrderOfProperties) {
  write(kAscii);
  const PointShell shell = loadPly(path());
  ASSERT_EQ(shell.size(), 3u);
  EXPECT_EQ(shell.points[1], Vec3(1e-3, 2, -3));
  EXPECT_EQ(shell.inward[1], Vec3(0, 0, -1));
  EXPECT_EQ(shell.area_m2[0], 4);
  EXPECT_NEAR(shell.inward[2].norm(), 1, 1e-15);  // written with seven digits, normalised on reading
  EXPECT_EQ(shell.spacing_m, std::sqrt(3.0));     // spacing of the mean area
  EXPECT_EQ(shell.nodes.size(), 1u);
}

TEST_F(PlyIo, AFileCutAtAnyByteIsRefused) {
  savePly(buildPointShell(makeBox({1e-3, 1e-3, 1e-3}), {2e-3, 0.35}), path());
  const std::string binary = content();
  const std::string ascii = kAscii.substr(0, kAscii.find("element face")) + "end_header\n" +
                            "0 0 1 0.5 0 0 255 4\n0 0 -1 1e-3 2 -3 0 1\n0.7071068 0.7071068 0 1 1 1 9 4\n";
  for (const std::string& whole : {binary, ascii}) {
    write(whole);
    ASSERT_EQ(refusal(), "accepted");
    for (std::size_t size = whole.size(); size-- > 0;) {
      fs::resize_file(path(), size);
      ASSERT_NE(refusal(), "accepted") << "cut to " << size << " of " << whole.size() << " bytes";
    }
  }
}

TEST_F(PlyIo, AnyDamagedByteIsRefusedOrGivesAValidShell) {
  savePly(buildPointShell(makeBox({1e-3, 1e-3, 1e-3}), {2e-3, 0.35}), path());
  const std::string whole = content();
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char with : {'\0', '9', '\xff'}) {
      std::string damaged = whole;
      damaged[i] = with;
      write(damaged);
      try {
        const PointShell shell = loadPly(path());
        ASSERT_EQ(shell.inward.size(), shell.size());
        for (const Vec3& p : shell.points) ASSERT_TRUE(p.allFinite());
      } catch (const LoadError&) {
      }
    }
}

TEST_F(PlyIo, ErrorsNameTheFile) {
  const auto refusalOf = [this](const std::string& from, const std::string& to) {
    std::string text = kAscii;
    text.replace(text.find(from), from.size(), to);
    write(text);
    return refusal();
  };
  EXPECT_NE(refusalOf("ply\n", "solid\n").find("not a PLY"), std::string::npos);
  EXPECT_NE(refusalOf("ascii", "binary_big_endian").find("binary_little_endian"), std::string::npos);
  EXPECT_NE(refusalOf("double area", "double weight").find("'area'"), std::string::npos);
  EXPECT_NE(refusalOf("uchar red", "list uchar int red").find("'list'"), std::string::npos);
  EXPECT_NE(refusalOf("vertex 3", "vertex 0").find("no points"), std::string::npos);
  EXPECT_NE(refusalOf("vertex 3", "vertex 99999999999999999").find("ends early"), std::string::npos);
  EXPECT_NE(refusalOf("1e-3 2 -3", "nan 2 -3").find("point 1 is not finite"), std::string::npos);
  EXPECT_NE(refusalOf("1e-3 2 -3", "1e-3 two -3").find("two"), std::string::npos);
  EXPECT_NE(refusalOf("0 0 -1", "0 0 -2").find("normal of length 2"), std::string::npos);
  EXPECT_NE(refusalOf("255 4", "255 -4").find("negative area"), std::string::npos);
  EXPECT_NE(refusalOf("255 4", "255").find("too few numbers"), std::string::npos);
  EXPECT_NE(refusalOf("255 4", "255 4 4").find("too many numbers"), std::string::npos);
  EXPECT_NE(refusalOf("255 4", "255").find("shell.ply"), std::string::npos);
  fs::remove(path());
  EXPECT_NE(refusal().find("cannot be opened"), std::string::npos);
}

TEST_F(PlyIo, AFailedWriteLeavesTheOldFileAndNoOther) {
  const PointShell shell = buildPointShell(makeBox({1e-3, 1e-3, 1e-3}), {1e-3, 0.35});
  EXPECT_THROW(savePly(shell, path("no/such/folder.ply")), LoadError);
  fs::create_directory(path("taken.ply"));  // a folder cannot be replaced by a file
  EXPECT_THROW(savePly(shell, path("taken.ply")), LoadError);
  const fs::path folder = fs::path(path()).parent_path();
  for (const auto& left : fs::directory_iterator(folder)) EXPECT_EQ(left.path(), path("taken.ply"));
}

}  // namespace
}  // namespace vps
