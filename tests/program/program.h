// SPDX-License-Identifier: BSD-3-Clause
// A test fixture that runs the program `vps` in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "support/stl_box.h"

namespace vps {

namespace fs = std::filesystem;

inline std::string slurp(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

struct Ran {
  int status = -1;  ///< -1: ended by a signal
  std::string out, err;
};

class Program : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("vps_program_" + std::string(info->name()));
    TearDown();
    fs::create_directories(folder_);
    write("plate.stl", stlBox(Vec3(20, 20, 10)));  // millimetres
    write("pin.stl", stlBox(Vec3(4, 4, 8)));
    write("cut.stl", stlBox(Vec3(4, 4, 8)).substr(0, 300));
    write("scene.toml", kScene);
  }
  void TearDown() override {
    fs::remove_all(folder_);
    fs::remove_all(folder_.string() + ".cache");
  }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  Ran run(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && XDG_CACHE_HOME='" + folder_.string() +
                                ".cache' '" VPS_PROGRAM "' " + arguments +
                                " >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder_ / "stdout.txt"),
            slurp(folder_ / "stderr.txt")};
  }

  /// Expects status 2, one line on stderr that contains these words, and no unfinished files.
  void expectRefused(const std::string& arguments, const std::string& words) const {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << "\n" << ran.out << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << arguments << "\n" << ran.err;
    EXPECT_TRUE(ran.err.starts_with("vps: ")) << arguments << "\n" << ran.err;
    EXPECT_NE(ran.err.find(words), std::string::npos) << arguments << "\n" << ran.err;
    EXPECT_EQ(ran.out, "") << arguments;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      EXPECT_EQ(entry.path().filename().string().find(".unfinished"), std::string::npos) << entry.path();
  }

  static constexpr const char* kScene =
      "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n[[part]]\nfile = 'pin.stl'\n"
      "pose = {position = [0, 0, 9.1]}\n";
  fs::path folder_;
};

}  // namespace vps
